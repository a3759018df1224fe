"""Motions without a reduction: torque off the principal axes (evidence of a run), and free motion (periodic, exact).

Off the axes the system has no known invariant that would settle boundedness: what is reported is what a tight run
shows over its span, labelled so. Without torque the motion is closed on an energy ellipsoid, and one return gives its
period and every extreme.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ..errors import InputError
from .near_rest import beside_rest, small_loop
from ..integrate.extrema import roots_of_rates
from ..orbit.result import Fate
from ..integrate.trajectory import _state, trajectory

# A run that has not shown what is asked after this many steps (seconds of work) gives up and says so.
STEP_BUDGET = 1_000_000
# Two points of a closed orbit are the same where they agree to this share of the orbit's size.
SAME_POINT = 1e-9
# An axis is called the spin-up's when in this many doublings of the run in a row it keeps its sense and its least rate
# grows by this factor, and no other axis does (a spin like the square root of time gives 1.41, a steady spin-up 2); in the last
# it exceeds the whole spin of the beginning, which a temporary capture, however slowly its swing dies out, never does.
DOUBLINGS, GROWTH = 3, 1.2
# Or when it keeps its sense through the last doubling, ends ten times faster than the whole spin began, and holds this
# share of the squared spin throughout.
SHARE, FASTER = 0.9, 10.0


@dataclass(frozen=True)
class Evidence:
    """What a run over a span shows; it proves nothing beyond it.

    span: its length, s (tau when scaled); extremes: (3, 2) over it, ends included, as roots of the rates; size: |omega|
    (or |x|) at the start, at the end, and its largest value at those roots; energy: kinetic energy at start and end; trend:
    "rises", "falls", "oscillates"; drift: relative departure from the balance laws.
    """

    fate: Fate
    reason: str
    span: float
    extremes: np.ndarray
    extremes_over: str
    size: tuple[float, float, float]
    energy: tuple[float, float]
    trend: str
    drift: dict[str, float]
    steps: int


@dataclass(frozen=True)
class Growth:
    """Axis (1, 2, 3; 0 where unclear) and sense of the growing spin at the end of a run of length `span`."""

    axis: int
    sense: int
    span: float
    words: str
    steps: int


@dataclass(frozen=True)
class PeriodExtremes:
    """extremes: (3, 2) over `over` ("all time" or the span searched); period: inf where no return was found."""

    extremes: np.ndarray
    period: float
    over: str
    reason: str


def evidence(scene, state, span) -> Evidence:
    """The evidence of one run: `state` (three numbers) at its start; span: its length, or its two ends."""
    state = _state(state)
    start, end = (0.0, span) if np.ndim(span) == 0 else span
    length = float(end) - float(start)
    if not math.isfinite(length) or length == 0:
        raise InputError(f"span: expected a finite length other than 0, got {span!r}")
    roots = roots_of_rates(scene, state, length)
    run = trajectory(scene, state, np.linspace(0, roots.t_reached, 65)[1:] if roots.t_reached else [0.0])
    points = np.vstack([state, run.states])
    energy = _energy(scene, points)
    sizes = np.linalg.norm(np.vstack([points, roots.states]), axis=1)
    unit = scene.time_unit
    over = f"{unit} in [{float(start):g}, {float(start) + roots.t_reached:g}]"
    return Evidence(Fate.UNDECIDED, _why_undecided(scene) + (f"; {roots.reason}" if roots.reason else ""), roots.t_reached,
                    roots.extremes(), over, (float(sizes[0]), float(sizes[len(points) - 1]), float(sizes.max())),
                    (float(energy[0]), float(energy[-1])), _trend(energy), run.invariant_drift, roots.steps)


def _why_undecided(scene):
    torque = [f"axis {i + 1}" for i, m in enumerate(scene.quadratic().m) if m]
    if len(torque) > 1:
        return (f"the torque is off the principal axes (components on {' and '.join(torque)}): no invariant is known that decides "
                "boundedness; a run over a span cannot")
    return "boundedness was not decided; the run shows this span alone"


def _energy(scene, points):
    from ..physics.to_numpy import _equations, to_numpy
    return np.asarray(to_numpy(_equations(scene)).invariants(points)["energy"])


def _trend(energy):
    """Whether the energy of the last quarter of the run lies wholly above or below that of the first."""
    quarter = max(1, len(energy) // 4)
    first, last = energy[:quarter], energy[-quarter:]
    return "rises" if last.min() > first.max() else "falls" if last.max() < first.min() else "oscillates"


def growth(scene, state, t_max: float) -> Growth:
    """Run in doubling spans, up to t_max or the step budget, until one axis clearly holds the growing spin."""
    here, t, steps, stages = _state(state), 0.0, 0, []
    begin = np.linalg.norm(here) + math.sqrt(max(abs(float(v)) for v in scene.quadratic().m))
    span = min(10 / math.sqrt(max(abs(float(v)) for v in scene.quadratic().m)), t_max)
    while t < t_max and steps < STEP_BUDGET:
        run = trajectory(scene, here, np.linspace(0, span, 257)[1:])
        if run.status == "stopped":
            return Growth(0, 0, t, run.reason, steps)
        t, here, steps = t + span, run.states[-1], steps + run.counters["steps"]
        squares = run.states**2
        share = (squares / squares.sum(axis=1, keepdims=True)).min(axis=0)
        stages.append((np.sign(run.states).sum(axis=0) / len(run.states), np.abs(run.states).min(axis=0)))
        i = _holder(stages[-DOUBLINGS - 1:], begin) if len(stages) > DOUBLINGS else None
        if i is None and share.max() > SHARE and np.abs(here).max() > FASTER * begin:
            i = int(share.argmax())
        if i is not None and abs(stages[-1][0][i]) == 1:
            words = f"it alone keeps its sense and grows; least rate in the last half of the run {stages[-1][1][i]:.4g}"
            return Growth(i + 1, int(stages[-1][0][i]), t, words, steps)
        span = min(t, t_max - t)
    return Growth(0, 0, t, "no axis holds the spin", steps)


def _holder(stages, begin):
    """The one axis that keeps its sense through the stages while its least rate grows, past `begin`; None where it is not one."""
    senses, least = (np.array(column) for column in zip(*stages))
    held = (np.abs(senses.sum(axis=0)) == len(stages)) & (least[1:] > GROWTH * least[:-1]).all(axis=0) & (least[-1] > begin)
    return int(held.argmax()) if held.sum() == 1 else None


def extremes_over_period(scene, state) -> PeriodExtremes:
    """Period and extremes of a motion without torque (any gyrostatic moment), from one return to its first extreme.

    Each extreme is polished on the two invariants of the state, so it does not carry the run's drift. An equilibrium has
    period 0; a motion that does not return within the step budget (on or next to a separatrix) has period inf and its
    extremes are over the span run. Raises InputError where a torque acts.
    """
    form, given = scene.quadratic(), list(state)
    state = _state(state)
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
