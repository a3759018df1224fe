"""The answer of a page at a glance: the outcome, when, the largest rate, and the distance from another
outcome."""
from __future__ import annotations

import math
from typing import Any

from ....orbit.result import Motion
from ...terminal.letters import printed
from ...text import law
from ...text.headline import cause, fate_parts, largest, rate_and_height
from ...units import SHORT, Units


def tiles(motion: Motion, units: Units) -> list[tuple[str, str, str]]:
    """(what, its value, what belongs to it) of four: when a limit is reached first."""
    found = [("outcome", _outcome(motion, units)), ("when", _when(motion, units)),
             ("largest rate", _largest(motion, units)), ("to another outcome", _distance(motion, units))]
    if any(one.kind == "limit" for one in motion.caveats):
        found[:2] = reversed(found[:2])
    return [(name, printed(value), printed(note)) for name, (value, note) in found]


def _outcome(motion, units):
    value, about, condition = fate_parts(motion, units)
    if motion.fate.word == "undecided":
        note = cause(motion, units)
    else:
        note = f"{about}{condition.split(':')[0]}".strip()  # what a tilt does stands beside it
    return value.capitalize(), "; ".join(filter(None, ["by a law that does not hold"
                                                       * law.beyond(motion.validity), note]))


def _when(motion, units):
    """The limit of the case first, then what a tilt of the torque does, then a spin-up without a limit."""
    limit, found = motion.first or ("", None)
    limit = f"the limit, {units.words(limit)},"
    if found is not None and math.isfinite(found.high):
        middle = 0.5 * float(found.low + found.high)
        return units.time(middle, SHORT), f"until {limit} is reached ({found.level})"
    tilt: Any = motion.tilt
    if tilt is not None and not tilt.ranges and tilt.ends:
        return (units.time(tilt.low, SHORT),
                f"until {units.rate(tilt.limit, SHORT)}, where the torque is tilted by "
                f"{units.angle(tilt.angle, SHORT)} ({tilt.level}); else never")
    if found is not None:
        never = math.isinf(found.low)
        return ("never" if never else "not known", f"{limit} is not reached" + (
            f" ({found.level})" if never else f" before {units.time(float(found.low), SHORT)}"))
    if motion.fate.word == "spin-up":
        certain = motion.evidence.get("t_certificate")
        if certain is not None:
            return units.time(float(certain), SHORT), "from then on the spin-up is certain"
        return ("from the start", "the spin-up is certain") if motion.level == "exact" else ("not known", "")
    return ("never" if motion.fate.word in ("bounded", "equilibrium") else "not known"), ""


def _largest(motion, units):
    found = largest(motion, units)
    if motion.fate.word == "spin-up":
        return "without end", found
    if motion.fate.word == "equilibrium":
        return units.rate(math.hypot(*motion.at[:3]), SHORT), found
    value, _, note = found.removeprefix("largest rate ").partition(" (")
    return value or "not known", note.replace(")", "")


def _distance(motion, units):
    rate, height = rate_and_height(motion, units)
    if rate:
        told = f"; in energy {height}" if height else ""
        return rate, f"the smallest change of the rates to the separatrix{told}"
    if height:
        return height, "of energy, to the barrier"
    if motion.fate.word == "separatrix":
        return "none", "the smallest change decides"
    return "not known", units.words(motion.velocity_because).removeprefix("not known: ")
