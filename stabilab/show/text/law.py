"""How far approximate laws hold: the first line of a text, a key of JSON, a line of a picture, exit code."""
from __future__ import annotations

import math
from dataclasses import replace

from ... import caveat
from ...answers.caveats import caveats_of, limited
from ...case.attitude import vertical_of
from ...errors import printable
from ...physics.coefficients import limits_of
from .. import limiting
from ..axes import axes_of
from ..terminal.letters import lettered
from ..units import SI, Units, units_of

MOST = 1e5  # rad of turn along which a law beside other answers is judged: seconds


def first(validity, text: str, units: Units = SI, caveats=()) -> str:
    """The text with the caveats of its case, and with what is to be said of its law: behind the answer where
    the law holds; where it does not, as what follows is then no motion of such a body, that it does not
    before the answer, and by how much in a line below. units: of times."""
    text = limiting.noted(caveats, text, units)
    if validity is None:
        return text
    answer, *rest = text.split("\n")
    words = lettered(units.words(printable(validity.words)))
    if validity.held:
        return "\n".join([f"{answer}; {words}", *rest])
    return "\n".join([warned(validity, answer), f"law: {words.removeprefix(f'{validity.status.upper()}: ')}",
                      *rest])


def warned(validity, answer: str) -> str:
    """The answer, behind a warning where its law does not hold: of a line that has room for no more."""
    return f"{validity.status.upper()}; by that law: {answer}" if beyond(validity) else answer


def key(validity, case=None, steady: bool = False) -> dict:
    """The key "validity" of a JSON object, null where all laws are exact; of a case also its caveats, where
    the answer is no motion, which has them. steady: as of `caveats_of`."""
    told = {"validity": None if validity is None else validity.as_dict()}
    return (told if case is None
            else told | caveat.key(caveats_of(case.scene, steady, validity=validity, file=case.caveats)))


def worst(*found):
    """The most exceeded of several; None where all laws are exact."""
    return max((v for v in found if v is not None), key=lambda v: v.excess, default=None)


def beyond(*found) -> bool:
    """Whether a law does not hold."""
    return any(v is not None and not v.held for v in found)


def of_case(case, span=None, brief=False):
    """Of a case's own motion over a span, its own where None is given (15 units of time without one), at rest
    where it has none; None where all laws are exact, or, if brief, where more than a few power series were
    needed. Of a motion of very many turns it is that of the first ones, as `over` says."""
    limits = limits_of(case.scene)
    if limits is None:
        return None
    if case.state is None:
        return limits.validity(case.scene, (0.0,) * 3, "at rest")
    span = span or case.span or (0.0, 15.0)
    if "attitude" in case.blocks:
        from ...integrate.limits_along import law_along
        found = law_along(case.scene, case.state, vertical_of(*case.blocks["attitude"]), span)
        if found is not None:
            return found
    if brief:
        return None
    from ...answers.simulate import simulate
    spin, longest = math.hypot(*case.state), max(map(abs, span))
    if spin * longest <= MOST:
        return simulate(case.scene, case.state, span, case.blocks).validity
    first = tuple(t * MOST / (spin * longest) for t in span)
    found = simulate(case.scene, case.state, first, case.blocks).validity
    over = f"along the first {MOST / spin:.2g} s of the run"
    return found and replace(found, over=over, also=tuple(replace(one, over=over) for one in found.also))


def judged(case, motion, brief=False):
    """The motion with its law judged along the case's own run, where that hangs on the attitude and the case
    gives one, and with the caveats of the case. brief: of `of_case`, and without the time to the limit of the
    case."""
    if motion is None:
        return motion
    found = of_case(case, brief=brief) if _open(case, motion.validity) else None
    motion = limited(motion if found is None else replace(motion, validity=found), case.scene, case)
    if case.limits is None or brief:
        return motion
    from ...answers.when import with_first
    return with_first(case, motion)


def until(case, found, end: float):
    """The validity `found`, or that along the case's own run up to a time `end` (its span where that is none)
    where it hangs on the attitude and the case gives one."""
    return of_case(case, (0.0, end) if 0 < end < math.inf else None) if _open(case, found) else found


def _open(case, validity) -> bool:
    return validity is not None and validity.holds is None and "attitude" in case.blocks


def beside(case) -> list[str]:
    """A line beside answers at many points, where a law is not judged; none where all are exact."""
    found = of_case(case)
    return [] if found is None else [f"  laws are not judged at every point; of the case as it stands: "
                                     f"{_told(found, units_of(case))}"]


def of_cases(cases) -> str:
    """A line for every law among cases that one of them leaves; empty where there is none."""
    beyond = [(case, found) for case in cases if (found := of_case(case)) is not None and not found.held]
    return "\n".join(_of_alike(group, cases) for group in _alike(beyond))


def lines_of(judged, units: Units = SI) -> list[str]:
    """A line for every (case, validity) that has a law to be told, one for all combinations of a file that
    stand the same way to the same limit, and one for all cases that say the same; without a name where there
    is one case. units: in which times are told."""
    groups, cases = _alike([one for one in judged if one[1] is not None]), [case for case, _ in judged]
    if len(cases) == 1:
        return [_told(found, units) for group in groups for _, found in group]
    return together([_of_alike(group, cases, units) for group in groups])


def _told(found, units) -> str:
    return lettered(units.words(found.words))


def _alike(judged) -> list:
    """The (case, validity) in groups: alone, or all combinations of a file that stand alike to one limit."""
    told: dict = {}
    for n, (case, found) in enumerate(judged):
        told.setdefault((case.path, found.status, found.effect, found.number) if case.variant else n,
                        []).append((case, found))
    return list(told.values())


def together(lines) -> list[str]:
    """Lines of `of_cases`, those that say the same of several cases as one line that names them all."""
    told: dict[str, list[str]] = {}
    for line in lines:
        words, _, name = line.rpartition(" (")
        told.setdefault(words, []).append(name.removesuffix(")"))
    return [f"{words} ({', '.join(names)})" for words, names in told.items()]


def _of_alike(group, cases, units: Units = SI) -> str:
    """A line on a case, or on the most exceeded of a group of combinations."""
    case, _ = group[0]
    found = worst(*(one for _, one in group))
    words = _told(found, replace(units, axes=axes_of(case)))
    if not case.variant:
        return f"{words} ({printable(case.name)})"
    farthest = "" if found.value is None else ", the farthest of them given"
    of = sum(other.path == case.path for other in cases)
    return (f"{words} ({printable(case.name.removesuffix(case.variant))}: {len(group)} of {of} "
            f"combinations{farthest})")
