"""A motion in many digits which knows its own error: Taylor series of the exact equations, run at two precisions.

Nothing is shared with the methods that are judged by it but the equations themselves.
"""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..numbers.balls import DOUBLE_BITS, working
from ..physics.blocks import slices
from ..physics.equations import derive
from .taylor_digits import Exhausted, Loop, Recursion, steps

DIGITS = (30, 42, 84, 168, 336)  # of successive runs; each is checked by the one before
AGREEMENT = 1e-19  # two runs agree where they differ by less than this share of the state: far below a double's 1e-16
WORK = 60_000_000  # multiplications of all runs together, some ten seconds
SEARCH = 20  # evaluations of a series that the search for its roots takes in a step
GUARD = 8  # digits that the roundings of a run may use up


@dataclass(frozen=True)
class Reference:
    """States (n, N) at times t (n,) as unevaluated sums states + rest of two doubles.

    error: (n,) the difference between the last two runs, relative as of `relative_errors`; digits: of those two runs. period: (time, rest,
    error) of the first return, or None; extremes: least and greatest of each of the first three components over that
    period as (3, 2, 2) sums of two doubles, or None, extremes_error relative. status: "agrees" or "stopped", where t
    holds the longest part of the span on which they agree (reason says why it ends). work: multiplications.
    """

    t: np.ndarray
    states: np.ndarray
    rest: np.ndarray
    error: np.ndarray
    digits: tuple[int, int]
    slices: dict = field(repr=False)
    period: tuple | None = None
    extremes: np.ndarray | None = None
    extremes_error: float | None = None
    status: str = "agrees"
    reason: str = "two precisions agree at every time"
    work: int = 0


def one_run(recursion, start, times, digits, budget, orbit=False):
    """(states at the times reached, (period, extremes) or None) as balls at `digits` decimal digits.

    times: of one sign, moving away from 0. orbit: the motion is known to repeat: its return is found, and later times
    are folded by the period, so that they cost nothing.
    """
    found, passed, loop = [], [], Loop() if orbit else None
    with working(int((digits + GUARD) * 3.33)) as numbers:
        wanted = [numbers.ball(t) for t in times]
        try:
            for step in steps(recursion, start, digits, budget, numbers, -1 if len(times) and times[-1] < 0 else 1, orbit):
                while len(found) < len(wanted) and abs(wanted[len(found)] - step.start) <= abs(step.length):
                    found.append(step.at((wanted[len(found)] - step.start).mid()))
                if loop:
                    passed.append(step)
                    budget[0] -= SEARCH * (recursion.size + 1) * len(step.rows[0])
                    loop.take(step)
                    if loop.closed:
                        found += [_folded(passed, t, loop.period) for t in wanted[len(found):]]
                if len(found) == len(wanted) and (loop is None or loop.closed):
                    break
        except Exhausted:
            pass
        return found, (loop.period, loop.extremes) if loop and loop.closed else None


def _folded(passed, time, period):
    """State at a time beyond the first return."""
    within = (time - (time / period).floor() * period).mid()
    step = next((s for s in passed if s.start <= within and within - s.start <= s.length), passed[-1])
    return step.at((within - step.start).mid())


def relative_errors(values, states, rest, slices) -> np.ndarray:
    """(n,) error of states (n, N): in each block the largest component's distance over the block's largest size in the
    run, the worst block counting."""
    worst = np.zeros(len(states))
    for part in slices.values():
        size = np.abs(states[:, part]).max(initial=0.0)
        gap = np.abs((values[:, part] - states[:, part]) - rest[:, part]).max(axis=1)
        worst = np.maximum(worst, gap / size if size else gap)
    return worst


def reference(scene, start, times, blocks=(), orbit=False, work: int = WORK) -> Reference:
    """The motion from `start` (N numbers, taken as exact) at increasing (or decreasing) times of one sign.

    blocks: blocks of state beyond those the scene needs. orbit: the motion is known to repeat: find its period and
    extremes as well, and fold later times by the period. work: multiplications allowed. Where two precisions do not agree
    within it, the longest part of the span that does is returned, with status "stopped". Raises InputError for rates that are no polynomials.
    """
    equations = derive(scene, blocks)
    recursion, times, budget = Recursion(equations), np.asarray(times, float), [work]
    parts, before, best = slices(equations.blocks), None, None
    orbit = orbit and not (times < 0).any()
    empty = np.empty((0, recursion.size))
    for digits in DIGITS:
        kept = 0 if before else budget[0] * 2 // 3  # of the work, for the second run: it costs twice the first
        budget[0] -= kept
        now = one_run(recursion, start, times, digits, budget, orbit)
        budget[0] = max(budget[0], 0) + kept if kept else budget[0]
        if before is not None:
            found = _compared(times, before, now, parts, work - budget[0])
            best = found if best is None or len(found.t) >= len(best.t) else best
        if budget[0] < 0 or (best and best.status == "agrees" and (best.period is None or best.period[2] <= AGREEMENT)):
            break
        before = digits, now
    return best or Reference(np.empty(0), empty, empty, np.empty(0), DIGITS[:2], parts, status="stopped", work=work - budget[0],
                             reason=f"a run in {DIGITS[0]} digits takes more than the {work:.1g} multiplications allowed")


def _compared(times, before, now, parts, work) -> Reference:
    (low_digits, (low, low_loop)), (high, loop) = before, now
    n = min(len(low), len(high))
    states, rest = pairs(high[:n])
    lower, lower_rest = pairs(low[:n])
    error = relative_errors(lower, states, rest - lower_rest, parts) if n else np.empty(0)
    error = np.maximum(error, 10.0**-low_digits)
    good = error <= AGREEMENT
    reach = n if good.all() else int(np.argmin(good))
    ok, end = reach == len(times), times[reach - 1] if reach else 0.0
    why = "two precisions agree at every time" if ok else (
        f"{low_digits} and {DIGITS[DIGITS.index(low_digits) + 1]} digits agree up to t = {end:.6g} of {times[-1]:.6g}, and "
        + ("the multiplications allowed went no further" if reach == n else "not beyond: the motion is too sensitive"))
    period, extremes, extremes_error = _orbits(low_loop, loop)
    high_digits = DIGITS[DIGITS.index(low_digits) + 1]
    return Reference(times[:reach], states[:reach], rest[:reach], error[:reach], (low_digits, high_digits), parts, period, extremes,
                     extremes_error, "agrees" if ok else "stopped", why, work)


def pairs(rows):
    """Lists of balls as two arrays of doubles whose sum they are."""
    with working(DOUBLE_BITS):
        high = np.array([[float(v) for v in row] for row in rows])
        low = np.array([[float((v - float(v)).mid()) for v in row] for row in rows])
    return high, low


def _orbits(low, high):
    """((period, rest, relative error), extremes (3, 2, 2), their relative error) of two runs, or three Nones."""
    if low is None or high is None:
        return None, None, None
    (t0, pairs0), (t1, pairs1) = low, high
    with working(DOUBLE_BITS):
        period = float(t1), float(t1 - float(t1)), float(abs(t1 - t0) / t1)
        extremes = np.array([[[float(v), float(v - float(v))] for v in pair] for pair in pairs1])
        gap = max(float(abs(a - b)) for one, two in zip(pairs0, pairs1) for a, b in zip(one, two))
    size = np.abs(extremes[..., 0]).max()
    return period, extremes, gap / size if size else gap
