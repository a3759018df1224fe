"""Commands about one case file, and those that compare methods.

`stabilab show`: the equations of a case and the laws that hold; `example`: a case to begin with; `import`:
another program's spacecraft as a case; `export`: the body of a case for other programs.

`stabilab compare` and `precision`: how far analytic models and numerical methods are from the exact
motion, and at what cost.
"""
from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from ..answers.motion import Needs
from ..case.formats import IMPORTERS, importer_of
from ..case.programs.export_urdf import exported
from ..case.programs.imported import case_text, faults_of
from ..case.read import Case
from ..case.source import EXAMPLES, LARGEST_IMPORT, command_of, source_text
from ..case.source import example as text_of
from ..case.write import data_of
from ..cost.accuracy import precision as measure
from ..errors import InputError, printable
from ..files import write_text
from ..show import endings, precision_overview
from ..show import precision as shown
from ..show.space.span import natural, seen
from ..show.terminal import say, tell
from ..show.text import cost
from ..show.text.scene import of_all
from ..show.units import SI
from ..theories.follow import models_of
from ..theories.theory import compare as set_side_by_side
from .common import load_cases, motion_of, time_asked
from .runner import View, run
from .writing import write, write_each

COMPARE = View(text=cost.text, data=cost.as_dict, law=lambda case, result: result.validity, files=(".csv",),
               drawn=lambda case, result, units, path: cost.write(case, result, path))
PRECISION = View(text=lambda case, result, units: shown.text(result),
                 data=lambda case, result: shown.as_dict(result), csv=shown.CSV,
                 law=lambda case, result: result.validity, files=shown.FILES,
                 drawn=lambda case, result, units, path: shown.write(result, path),
                 short=lambda result: [] if result.questions else [result.reference.reason])

if TYPE_CHECKING:
    from pathlib import Path


def show(case: Path):
    """Equations and laws of a case, of every combination where it has a [sweep]."""
    tell(of_all(load_cases([case])))


def example(name):
    """The list of examples, or the text of one."""
    if name is not None:
        write(text_of(name).rstrip("\n"))
        return
    rows = [f"  {info:<14}{command_of(info):<10}{data_of(text_of(info))['title']}" for info in EXAMPLES]
    tell("\n".join(["stabilab example NAME > NAME.toml writes one of these, for stabilab COMMAND NAME.toml.",
                    "", f"  {'NAME':<14}COMMAND", *rows]))


def import_(file, out, stuck, body=None):
    """Write the case, name what has no counterpart, and refuse what has faults yet."""
    supplied = source_text(file, LARGEST_IMPORT)
    importer = importer_of(supplied)
    if body is not None and not importer.bodies:
        names = ", ".join(item.name for item in IMPORTERS if item.bodies)
        raise InputError(f"--body takes a body of one of {names}, and {printable(str(file))} is none")
    result = importer.read(supplied, file, body)
    if isinstance(result, str):
        _written(result, file, out, stuck)
        return
    text = case_text(result, file, stuck or ())
    _written(text, file, out, (), (*result.caveats, *result.said), result.omitted)


def _written(text, file, out, stuck, said=(), omitted=()):
    """Write the case, then say what was done with the rest, and what its reader refuses."""
    if stuck:
        raise InputError(
            f"--stuck: {printable(str(file))} has the tables of a case: write stuck = true there")
    if out:
        say(f"written: {write_text(out, text)}")
    else:
        write(text)
    for phrase in said:
        say(f"{printable(str(file))}: {printable(phrase)}")
    for phrase in omitted:
        say(f"{printable(str(file))}: no counterpart: {printable(phrase)}")
    faults = faults_of(text, out or file)
    if faults:
        raise InputError("\n".join(("the case has faults yet:", *faults)))


def export(case, out):
    """Write the body of a case for other programs, of every combination where it has a [sweep]; name what
    that has no place for."""
    if out:
        endings.file(out, (".urdf",))
    results = exported(str(case))
    if not out and len(results) > 1:
        raise InputError(f"{printable(str(case))}: its [sweep] makes {len(results)} cases: give --out "
                         "FILE.urdf for a file of each")
    if out:
        write_each(out, [(item.case, partial(write_text, text=item.text)) for item in results])
    else:
        write(results[0].text)
    for phrase in dict.fromkeys(phrase for item in results for phrase in item.said):
        say(f"{printable(str(case))}: {printable(phrase)}")
    left = list(dict.fromkeys(phrase for item in results for phrase in item.left))
    if left:
        say(f"{printable(str(case))}: no place for: {', '.join(left)}")


def compare(case, order, out, json, strict, units):
    """Set the models of a case beside its exact motion."""
    loaded = load_cases([case], motion=True)
    for item in loaded:
        if item.span is None:
            raise InputError(f"{item.place}: motion: no span; compare needs span = [0, T] in [motion]")
        if models_of(item.scene) == ("exact",):
            raise InputError(
                f"{item.place}: no analytic model applies to this scene; there is nothing to compare")
    run(COMPARE, loaded, lambda entry: set_side_by_side(entry, order=order), units=units, out=out, json=json,
        strict=strict)


def precision(case, json, csv, out, until, quick, all_settings, overview, strict):
    """Measure error and time of every method."""
    if out:
        shown.checked(out)
    loaded = load_cases([case], motion=True)
    ends = {item.place: _end(item, until) for item in loaded}
    view = replace(PRECISION, text=lambda item, result, units: shown.text(result, all_settings))
    if overview:
        if out is None or out.suffix == ".csv":
            raise InputError("--overview: expected a picture, --out FILE.png, .svg or .pdf")
        view = replace(view, drawn=lambda item, result, units, path: precision_overview.write(result, path))
    run(view, loaded, lambda item: measure(item, "quick" if quick else "full", ends[item.place]),
        systems=[SI] * len(loaded), out=out, json=json, csv=csv, strict=strict)


def _end(case: Case, until: str | None):
    """The end of the span, None for the case's own; as pictures have it where there is neither."""
    if until is not None or case.span is not None:
        return time_asked(until, case, "until")
    return seen(None, motion_of(case, needs=Needs.QUICK), natural(case.scene, case.state))[1]
