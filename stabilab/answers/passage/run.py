"""The first crossing by roots along a run of machine precision; a second run from a start moved in its last place says how well it is known."""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from ...integrate.event_run import first_root
from ...integrate.motion_units import in_unit, mass_unit, own_unit
from ...integrate.to_heyoka import TAYLOR_TOLERANCE
from ...physics.attitude import to_space
from ...physics.equations import Equations, derive, rotation
from ...physics.scene import AnyScene
from ...physics.states import equations_and_start, moved_row
from ...physics.to_numpy import to_numpy
from .limit import Limit
from .result import Found

STEPS = 300_000  # of each of the two runs
MOVED = 2.0  # places by which the second run's start is moved
WIDER = 4.0  # times what the two runs differ by
ROUNDING = 2.0**-50  # relative, of a time that both find alike


def by_run(scene: AnyScene, start: Any, limit: Limit, t_max: float = math.inf, steps: int = STEPS) -> Found:
    """The first crossing of the motion of any scene. start: numbers or blocks, as `trajectory` takes them; t_max: the scene's time."""
    return by_run_of(scene, start, limit, t_max, steps)[0]


def by_run_of(scene: AnyScene, start: Any, limit: Limit, t_max: float = math.inf, steps: int = STEPS) -> tuple[Found, int]:
    """The same, and the steps that the first run took."""
    equations, state, unit, expressions = _asked(scene, start, limit)
    end = t_max * unit if math.isfinite(t_max) else 1e300
    one = first_root(equations, state, expressions, end, steps)
    words = f"{limit.words}: roots along a run in machine precision"
    if one.t is None:
        far = "t_max" if one.ended else f"{steps} steps"
        return Found(_less(one.until) / unit, math.nan, "run", f"{words}: not reached by t = {one.until / unit:.6g} {scene.time_unit} ({far})"), one.steps
    two = first_root(equations, moved_row(state, MOVED), expressions, end, 2 * steps, 4 * TAYLOR_TOLERANCE)
    if two.t is None:
        return Found(0.0, math.nan, "undecided", f"{words} find it at {one.t / unit:.6g} {scene.time_unit}, a second run from a start moved in its "
                                                 "last place does not: more than a run in doubles can tell"), one.steps
    blur = WIDER * abs(one.t - two.t) + ROUNDING * one.t
    return Found(max(0.0, one.t - blur) / unit, (one.t + blur) / unit, "run", f"{words}, the error from a second one"), one.steps


def run_once(scene: AnyScene, start: Any, limit: Limit, t_max: float = math.inf, steps: int = STEPS) -> tuple[Any, float]:
    """(`FirstRoot` of one run, in the motion's own time; that time's unit): no word on its error."""
    equations, state, unit, expressions = _asked(scene, start, limit)
    return first_root(equations, state, expressions, t_max * unit if math.isfinite(t_max) else 1e300, steps), unit


def _less(t: float) -> float:
    return t * (1 - ROUNDING)


def _asked(scene: AnyScene, start: Any, limit: Limit) -> tuple[Equations, np.ndarray, float, list[Any]]:
    """(equations, state, unit, expressions that vanish at the limit), in units near the motion's own where these are known."""
    tilted = limit.kind == "tilt"
    if tilted and not isinstance(start, dict):
        start = {"omega": tuple(start)[:3]} | ({"gamma": tuple(start)[3:6]} if "gamma" in scene.blocks else {})
    if tilted:
        start = {"attitude": (1.0, 0.0, 0.0, 0.0), **start}
    equations, state = equations_and_start(scene, start)
    unit = 1.0
    if set(equations.blocks) <= {"omega", "attitude"}:
        with np.errstate(all="ignore"):
            unit = own_unit(scene, state[:3].tolist(), np.asarray(to_numpy(equations)(state))[:3].tolist())
        mass = mass_unit(scene)
        if unit != 1 or mass != 1:
            changed = in_unit(scene, unit, mass)
            equations = derive(changed, equations.blocks)
            state = np.concatenate([state[:3] / unit, state[3:]])
    return equations, state, unit, _expressions(limit, equations, state, unit)


def _expressions(limit: Limit, equations: Equations, state: Sequence[float] | np.ndarray, unit: float) -> list[Any]:
    from sympy import Float, Rational, cos
    rational = lambda v: Rational(v.numerator, v.denominator)
    if limit.kind != "tilt":
        omega = equations.state[:3]
        power = rational(_fraction(unit)) ** 2
        return [sum(rational(c) * sum(rational(a) * w for a, w in zip(vector, omega) if a) ** 2 for c, vector in terms) - rational(most) / power
                for terms, most in limit.parts]
    at = 3 + (3 if "gamma" in equations.blocks else 0)
    q = equations.state[at:at + 4]
    direction = limit.direction or ()
    first = to_space(state[at:at + 4], [float(v) for v in direction])
    rows = rotation(q)
    turned = sum(Rational(float(f)) * rational(a) * entry for f, row in zip(first, rows) for a, entry in zip(direction, row) if a)
    return [turned - Rational(float(cos(Float(rational(limit.parts[0][1]), 30))))]


def _fraction(value: float) -> Fraction:
    return Fraction(value)
