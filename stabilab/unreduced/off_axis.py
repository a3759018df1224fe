"""A torque off the principal axes: spin-up with its certificate, found by following the motion, or
undecided with the cause seen.

No integral of motion is known that would settle boundedness here. `spin_up` follows each motion until an
inequality holds that stays true for ever; what it finds is said here in the words of every other kind of
scene, with the bounds that hold for all times.

Bounds of the rates over a whole span come from validated steps (`enclosure`). Each is cut into pieces of
equal length, on which a polynomial lies between the least and the greatest of its Bernstein coefficients;
one formed in doubles errs by less than 2^-44 of the sum of sizes."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Context

import numpy as np

from ..errors import InputError
from ..integrate.events import roots_of_rates
from ..numbers.numba_door import installed
from ..orbit.fate import Basis, OneFate, at_rest
from ..orbit.fate_arrays import FateResult, empty_columns
from ..orbit.result import AS_BOUNDS, Fate, Motion, Needs, finite, judged, pairs, without_return
from ..physics.coefficients import three_floats
from ..physics.scene import Scene, rests
from ..physics.states import equilibrium_mask
from ..reasons import Angle, Quantity, Reason, Sentence
from . import enclosure_kernel
from .crossing import PIECES, bernstein_of
from .enclosure import Band, Course, allowed
from .evidence import extremes_over, seen_over, sizes
from .periodic import in_the_middle
from .spin_up.follow import LEVELS, SpinUps, spin_up, spin_up_many
from .spin_up.form import ISLAND_POSSIBLE, ISLAND_SEEN
from .spin_up.result import SpinUp


# --- Ranges of the rates
def ranges(band: Band) -> np.ndarray:
    """(3, 2) least and greatest that each rate may have during the steps of a band."""
    values = band.polynomials @ bernstein_of(enclosure_kernel.ORDER, PIECES).T
    blur = (band.radii + 2.0**-44 * np.abs(band.polynomials).sum(axis=2)) * (1 + 2.0**-30)
    return np.stack([(values.min(axis=2) - blur).min(axis=0), (values.max(axis=2) + blur).max(axis=0)],
                    axis=1)


def ranges_until(scene: Scene, state: Sequence[float], t: float,
                 steps: int | None = None) -> np.ndarray | None:
    """(3, 2) bounds of each rate over [0, t]; None where the steps do not reach. Arguments as of
    `enclosure.Course`."""
    course, out = Course(scene, state, t), np.array([[math.inf, -math.inf]] * 3)
    steps = allowed() if steps is None else steps
    while course.status == enclosure_kernel.GOING and course.steps < steps:
        band = course.advance(t, steps - course.steps, band=True)
        if band is not None:
            result = ranges(band)
            out = np.stack([np.minimum(out[:, 0], result[:, 0]), np.maximum(out[:, 1], result[:, 1])], axis=1)
    return out if course.status == enclosure_kernel.DONE else None


# --- The motion, and many motions
__all__ = ["extremes", "fates", "motion", "periods"]


NO_BRANCHES = Sentence(
    "no-branches-off-axis", "not known: the torque is off the principal axes, and no separatrix is known "
    "there")()
MAX_STEPS = 600_000  # steps for which a motion is followed where nobody says how long: seconds
AS_WRITTEN = 120  # times fewer steps where numba is not installed
ENDLESS = 10**9     # steps where the caller names a time
BOUND_DIGITS = 10  # decimals of a bound for all times
PERIODIC_MIDDLE = Sentence(
    "periodic-middle", "in its middle is a periodic motion of period {period}, elliptic: neighbours turn "
    "about it by {angle} from passage to passage")
REASON = {"undecided": Basis.OFF_AXIS, "certified": Basis.CERTIFIED, "proved": Basis.CERTIFIED,
          "exact": Basis.CLOSED_FORM}
NO_SPAN = Sentence(
    "span-needed-off-axis", "not known without a certificate of spin-up: give span=T ({unit}), or a span in "
    "the case's [motion], to search them over a time span, or follow=T to look for the certificate longer")


def motion(scene, state, span=None, exact=None, needs: Needs = Needs.ALL, follow: float | None = None,
           tell=None, proof: bool = False) -> Motion:
    """See `answers.motion`. Extremes over the span where one is given, else bounds for all times where
    spin-up is certified."""
    state = three_floats(state)
    if rests(scene.quadratic(), exact or state):
        decided = at_rest(scene, OneFate(Fate.UNDECIDED, Basis.OFF_AXIS, math.nan))
        return Motion(**judged(state, decided), margin_energy=finite(decided.margin),
                      extremes=tuple((v, v) for v in state), velocity_reason=NO_BRANCHES)
    start = list(exact or state) if proof else state
    result = spin_up(scene, start, **_limits(follow), tell=tell, proof=proof)
    decided = OneFate(result.fate, REASON[result.level], math.nan, result.axis, result.sense)
    bounds = bounds_for_ever(scene, start, result) if needs & Needs.EXTREMES else None
    fields = {**judged(state, decided), "velocity_reason": NO_BRANCHES, "level": result.level,
              "finding": result.reason, "bounds": bounds,
              "extremes": bounds, "over": AS_BOUNDS if bounds else NO_SPAN(unit=scene.time_unit)}
    fields["reason"] = decided.reason.then(result.reason)
    resolved = {"t_certificate" if result.fate == Fate.SPIN_UP else "followed_until": result.t,
             "steps_followed": result.steps,
             "small_change_grew": result.condition}
    visited = {} if span is None or not needs & Needs.EXTREMES else seen_over(scene, state, span)
    if result.fate == Fate.UNDECIDED and result.reason.says(ISLAND_SEEN):
        fields["reason"] = fields["reason"].then(_middle(scene, result.state))
    if visited and result.fate == Fate.UNDECIDED:
        fields["reason"] = fields["reason"].then(sizes(visited["evidence"], scene.variables == "scaled"))
    return Motion(**fields | visited | {"evidence": {**visited.get("evidence", {}), **resolved}})


def _middle(scene, state) -> Reason | None:
    """The periodic motion in the middle of an island, where one is found."""
    orbit = in_the_middle(scene, state)
    return None if orbit is None else PERIODIC_MIDDLE(
        period=Quantity(orbit.period, scene.time_unit), angle=Angle(orbit.angle))


def _limits(follow: float | None) -> dict:
    """How far a motion is followed: to a time, or for MAX_STEPS steps, fewer where nothing is compiled."""
    if follow is None:
        return {"budget": MAX_STEPS if installed() else MAX_STEPS // AS_WRITTEN}
    return {"t_max": float(follow), "budget": ENDLESS}


def bounds_for_ever(scene: Scene, state: Sequence[float], result: SpinUp) -> tuple | None:
    """((low, high),) * 3 of the rates at all t >= 0 of a motion that spins up: those of the trap from found.t
    on, and the extremes of the run until then (where the spin-up is proved: what the enclosure of the way
    cannot leave); None where they are not known."""
    if result.fate != Fate.SPIN_UP or result.trap is None:
        return None
    later = tuple((outward(a, ROUND_FLOOR), outward(b, ROUND_CEILING)) for a, b in result.trap.bounds())
    if not result.t:
        return later
    before = (_extremes_until(scene, state, result) if result.passed <= MAX_STEPS
              else _reach(scene, state, result.t))
    return before and tuple((min(a, c), max(b, d)) for (a, b), (c, d) in zip(later, before))


def outward(bound: float, towards: str) -> float:
    """A bound to BOUND_DIGITS decimals, rounded to its safe side: the trap's last places differ from
    processor to processor."""
    if not bound or not math.isfinite(bound):
        return bound
    printed = float(Context(prec=BOUND_DIGITS, rounding=towards).create_decimal_from_float(bound))
    side = math.inf if towards == ROUND_CEILING else -math.inf
    # the double next to the decimal
    return printed if printed == bound or (printed > bound) == (side > 0) else math.nextafter(printed, side)


def _extremes_until(scene: Scene, state: Sequence[float], result: SpinUp) -> tuple | None:
    if result.level == "proved" and (sure := ranges_until(scene, state, result.t)) is not None:
        return pairs(sure)
    run = roots_of_rates(scene, three_floats(state), result.t)
    return None if run.reason else pairs(run.extremes())


def _reach(scene, state, t: float) -> tuple | None:
    """((low, high),) * 3 of the rates until t: with W_i = sqrt(D_i) omega_i, D omega' = M - omega x (D omega
    + l) gives |W|' <= |D^(-1/2) M|."""
    if scene.variables == "scaled":
        return None
    D, M = ([float(v) for v in vector] for vector in (scene.body.exact, scene.vector("constant_torque")))
    size = (math.hypot(*(math.sqrt(d) * float(v) for d, v in zip(D, state)))
            + t * math.hypot(*(m / math.sqrt(d) for m, d in zip(M, D))))
    return tuple((outward(-size / math.sqrt(d), ROUND_FLOOR), outward(size / math.sqrt(d), ROUND_CEILING))
                 for d in D)


@dataclass(frozen=True)
class Followed:
    """What is known of each state of an array: `row(n)`, None where state n is at rest."""

    found: SpinUps
    place: np.ndarray

    @property
    def proved(self) -> np.ndarray:
        """(n,) of which the way is enclosed."""
        level = np.append(self.found.level, 0)  # the last one for states at rest
        return level[self.place] == LEVELS.index("proved")

    @property
    def islands(self) -> np.ndarray:
        """(n,) int8: 2 where a motion is seen to stay on what looks like a bounded island, 1 where it is
        undecided and an island may exist, else 0."""
        out = np.zeros(len(self.place), np.int8)
        for n in np.flatnonzero(np.append(self.found.fate, 0)[self.place] == Fate.UNDECIDED).tolist():
            out[n] = _island(self.row(n))
        return out

    def row(self, number: int) -> SpinUp | None:
        """All that following state `number` showed: trap, cause, time."""
        return None if self.place[number] < 0 else self.found.row(int(self.place[number]))


def _island(result: SpinUp | None) -> int:
    if result is None or result.fate != Fate.UNDECIDED:
        return 0
    return 2 if result.reason.says(ISLAND_SEEN) else int(result.reason.says(ISLAND_POSSIBLE.sentence))


def fates(scene, states, fast: bool | None = None, follow: float | None = None, tell=None,
          proof: bool = False) -> FateResult:
    """Fates of states (n, 3), followed in batches until each is certified. proof: then proved, one after
    another."""
    rest = equilibrium_mask(scene, states)
    moving = np.flatnonzero(~rest)
    result = spin_up_many(scene, states[moving], **_limits(follow), tell=tell, fast=fast, proof=proof)
    out = empty_columns(len(states)) | {"margins": np.full(len(states), np.nan)}
    out["labels"][:], out["reasons"][:] = Fate.EQUILIBRIUM, Basis.AT_REST
    for name, values in (("labels", result.fate), ("axis", result.axis), ("sense", result.sense)):
        out[name][moving] = values
    out["reasons"][moving] = np.array([REASON[word] for word in LEVELS], np.int8)[result.level]
    index = np.full(len(states), -1)
    index[moving] = np.arange(len(moving))
    blank = FateResult(**out, followed=Followed(result, index))  # type: ignore[arg-type]  # the columns alone
    if rest.any():
        resting = at_rest(scene, OneFate(Fate.UNDECIDED, Basis.OFF_AXIS, math.nan))
        blank = replace(blank, margins=np.where(rest, resting.margin, blank.margins))
    return blank


def periods(scene, states, fast: bool | None = None):
    """(n,): 0 at an equilibrium, inf where spin-up is certified, NaN elsewhere."""
    return np.array([without_return(label) for label in fates(scene, states, fast).labels])


def extremes(scene, states, span=None, fast: bool | None = None, follow: float | None = None, tell=None):
    """(n, 3, 2) over the span [0, span], NaN where a run ends before it; without it bounds for all t >= 0 of
    the motions whose spin-up is certified, NaN for the others (InputError where there is nothing else)."""
    rest = equilibrium_mask(scene, states)
    still = np.stack([states, states], axis=2)
    if span is not None:
        return np.array([item if at else extremes_over(scene, s, span) for s, item,
                         at in zip(states, still, rest)]).reshape(-1, 3, 2)
    moving = np.flatnonzero(~rest)
    result = spin_up_many(scene, states[moving], **_limits(follow), tell=tell, fast=fast)
    if len(moving) and not (result.fate == Fate.SPIN_UP).any():
        raise InputError(f"extremes: {NO_SPAN(unit=scene.time_unit)}")
    for n, row in enumerate(moving):
        still[row] = bounds_for_ever(scene, states[row].tolist(), result.row(n)) or np.nan
    return still
