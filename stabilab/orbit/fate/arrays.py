"""Fates of many states, NumPy.

The fate of many torque-free motions: the margin of `free_gyrostat` in doubles, and in many digits where these
are not enough.

With the saddle omega* of speed s on the motion's momentum sphere the first-order terms drop out of the
difference of their kinetic energies, and what is left has neither the large terms of the gyrostatic moment
nor, to first order, the error of s:

    margin = sum D_i (D_i - s)/(2 s) (omega_i - omega*_i)^2,     omega*_i = lambda_i/(s - D_i).

About a middle axis without a gyrostatic moment s = D_i, and that component drops out. Other saddles lie
between the least and the greatest moment, on a branch on either side of the middle one, along which |H| runs
one way; s is measured from the middle moment, so that its distance from the pole there keeps its digits.

The fate of a state: bounded, spin-up, on the separatrix, at rest, or undecided; and its margin in energy.

Decided by energy, never by running. On a circle (elliptic reduction) a motion is bounded iff a barrier at
least as high as its energy stands ahead, in the direction of the torque, within one turn: one turn later the
tilted potential has fallen. On a hyperbola or parabola the potential grows on both sides, so all motions are
bounded but those on one of the invariant planes Q = 0. Inputs are taken as exact; what doubles cannot decide
is decided in many digits.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...numbers.constants import EPS, TURN
from ...numbers.roots import bracketed_newton
from ...physics.states import equilibrium_mask
from ..far_states import far_exponent, far_fate, far_rows
from ..fine.margins import MARGIN_SHARE, valley_margins
from ..landscape import ROUNDINGS, Landscape, in_doubles, landscape
from ..one_orbit import Orbit
from ..potential import derivatives_on_parabola
from ..reduction import reduce
from ..result import Fate
from .by_table import label_by_table
from .one_state import Reason, decide, free_margin, free_middle, is_free, margin_at_rest
from .result import FateResult, empty_columns, in_chunks, write_row
from .table import barrier_table

SURE = 16  # times the estimate of rounding: so far from zero a margin's sign is certain
# times that estimate a margin exceeds it, or many digits are asked: so it keeps nine of its own, near a
# saddle too
OWN = 1e9
# of both kinetic energies: the estimate counts single roundings, of which a margin may have four times as
# many
FREE_MARGIN_SHARE = 5e-13 / 4
LEAST = 1e-290  # smaller terms may have lost digits to underflow


class Branch(NamedTuple):
    """Saddles with s = middle + side r, 0 < r < end; |H| falls from `high` (inf at a pole) to `low` as r
    grows."""

    side: int
    end: float
    low: float
    high: float


class Saddles(NamedTuple):
    """The saddles of a scene: moments, gyrostatic moment and |H| over `unit`, the middle moment, its distance
    from each (3,), the branches, and the least |H| of rotations about a middle axis without a gyrostatic
    moment (inf where there is no such axis)."""

    D: np.ndarray
    lam: np.ndarray
    unit: float
    middle: float
    gaps: np.ndarray
    branches: tuple
    least: float


@lru_cache(maxsize=64)
def saddles_of(scene) -> Saddles:
    """The saddles of a torque-free scene (cached)."""
    D, lam, middle = scene.body.exact, scene.vector("gyrostat"), sorted(scene.body.exact)[1]
    largest = float(max(map(abs, lam)))
    unit = 2.0 ** min(int(np.frexp(largest)[1]), 1023) if largest else 1.0
    floats = lambda values: np.array([float(v) for v in values])
    found = Saddles(floats(D), floats(lam) / unit, unit, float(middle), floats(middle - d for d in D), (),
                    np.inf)
    with np.errstate(all="ignore"):
        if free_middle(D, lam):
            found = found._replace(least=float(_momentum(found, np.zeros(1))[0]))
        return found._replace(branches=tuple(filter(None, (_branch(found, side) for side in (-1, 1)))))


def _parts(saddles, t):
    """(s - D_i, omega*_i), each (3, n), for s = middle + t."""
    gap = t + saddles.gaps[:, None]
    return gap, np.where(saddles.lam[:, None] == 0, 0.0, saddles.lam[:, None] / gap)


def _momentum(saddles, t):
    """|H| (n,) of the permanent rotations of speed middle + t."""
    return (saddles.middle + t) * np.sqrt((_parts(saddles, t)[1] ** 2).sum(axis=0))


def _fall(saddles, t):
    """sum lambda_i^2 D_i/(s - D_i)^3: (|H|^2)' over -2 s, falling in s between two poles."""
    gap, omega = _parts(saddles, t)
    return np.where(saddles.lam[:, None] == 0, 0.0, saddles.D[:, None] * omega * omega / gap).sum(axis=0)


def _branch(saddles, side) -> Branch | None:
    """The branch on one side of the middle moment: where `side` times the fall is positive."""
    reach = float((-side * saddles.gaps).max())
    pole = bool((saddles.lam[saddles.gaps == 0] != 0).any())
    rising = lambda r: side * _fall(saddles, side * np.array([r]))[0] > 0
    if not reach > 0 or not saddles.lam.any() or not (pole or rising(0.0)):
        return None
    end = (reach if (saddles.lam[-side * saddles.gaps == reach] == 0).all() and rising(reach)
           else _fold(rising, reach))
    low, high = (float(_momentum(saddles, side * np.array([r]))[0]) for r in (end, 0.0))
    return Branch(side, end, low, np.inf if pole else high)


def _fold(rising, reach) -> float:
    """r below `reach` up to which |H| falls, to rounding."""
    low, high = 0.0, reach
    for power in range(1, 1000):
        if rising(reach * 2.0**-power):
            low = reach * 2.0**-power
            break
        high = reach * 2.0**-power
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if rising(middle) else (low, middle)
    return low


def label_free(scene, states, out) -> int:
    """Fill the columns of `out` for states (n, 3), as the labellers of `fate` do; returns how many were
    decided in many digits."""
    margins, doubtful = free_margins(scene, states)
    ties = np.zeros(len(states), bool)
    for index in np.nonzero(doubtful)[0]:
        found = free_margin(scene, states[index].tolist())
        margins[index], ties[index] = found.double, found.tie
    out["margins"][:], out["axis"][:], out["sense"][:] = margins, 0, 0
    out["labels"][:] = np.where(ties, Fate.SEPARATRIX, Fate.BOUNDED)
    out["reasons"][:] = np.where(ties, Reason.TIE, Reason.TORQUE_FREE)
    return int(doubtful.sum())


def free_margins(scene, states):
    """(margins (n,) in J, doubtful (n,)) of states (n, 3): inf where the momentum sphere has no saddle;
    doubtful where rounding may cost the sign, or a margin its twelve digits against the kinetic energies of
    the motion and of the saddle."""
    saddles = saddles_of(scene)
    with np.errstate(all="ignore"):
        omega = (states / saddles.unit).T
        H = saddles.D[:, None] * omega + saddles.lam[:, None]
        size = np.sqrt((H * H).sum(axis=0))
        blur = 4 * EPS * (np.abs(saddles.D[:, None] * omega) + np.abs(saddles.lam[:, None])).sum(axis=0)
        energy = 0.5 * (saddles.D[:, None] * omega * omega).sum(axis=0)
        best, rounding, doubtful = np.full(size.shape,
                                           np.inf), np.zeros(size.shape), ~np.isfinite(energy + size * size)
        for there, unsure, margin, error in _candidates(saddles, omega, size, blur):
            doubtful |= unsure | there & ~np.isfinite(margin + error)
            doubtful |= (there & (np.abs(np.abs(margin) - np.abs(best)) <= SURE * (error + rounding))
                         & (margin * best < 0))
            nearer = there & (np.abs(margin) < np.abs(best))
            best, rounding = np.where(nearer, margin, best), np.where(nearer, error, rounding)
        known = (np.isinf(best) | (np.abs(best) > OWN * rounding)
                 & (rounding <= FREE_MARGIN_SHARE * (energy + np.abs(best + energy))))
        margins = best * saddles.unit * saddles.unit
        # in J, a margin that is no double
        lost = np.isfinite(best) & (best != 0) & ~(np.isfinite(margins) & (margins != 0))
        return margins, doubtful | ~known | lost


def _candidates(saddles, omega, size, blur):
    """(there, unsure whether, margin, rounding), arrays (n,), of each kind of saddle."""
    if np.isfinite(saddles.least):
        there = size >= saddles.least
        yield (there & (size > 0), np.abs(size - saddles.least) <= SURE * blur,
               *_margin(saddles, omega, np.zeros(size.shape), np.zeros(size.shape)))
    for branch in saddles.branches:
        there = (branch.low < size) & (size < branch.high)
        unsure = (np.minimum(np.abs(size - branch.low), np.abs(size - branch.high)) <= SURE * blur
                  + SURE * EPS * size)
        margin, error = np.full(size.shape, np.nan), np.zeros(size.shape)
        r = _solved(saddles, branch, size[there])
        margin[there], error[there] = _margin(saddles, omega[:, there], branch.side * r,
                                              size[there] * (blur + EPS * size)[there])
        yield there, unsure, margin, error


def _solved(saddles, branch, size):
    """r (n,) on a branch where |H| is `size`: Newton's method in 1/|H|, which is nearly linear in r next to
    the pole."""
    pole = float(np.hypot.reduce(saddles.lam[saddles.gaps == 0])) if np.isinf(branch.high) else 0.0
    least = (saddles.middle - branch.end if branch.side < 0 else saddles.middle) * pole / size

    def fun(r, size):
        t = branch.side * r
        here = _momentum(saddles, t)
        return 1 / here - 1 / size, branch.side * (saddles.middle + t) * _fall(saddles, t) / here**3
    low = np.minimum(0.99 * least, branch.end)
    start = (np.minimum(saddles.middle * pole / size, 0.5 * branch.end) if pole
             else np.full(size.shape, 0.5 * branch.end))
    return bracketed_newton(fun, low, np.full(size.shape, branch.end), np.maximum(start, low), (size,))


def _margin(saddles, omega, t, residue):
    """(margin, rounding), (n,) each, over the square of the unit; residue: error of |H|^2/2, and so of s."""
    gap, star = _parts(saddles, t)
    s = saddles.middle + t
    share, way = saddles.D[:, None] * np.abs(gap) / (2 * s), omega - star
    loss = np.where(gap == 0, 0.0, (np.abs(t) + np.abs(saddles.gaps[:, None])) / np.abs(gap))
    rounding = (EPS * (share * np.abs(way) * ((2 + loss) * np.abs(way) + 2 * np.abs(omega)
                                              + (2 + 2 * loss) * np.abs(star))).sum(axis=0))
    bend = np.where(residue == 0, 0.0, residue**2 / (s**3 * np.abs(_fall(saddles, t))))
    return -(np.sign(gap) * share * way * way).sum(axis=0), rounding + bend + LEAST


# a table costs some ten milliseconds to build, as much as the general formula needs for these
TABLE_FROM = 5000


def fates(scene, states, fast=None) -> FateResult:
    """Fates and margins of states (n, 3) of a scene with an orbit, or of a free body: `answers.fate` for one
    shape.

    From `TABLE_FROM` states on the barriers come from the scene's table, and what it leaves open from the
    general formula; `fast` is not needed. States whose squares may leave the range of doubles are decided
    one at a time, each in its own unit.
    """
    reduction, out = reduce(scene), empty_columns(len(states))
    far = rows_beyond_doubles(scene, states) if reduction is not None else np.zeros(len(states), bool)
    table = barrier_table(scene) if len(states) >= TABLE_FROM and not far.any() else None
    rows = np.nonzero(~far)[0] if table is None else label_by_table(table, states, out)
    precise = int(far.sum())
    if len(rows):
        near = in_chunks(labeller(scene), states[rows])
        precise += near.precise
        for name, column in out.items():
            column[rows] = getattr(near, name)
    for index in np.nonzero(far)[0]:
        state = states[index].tolist()
        write_row(out, index, *far_fate(scene, Orbit(reduction, state), far_exponent(scene, state) or 0))
    return FateResult(**out, precise=precise)  # type: ignore[arg-type]  # the columns alone


def rows_beyond_doubles(scene, states):
    """Return (n,) booleans that mark which of the states (n, 3) have to be answered one at a time.

    Those are states whose squares may leave the range of doubles; where the numbers of the scene's landscape
    may leave it, all states are. The scene has a reduction.
    """
    far = far_rows(scene, states)
    return far if far.all() or in_doubles(scene) else np.ones(len(states), bool)


def labeller(scene):
    """Return the function that labels a chunk of states (n, 3). It fills the columns of `out` and returns how
    many states needed many digits."""
    land = None if is_free(scene) else landscape(scene)

    def label(states, out):
        precise = (label_free(scene, states, out) if land is None
                   else _by_geometry(land).label(land, states, out))
        at_rest(scene, states, out)
        return precise
    return label


def at_rest(scene, states, out):
    """Mark the states at which every rate of change vanishes exactly. Their margins are those of
    `margin_at_rest`."""
    found = equilibrium_mask(scene, states)
    if found.any():
        out["labels"][found], out["reasons"][found] = Fate.EQUILIBRIUM, Reason.AT_REST
        out["axis"][found] = out["sense"][found] = 0
        out["margins"][found] = [margin_at_rest(scene, margin) for margin in out["margins"][found]]


def fate_on_orbit(scene, land, states) -> FateResult:
    """Return the fates of `fates`, with margins against the barriers of the reduction's own orbit.

    The two margins differ only without a torque: there `fates` compares motions of equal momentum, while the
    reduction keeps another invariant. The margin is 0 on an invariant plane, where no barrier stands.
    """
    found = fates(scene, states)
    if land.sense or not len(states):
        return found
    margins = _by_geometry(land).margins(land, states, *land.start(states))[0]
    return replace(found, margins=margins * land.reduction.energy_unit)


def _settled_circle(land, states, place, w, size):
    """Return the margins (n,) in canonical units, their signs (n,), and how many of the signs took many
    digits to decide."""
    margins, doubtful = circle_margins(land, place, w, size)
    doubtful = np.nonzero(doubtful)[0]
    signs = np.sign(margins)
    for index in doubtful:
        tie = decide(Orbit(land.reduction, states[index]))
        margins[index], signs[index] = tie.margin, tie.sign
    return margins, signs, len(doubtful)


def _label_circle(land: Landscape, states, out) -> int:
    place, w, size = land.start(states)
    margins, signs, precise = _settled_circle(land, states, place, w, size)
    axis, sense = land.reduction.axis + 1, land.sense
    out["margins"][:] = margins * land.reduction.energy_unit
    if sense == 0:  # no torque, in scaled variables: bounded either way
        out["labels"][:], out["reasons"][:] = Fate.BOUNDED, Reason.TORQUE_FREE
    else:
        inside = signs > 0
        out["labels"][:] = np.where(inside, Fate.BOUNDED, Fate.SPIN_UP)
        out["reasons"][:] = np.where(inside, Reason.BELOW_BARRIER,
                                     np.where(np.isneginf(margins), Reason.NO_BARRIER, Reason.ABOVE_BARRIER))
        out["axis"][:], out["sense"][:] = np.where(inside, 0, axis), np.where(inside, 0, sense)
    _mark_ties(out, signs == 0)
    return precise


def _mark_ties(out, tie):
    out["labels"][tie], out["reasons"][tie] = Fate.SEPARATRIX, Reason.TIE
    out["axis"][tie] = out["sense"][tie] = 0


def circle_margins(land: Landscape, place, w, size):
    """Return the margins (n,) in canonical units, and which of them are doubtful (n,).

    A margin is the height of the highest barrier within one turn ahead, less the energy.
    """
    pot = land.potential
    offsets, spots, barrier = land.critical(place, barriers_only=True)
    energy = 0.5 * w * w
    best, doubtful, blurred = np.full(w.shape, -np.inf), np.zeros(w.shape, bool), np.full(w.shape, -np.inf)
    x, z = place
    radius = np.hypot(x, z)
    rounding = size[0] + size[1]
    with np.errstate(all="ignore"):
        pull = np.abs(pot.G * x + pot.c) + abs(pot.d)
        for column in range(offsets.shape[1]):
            offset = np.where(barrier[:, column], offsets[:, column], np.nan)
            spot = spots[:, :, column]
            height, unsure = pot.height_over(place, spot, offset)
            margin = height - energy
            # rounding of the angle adds less: where a barrier stands mu is below the other terms of the force
            scale = (pot.mu * offset + energy
                     + (pull + np.abs(pot.G * spot[0] + pot.c))
                     * (rounding + np.abs(spot[0]) + np.abs(spot[1])))
            there = ~np.isnan(offset)
            # next to a fold the force hardly changes with the angle, so that its rounding moves the barrier
            # far along the circle
            angle_error = (32 * EPS * (1 + rounding / radius)
                           * (1 + pot.terms(tuple(spot)) / np.abs(pot.slope(tuple(spot)))))
            # at a barrier rounding decides whether it stands ahead or behind, and then the next one counts
            doubtful |= (there & ((np.abs(margin) <= ROUNDINGS * EPS * scale)
                                  | (np.minimum(offset, TURN - offset) <= angle_error)))
            best = np.where(there & (margin > best), margin, best)
            vague = there & ~(unsure <= MARGIN_SHARE * (np.abs(height) + energy))
            blurred = np.where(vague & ~(margin + unsure <= blurred), margin + unsure, blurred)
        for edge in land.conic.fold_invariants + land.conic.tangents:
            doubtful |= np.abs(radius**2 - edge) <= ROUNDINGS * EPS * (rounding**2 + edge)
    # a barrier of less digits than promised may be the highest
    doubtful |= ~(blurred < best) & ~np.isneginf(blurred)
    return best, doubtful & (radius > 0)


def _label_hyperbola(land: Landscape, states, out) -> int:
    place, w, size = land.start(states)
    out["labels"][:], out["reasons"][:] = Fate.BOUNDED, Reason.WALLS
    margins, signs, precise = _valley_margins(land, states, place, w, size)
    tie = signs == 0
    out["margins"][:] = margins * land.reduction.energy_unit
    _mark_ties(out, tie)
    on_plane = np.nonzero((place[0] == 0) | (place[1] == 0))[0]
    for index in on_plane:
        _label_plane(land, states[index], [v[index] for v in place], out, index)
    return precise


def _valley_margins(land, states, place, w, size):
    """Return the margins to the barrier that is nearest in height, +inf where the orbit has none. Motions on
    either side of it are bounded."""
    n = len(w)
    margins, signs = np.full(n, np.inf), np.ones(n)
    if not land.may_have_barriers():
        return margins, signs, 0
    pot, energy = land.potential, 0.5 * w * w
    offsets, spots, barrier = land.critical(place, barriers_only=True)
    doubtful = np.zeros(n, bool)
    with np.errstate(all="ignore"):
        for column in range(offsets.shape[1]):
            offset, spot = offsets[:, column], spots[:, :, column]
            rise = pot.rise(-offset, spot)
            margin = np.where(barrier[:, column], -rise - energy, np.inf)
            vague = ~(pot.rounding(-offset, spot, place, size) <= MARGIN_SHARE * (np.abs(rise) + energy))
            nearer = np.abs(margin) < np.abs(margins)
            margins = np.where(nearer, margin, margins)
            force, slope = np.abs(pot.force(place)), np.abs(pot.slope(place))
            scale = energy + np.abs(rise) + force * np.abs(offset) + slope * offset**2 + land.roughness(size)
            doubtful |= nearer & (vague | (np.abs(margin) <= ROUNDINGS * EPS * scale))
            # rounding has led to another equilibrium than was sought, or tilts the way to it
            doubtful |= (barrier[:, column]
                         & (~(pot.slope(spot) > 0) | _tilted(pot, spot, offset, -rise - energy, energy)))
        doubtful |= land.beside_fold(place) | land.beside_centre(place)
    signs = np.sign(margins)
    rows = np.nonzero(doubtful)[0]
    if rows.size:
        found, sure = valley_margins(land, states[rows], (offsets[rows], spots[:, rows], barrier[rows]))
        margins[rows[sure]], signs[rows[sure]], doubtful[rows[sure]] = found[sure], np.sign(
            found[sure]), False
    for index in np.nonzero(doubtful)[0]:
        tie = decide(Orbit(land.reduction, states[index]))
        signs[index], margins[index] = (tie.sign, tie.margin) if np.isfinite(tie.margin) else (1, np.inf)
    return margins, signs, int(doubtful.sum())


def _tilted(pot, spot, offset, margin, energy):
    """(n,) True where the force that rounding leaves at an equilibrium costs a margin its twelve digits over
    the way to it."""
    return (2 * EPS * pot.terms(tuple(spot)) * np.abs(offset) > MARGIN_SHARE
            * (np.abs(margin + energy) + energy))


def _label_plane(land, state, place, out, index):
    """Label one state that is exactly on an invariant plane, or on both planes, where it is a pure spin."""
    xi, eta = place
    axis = land.reduction.axis + 1
    if xi == 0 and eta == 0:
        write_row(out, index, Fate.SPIN_UP, Reason.PURE_SPIN, -np.inf, axis, land.sense)
        return
    if eta == 0:  # grows ahead, and the torque's tilt rises behind
        write_row(out, index, Fate.BOUNDED, Reason.WALLS, np.inf)
        return
    tie = decide(Orbit(land.reduction, state))
    margin = tie.margin * land.reduction.energy_unit
    if tie.sign > 0:
        write_row(out, index, Fate.BOUNDED, Reason.PLANE_CAPTURED, margin)
    elif tie.sign == 0:
        write_row(out, index, Fate.SEPARATRIX, Reason.TIE, 0.0)
    else:
        write_row(out, index, Fate.SPIN_UP, Reason.PLANE_ESCAPES, margin, axis, land.sense)


def _plane_margins(land, states, place, w, size):
    """Return the margins of states on hyperbolas; they are 0 on an invariant plane."""
    margins, *rest = _valley_margins(land, states, place, w, size)
    margins[(place[0] == 0) | (place[1] == 0)] = 0.0
    return margins, *rest


def _label_parabola(land: Landscape, states, out) -> int:
    place, w, size = land.start(states)
    out["labels"][:], out["reasons"][:] = Fate.BOUNDED, Reason.WALLS
    margins, signs, precise = _valley_margins(land, states, place, w, size)
    out["margins"][:] = margins * land.reduction.energy_unit
    _mark_ties(out, signs == 0)
    for index in np.nonzero(flat_mask(land, states, place))[0]:
        write_row(out, index, Fate.SPIN_UP, Reason.PURE_SPIN, -np.inf, land.reduction.axis + 1, land.sense)
    return precise


def flat_mask(land, states, place):
    """(n,) True where the force does not change along the parabola at all (exactly): nothing holds the spin
    back."""
    small = land.nearly_flat(states, place)
    for index in np.nonzero(small)[0]:
        small[index] = _is_flat(land.reduction, states[index])
    return small


def _is_flat(r, state) -> bool:
    return not any(derivatives_on_parabola(r, *(Fraction(float(state[a])) for a in (r.j, r.k))))


class _Ways(NamedTuple):
    """What a geometry has to say here: how a chunk of states is labelled, and what the margins of its orbits
    are."""

    label: Callable
    margins: Callable


_WAYS = {-1: _Ways(_label_circle, _settled_circle), 1: _Ways(_label_hyperbola, _plane_margins),
         0: _Ways(_label_parabola, _valley_margins)}


def _by_geometry(land) -> _Ways:
    return _WAYS[land.e]
