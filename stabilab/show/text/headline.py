"""The answer in one line: what becomes of a motion and when, how large its rates grow, how far it is from
another fate, and its period; and how that line looks.

How far approximate laws hold stands above it: the first line of a text, a key of JSON, a line of a picture,
an exit code."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from ... import errors
from ...answers.caveats import caveats_of
from ...answers.motions.of_case import judged as judged
from ...answers.motions.of_case import law_is_open
from ...answers.motions.of_case import law_of as of_case
from ...errors import Kind, printable
from ...orbit.result import HEADS, OVER_SPAN
from .. import ending, limiting
from ..axes import PLAIN, axes_of, direction
from ..terminal import capital
from ..units import SHORT, SI, Unit, Units, as_bound, number, units_of

if TYPE_CHECKING:
    from ...case.read import Case
    from ...orbit.result import Motion
    from ...reasons import Reason


# --- How far an approximate law holds
def first(validity, text: str, units: Units = SI, caveats=()) -> str:
    """The text with the caveats of its case, and with what is to be said of its law: behind the answer where
    the law holds; where it does not, as what follows is then no motion of such a body, that it does not
    before the answer, and by how much in a line below. units: of times."""
    text = limiting.noted(caveats, text, units, law=validity is None)
    if validity is None:
        return text
    answer, *rest = text.split("\n")
    phrase = units.said(validity.reason)
    if validity.held:
        return "\n".join([f"{answer}; {phrase}", *rest])
    return "\n".join([warned(validity, answer), f"law: {phrase.removeprefix(f'{validity.status.upper()}: ')}",
                      *rest])


def warned(validity, answer: str) -> str:
    """The answer, behind a warning where its law does not hold: of a line that has room for no more."""
    return f"{validity.status.upper()}; by that law: {answer}" if beyond(validity) else answer


def key(validity, case=None, steady: bool = False) -> dict:
    """The key "validity" of a JSON object, null where all laws are exact; of a case also its caveats, where
    the answer is no motion, which has them. steady: as of `caveats_of`."""
    printed = {"validity": None if validity is None else validity.as_dict()}
    return (printed if case is None
            else printed | errors.key(caveats_of(case.scene, steady, validity=validity, file=case.caveats)))


def worst(*result):
    """The most exceeded of several; None where all laws are exact."""
    return max((v for v in result if v is not None), key=lambda v: v.excess, default=None)


def beyond(*result) -> bool:
    """Whether a law does not hold."""
    return any(v is not None and not v.held for v in result)


def until(case, result, end: float):
    """The validity `result`, or that along the case's own run up to a time `end` (its span where that is
    none) where it needs the attitude and the case gives one."""
    return of_case(case, (0.0, end) if 0 < end < math.inf else None) if law_is_open(case, result) else result


def of_cases(cases) -> str:
    """A line for every law among cases that one of them leaves; empty where there is none."""
    beyond = [(case, result) for case in cases if (result := of_case(case)) is not None and not result.held]
    return "\n".join(_of_alike(group, cases) for group in _alike(beyond))


def lines_of(judged: Sequence[tuple[Case | None, ...]], units: Units = SI) -> list[str]:
    """A line for every (case, validity) that has a law to be named, one for all combinations of a file that
    stand the same way to the same limit, and one for all cases that say the same; without a name where there
    is one case. units: in which times are printed."""
    groups, cases = _alike([item for item in judged if item[1] is not None]), [case for case, _ in judged]
    if len(cases) == 1:
        return [_told(result, units) for group in groups for _, result in group]
    return together([_of_alike(group, cases, units) for group in groups])


def exceeded(judged, units: Units) -> str:
    """By how much the first law of `lines_of` is left; empty where none is."""
    group = next(iter(_alike([item for item in judged if item[1] is not None and not item[1].held])), ())
    return units.said(worst(*(result for _, result in group)).brief) if group else ""


def _told(result, units) -> str:
    return units.said(result.reason)


def _alike(judged) -> list:
    """The (case, validity) in groups: alone, or all combinations of a file that stand alike to one limit."""
    printed: dict = {}
    for n, (case, result) in enumerate(judged):
        printed.setdefault((case.path, result.status, result.effect, result.number) if case.variant else n,
                        []).append((case, result))
    return list(printed.values())


def together(lines) -> list[str]:
    """Lines of `of_cases`, those that say the same of several cases as one line that names them all."""
    printed: dict[str, list[str]] = {}
    for line in lines:
        text, _, name = line.rpartition(" (")
        printed.setdefault(text, []).append(name.removesuffix(")"))
    return [f"{phrase} ({', '.join(names)})" for phrase, names in printed.items()]


def _of_alike(group, cases, units: Units = SI) -> str:
    """A line on a case, or on the most exceeded of a group of combinations."""
    case, _ = group[0]
    result = worst(*(item for _, item in group))
    text = _told(result, replace(units, axes=axes_of(case)))
    if not case.variant:
        return f"{text} ({printable(case.name)})"
    farthest = "" if result.value is None else ", the farthest of them given"
    of = sum(other.path == case.path for other in cases)
    return (f"{text} ({printable(case.name.removesuffix(case.variant))}: {len(group)} of {of} "
            f"combinations{farthest})")


# --- The answer in one line
REST = "AT REST"  # an equilibrium without a rate
LEVELS = {"run": "by a run alone"}
CLAUSE = 110  # letters of a cause that the line has room for


def headline(case: Case, motion: Motion, units: Units | None = None, placed: bool = True) -> str:
    """The line of every page, picture and explorer, without the name of the case: the verdict, behind a
    warning where it is that of an approximate law that does not hold. units: of the case where None; their
    names of axes, where they have any, go before those of the case. placed: as of `verdict`."""
    line = verdict(case, motion, units, placed, named=False)
    return warned(motion.validity, limiting.ahead(motion.caveats, line, named=False))


def verdict(case: Case, motion: Motion, units: Units | None = None, placed: bool = True,
            named: bool = True) -> str:
    """The outcome, its axis and the condition that it rests on; when the limit of the case is reached; what a
    tilt does; then its numbers. placed: with where an axis without a letter lies; named: behind the name of
    the case."""
    units = (units_of(case) if units is None else replace(units, axes=axes_of(case)) if units.axes == PLAIN
             else units)
    rest = [cause(motion, units), largest(motion, units), margin(motion, units), period(motion, units),
            *(directions(motion, units) if placed else ())]

    def line(short: bool) -> str:
        return "; ".join(filter(None, [*outcome(motion, units, short), *rest]))
    return limiting.fitted(line, before(case, motion) if named else 0)


FIRST = 60  # letters of the first of two lines


def two_lines(case: Case, motion: Motion, units: Units | None = None) -> tuple[str, str]:
    """(at most FIRST letters, which pages and pictures show large; all that these leave out of `headline`).

    The first has what becomes of the motion and the condition that this rests on, then as much as fits: when
    the limit is reached, the axis, the next number. units: as of `headline`."""
    line = headline(case, motion, units)
    units = (units_of(case) if units is None else replace(units, axes=axes_of(case)) if units.axes == PLAIN
             else units)
    head, about, where = fate_parts(motion, units, tilt=False, short=True)
    limit = limiting.reached(motion.caveats, units)
    axis = units.axes.signed(motion.axis, motion.sense) if motion.axis and motion.ending is None else ""
    abouts = [about, *([f" about {axis}{known_as(motion)}", f" about {axis}"] if axis else []),
              ending.BY_RUN * about.endswith(ending.BY_RUN)]
    forms = [(text, limit.removeprefix("reaches ")) for text in abouts] if limit else []
    if not limit and (ended := ending.words(motion.ending, units)):  # how fast it turns in the end, and when
        forms = [(ended[1], ending.when(motion.ending, units)), (ended[1], "")]
        if about and (rate := ending.rate(motion.ending, units)):  # without an axis that has no room
            forms.append((f", {rate}{abouts[-1]}", ""))
    large = next((text for about, tail in (*forms, *((text, "") for text in abouts)) for text in [_large(
        motion, f"{head.lower()}{about}{where}", tail)] if len(text) <= FIRST), "")
    if not large:  # the condition is too long: that there is one must stay
        large = _large(motion, f"{head.lower()}, on a condition" if where else head.lower(), "")
    became, *rest = line.split("; ")
    if beyond(motion.validity):  # the warning stands alone before what that law has
        became, *rest = [rest[0].removeprefix("by that law: "), *rest[1:]]
    if became.lower().startswith(head.lower()):
        became = became[len(head):].lstrip(":, ")
    full, brief = (limiting.condition(motion.caveats, units, True, short).strip() for short in (False, True))
    if full and became == full and brief in large:  # of the same in more words the rank of the axis is new
        became = units.axes.rank_clause(limiting.axis_of_condition(motion.caveats))
    clauses = [clause for clause in [became, *rest] if clause and not _in(clause, large)]
    for clause in clauses:  # whatever comes next, if it fits
        if (where or about or not limit) and clause in (cause(motion, units), largest(motion, units)):
            if len(longer := f"{large}; {clause}") <= FIRST and motion.fate.word != "undecided":
                large, clauses = longer, [other for other in clauses if other != clause]
            break
    return large, capital("; ".join(clauses))


def _large(motion: Motion, text: str, tail: str) -> str:
    """The first of two lines: as a sentence, behind what an answer must not lack."""
    line = limiting.ahead(motion.caveats, "; ".join(filter(None, (text, tail))), named=False)
    if beyond(motion.validity):
        line = f"{motion.validity.status.lower()}: {line}"
    return line[:1].upper() + line[1:]


def _in(clause: str, large: str) -> bool:
    """Whether the first of two lines says a clause of the headline."""
    return clause.removeprefix("reaches ").lower() in large.lower()


def before(case: Case, answer) -> int:
    """How many letters stand before the answer of a first line: the name of the case and its warnings."""
    return len(warned(answer.validity, limiting.ahead(answer.caveats, f"{case.name}: ")))


def directions(motion: Motion, units: Units) -> list[str]:
    """Where the axes without a letter lie that the line names."""
    flipped = 0 if motion.flips is None or motion.flips.free else motion.flips.axis
    return [*filter(None, (units.axes.direction_clause(axis)
                           for axis in dict.fromkeys((motion.axis, flipped, largest_axis(motion, units)))))]


def outcome(motion: Motion, units: Units, short: bool = False) -> list[str]:
    """What becomes of the motion, when its limit is reached, what a tilt does; each may be empty. short: with
    the condition that it rests on in fewer words."""
    departs = limiting.unstable(motion.caveats, units)
    joint = "; " if short else ": "
    departs = departs and (f"{joint}{departs.removeprefix('unstable: ')}" if departs.startswith("unstable: ")
                           else f"; {departs}")
    became = ("".join(fate_parts(motion, units, short=short)) + departs,
              ending.rate(motion.ending, units) if short else "", ending.when(motion.ending, units))
    return ["; ".join(filter(None, became)), limiting.reached(motion.caveats, units),
            limiting.tilted(motion.caveats, units)]


def look(motion: Motion) -> str:
    """How the line looks: "changes" of a motion that spins up, reaches its limit or is on the separatrix;
    "conditional" where the verdict rests on a condition, on a law that does not hold, or is open; else
    "bounded"."""
    if beyond(motion.validity) or motion.fate.word == "undecided":
        return "conditional"
    kinds = [caveat.kind for caveat in motion.caveats]
    turns_over = motion.ending is not None and motion.ending.kind == "flat spin"
    if (motion.fate.word in ("spin-up", "separatrix") or {Kind.LIMIT, Kind.UNSTABLE} & set(kinds)
            or turns_over):
        return "changes"
    return "conditional" if Kind.TILT in kinds else "bounded"


def fate_parts(motion: Motion, units: Units, tilt: bool = True, short: bool = False) -> tuple[str, str, str]:
    """(the fate; its axis and how well it is known; the condition that it rests on). tilt: with what a tilt
    of the torque does to that; short: as of `outcome`."""
    fate = motion.fate.word
    text, where = HEADS[fate], limiting.condition(motion.caveats, units, not tilt, short)
    if where:
        text = text.removesuffix(" for ever")
    if fate == "equilibrium":
        text = f"{text if any(motion.at[:3]) else REST}{stable_word(motion)}"
    if ended := ending.words(motion.ending, units, short):
        return *ended, where
    about = f" about {units.axes.head(motion.axis)}, {direction(motion.sense)}" if motion.axis else ""
    return text, about + known_as(motion), where


def stable_word(motion: Motion) -> str:
    """Behind the fate of an equilibrium: its stability, where that is known."""
    word = "" if motion.stability is None else motion.stability.verdict
    return {"": "", "unstable": ", UNSTABLE", "undecided": ""}.get(word, f" ({word})")


def known_as(motion: Motion) -> str:
    """How well a fate is known, where that is not a matter of course."""
    return ("" if motion.level == "exact" or motion.fate.word == "undecided"
            else f" ({LEVELS.get(motion.level, motion.level)})")


def cause(motion: Motion, units: Units) -> str:
    """Why nothing is decided, what it means to be on the separatrix or at an equilibrium, or how often a
    bounded motion turns over."""
    fate = motion.fate.word
    if fate == "undecided":
        text = units.said(motion.reason).removeprefix("undecided: ")
        if motion.finding is not None and len(text) > CLAUSE:
            text = units.said(motion.finding.alone).removeprefix("undecided: ")
        else:
            text = units.said(motion.reason.alone).removeprefix("undecided: ")
        return text if len(text) <= CLAUSE else text[:CLAUSE].rsplit(" ", 1)[0] + " ..."
    stays = "" if limiting.unstable(motion.caveats, units) else "every rate stays as it is"
    return {"separatrix": "the smallest change decides what becomes of it",
            "equilibrium": stays}.get(fate, flips(motion, units))


def flips(motion: Motion, units: Units) -> str:
    """How often it turns over; empty where it does not, or where that is not known."""
    if motion.flips is None:
        return ""
    times, axis = motion.flips.times, units.axes.brief(motion.flips.axis)
    text = "turns over" if motion.flips.free else f"its angular momentum along {axis} changes sign"
    told = [units.time(time, SHORT) for time in times[:2]]
    if len(times) > 2:
        return f"{text} {len(times)} times in {units.time(sum(times), SHORT)}"
    return f"{text} every {told[0]}" if len(times) == 1 else f"{text} after {told[0]} and {told[1]} in turn"


def largest(motion: Motion, units: Units, short: bool = False) -> str:
    """The largest rate that is reached; of a spin-up, of the components that stay bounded. short: with the
    largest component as a clause of its own."""
    if motion.fate.word == "equilibrium":
        return f"rates {units.vector(units.axes.in_file(motion.at[:3]), units.rates, SHORT)}"
    sizes, over = _sizes(motion, units)
    finite = {n: size for n, size in sizes.items() if math.isfinite(size)}
    if motion.fate.word == "spin-up":
        finite.pop(motion.axis, None)
        if not motion.axis or over or len(finite) < 2:
            return ""
        return f"about the other axes at most {units.rate(max(finite.values()), SHORT, 1)}"
    bound = motion.invariants.get("rate_bound")
    if bound is not None and math.isfinite(bound) and (over or not finite):
        late = motion.invariants.get("late_rate_bound")
        end = ("" if late is None or late >= bound else f", {units.rate(late, SHORT, 1)} in the end" if late
               else ", tends to rest")
        return f"{'|x|' if units.scaled else '|ω|'} at most {units.rate(bound, SHORT, 1)}{end}"
    result = greatest(motion, units, short)
    return f"{'' if short else 'largest rate '}{result}" if result else ""


def greatest(motion: Motion, units: Units, short: bool = False) -> str:
    """The largest |omega|, or a bound of it, with the largest component and its axis, and over which time
    where that is not all; empty where a rate has no end or is not known. short: as of `largest`."""
    sizes, over = _sizes(motion, units)
    if len(sizes) < 3 or not all(map(math.isfinite, sizes.values())):
        return ""
    axis = max(sizes, key=sizes.__getitem__)
    name, bound = "|x|" if units.scaled else "|ω|", math.hypot(*sizes.values())
    sharp = motion.largest is not None and not over
    printed = (f"{name} = {units.rate(motion.largest, SHORT)}" if sharp
            else f"{name} at most {units.rate(bound, SHORT, 1)}")
    upper = units.rate(sizes[axis], SHORT, 0 if sharp else 1)
    component = f"{upper} about {units.axes.brief(axis)}"
    return (f"{printed}{over}; {'' if sharp else 'at most '}{component}" if short
            else f"{printed} ({component}){over}")


def largest_axis(motion: Motion, units: Units) -> int:
    """The axis of the largest component, where `largest` names it; else 0."""
    sizes, _ = _sizes(motion, units)
    text = greatest(motion, units)
    return max(sizes, key=sizes.__getitem__) if text and text in largest(motion, units) else 0


def _sizes(motion: Motion, units: Units):
    """({number of a component: the most that it reaches}, over which time in words, "" where that is all)."""
    pairs, over = motion.extremes, ""
    if not motion.for_all_time:
        pairs, over = ((motion.bounds, "") if motion.bounds is not None
                       else (pairs, f" {span_words(motion.over, units)}"))
    return {n: max(map(abs, pair)) for n, pair in enumerate(pairs or (), 1) if None not in pair}, over


def largest_key(motion: Motion) -> dict:
    """The largest rates in JSON, SI: "value" is |omega| at the most, "bound" whether it is an upper bound and
    not the largest that is reached, "components" the most of each; null where it has no end or is unknown."""
    pairs = motion.extremes if motion.for_all_time else motion.bounds or motion.extremes
    upper = [None if pair is None or None in pair else max(map(abs, pair)) for pair in pairs or (None,) * 3]
    sharp = motion.largest is not None and motion.for_all_time
    value = motion.largest if sharp else None if None in upper else math.hypot(*upper)
    bound = motion.invariants.get("rate_bound", math.inf)
    if not sharp and math.isfinite(bound) and (value is None or not motion.for_all_time):
        value = bound  # as text has it: for all time, where the extremes are those of a span
    return {"value": value, "bound": not sharp, "components": upper}


def span_words(over: Reason, units: Units) -> str:
    """What extremes are known over, with the units of people: "s in [0, 1200]" is "within 0 to 20 min"."""
    return f"{'within' if over.says(OVER_SPAN) else 'over'} {units.said(over)}"


def margin(motion: Motion, units: Units) -> str:
    """The distance to the separatrix as a rate, and the energy to the barrier."""
    rate, height = rate_and_height(motion, units)
    if units.scaled and rate and height:  # two numbers without units are known by names
        return f"{rate} from the separatrix in x, {height} in energy"
    if rate:
        return f"{rate} from the separatrix" + (f" ({height})" if height else "")
    return f"{height} below the barrier" if height and motion.margin_energy > 0 else height


def rate_and_height(motion: Motion, units: Units) -> tuple[str, str]:
    """The distance to the separatrix and the energy to the barrier, each empty where not known."""
    rate, energy = rate_margin(motion, units, SHORT), motion.margin_energy
    if motion.fate.word in ("separatrix", "equilibrium", "undecided"):
        return "", ""
    return rate, "" if energy is None else units.energy(abs(energy),
                                                        SHORT) + (" above the barrier" if energy < 0 else "")


def rate_margin(motion: Motion, units: Units, digits: int) -> str:
    """The distance from the separatrix, or its bounds where it is not one to 1e-6; empty where unknown."""
    if motion.velocity_reason and motion.velocity_bounds:
        return bracketed(*motion.velocity_bounds, units.rates, digits)
    return "" if motion.margin_velocity is None else units.rate(motion.margin_velocity, digits)


def bracketed(low: float, high: float, unit: Unit, digits: int) -> str:
    """Two bounds in SI with as many digits as tell them apart, the lower rounded down and the upper up."""
    name, item = unit
    more = digits
    if low > 0 and math.isfinite(high):
        more = min(17, max(digits, 1 - math.floor(math.log10((high - low) / high)) if high > low else 0))
    ends = (number(as_bound(end, item, more, side), more) for end, side in ((low, -1), (high, 1)))
    return f"{' to '.join(ends)} {name}".rstrip()


def period(motion: Motion, units: Units) -> str:
    """The period, where the motion repeats."""
    return "" if motion.period is None else f"period {units.time(motion.period, SHORT)}"
