"""A motion in words: where it starts, how far its rates go, its margins and period, and why; every number with its unit."""
from __future__ import annotations

import math
from functools import partial

from .. import limiting
from ..text import frame
from ..text.headline import rate_margin, span_words
from ..units import DEG, DIGITS, Units, bracket, but_for_rounding, number
from .letters import greek, lettered

WIDE = 24  # columns of a name
QUANTITIES = {  # of invariants and of what a run showed: which number of `Units` it is; "" for a plain number
    "Q": "Q", "energy": "energy", "momentum": "momentum", "rate_bound": "rate", "late_rate_bound": "rate", "span": "time", "size_start": "rate",
    "size_end": "rate", "size_largest": "rate", "energy_start": "energy", "energy_end": "energy", "energy_change": "energy", "t_certificate": "time",
    "followed_until": "time", "release_time": "time", "release_estimate": "time", "rate_end": "rates", "J": "(N m s)^2", "J_rate": "(N m s)^2/s",
    "steps": "", "steps_followed": "", "small_change_grew": "", "invariant_drift": "", "energy_trend": "", "certificate": ""}
TILTED = 'any tilt of the torque may end this: --tilt "1 deg" says how soon'


def row(name: str, words: str) -> str:
    """A name in its column, then the words."""
    return f"  {name:<{WIDE}}{words}".rstrip()


def table(case, motion, units: Units) -> list[str]:
    """The start, the extremes, the bounds for all times, margins and period, a line each."""
    lines = [row("start", state(motion.at, units)), *extreme_lines(case, motion, units), *bound_lines(case, motion, units)]
    height = partial(energy_margin, tell=units.energy)
    for name, words in (("margin, rate", rate_margin(motion, units, DIGITS)), ("margin, energy", _told(motion.margin_energy, height)),
                        ("period", _told(motion.period, units.time))):
        lines += [row(name, words)] if words else []
    return lines


def state(at, units: Units) -> str:
    """The rates of a state with their unit; the vertical after them, where it is part of the state."""
    vertical = f", gamma = {units.vector(at[3:], ('', 1.0))}" if len(at) > 3 else ""
    return units.vector(at[:3], units.rates) + vertical


def energy_margin(value, tell) -> str:
    """The energy that is missing to the barrier, or by how much it is above. tell: of a size, with its unit."""
    return f"{tell(-value)} above the barrier" if value < 0 else tell(value)


def _told(value, words) -> str:
    return "" if value is None else words(value)


def extreme_lines(case, motion, units: Units) -> list[str]:
    """Least and greatest of every component under a head that says over which time."""
    pairs, over = but_for_rounding(motion.extremes, motion.tolerance), motion.extremes_over
    if pairs is None:
        return []
    when = over if over == "all time" else span_words(over, units).removeprefix("over ")
    return [*_head(f"over {when}" if over == "all time" else when), *pair_lines(case, pairs, units)]


def _head(when: str) -> list[str]:
    """Over which time, beside the heads of the columns, or above them where it is longer than its column."""
    told = [] if len(when) < WIDE else [f"  {when}:"]
    return [*told, f"  {'' if told else when + ',':<{WIDE}}{'least':>12}{'greatest':>14}"]


def pair_lines(case, pairs, units: Units) -> list[str]:
    """A line a component: its name, least, greatest, unit."""
    name, one = units.rates
    return [f"    {greek(component):<{WIDE - 2}}{shown(low, one):>12}{shown(high, one):>14}  {name}".rstrip()
            for component, (low, high) in zip(case.scene.components, pairs)]


def shown(value, one: float = 1.0, digits: int = DIGITS) -> str:
    """A number of a column; a word where it is unbounded or unknown."""
    if value is None:
        return "unknown"
    return "unbounded" if math.isinf(value) else number(value * one, digits)  # its column says downwards or upwards


def bound_lines(case, motion, units: Units) -> list[str]:
    """The bounds of the rates for all times, where they are not the extremes told already."""
    if motion.bounds is None or motion.bounds == motion.extremes:
        return []
    return [*_head("bounds for all times"), *pair_lines(case, motion.bounds, units)]


def why(case, motion, units: Units, proofs: bool) -> list[str]:
    """The reason; with `proofs` also what is not known of the margin, the invariants, and what a run showed."""
    lines = [f"why: {reason(motion.because, units)}"]
    if proofs and motion.velocity_because:
        lines.append(f"  {'' if motion.velocity_bounds else 'margin, rate unknown: '}{reason(motion.velocity_because, units)}")
    if proofs:
        called = names(motion)
        lines += [row(called.get(name, name.replace("_", " ")), quantity(name, value, units)) for found in (motion.invariants, motion.evidence)
                  for name, value in found.items() if value is not None]
    return lines


def names(motion) -> dict:
    """What the constants of a motion are called where the name of the field does not say it; a potential is in the energy of a reduced motion, and none of
    its parts is that of the whole body."""
    own = {"rate_bound": "|ω| never exceeds", "late_rate_bound": "|ω| in the end at most", "Q": "invariant Q", "J": "J of the law", "J_rate": "J changes by",
           "momentum": "angular momentum"}
    return own | ({"energy": "energy, reduced motion"} if "Q" in motion.invariants else {})


def reason(words: str, units: Units) -> str:
    """What the analysis says of a motion: names as letters, rates and times in the units of the lines about it."""
    return lettered(units.words(words))


def quantity(name: str, value, units: Units) -> str:
    """An invariant, or what a run showed, with its unit."""
    kind = QUANTITIES[name]
    if kind == "rates":
        return units.vector(value, units.rates)
    if not kind or not isinstance(value, float):
        return number(value, DIGITS) if isinstance(value, float) else str(value)
    return units.told(value, units.plain(kind), DIGITS) if kind.startswith("(") else getattr(units, kind)(value)


def tilt_lines(case, motion, units: Units, proofs: bool = False) -> list[str]:
    """What a tilt of the torque does, or how to ask for it."""
    found = motion.tilt
    if found is None or found.ranges:
        asked = found is None and not units.scaled and limiting.condition(motion.caveats, units)
        return [row("off that axis", TILTED)] if asked else []
    limit = f"|omega| = {units.rate(found.limit)}{'' if found.stated else ', twice the largest of this motion (no limit is stated)'}"
    lines = [f"  tilted by {_angle(found.angle)}: {found.of}, to {limit}"]
    if found.ends:
        lines.append(f"    shortest time found   {clock((found.low, found.high), units)} ({found.level})")
        if proofs:
            lines.append(f"    at azimuth            {_angle(found.azimuth)}, torque {units.vector(found.torque, units.plain('N m'))}")
    else:
        many, far = len(found.times), units.time(found.followed)
        told = f"{many} azimuths were followed for {far} or more" if many > 1 else f"one azimuth was followed for {far}, which is before it can be reached"
        lines.append(f"    shortest time found   none: {told}")
    return [*lines, f"    not before            {units.time(found.not_before)}, whatever the azimuth and for any smaller tilt (proved)"]


def clock(ends, units: Units) -> str:
    """A time between two bounds, in one unit."""
    name, one = units.times(ends[1])
    low, high = bracket(ends[0] * one, ends[1] * one)
    return f"{low} to {high} {name}"


def _angle(value: float) -> str:
    return DEG.angle(value)


def framed(case) -> list[str]:
    """One line where vectors are along other axes than the file's."""
    return frame.note(case)
