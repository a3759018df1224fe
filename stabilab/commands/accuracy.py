"""`stabilab compare` and `precision`: how far analytic models and numerical methods are from the exact
motion, and at what cost."""
from __future__ import annotations

from functools import partial

from ..case.read import blamed_on
from ..cost.accuracy import precision as measure
from ..errors import InputError
from ..show.files import endings
from ..show.spans import natural, seen
from ..show.text import law
from ..show.text.cost import comparison
from ..show.text.cost import precision as shown
from ..theories.comparison import compare as set_side_by_side
from ..theories.follow import models_of
from .common.cases import answers_of, load_cases, motion_of, one_by_one, time_asked, units_asked
from .common.output import all_reached, hold_laws, tell, write, write_each, write_json


def compare(case, order, out, json, strict, units):
    """Set the models of a case beside its exact motion."""
    loaded = load_cases([case], motion=True)
    systems = units_asked(loaded, units)
    if out:
        endings.file(out, (".csv",))
    for one in loaded:
        if one.span is None:
            raise InputError(f"{one.place}: motion: no span; compare needs span = [0, T] in [motion]")
        if models_of(one.scene) == ("exact",):
            raise InputError(
                f"{one.place}: no analytic model applies to this scene; there is nothing to compare")
    compared = answers_of(loaded, lambda one: set_side_by_side(one, order=order))
    if out:
        write_each(out, [(one, partial(comparison.write, one, found)) for one, found in compared])
    if json:
        write_json(loaded,
                   [comparison.as_dict(one, found) | law.key(found.validity, one) for one, found in compared])
    else:
        tell("\n\n".join(law.first(found.validity, comparison.text(one, found, system), system, one.caveats)
                         for (one, found), system in zip(compared, systems)))
    hold_laws(strict, (found.validity for _, found in compared), loaded)


def precision(case, json, csv, out, until, quick, all_settings, strict):
    """Measure error and time of every method."""
    if out:
        shown.checked(out)
    loaded = load_cases([case], motion=True)
    effort = "quick" if quick else "full"
    measured = []
    for one in one_by_one(loaded):
        end = _end(one, until)
        with blamed_on(one):
            measured.append(measure(one, effort, end))
    if out:
        write_each(out, [(found.case, partial(shown.write, found)) for found in measured])
    if json:
        write_json(loaded, [shown.as_dict(found) | law.key(found.validity, found.case) for found in measured])
    elif csv:
        write(shown.csv(*measured))
    else:
        tell("\n\n".join(law.first(found.validity, shown.text(found, all_settings),
                                   caveats=found.case.caveats) for found in measured))
    all_reached((found.case, found.reference.reason) for found in measured if not found.questions)
    hold_laws(strict, (found.validity for found in measured), [found.case for found in measured])


def _end(case, until):
    """The end of the span, None for the case's own; as pictures have it where there is neither."""
    if until is not None or case.span is not None:
        return time_asked(until, case, "until")
    return seen(None, motion_of(case, brief=True), natural(case.scene, case.state))[1]
