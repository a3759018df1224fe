"""The tables beside the pictures: what is known of the motion, and the equilibria."""
from __future__ import annotations

import math
from itertools import groupby
from typing import Any

from ...case.read import Case
from ...equilibrium.result import Equilibria
from ...orbit.result import Motion
from ..terminal.letters import greek, lettered
from ..terminal.motion import margins
from ..units import Units, but_for_rounding

MOST = 12  # rows of equilibria


def rows(case: Case, motion: Motion, units: Units) -> list[list[str]]:
    """[words, value] of what is known of the motion."""
    found = [["start", units.vector(motion.at[:3], units.rates)],
             *([name, greek(words)] for name, words in margins(motion, units))]
    if motion.extremes is not None and not any(map(math.isnan, sum(map(list, motion.extremes), []))):
        for component, pair in zip(case.scene.components, but_for_rounding(motion.extremes, motion.tolerance)):
            found.append([component.replace("omega", "ω"), _range(*pair, units)])
    return [*found, ["why", lettered(units.words(motion.because))]]


def _range(low: float, high: float, units: Units) -> str:
    """Least and greatest rate."""
    least, greatest = (units.told(value, units.rates) for value in (low, high))
    if math.isinf(low) or math.isinf(high):
        return "without end both ways" if low == -high else f"from {least} up, without end" if math.isinf(high) else f"from {greatest} down, without end"
    return f"{least} to {greatest}"


def equilibria(found: Equilibria, units: Units) -> dict[str, Any]:
    """{reason, rows of (where, verdict)}: of a curve a state on each of its pieces, as `classify` tells them."""
    told = [[units.vector(point.at[:3], units.rates), point.verdict] for point in found.points]
    for curve in found.curves:
        for verdict, samples in groupby(curve.samples, lambda sample: sample.verdict):
            slowest = min(samples, key=lambda sample: max(map(abs, sample.at[:3])))
            where = f"{units.axes.sentence(curve.name)}, such as {units.vector(slowest.at[:3], units.rates)}"
            told.append([lettered(where), verdict])
    more = len(told) - MOST
    return {"reason": lettered(units.words(found.reason)), "rows": told[:MOST] + ([[f"and {more} more", ""]] if more > 0 else [])}
