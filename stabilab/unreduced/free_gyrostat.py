"""A free gyrostat whose wheel has no zero component: no orbit in a plane, but a closed one, and one return gives its period and every extreme."""
from __future__ import annotations
from dataclasses import dataclass
from fractions import Fraction
import math
import numpy as np
from ..errors import InputError
from .off_axis import STEP_BUDGET
from .near_rest import beside_rest, small_loop
from ..integrate.extrema import roots_of_rates
from ..physics.states import equilibrium_mask, three_numbers
from ..orbit.fate.arrays import fates  # noqa: F401  one of the four questions of `answers.kinds`
from ..orbit.fate.one_state import at_rest, free_fate
from ..orbit.result import finite, judged, Motion, pairs, repeats
from ..physics.quadratic import rests
from ..physics.state import three_floats

# Two points of a closed orbit are the same where they agree to this share of the orbit's size.
SAME_POINT = 1e-9


@dataclass(frozen=True)
class PeriodExtremes:
    """extremes: (3, 2) over `over` ("all time" or the span searched); period: inf where no return was found."""

    extremes: np.ndarray
    period: float
    over: str
    reason: str


def extremes_over_period(scene, state) -> PeriodExtremes:
    """Period and extremes of a motion without torque (any gyrostatic moment), from one return to its first extreme.

    Each extreme is polished on the two invariants of the state, so it does not carry the run's drift. An equilibrium has
    period 0; a motion that does not return within the step budget (on or next to a separatrix) has period inf and its
    extremes are over the span run. Raises InputError where a torque acts.
    """
    form, given = scene.quadratic(), list(state)
    state = three_numbers(state)
    if any(form.m):
        raise InputError("the period by return is for motions without torque; this scene has one")
    if not any(form.rate([Fraction(v) for v in given])):
        return PeriodExtremes(np.stack([state, state], axis=1), 0.0, "all time", "equilibrium: every rate is exactly 0")
    if beside_rest(form, given) and (loop := small_loop(form, given)):
        period, pairs = loop
        return PeriodExtremes(np.array([[float(v) for v in pair] for pair in pairs]), float(period), "all time",
                              "no torque: the motion is closed and periodic; followed in many digits, as its rates are small")
    span, roots = _first_span(form, state), None
    while roots is None or (roots.steps < STEP_BUDGET and not roots.reason):
        roots = roots_of_rates(scene, state, span)
        closing = _return(roots, state)
        if closing is not None:
            return _one_period(scene, roots, closing)
        span *= 4
    return PeriodExtremes(roots.extremes(), math.inf, f"{scene.time_unit} in [0, {roots.t_reached:g}]",
                          f"no return within {roots.steps} steps: on or next to a separatrix")


def _first_span(form, x):
    """A few turns: the inverse of the largest frequency that the Jacobian can show at this size."""
    size = np.abs(x).max()
    kappa, rho, sigma, _ = form.coefficients
    return 40.0 / (size * max(map(abs, kappa)) + max(map(abs, (*rho, *sigma))))


def _return(roots, state):
    """Index of the root at which the motion is back at its first root; None where it is not."""
    if not len(roots.t):
        return None
    size = max(np.ptp(np.vstack([roots.states, state]), axis=0).max(), 1e-300)
    apart = np.abs(roots.states[1:] - roots.states[0]).max(axis=1)
    same = (roots.component[1:] == roots.component[0]) & (apart <= SAME_POINT * size)
    found = np.nonzero(same)[0]
    return int(found[0]) + 1 if found.size else None


def _one_period(scene, roots, closing):
    inertia, momentum = _quadrics(scene)
    polished = np.array([_polish(scene.quadratic(), inertia, momentum, roots.start, x, i)
                         for x, i in zip(roots.states[:closing], roots.component[:closing])])
    extremes = np.stack([roots.start, roots.start], axis=1)
    for i in range(3):
        values = polished[roots.component[:closing] == i, i]
        if values.size:
            extremes[i] = values.min(), values.max()
    return PeriodExtremes(extremes, float(abs(roots.t[closing] - roots.t[0])), "all time",
                          "no torque: the motion is closed and periodic")


def _quadrics(scene):
    """Two invariants w . x^2 / 2 + l . x of the free motion: ((w, l), (w, l))."""
    if scene.variables == "physical":
        D, lam = np.array(scene.body.inertia), np.array([float(v) for v in scene.vector("gyrostat")])
        return (D, 0 * lam), (D * D, D * lam)
    a, b = scene.a, scene.b
    return (np.array([1.0, 1.0, 0.0]), np.array([a, 0, 0])), (np.array([1.0, 0.0, -1.0]), np.array([b, 0, 0]))


def _polish(form, first, second, start, x, i):
    """Newton on rate_i = 0 and the two invariants of `start`, differences formed as products; x where it does not help."""
    better = x.copy()
    for _ in range(3):
        residual = [w @ ((better - start) * (better + start)) / 2 + l @ (better - start) for w, l in (first, second)]
        matrix = np.array([w * better + l for w, l in (first, second)] + [form.jacobian(better.tolist())[i]])
        scale = np.abs(matrix).max(axis=1)
        if not (scale > 0).all():
            return x
        try:
            better = better - np.linalg.solve(matrix / scale[:, None], np.array([*residual, form.rate(better.tolist())[i]]) / scale)
        except np.linalg.LinAlgError:
            return x
    return better if np.abs(better - x).max() <= 1e-9 * np.abs(x).max() else x


def motion(scene, state, span=None, exact=None, brief: bool = False) -> Motion:
    """See `answers.motion`: the motion is closed, and one return gives its period and every extreme."""
    state = three_floats(state)
    given = exact or state
    decided = free_fate(scene, given)
    if rests(scene.quadratic(), given):
        decided = at_rest(scene, decided)
        return Motion(**judged(state, decided), margin_energy=finite(decided.margin), extremes=tuple((v, v) for v in state))
    closed = extremes_over_period(scene, given)
    return Motion(**judged(state, decided), margin_energy=finite(decided.margin), extremes=pairs(closed.extremes), extremes_over=closed.over,
                  period=repeats(closed.period))


def extremes(scene, states, span=None, fast: bool | None = None):
    """(n, 3, 2) over all time."""
    rest = equilibrium_mask(scene, states)
    return np.array([np.stack([s, s], axis=1) if still else extremes_over_period(scene, s).extremes for s, still in zip(states, rest)]).reshape(-1, 3, 2)


def periods(scene, states, fast: bool | None = None):
    """(n,); 0 at an equilibrium, inf on or next to a separatrix."""
    rest = equilibrium_mask(scene, states)
    return np.array([0.0 if still else extremes_over_period(scene, s).period for s, still in zip(states, rest)])
