"""A motion to as many digits as are asked for: the cheapest setting that was measured to reach them, checked afterwards.

The check needs no reference: the same motion at another tolerance, its start moved by a unit in its last place, shows the
error of the first run and what doubles can hold, for the price of one run more. What falls short is done again with the next
setting, at last in many digits, rounded once.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ..attitude import angles, beyond, to_space
from ..compiled import TAYLOR_TOLERANCE
from ..errors import InputError, ToleranceNotMet
from .precision_front import SAFETY, front
from .precision_told import CAUTION, DEFAULT, MOST, checked_digits, digits_of
from .simulation import STIFF_METHOD, Simulation, body_momentum, simulate, start_of
from .trajectories import FALLBACK_RTOL, SCIPY_METHODS, _start

MANY = "many digits"
OWN = ("as simulate chooses", 0.0)  # the finest Taylor series, which costs little more than a coarse one; Radau where the scene is stiff
STIFF_FINE = (STIFF_METHOD, 1e-12)
LAST_PLACE = 2.0**-52
COUNTED = 1.0  # rad: angles this near to those of a run in doubles have the same number of turns


@dataclass(frozen=True)
class Reached:
    """A motion and the digits that the check showed. because: how they were checked."""

    run: Simulation
    asked: int
    digits: float
    because: str

    @property
    def enough(self) -> bool:
        return self.run.status == "reached" and self.digits >= self.asked


def simulate_to(case, times, digits: int = DEFAULT) -> Reached:
    """The exact motion of a case at the times (as of `simulate`) to `digits` decimal digits: relative to the largest size of
    each part of the state over the times.

    Raises InputError for digits outside 1 to 15, and ToleranceNotMet where no setting reaches them.
    """
    found = best_reached(case, times, digits)
    if not found.enough:
        raise ToleranceNotMet(missed(case, found))
    return found


def missed(case, found) -> str:
    """Why digits were not reached, in words."""
    if found.run.status != "reached":
        return f"{case.place}: {found.run.reason}"
    return f"{case.place}: {found.asked} digits asked for, {found.digits:.1f} reached ({found.because}); ask for fewer or for a shorter span"


def best_reached(case, times, digits: int = DEFAULT, measured: bool = True) -> Reached:
    """As `simulate_to`, but where no setting reaches the digits the motion that comes nearest. A run that stops early ends
    the search. measured: choose by the times that were measured on this machine; without them the answer is always the same."""
    checked_digits(digits, MOST)
    times, best = np.atleast_1d(np.asarray(times, float)), None
    for method, value in candidates(case, times, digits) if measured else (OWN, (MANY, 0.0)):
        found = _checked(case, times, method, value, digits)
        if found is None:
            continue
        if found.enough or found.run.status != "reached":
            return found
        best = found if best is None or found.digits > best.digits else best
    return best


def candidates(case, times, digits) -> list[tuple[str, float]]:
    """(method, setting) to try, in order: what was measured to reach the digits with one to spare, cheapest first; then,
    whatever was measured, what `simulate` chooses itself; then many digits."""
    end = max(case.span, key=abs) if case.span else 0.0
    inside = np.all((times * np.sign(end) >= 0) & (np.abs(times) <= abs(end)))
    measured = [(p.method, p.rtol) for p in front(case) if inside and p.digits >= digits + SAFETY and p.method in RUNS]
    return list(dict.fromkeys([*measured, OWN, (MANY, 0.0)]))


def _checked(case, times, method, value, asked) -> Reached | None:
    """The motion by one setting with the digits that the check shows; None where that way has no answer."""
    if method == MANY:
        return _many_digits(case, times, asked)
    try:
        run = RUNS[method](case, times, method, value)
    except InputError:
        if (method, value) == OWN:
            raise
        return None
    if (method, value) == OWN:
        method, value = run.method, run.rtol
        if method == STIFF_METHOD and value > STIFF_FINE[1] and asked > -math.log10(value) - SAFETY:
            return _checked(case, times, *STIFF_FINE, asked)
    other_value = _other(method, value)
    other = RUNS[method](_moved(case), times, method, other_value) if run.status == "reached" else run
    if other.status != "reached":
        return Reached(run, asked, 0.0, f"the check of {method} stopped early")
    gap = _distance(run, other)
    return Reached(run, asked, digits_of(CAUTION * gap), f"{method} with {'nodes' if method == 'reduced' else 'rtol'} {other_value:.2g} "
                   f"from a start moved in its last place differs by {gap:.1e}")


def _other(method, value):
    """A setting fine enough to judge by, or, where there is none, a coarser one: the difference is then too large."""
    if method == "reduced":
        return 2 * value
    finest = TAYLOR_TOLERANCE if method == "taylor" else FALLBACK_RTOL
    return max(value / 1000, finest) if value > 4 * finest and method != STIFF_METHOD else value * 8


def moved_row(row) -> np.ndarray:
    """Numbers each moved by about a unit in its last place; a zero by half a unit of the largest."""
    row = np.asarray(row, float)
    signs = np.random.default_rng(1).choice([-1.0, 1.0], row.size)
    return row + signs * LAST_PLACE * np.where(row == 0, 0.5 * np.abs(row).max(), np.abs(row))


def _moved(case):
    """The case with its start moved; what is zero throughout (rest at the origin) stays."""
    return replace(case, state=tuple(map(float, moved_row(case.state))),
                   blocks={name: tuple(map(float, moved_row(row))) for name, row in case.blocks.items()})


def _distance(one, two) -> float:
    worst = 0.0
    for name, values in one.state.items():
        size = np.abs(values).max() or 1.0
        worst = max(worst, float(np.abs(values - two.state[name]).max() / size))
    return worst if math.isfinite(worst) else math.inf


def _integrated(case, times, method, rtol):
    own = (method, rtol) == OWN
    return simulate(case.scene, case.state, times, case.blocks, None if own else method, None if own else rtol)


def _reduced(case, times, method, nodes):
    from .precision_reduced import reduced
    if case.blocks or case.scene.blocks != ("omega",) or (times < 0).any():
        raise InputError("the reduced form gives the rate alone, from time 0 on")
    orbit = reduced(case.scene, case.state, int(nodes))
    return Simulation(times, {_first(case): orbit.at(times)}, "exact", "reduced form", None, counters={"evaluations": int(orbit.counts)},
                      reason=f"time as an integral over the reduced coordinate, {int(nodes)} nodes")


RUNS = {"taylor": _integrated, OWN[0]: _integrated, **dict.fromkeys(SCIPY_METHODS, _integrated), "reduced": _reduced}


def _first(case):
    return "x" if case.scene.variables == "scaled" else "omega"


def _many_digits(case, times, asked) -> Reached | None:
    """The reference itself, rounded once; at times of one sign."""
    from .precision_reference import reference
    scaled = case.scene.variables == "scaled"
    equations, start = _start(case.scene, case.state if scaled else start_of(case.scene, case.state, case.blocks))
    if times.min() < 0 < times.max():
        return None
    start = [*(case.exact_state or start[:3]), *start[3:]]  # the decimals as they were written
    order = np.argsort(np.abs(times), kind="stable")
    found = reference(case.scene, start, times[order], equations.blocks)
    if found.status != "agrees":
        return None
    states = np.empty_like(found.states)
    states[order] = found.states
    validity = _validity(case.scene, {name: states[:, part] for name, part in found.slices.items()})
    parts = {_first(case) if name == "omega" else name: states[:, part] for name, part in found.slices.items()}
    error = float(found.error.max()) + 2.0**-53
    if "attitude" in parts:
        parts = _with_angles(case, times, parts)
        if parts is None:
            return None
        error += 2.0**-51 / np.abs(np.cos(parts["angles"][:, 0])).min()  # phi and theta magnify the rounding of the quaternion
    because = f"Taylor series in {found.digits[0]} and {found.digits[1]} digits differ by {found.error.max():.0e}; rounded once"
    run = Simulation(times, parts, "exact", MANY, None, counters={"multiplications": found.work}, reason=because, validity=validity)
    return Reached(run, asked, digits_of(error), because)


def _validity(scene, blocks):
    """Of the laws at the times asked for; None where all are exact."""
    if not scene.approximate:
        return None
    from ..law_limits import along
    return along(scene, blocks, "at the times told")


def _with_angles(case, times, parts):
    """Angles and momentum in place of the quaternion: turns counted by a run in doubles; None where it is too far off to count."""
    near, q = _integrated(case, times, *OWN), parts.pop("attitude")
    if near.status != "reached":
        return None
    ways = [found + 2 * np.pi * np.round((near.state["angles"] - found) / (2 * np.pi)) for found in (angles(q), beyond(angles(q)))]
    gaps = [np.abs(way - near.state["angles"]).max(axis=1, keepdims=True) for way in ways]
    if np.minimum(*gaps).max() > COUNTED:
        return None
    found = np.where(gaps[0] <= gaps[1], *ways)
    first = {name: parts.pop(name) for name in ("omega", "gamma") if name in parts}
    return first | {"angles": found, "momentum": to_space(q, body_momentum(case.scene, first["omega"]))} | parts
