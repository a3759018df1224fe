"""The answer in one line: what becomes of a motion and when, how large its rates grow, how far it is from
another fate, and its period; and how that line looks."""
from __future__ import annotations

import math
import re
from dataclasses import replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal, localcontext
from typing import TYPE_CHECKING

from .. import limiting
from ..axes import PLAIN, axes_of, direction
from ..terminal.letters import lettered
from ..units import SHORT, SPAN, Units, number, units_of
from . import law

if TYPE_CHECKING:
    from ...case.read import Case
    from ...orbit.result import Motion

# of an equilibrium: without a rate, and with one
REST, STEADY = "AT REST", "STEADY ROTATION (relative equilibrium)"
WORDS = {"bounded": "BOUNDED for ever", "spin-up": "SPINS UP", "separatrix": "ON THE SEPARATRIX",
         "equilibrium": STEADY, "undecided": "UNDECIDED"}
LEVELS = {"run": "by a run alone"}
CLAUSE = 110  # letters of a cause that the line has room for


def headline(case: Case, motion: Motion, units: Units | None = None) -> str:
    """The line of every page, picture and explorer, without the name of the case: the verdict, behind a
    warning where it is that of an approximate law that does not hold. units: of the case where None; their
    names of axes, where they have any, go before those of the case."""
    return law.warned(motion.validity, verdict(case, motion, units))


def verdict(case: Case, motion: Motion, units: Units | None = None) -> str:
    """The outcome, its axis and the condition that it rests on; when the limit of the case is reached; what a
    tilt does; then its numbers."""
    units = (units_of(case) if units is None else replace(units, axes=axes_of(case)) if units.axes == PLAIN
             else units)
    parts = [*outcome(motion, units), cause(motion, units), largest(motion, units), margin(motion, units),
             period(motion, units)]
    return "; ".join(part for part in parts if part)


def outcome(motion: Motion, units: Units) -> list[str]:
    """What becomes of the motion, when its limit is reached, what a tilt does; each may be empty."""
    return ["".join(fate_parts(motion, units)), limiting.reached(motion.caveats, units),
            limiting.tilted(motion.caveats, units)]


def look(motion: Motion) -> str:
    """How the line looks: "changes" of a motion that spins up, reaches its limit or is on the separatrix;
    "conditional" where the verdict rests on a condition, on a law that does not hold, or is open; else
    "bounded"."""
    if law.beyond(motion.validity) or motion.fate.word == "undecided":
        return "conditional"
    kinds = [one.kind for one in motion.caveats]
    if motion.fate.word in ("spin-up", "separatrix") or "limit" in kinds:
        return "changes"
    return "conditional" if "tilt" in kinds else "bounded"


def fate_parts(motion: Motion, units: Units) -> tuple[str, str, str]:
    """(the fate; its axis and how well it is known; the condition that it rests on)."""
    fate = motion.fate.word
    words, where = WORDS[fate], limiting.condition(motion.caveats, units)
    if where:
        words = words.removesuffix(" for ever")
    if fate == "equilibrium" and not any(motion.at[:3]):
        words = REST
    about = f" about {units.axes.whole(motion.axis)}, {direction(motion.sense)}" if motion.axis else ""
    return words, about + known_as(motion), where


def known_as(motion: Motion) -> str:
    """How well a fate is known, where that is not a matter of course."""
    return ("" if motion.level == "exact" or motion.fate.word == "undecided"
            else f" ({LEVELS.get(motion.level, motion.level)})")


def cause(motion: Motion, units: Units) -> str:
    """Why nothing is decided, or what it means to be on the separatrix or at an equilibrium."""
    fate = motion.fate.word
    if fate == "undecided":
        words = motion.because.removeprefix("undecided: ")
        words = (re.split(r"; |: ", motion.cause.removeprefix("undecided: "))[0] if motion.cause
                 and len(words) > CLAUSE else words.split("; ")[0])
        words = lettered(units.words(words))
        return words if len(words) <= CLAUSE else words[:CLAUSE].rsplit(" ", 1)[0] + " ..."
    return {"separatrix": "the smallest change decides what becomes of it",
            "equilibrium": "every rate stays as it is"}.get(fate, "")


def largest(motion: Motion, units: Units) -> str:
    """The largest rate that is reached; of a spin-up, of the components that stay bounded."""
    if motion.fate.word == "equilibrium":
        return f"rates {units.vector(motion.at[:3], units.rates, SHORT)}"
    sizes, over = _sizes(motion, units)
    finite = {n: size for n, size in sizes.items() if math.isfinite(size)}
    if motion.fate.word == "spin-up":
        finite.pop(motion.axis, None)
        if not motion.axis or over or len(finite) < 2:
            return ""
        return f"about the other axes at most {units.rate(max(finite.values()), SHORT)}"
    bound = motion.invariants.get("rate_bound")
    if bound is not None and math.isfinite(bound) and (over or not finite):
        late = motion.invariants.get("late_rate_bound")
        end = ("" if late is None or late >= bound else f", {units.rate(late, SHORT)} in the end" if late
               else ", tends to rest")
        return f"{'|x|' if units.scaled else '|omega|'} at most {units.rate(bound, SHORT)}{end}"
    found = greatest(motion, units)
    return f"largest rate {found}" if found else ""


def greatest(motion: Motion, units: Units) -> str:
    """The largest |omega|, or a bound of it, with the largest component and its axis, and over which time
    where that is not all; empty where a rate has no end or is not known."""
    sizes, over = _sizes(motion, units)
    if len(sizes) < 3 or not all(map(math.isfinite, sizes.values())):
        return ""
    axis = max(sizes, key=sizes.__getitem__)
    name, bound = "|x|" if units.scaled else "|omega|", math.hypot(*sizes.values())
    told = (f"{name} = {units.rate(motion.largest, SHORT)}" if motion.largest is not None and not over
            else f"{name} at most {units.rate(bound, SHORT)}")
    return f"{told} ({units.rate(sizes[axis], SHORT)} about {units.axes.brief(axis)}){over}"


def _sizes(motion, units):
    """({number of a component: the most that it reaches}, over which time in words, "" where that is all)."""
    pairs, over = motion.extremes, ""
    if motion.extremes_over != "all time":
        pairs, over = ((motion.bounds, "") if motion.bounds is not None
                       else (pairs, f" {span_words(motion.extremes_over, units)}"))
    return {n: max(map(abs, pair)) for n, pair in enumerate(pairs or (), 1) if None not in pair}, over


def span_words(over: str, units: Units) -> str:
    """What extremes are known over, with the units of people: "s in [0, 1200]" is "within 0 to 20 min"."""
    return f"{'within' if SPAN.fullmatch(over) else 'over'} {units.words(over)}"


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
    if motion.velocity_because and motion.velocity_bounds:
        name, one = units.rates
        low, high = motion.velocity_bounds
        return bracketed(low * one, high * one, name, digits)
    return "" if motion.margin_velocity is None else units.rate(motion.margin_velocity, digits)


def bracketed(low: float, high: float, unit: str, digits: int) -> str:
    """Two bounds with as many digits as tell them apart, the lower rounded down and the upper up."""
    if not low > 0 or not math.isfinite(high):
        return f"{number(low, digits)} to {number(high, digits)} {unit}".rstrip()
    more = min(17, max(digits, 1 - math.floor(math.log10((high - low) / high)) if high > low else 0))
    with localcontext() as context:
        context.prec, ends = more, []
        for end, context.rounding in ((low, ROUND_FLOOR), (high, ROUND_CEILING)):
            ends.append(number(float(+Decimal(end)), more))
    return f"{ends[0]} to {ends[1]} {unit}".rstrip()


def period(motion: Motion, units: Units) -> str:
    """The period, where the motion repeats."""
    return "" if motion.period is None else f"period {units.time(motion.period, SHORT)}"
