"""`stabilab sweep`, `bifurcation`, `basin` and `atlas`: one case over ranges of its numbers."""
from __future__ import annotations

from ..maps.atlas.run import asked, drawn
from ..maps.basins.ask import basins
from ..maps.bifurcation.ask import bifurcation as ask
from ..maps.bifurcation.family import Diagram
from ..maps.diagram_certificate import certifiable, diagram_certificate
from ..maps.plan import planned, split_keys
from ..maps.run import run
from ..show.files import endings
from ..show.maps import dataset, words
from ..show.maps.atlas import to_file as atlas_files
from ..show.maps.atlas import words as atlas_words
from ..show.maps.basins import words as basin_words
from ..show.maps.basins import write as basin_files
from ..show.maps.bifurcation import picture as diagram_picture
from ..show.maps.bifurcation import plane_picture, plane_words
from ..show.maps.bifurcation import words as diagram_words
from ..show.text import certification
from ..show.units import units_of
from .common.output import answer, leave_undecided, say, say_written, unphysical


def sweep(case, vary, samples, seed, answers, follow, limits, out, workers, scheduler, csv, json, strict):
    """Answer the case at every point. limits: those of the answer when, by the names of their options."""
    plan = planned(case, split_keys(vary or []), samples, seed, answers, follow, **limits)
    if out:
        dataset.checked(out)
    with run(plan, out, workers, scheduler) as found:
        files = [dataset.write(dataset.dataset(found), out)] if out else []
    answer(words, found, json, csv)
    say_written(files)
    leave_undecided(strict, strict and (words.undecided(found) or unphysical([plan.case])))


def bifurcation(case, vary, curve, out, certify, csv, json):
    """Find where equilibria appear and vanish over the range of one number or two."""
    if out:
        endings.file(out, endings.PICTURES)
    spans = split_keys(vary or [], "KEY=FROM:TO")
    if certify:
        certification.checked(certify)
        certifiable(spans)
    found = ask(case, spans, curve)
    made = diagram_certificate(found) if certify else None
    shown, picture = ((diagram_words, diagram_picture) if isinstance(found, Diagram)
                      else (plane_words, plane_picture))
    files = [picture.write(found, out)] if out else []
    answer(shown, found, json, csv)
    say_written(files)
    if made:
        _certified(made, certify)


def _certified(made, path):
    say("\n".join([f"written: {certification.write(made, path)}",
                   f"certified: {len(made['events'])} values, {len(made['pieces'])} counts between them",
                   *(f"not certified: {why}" for why in made["uncertified"])]))


def basin(case, vary, depth, out, workers, scheduler, follow, csv, json, strict):
    """Show which initial states of a plane spin up, and how rough the boundary is."""
    targets = basin_files.checked(out or [])
    with basins(case, split_keys(vary or [], "KEY=FROM:TO or KEY=FROM:TO:N"), depth, targets.data, workers,
                scheduler, follow) as found:
        files = [basin_files.write(found, path) for path in targets.paths]
    answer(basin_words, found, json, csv)
    say_written(files)
    leave_undecided(strict, strict and (basin_words.undecided(found) or unphysical([found.plan.case])))


def atlas(case, torque, wheel, level, refine, certify, follow, timed, limits, out, workers, scheduler, units,
          csv, json, strict):
    """Map all directions of a torque. limits: what is to be reached, by the names of the options."""
    plan = asked(case, torque, wheel, level, refine, certify, follow, timed, **limits)
    system, targets = units_of(plan.case, units), atlas_files.checked(out or [])
    with drawn(plan, targets[0] if targets else None, workers, scheduler) as found:
        files = [atlas_files.write(found, target, system) for target in targets]
    answer(atlas_words, found, json, csv, system)
    say_written(files)
    leave_undecided(strict, strict and (atlas_words.undecided(found) or unphysical([plan.case])))
