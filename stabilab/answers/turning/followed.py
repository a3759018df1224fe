"""The attitude of motions that are followed: wheels without a torque, and bounded motions under a torque.

With wheels the mean rate of precession is a sum over equal times of one period, whose error falls like a
power with their number (the trapezoidal rule on a periodic function); under a torque the attitude is followed
for one period.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from ...numbers.exact import sqrt_fraction
from ...orbit.result import Motion
from ...physics.scene import Scene
from ...reasons import Sentence
from ..simulate import simulated, trajectory
from .result import LONG, ROUND_AXIS, SHORT, Attitude, turned

SUM_ERROR, RUN_ERROR = 1e-11, 1e-10  # relative: of a sum over a run, of a run's end
OTHERS = 1.0 - np.eye(3)  # rows: the two axes beside each one
UNDERFLOW = Sentence(
    "momentum-too-near-axis", "undecided: the angular momentum is so near an axis that doubles do not tell "
    "how it goes round it")()
ROUND_NEITHER = Sentence(
    "momentum-round-neither", "no torque: in the body the angular momentum goes round neither the long nor "
    "the short axis alone, so none of them precesses about it")()
TORQUE_TURNS = Sentence(
    "torque-turns-momentum", "a torque changes the angular momentum: no axis precesses about it; the rates "
    "repeat after one rotation period, and the attitude has turned")()
NUTATION = 1e-11  # squares of angles up to which the motion is linear
FEWEST, MOST = 64, 1 << 17  # times of the sum


def followed(scene: Scene, base: Attitude, result: Motion, period: float) -> Attitude:
    """base: what is known at the start; result: the motion; period: its own."""
    if any(scene.vector("constant_torque")):
        return _under_torque(scene, base, period)
    return _of_gyrostat(scene, base, result, period)


def _of_gyrostat(scene: Scene, base: Attitude, result: Motion, period: float) -> Attitude:
    """A body with wheels and no torque: sums over equal times of one period."""
    D, wheel = (np.array(v, float) for v in (scene.body.exact, scene.vector("gyrostat")))
    count, before, names = FEWEST, math.inf, _long_and_short(scene.body.exact)
    while True:
        states = trajectory(scene, result.at, np.arange(1, count) * (period / count), laws=False).states
        omega = np.vstack([result.at, states])
        h = D * omega + wheel
        h /= np.linalg.norm(h, axis=1)[:, None]
        # of each axis, the square of the sine of its angle from H; 1 - h^2 would cancel near an axis
        across = (h * h) @ OTHERS
        # the long or the short axis where H goes round it alone; else the axis that H keeps farthest from
        encircled = [i for i in names if _winding(h, i)]
        e = encircled[0] if len(encircled) == 1 else int(across.min(axis=0).argmax())
        if (small := _small_nutation(scene, result, e, float(across[:, e].max()))) is not None:
            mean, before = small
            break
        with np.errstate(all="ignore"):
            mean = float(((omega * h) @ OTHERS[e] / across[:, e]).mean())
        if not math.isfinite(mean) or not mean:
            return replace(base, rotation_period=period, reason=UNDERFLOW)
        if abs(mean - before) <= SUM_ERROR * abs(mean) or count >= MOST:
            break
        before, count = mean, 2 * count
    error = max(SUM_ERROR, abs(mean - before) / abs(mean))
    mode = names[e] if encircled == [e] else None
    reason = ROUND_AXIS(axis=mode.removesuffix("-axis")) if mode else ROUND_NEITHER
    cone = None
    if mode and result.extremes is not None:
        low, high = (min(1.0, max(-1.0, (D[e] * v + wheel[e]) / base.momentum)) for v in result.extremes[e])
        low, high = (-high, -low) if low + high < 0 else (low, high)
        cone = math.acos(high), math.acos(low)
    return turned(replace(base, mode=mode, rotation_period=period, cone=cone, error=error, reason=reason,
                           precession_period=2 * math.pi / abs(mean) if mode else None),
                   mean * period / (2 * math.pi))


def _small_nutation(scene: Scene, result: Motion, e: int, across: float) -> tuple[float, float] | None:
    """(mean rate of precession about axis e, another as far from it as it may be wrong) of the linear motion,
    where H keeps so near the axis that a run loses the digits of the small rates; else None. across: the
    square of the sine of their largest angle.

    With w, H about the axis and i, j beside it D_i w_i' = -(H - D_j w) w_j, D_j w_j' = (H - D_i w) w_i: H
    goes round the axis in the body at W, W^2 the product of both brackets over D_i D_j, in the direction of
    their sign, and the axis precesses at w + W. What is left out is of the second order in the angle over a
    bracket."""
    D, wheel = scene.body.exact, scene.vector("gyrostat")
    w = Fraction(result.at[e])
    i, j = (n for n in range(3) if n != e)
    H = D[e] * w + wheel[e]
    brackets = [H - D[n] * w for n in (i, j)]
    if not H or brackets[0] * brackets[1] <= 0:
        return None
    left = across * float(H / min(brackets, key=abs)) ** 2
    if not left <= NUTATION:
        return None
    W = math.copysign(float(sqrt_fraction(brackets[0] * brackets[1] / (D[i] * D[j]))), brackets[0])
    mean = float(w) + W
    return (mean, mean * (1 + 10 * left)) if mean else None


def _winding(h: np.ndarray, i: int) -> int:
    """How often the directions h, a closed row of them, go round axis i."""
    z = h[:, (i + 1) % 3] + 1j * h[:, (i + 2) % 3]
    return round(float(np.angle(np.roll(z, -1) / z).sum()) / (2 * math.pi))


def _long_and_short(D: Sequence[Fraction]) -> dict[int, str]:
    """The axes of least and of greatest moment; where two moments are equal, the one that differs."""
    low, middle, high = sorted(range(3), key=lambda i: D[i])
    return {**({low: LONG} if D[low] < D[middle] else {}), **({high: SHORT} if D[middle] < D[high] else {})}


def _under_torque(scene: Scene, base: Attitude, period: float) -> Attitude:
    """The turn after one period of the rates; the attitude is followed."""
    run = simulated(scene, base.at, [0.0, period], {"attitude": (0.0, 0.0, 0.0, 1.0)})
    *vector, w = run.state["quaternion"][-1].tolist()
    size = math.hypot(*vector)
    axis = tuple(math.copysign(1.0, w) * v / size for v in vector) if size else None
    return replace(base, rotation_period=period, turn_angle=2 * math.atan2(size, abs(w)), turn_axis=axis,
                   error=RUN_ERROR,
                   reason=TORQUE_TURNS)
