"""A motion to as many digits as are asked for: the cheapest setting that was measured to reach them, checked afterwards.

The check needs no reference: the same motion at another tolerance shows the error of the first, and a start moved by a
unit in its last place shows what doubles can hold. What falls short is done again with the next setting, at last in
many digits, rounded once.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ..compiled import TAYLOR_TOLERANCE, heyoka_available
from ..errors import InputError, ToleranceNotMet
from .precision_front import SAFETY, front
from .simulation import Simulation, simulate, start_of
from .trajectories import FALLBACK_RTOL, SCIPY_METHODS, _start

MOST = 15  # decimal digits that every double holds
MANY = "many digits"
LAST_PLACE = 2.0**-52
CAUTION = 4  # the differences are samples of the error, not bounds: several times their sum counts


@dataclass(frozen=True)
class Reached:
    """A motion that has the digits asked for. digits: those that the check showed; because: how they were checked."""

    run: Simulation
    asked: int
    digits: float
    because: str


def simulate_to(case, times, digits: int = 10) -> Reached:
    """The exact motion of a case at the times (sorted, as of `simulate`) to `digits` decimal digits: relative to the
    largest size of each part of the state over the times.

    Raises InputError for digits outside 1 to 15, and ToleranceNotMet where no setting reaches them.
    """
    if not (isinstance(digits, int) and 1 <= digits <= MOST):
        raise InputError(f"digits: expected a whole number from 1 to {MOST} (what doubles hold), got {digits!r}")
    times, best = np.atleast_1d(np.asarray(times, float)), 0.0
    for method, value in candidates(case, times, digits):
        answer = _checked(case, times, method, value)
        if answer is None:
            continue
        run, error, because = answer
        reached = min(-math.log10(error), MOST + 0.95) if error > 0 else MOST + 0.95
        if reached >= digits:
            return Reached(run, digits, reached, because)
        best = max(best, reached)
    raise ToleranceNotMet(f"{case.path}: {digits} digits asked for, {best:.1f} reached; ask for fewer or for a shorter span")


def candidates(case, times, digits) -> list[tuple[str, float]]:
    """(method, setting) to try, in order: what was measured to reach the digits with one to spare, cheapest first; then,
    whatever was measured, the finest Taylor series, which costs little more than a coarse one; then many digits."""
    end = max(case.span, key=abs) if case.span else 0.0
    inside = np.all((times * np.sign(end) >= 0) & (np.abs(times) <= abs(end)))
    measured = [(p.method, p.rtol) for p in front(case) if inside and p.digits >= digits + SAFETY and p.method in RUNS]
    rule = ("taylor", TAYLOR_TOLERANCE) if heyoka_available() else ("DOP853", FALLBACK_RTOL)
    return list(dict.fromkeys([*measured, rule, (MANY, 0.0)]))


def _checked(case, times, method, value):
    """(run, largest relative error that the check shows, words), or None where the method has no answer."""
    if method == MANY:
        return _many_digits(case, times)
    try:
        run, other, moved = (RUNS[method](one, times, method, v) for one, v in (
            (case, value), (case, _other(method, value)), (_moved(case), value)))
    except InputError:
        return None
    if any(r.status != "reached" for r in (run, other, moved)):
        return None
    tolerance, place = _distance(run, other), _distance(run, moved)
    setting = f"{'nodes' if method == 'reduced' else 'rtol'} {_other(method, value):.2g}"
    return run, CAUTION * (tolerance + place), (f"{method} with {setting} differs by {tolerance:.1e}, a start moved in its last place by {place:.1e}")


def _other(method, value):
    """A setting fine enough to judge by, or, where there is none, a coarser one: the difference is then too large."""
    if method == "reduced":
        return 2 * value
    finest = TAYLOR_TOLERANCE if method == "taylor" else FALLBACK_RTOL
    return max(value / 1000, finest) if value > 4 * finest else value * 8


def _moved(case):
    """The case with every component of the rate moved by about a unit in its last place."""
    top = max(map(abs, case.state)) or 1.0
    signs = np.random.default_rng(1).choice([-1.0, 1.0], 3)
    return replace(case, state=tuple(float(v + s * LAST_PLACE * (abs(v) or top / 2)) for v, s in zip(case.state, signs)))


def _distance(one, two) -> float:
    worst = 0.0
    for name, values in one.state.items():
        size = np.abs(values).max() or 1.0
        worst = max(worst, float(np.abs(values - two.state[name]).max() / size))
    return worst if math.isfinite(worst) else math.inf


def _integrated(case, times, method, rtol):
    return simulate(case.scene, case.state, times, case.blocks, method, rtol)


def _reduced(case, times, method, nodes):
    from .precision_reduced import reduced
    if case.blocks or case.scene.blocks != ("omega",) or (times < 0).any():
        raise InputError("the reduced form gives the rate alone, from time 0 on")
    orbit = reduced(case.scene, case.state, int(nodes))
    return Simulation(times, {_first(case): orbit.at(times)}, "exact", "reduced form", None, counters={"evaluations": int(orbit.counts)},
                      reason=f"time as an integral over the reduced coordinate, {int(nodes)} nodes")


RUNS = {"taylor": _integrated, **dict.fromkeys(SCIPY_METHODS, _integrated), "reduced": _reduced}


def _first(case):
    return "x" if case.scene.variables == "scaled" else "omega"


def _many_digits(case, times):
    """The reference itself, rounded once; for states without an attitude, at times of one sign."""
    from .precision_reference import reference
    scaled = case.scene.variables == "scaled"
    equations, start = _start(case.scene, case.state if scaled else start_of(case.scene, case.state, case.blocks))
    if "attitude" in equations.blocks or (times.min() < 0 < times.max()):
        return None
    order = np.argsort(np.abs(times), kind="stable")
    found = reference(case.scene, start, times[order], equations.blocks)
    if found.status != "agrees":
        return None
    states = np.empty_like(found.states)
    states[order] = found.states
    parts = {_first(case) if name == "omega" else name: states[:, part] for name, part in found.slices.items()}
    because = f"Taylor series in {found.digits[0]} and {found.digits[1]} digits differ by {found.error.max():.0e}; rounded once"
    return Simulation(times, parts, "exact", MANY, None, counters={"multiplications": found.work}, reason=because), (
        float(found.error.max()) + 2.0**-53), because
