"""`stabilab sweep`, `bifurcation`, `basin` and `atlas`: one case over ranges of its numbers."""
from __future__ import annotations

from ..maps.atlas.run import asked, drawn
from ..maps.basins.ask import basins
from ..maps.bifurcation.ask import bifurcation as ask
from ..maps.diagram_certificate import certifiable, diagram_certificate
from ..maps.plan import planned, split_keys
from ..maps.run import run
from ..show import certification
from ..show.files import endings
from ..show.maps import atlas as atlas_shown
from ..show.maps import basins as basins_shown
from ..show.maps import bifurcation as diagram_shown
from ..show.maps import bifurcation_picture, to_file
from ..show.maps import sweep as sweep_shown
from ..show.units import units_of
from .common.output import leave_undecided, say, say_written, unphysical, write_answer


def sweep(case, vary, samples, seed, answer, follow, out, workers, scheduler, csv, json, strict, **limits):
    """Answer the case at every point. limits: those of the answer when, by the names of their options."""
    plan = planned(case, split_keys(vary or []), samples, seed, answer, follow, **limits)
    if out:
        sweep_shown.checked(out)
    with run(plan, out, workers, scheduler) as found:
        files = [sweep_shown.write(sweep_shown.dataset(found), out)] if out else []
    write_answer(sweep_shown, found, json, csv)
    say_written(files)
    leave_undecided(strict, strict and (sweep_shown.undecided(found) or unphysical([plan.case])))


def bifurcation(case, vary, curve, out, certify, csv, json):
    """Find where equilibria appear and vanish over the range of one number or two."""
    if out:
        endings.file(out, endings.PICTURES)
    spans = split_keys(vary or [], "KEY=FROM:TO")
    if certify:
        endings.file(certify, (".json",))
        certifiable(spans)
    found = ask(case, spans, curve)
    made = diagram_certificate(found) if certify else None
    files = [bifurcation_picture.write(found, out)] if out else []
    write_answer(diagram_shown, found, json, csv)
    say_written(files)
    if made:
        say("\n".join([f"written: {certification.write(made, certify)}",
                       f"certified: {len(made['events'])} values, {len(made['pieces'])} counts between them",
                       *(f"not certified: {why}" for why in made["uncertified"])]))


def basin(case, vary, depth, out, workers, scheduler, follow, csv, json, strict):
    """Show which initial states of a plane spin up, and how rough the boundary is."""
    targets = to_file.checked(out or [])
    with basins(case, split_keys(vary or [], "KEY=FROM:TO or KEY=FROM:TO:N"), depth,
                to_file.data_of(targets), workers, scheduler, follow) as found:
        files = [to_file.write_basins(found, path) for path in targets]
    write_answer(basins_shown, found, json, csv)
    say_written(files)
    leave_undecided(strict, strict and (basins_shown.undecided(found) or unphysical([found.plan.case])))


def atlas(case, torque, wheel, level, refine, certify, follow, no_time, out, workers, scheduler, units, csv,
          json, strict, **limits):
    """Map all directions of a torque. limits: what is to be reached, by the names of the options."""
    plan = asked(case, torque, wheel, level, refine, certify, follow, not no_time, **limits)
    system, targets = units_of(plan.case, units), to_file.checked(out or [], to_file.PAGES)
    with drawn(plan, targets[0] if targets else None, workers, scheduler) as found:
        files = [to_file.write_atlas(found, target, system) for target in targets]
    write_answer(atlas_shown, found, json, csv, system)
    say_written(files)
    leave_undecided(strict, strict and (atlas_shown.undecided(found) or unphysical([plan.case])))
