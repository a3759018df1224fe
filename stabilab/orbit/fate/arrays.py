"""The fate of a state: bounded, spin-up, on the separatrix, at rest, or undecided; and its margin in energy.

Decided by energy, never by running. On a circle (elliptic reduction) a motion is bounded iff a barrier at least as
high as its energy stands ahead, in the direction of the torque, within one turn: one turn later the tilted potential
has fallen. On a hyperbola or parabola the potential grows on both sides, so all motions are bounded but those on one
of the invariant planes Q = 0. Inputs are taken as exact; what doubles cannot decide is decided in many digits.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from ...numbers.constants import EPS, TURN
from ...physics.states import equilibrium_mask
from ..ball_orbit import Orbit
from ..far_states import far_exponent, far_fate, far_rows
from ..fine.margins import MARGIN_SHARE, valley_margins
from ..landscape import ROUNDINGS, Landscape, in_doubles, landscape
from ..potential import derivatives_on_parabola
from ..reduction import reduce
from ..result import Fate
from .balls import decide
from .by_table import label_by_table
from .free_arrays import label_free
from .free_margin import is_free
from .reasons import Reason, margin_at_rest
from .result import FateResult, empty_columns, in_chunks, write_row
from .table import barrier_table
from .table_numba import compiled_loops

TABLE_FROM = 5000  # a table costs some ten milliseconds to build, as much as the general formula needs for these


def fates(scene, states, fast=None) -> FateResult:
    """Fates and margins of states (n, 3) of a scene with an orbit, or of a free body: `answers.fate` for one shape.

    From `TABLE_FROM` states on the barriers come from the scene's table (`fast`: whether compiled), and what it leaves open
    from the general formula. States whose squares may leave the range of doubles are decided one at a time, each in its own unit.
    """
    reduction = reduce(scene)
    far = rows_beyond_doubles(scene, states) if reduction is not None else np.zeros(len(states), bool)
    if not far.any():
        return _ordinary(scene, states, fast)
    out, precise = empty_columns(len(states)), int(far.sum())
    if not far.all():
        near = in_chunks(labeller(scene), states[~far])
        precise += near.precise
        for name, column in out.items():
            column[~far] = getattr(near, name)
    for index in np.nonzero(far)[0]:
        state = states[index].tolist()
        write_row(out, index, *far_fate(scene, Orbit(reduction, state), far_exponent(scene, state) or 0))
    return FateResult(**out, precise=precise)  # type: ignore[arg-type]  # the columns alone


def rows_beyond_doubles(scene, states):
    """Return (n,) booleans that mark which of the states (n, 3) have to be answered one at a time.

    Those are states whose squares may leave the range of doubles; where the numbers of the scene's landscape may leave it, all states are. The
    scene has a reduction.
    """
    far = far_rows(scene, states)
    return far if far.all() or in_doubles(scene) else np.ones(len(states), bool)


def _ordinary(scene, states, fast) -> FateResult:
    label, table = labeller(scene), barrier_table(scene) if len(states) >= TABLE_FROM else None
    if table is None:
        return in_chunks(label, states)
    out = empty_columns(len(states))
    rest = label_by_table(table, states, out, compiled_loops(len(states), fast))
    open_ones = in_chunks(label, states[rest])
    for name, column in out.items():
        column[rest] = getattr(open_ones, name)
    return FateResult(**out, precise=open_ones.precise)  # type: ignore[arg-type]  # the columns alone


def labeller(scene):
    """Return the function that labels a chunk of states (n, 3). It fills the columns of `out` and returns how many states needed many digits."""
    if is_free(scene):
        return _at_rest_too(scene, lambda states, out: label_free(scene, states, out))
    land = landscape(scene)
    return _at_rest_too(scene, lambda states, out: _by_geometry(land).label(land, states, out))


def _at_rest_too(scene, label):
    """Return a labeller that does what `label` does and then marks the states at rest."""
    def whole(states, out):
        precise = label(states, out)
        at_rest(scene, states, out)
        return precise
    return whole


def at_rest(scene, states, out):
    """Mark the states at which every rate of change vanishes exactly. Their margins are those of `margin_at_rest`."""
    found = equilibrium_mask(scene, states)
    if found.any():
        out["labels"][found], out["reasons"][found] = Fate.EQUILIBRIUM, Reason.AT_REST
        out["axis"][found] = out["sense"][found] = 0
        out["margins"][found] = [margin_at_rest(scene, margin) for margin in out["margins"][found]]


def fate_on_orbit(scene, land, states) -> FateResult:
    """Return the fates of `fates`, with margins against the barriers of the reduction's own orbit.

    The two margins differ only without a torque: there `fates` compares motions of equal momentum, while the reduction keeps another invariant.
    The margin is 0 on an invariant plane, where no barrier stands.
    """
    found = fates(scene, states)
    if land.sense or not len(states):
        return found
    margins = _by_geometry(land).margins(land, states, *land.start(states))[0]
    return replace(found, margins=margins * land.reduction.energy_unit)


def _settled_circle(land, states, place, w, size):
    """Return the margins (n,) in canonical units, their signs (n,), and how many of the signs took many digits to decide."""
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
                     + (pull + np.abs(pot.G * spot[0] + pot.c)) * (rounding + np.abs(spot[0]) + np.abs(spot[1])))
            there = ~np.isnan(offset)
            # next to a fold the force hardly changes with the angle, so that its rounding moves the barrier far along the circle
            angle_error = 32 * EPS * (1 + rounding / radius) * (1 + pot.terms(tuple(spot)) / np.abs(pot.slope(tuple(spot))))
            # at a barrier rounding decides whether it stands ahead or behind, and then the next one counts
            doubtful |= there & ((np.abs(margin) <= ROUNDINGS * EPS * scale) | (np.minimum(offset, TURN - offset) <= angle_error))
            best = np.where(there & (margin > best), margin, best)
            vague = there & ~(unsure <= MARGIN_SHARE * (np.abs(height) + energy))
            blurred = np.where(vague & ~(margin + unsure <= blurred), margin + unsure, blurred)
        for edge in land.conic.fold_invariants + land.conic.tangents:
            doubtful |= np.abs(radius**2 - edge) <= ROUNDINGS * EPS * (rounding**2 + edge)
    doubtful |= ~(blurred < best) & ~np.isneginf(blurred)  # a barrier of less digits than promised may be the highest
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
    """Return the margins to the barrier that is nearest in height, +inf where the orbit has none. Motions on either side of it are bounded."""
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
            doubtful |= barrier[:, column] & (~(pot.slope(spot) > 0) | _tilted(pot, spot, offset, -rise - energy, energy))
        doubtful |= land.beside_fold(place) | land.beside_centre(place)
    signs = np.sign(margins)
    rows = np.nonzero(doubtful)[0]
    if rows.size:
        found, sure = valley_margins(land, states[rows], (offsets[rows], spots[:, rows], barrier[rows]))
        margins[rows[sure]], signs[rows[sure]], doubtful[rows[sure]] = found[sure], np.sign(found[sure]), False
    for index in np.nonzero(doubtful)[0]:
        tie = decide(Orbit(land.reduction, states[index]))
        signs[index], margins[index] = (tie.sign, tie.margin) if np.isfinite(tie.margin) else (1, np.inf)
    return margins, signs, int(doubtful.sum())


def _tilted(pot, spot, offset, margin, energy):
    """(n,) True where the force that rounding leaves at an equilibrium costs a margin its twelve digits over the way to it."""
    return 2 * EPS * pot.terms(tuple(spot)) * np.abs(offset) > MARGIN_SHARE * (np.abs(margin + energy) + energy)


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
    """(n,) True where the force does not change along the parabola at all (exactly): nothing holds the spin back."""
    small = land.nearly_flat(states, place)
    for index in np.nonzero(small)[0]:
        small[index] = _is_flat(land.reduction, states[index])
    return small


def _is_flat(r, state) -> bool:
    return not any(derivatives_on_parabola(r, *(Fraction(float(state[a])) for a in (r.j, r.k))))


class _Ways(NamedTuple):
    """What a geometry has to say here: how a chunk of states is labelled, and what the margins of its orbits are."""

    label: Callable
    margins: Callable


_WAYS = {-1: _Ways(_label_circle, _settled_circle), 1: _Ways(_label_hyperbola, _plane_margins), 0: _Ways(_label_parabola, _valley_margins)}


def _by_geometry(land) -> _Ways:
    return _WAYS[land.e]
