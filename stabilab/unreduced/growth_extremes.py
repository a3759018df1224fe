"""Extremes of a motion that grows for ever by an exact law."""
from __future__ import annotations

import math

from ..integrate.extrema import roots_of_rates
from .growth import CapturedFate, captured_fate
from .growth_certificates import spin_up_margin
from .growth_form import standard_form

# Steps after which the finite end of a spin-up is given over the span run, unproved beyond it.
EXTREMES_BUDGET = 300_000


def captured_extremes(scene, state, answer: CapturedFate | None = None):
    """((3, 2) array of extremes over t >= 0, words saying over what they are known).

    Growing components have +-inf at their growing end; in a capture "well" the two other components swing ever wider, like
    t^(1/4) (their action is an adiabatic invariant), and have both. The finite end of a certified spin-up holds for all
    time, P >= sqrt(2L) keeping it from falling lower; every other finite entry is over the span named.
    """
    import numpy as np
    answer = answer or captured_fate(scene, state)
    change = standard_form(scene)
    unit = change.time if change else 1 / math.sqrt(max(abs(float(v)) for v in scene.quadratic().m))
    span = max(1.5 * (answer.t_certificate or 0.0), 20 * unit)
    roots = roots_of_rates(scene, state, span)
    certain = answer.certificate in ("spin-up", "axis")
    while answer.certificate == "spin-up" and certain and not _floor_holds(change, roots):
        span *= 1.5
        certain = not roots.reason and roots.steps < EXTREMES_BUDGET
        roots = roots_of_rates(scene, state, span) if certain else roots
    extremes = roots.extremes()
    if answer.certificate == "well":
        others = [i for i in range(3) if i != answer.axis - 1]
        extremes[others] = -np.inf, np.inf
    if answer.axis:
        extremes[answer.axis - 1, 1 if answer.sense > 0 else 0] = answer.sense * np.inf
    where = f"{scene.time_unit} in [0, {roots.t_reached:g}]"
    if answer.certificate == "axis":
        return extremes, "all time"
    return extremes, f"axis {answer.axis} for all time, the others over {where}" if certain else f"finite entries over {where}"


def _floor_holds(change, roots):
    """Whether u can fall no lower after the run than it did in it: u >= sqrt(2L) - |c|/2, L growing (module docstring)."""
    c, i = change.c, change.axes[0]
    margin, _ = spin_up_margin(c, change.to_standard(roots.end.tolist()))
    u = [change.to_standard(x.tolist())[0] for x in (roots.start, roots.end, *roots.states[roots.component == i])]
    return margin > 0 and math.sqrt(2 * (margin + c * c / 2)) - abs(c) / 2 >= min(u)
