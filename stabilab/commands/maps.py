"""`stabilab bifurcation`, `basin`, `atlas`: one case over ranges of its numbers as a map, and its picture."""
from __future__ import annotations

from ..errors import InputError
from ..maps.atlas import asked, drawn
from ..maps.basins import basins
from ..maps.bifurcation.ask import bifurcation as ask
from ..maps.bifurcation.diagram import certifiable, diagram_certificate
from ..maps.bifurcation.tops import TopDiagram
from ..maps.plan import split_keys
from ..show import certification, endings
from ..show.maps import atlas as atlas_shown
from ..show.maps import basins as basins_shown
from ..show.maps import bifurcation as diagram_shown
from ..show.maps import bifurcation_picture
from ..show.maps import rotations as rotations_shown
from ..show.maps import to_file as map_files
from ..show.maps import tops as tops_shown
from ..show.terminal import say
from ..show.units import units_of
from .writing import of_map, say_written, write_answer


def bifurcation(case, vary, curve, momentum, spin, out, certify, csv, json):
    """Find where equilibria appear and vanish over the range of one number or two."""
    if out:
        endings.file(out, endings.PICTURES)
    spans = split_keys(vary or [], "KEY=FROM:TO")
    rotations = momentum is not None or spin is not None
    if certify and rotations:
        raise InputError("--certify: no certificate is known of rotations at one momentum or spin")
    if certify:
        endings.file(certify, (".json",))
        certifiable(spans)
    if rotations:
        result = ask(case, spans, curve, momentum=momentum, spin=spin)
        write_answer(rotations_shown, result, json, csv)
        say_written([rotations_shown.write(result, out)] if out else [])
        return
    result = ask(case, spans, curve)
    if isinstance(result, TopDiagram):
        if certify:
            raise InputError("--certify: no certificate is known of the steady motions of a top")
        write_answer(tops_shown, result, json, csv)
        say_written([tops_shown.write(result, out)] if out else [])
        return
    made = diagram_certificate(result) if certify else None
    files = [bifurcation_picture.write(result, out)] if out else []
    write_answer(diagram_shown, result, json, csv)
    say_written(files)
    if made:
        say("\n".join([f"written: {certification.write(made, certify)}",
                       f"certified: {len(made['events'])} values, {len(made['pieces'])} counts between them",
                       *(f"not certified: {why}" for why in made["uncertified"])]))


def basin(case, vary, depth, out, workers, scheduler, follow, csv, json, strict):
    """Show which initial states of a plane spin up, and how rough the boundary is."""
    targets = map_files.checked(out or [])
    with basins(case, split_keys(vary or [], "KEY=FROM:TO or KEY=FROM:TO:N"), depth,
                map_files.data_of(targets), workers, scheduler, follow) as result:
        files = [map_files.write_basins(result, path) for path in targets]
    of_map(basins_shown, result, result.plan.case, files, json, csv, strict)


def atlas(case, torque, wheel, level, refine, certify, follow, no_time, out, workers, scheduler, units, csv,
          json, strict, **limits):
    """Map all directions of a torque. limits: what is to be reached, by the names of the options."""
    plan = asked(case, torque, wheel, level, refine, certify, follow, not no_time, **limits)
    system, targets = units_of(plan.case, units), map_files.checked(out or [], map_files.PAGES)
    with drawn(plan, targets[0] if targets else None, workers, scheduler) as result:
        files = [map_files.write_atlas(result, target, system) for target in targets]
    of_map(atlas_shown, result, plan.case, files, json, csv, strict, system)
