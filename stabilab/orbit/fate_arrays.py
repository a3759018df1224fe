"""The fates of many states, NumPy: bounded, spin-up, on the separatrix or at rest, with margins in energy.

Decided by energy, never by running. On a circle (elliptic reduction) a motion is bounded iff a barrier at
least as high as its energy stands ahead, in the direction of the torque, within one turn: one turn later the
tilted potential has fallen. On a hyperbola or parabola the potential grows on both sides, so all motions are
bounded but those on one of the invariant planes Q = 0. Inputs are taken as exact; what doubles cannot decide
is decided in many digits.

A free body has the margin from the saddle omega* of speed s on its momentum sphere, where the first-order
terms drop out of the difference of kinetic energies, and what is left has neither the large terms of the
gyrostatic moment nor, to first order, the error of s:

    margin = sum D_i (D_i - s)/(2 s) (omega_i - omega*_i)^2,     omega*_i = lambda_i/(s - D_i).

About a middle axis without a gyrostatic moment s = D_i, and that component drops out. Other saddles lie
between the least and the greatest moment, on a branch on either side of the middle one, along which |H| runs
one way; s is measured from the middle moment, so that its distance from the pole there keeps its digits."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..numbers.double_double import EPS
from ..numbers.numba_door import Kernel
from ..numbers.polynomial import bracketed_newton
from ..physics.coefficients import limits_of
from ..physics.own_unit import far_exponent
from ..physics.scene import AnyScene, Scene
from ..physics.states import equilibrium_mask
from ..representation import Compared, Shown
from . import equilibria_kernel
from .arc_kernel import BASE, ENTRIES, INLINED
from .barriers_arrays import margins_of
from .fate import REASONS, Basis, decide, fate_of, free_middle, is_free, margin_at_rest
from .landscape import Landscape, in_doubles, landscape
from .one_orbit import Orbit
from .one_state import LOST, far_fate, far_rows
from .potential import derivatives_on_parabola
from .reduction import Reduction, reduce
from .result import Fate, spins_about
from .separatrix.distance import separatrix_distance

# --- The answer
MARGIN = 4.3e-4  # s of a processor: the margin of a row in plain Python
CHUNK = 16384  # states at a time: some thirty arrays of so many doubles stay in the processor's caches


@dataclass(frozen=True, repr=False, eq=False)
class FateResult(Shown, Compared):
    """Labels and margins of states (..., 3).

    labels: (...,) int8 of `Fate`. margins: (...,) barrier minus energy in the scene's energy (J; or x_i^2/2 +
    U when scaled): positive below the barrier; -inf where there is no barrier ahead, +inf where no separatrix
    bounds the motion, NaN where nothing is known of any (undecided, and no law keeps the motion from being
    bounded); at an equilibrium on the separatrix 0, and NaN where it is no double (`because` says so).
    Without a torque all motions are bounded, and the barrier is the kinetic energy of a permanent rotation of
    the same momentum that is a saddle, of two the nearer in energy: 0 on a separatrix, > 0 with less energy
    than that (a body turning about its major axis), < 0 with more, whatever the axes are called
    (`free_gyrostat`; in scaled variables, which know no momentum, the reduction about axis 3 has the
    barrier). axis: 1, 2, 3 of a spin-up, else 0; sense: its sign, else 0. reasons: (...,) `Basis` codes.
    precise: how many states had to be decided in many digits. Iterating gives labels, margins.
    """

    labels: np.ndarray
    margins: np.ndarray
    axis: np.ndarray
    sense: np.ndarray
    reasons: np.ndarray
    precise: int = 0
    # of motions that were followed: `row(n)` has all that is known of state n, or None
    followed: Any = field(default=None, repr=False, compare=False)
    scene: AnyScene | None = field(default=None, repr=False, compare=False)
    states: np.ndarray = field(default=None, repr=False, compare=False)
    # the scene asked for, of which `scene` is the twin
    given: AnyScene | None = field(default=None, repr=False, compare=False)

    def __iter__(self):
        return iter((self.labels, self.margins))

    @property
    def outcome(self):
        """The labels in words, "bounded" or "spin-up": a string for one state, an object array otherwise."""
        return np.array([fate.word for fate in Fate], dtype=object)[self.labels]

    @property
    def because(self):
        """The reason in words: a string for one state, an object array otherwise."""
        text = np.array([_told(*item)
                          for item in zip(*map(np.ravel, (self.reasons, self.labels, self.margins, self.axis,
                                                         self.sense)))], dtype=object)
        if self.followed is not None:
            text = np.array([word + _cause(self.followed.row(n)) for n, word in enumerate(text)],
                             dtype=object)
        return text[0] if self.reasons.ndim == 0 else text.reshape(self.reasons.shape)

    @cached_property
    def velocity_margins(self) -> np.ndarray:
        """(...,) smallest change of the state that reaches the separatrix, in the state's unit; inf without
        one, 0 on it; NaN, not known, where the label is undecided, for free gyrostats whose moment has no
        zero component, and for torques off the axes."""
        resolved = np.where(self.labels == Fate.SEPARATRIX, 0.0, separatrix_distance(self.scene, self.states))
        return np.where(self.labels == Fate.UNDECIDED, np.nan, resolved)[()]

    @property
    def levels(self):
        """How well each label is known: "exact" (by a law or a closed solution), "certified" (an inequality
        met by a run of machine precision), "proved" (where `fate` was asked for it: the way to the inequality
        enclosed) or "undecided": a string for one state, an object array otherwise."""
        phrases = ("undecided", "certified", "exact", "proved")
        return np.array(phrases, dtype=object)[self.level_numbers(phrases)]

    def level_numbers(self, words: Sequence[str]) -> np.ndarray:
        """The same as the places of these words in a row of them."""
        undecided, certified, exact, proved = map(words.index, ("undecided", "certified", "exact", "proved"))
        result = np.where(self.labels == Fate.UNDECIDED, np.int8(undecided),
                         np.where(self.reasons == Basis.CERTIFIED, np.int8(certified), np.int8(exact)))
        if self.followed is not None:
            result[self.followed.proved.reshape(result.shape)] = proved
        return result

    @cached_property
    def validity(self):
        """Of an approximate law (`stabilab.physics.law_limits`), value and holds (...,): without bound in a
        spin-up, else at the start; None where all laws are exact."""
        limits = limits_of(self.given)
        if limits is None:
            return None
        rows = np.where((self.labels == Fate.SPIN_UP)[..., None], np.inf, self.states)
        return limits.validity(self.given, rows, "along a spin-up, or at the start")


def _cause(row) -> str:
    return "" if row is None else f"; {row.cause}"


def _told(reason: int, label: int, margin: float, axis: int, sense: int) -> str:
    resolved = (margin == margin or reason in (Basis.OFF_AXIS, Basis.TURN_ROUNDS, Basis.CERTIFIED,
                                            Basis.CLOSED_FORM) or label == Fate.EQUILIBRIUM)
    about = None if reason == Basis.CERTIFIED else spins_about(label, int(axis), int(sense))
    return str(REASONS[Basis(reason)].then(about)
               .then(None if resolved else LOST(what="the margin in energy")))


def empty_columns(n: int) -> dict[str, np.ndarray]:
    """Columns of a FateResult for n states, to be filled."""
    return {"labels": np.empty(n, np.int8), "margins": np.empty(n), "axis": np.zeros(n, np.int8),
            "sense": np.zeros(n, np.int8), "reasons": np.empty(n, np.int8)}


def chunks(count: int) -> list[slice]:
    """Slices of so many states, `CHUNK` at a time."""
    return [slice(start, start + CHUNK) for start in range(0, count, CHUNK)]


def in_chunks(label: Callable[[np.ndarray, dict[str, np.ndarray]], int], states: np.ndarray) -> FateResult:
    """The fates of states (n, 3) by a labeller: it fills the columns of a chunk and returns how many needed
    many digits."""
    out, precise = empty_columns(len(states)), 0
    for part in chunks(len(states)):
        precise += label(states[part], {name: column[part] for name, column in out.items()})
    return FateResult(**out, precise=precise)  # type: ignore[arg-type]  # the columns alone


def write_row(out: Mapping[str, np.ndarray], index: int | np.integer | np.ndarray, label: Fate, reason: Basis,
              margin: float, axis: int = 0, sense: int = 0) -> None:
    """Put a fate into the columns, of one state or of all those of an array of indices."""
    spin = label == Fate.SPIN_UP
    out["labels"][index], out["reasons"][index], out["margins"][index] = label, reason, margin
    out["axis"][index], out["sense"][index] = axis * spin, sense * spin


# --- Free bodies: the margin from the saddle on the momentum sphere
SURE = 16  # times the estimate of rounding: so far from zero a margin's sign is certain
# times that estimate a margin exceeds it, or many digits are asked: so it keeps nine of its own, near a
# saddle too
OWN = 1e9
# of both kinetic energies: the estimate counts single roundings, of which a margin may have four times as
# many
FREE_MARGIN_SHARE = 5e-13 / 4
LEAST = 1e-290  # smaller terms may have lost digits to underflow
HEAP = 1 << 23  # bytes, more than all temporary arrays of a chunk; fresh pages for them cost half of the time


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
def saddles_of(scene: Scene) -> Saddles:
    """The saddles of a torque-free scene (cached)."""
    D, lam, middle = scene.body.exact, scene.vector("gyrostat"), sorted(scene.body.exact)[1]
    largest = float(max(map(abs, lam)))
    unit = 2.0 ** min(int(np.frexp(largest)[1]), 1023) if largest else 1.0
    floats = lambda values: np.array([float(v) for v in values])
    result = Saddles(floats(D), floats(lam) / unit, unit, float(middle), floats(middle - d for d in D), (),
                    np.inf)
    with np.errstate(all="ignore"):
        if free_middle(D, lam):
            result = result._replace(least=float(_momentum(result, np.zeros(1))[0]))
        return result._replace(branches=tuple(filter(None, (_branch(result, side) for side in (-1, 1)))))


def _parts(saddles: Saddles, t: np.ndarray):
    """(s - D_i, omega*_i), each (3, n), for s = middle + t."""
    gap = t + saddles.gaps[:, None]
    return gap, np.where(saddles.lam[:, None] == 0, 0.0, saddles.lam[:, None] / gap)


def _momentum(saddles: Saddles, t: np.ndarray):
    """|H| (n,) of the permanent rotations of speed middle + t."""
    return (saddles.middle + t) * np.sqrt((_parts(saddles, t)[1] ** 2).sum(axis=0))


def _fall(saddles: Saddles, t: np.ndarray):
    """sum lambda_i^2 D_i/(s - D_i)^3: (|H|^2)' over -2 s, falling in s between two poles."""
    gap, omega = _parts(saddles, t)
    return np.where(saddles.lam[:, None] == 0, 0.0, saddles.D[:, None] * omega * omega / gap).sum(axis=0)


def _branch(saddles: Saddles, side: int) -> Branch | None:
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


def _fold(rising: Callable[[float], bool], reach: float) -> float:
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


def free_margins(scene: AnyScene, states: np.ndarray):
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
        resolved = (np.isinf(best) | (np.abs(best) > OWN * rounding)
                 & (rounding <= FREE_MARGIN_SHARE * (energy + np.abs(best + energy))))
        margins = best * saddles.unit * saddles.unit
        # in J, a margin that is no double
        lost = np.isfinite(best) & (best != 0) & ~(np.isfinite(margins) & (margins != 0))
        return margins, doubtful | ~resolved | lost


def _candidates(saddles: Saddles, omega: np.ndarray, size: np.ndarray, blur: np.ndarray):
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


def _solved(saddles: Saddles, branch: Branch, size: np.ndarray):
    """r (n,) on a branch where |H| is `size`: Newton's method in 1/|H|, which is nearly linear in r next to
    the pole."""
    pole = float(np.hypot.reduce(saddles.lam[saddles.gaps == 0])) if np.isinf(branch.high) else 0.0
    smallest = (saddles.middle - branch.end if branch.side < 0 else saddles.middle) * pole / size

    def fun(r: np.ndarray, size: np.ndarray):
        t = branch.side * r
        here = _momentum(saddles, t)
        return 1 / here - 1 / size, branch.side * (saddles.middle + t) * _fall(saddles, t) / here**3
    low = np.minimum(0.99 * smallest, branch.end)
    start = (np.minimum(saddles.middle * pole / size, 0.5 * branch.end) if pole
             else np.full(size.shape, 0.5 * branch.end))
    return bracketed_newton(fun, low, np.full(size.shape, branch.end), np.maximum(start, low), (size,))


def _margin(saddles: Saddles, omega: np.ndarray, t: np.ndarray, residue: np.ndarray):
    """(margin, rounding), (n,) each, over the square of the unit; residue: error of |H|^2/2, and so of s."""
    gap, star = _parts(saddles, t)
    s = saddles.middle + t
    fraction, route = saddles.D[:, None] * np.abs(gap) / (2 * s), omega - star
    loss = np.where(gap == 0, 0.0, (np.abs(t) + np.abs(saddles.gaps[:, None])) / np.abs(gap))
    rounding = (EPS * (fraction * np.abs(route) * ((2 + loss) * np.abs(route) + 2 * np.abs(omega)
                                              + (2 + 2 * loss) * np.abs(star))).sum(axis=0))
    bend = np.where(residue == 0, 0.0, residue**2 / (s**3 * np.abs(_fall(saddles, t))))
    return -(np.sign(gap) * fraction * route * route).sum(axis=0), rounding + bend + LEAST


# --- Fates of many states
def fates(scene: AnyScene, states: np.ndarray, fast: bool | None = None) -> FateResult:
    """Fates and margins of states (n, 3) of a scene with an orbit, or of a free body: `answers.fate` for one
    shape; `fast` is not needed.

    States whose squares may leave the range of doubles are decided one at a time, each in its own unit.
    """
    reduction, out = reduce(scene), empty_columns(len(states))
    far = rows_beyond_doubles(scene, states) if reduction is not None else np.zeros(len(states), bool)
    nearby = np.nonzero(~far)[0] if far.any() else slice(None)
    columns = _rows_of(out, nearby)
    precise = int(far.sum()) + _label(scene, states[nearby], columns)
    for name, column in columns.items():
        out[name][nearby] = column
    for index in np.nonzero(far)[0]:
        state = states[index].tolist()
        write_row(out, index, *far_fate(scene, Orbit(reduction, state), far_exponent(scene, state) or 0))
    return FateResult(**out, precise=precise)  # type: ignore[arg-type]  # the columns alone


def rows_beyond_doubles(scene: AnyScene, states: np.ndarray):
    """Return (n,) booleans that mark which of the states (n, 3) have to be answered one at a time.

    Those are states whose squares may leave the range of doubles; where the numbers of the scene's landscape
    may leave it, all states are. The scene has a reduction.
    """
    far = far_rows(scene, states)
    return far if far.all() or in_doubles(scene) else np.ones(len(states), bool)


def _label(scene: AnyScene, states: np.ndarray, out: Mapping[str, np.ndarray]) -> int:
    """Fill the columns for states (n, 3); returns how many took many digits."""
    if not len(states):  # of a scene whose constants are no doubles, all states are far
        return 0
    land, doubtful = None if is_free(scene) else landscape(scene), np.zeros(len(states), bool)
    # freed at once: glibc then keeps that much free memory instead of returning it after every array
    np.empty(HEAP, np.int8)
    for part in chunks(len(states)):
        doubtful[part] = _label_chunk(scene, land, states[part], _rows_of(out, part))
    rows = np.nonzero(doubtful)[0]
    if land is not None and rows.size:
        some = _rows_of(out, rows)  # copies
        left = _settled(land, states[rows], some["margins"])
        _mark_spins(land, some)
        for name, column in some.items():
            out[name][rows] = column
        rows = rows[left]
    for index in rows:
        write_row(out, index, *fate_of(scene, Orbit(reduce(scene), states[index].tolist())))
    for part in chunks(len(states)):
        at_rest(scene, states[part], _rows_of(out, part))
    return len(rows)


def _rows_of(columns: Mapping[str, np.ndarray], rows: np.ndarray | slice):
    return {name: column[rows] for name, column in columns.items()}


def _label_chunk(scene: AnyScene, land: Landscape | None, states: np.ndarray, out: Mapping[str, np.ndarray]):
    """Fill the columns for states (n, 3), each clear of a separatrix, and return which are not clear, (n,);
    land: None of a free body."""
    out["axis"][:], out["sense"][:], out["labels"][:] = 0, 0, Fate.BOUNDED
    if land is None:
        out["reasons"][:] = Basis.TORQUE_FREE
        out["margins"][:], doubtful = free_margins(scene, states)
        return doubtful
    margins, doubtful = _margins(land, states)
    np.multiply(margins, land.reduction.energy_unit, out=out["margins"])
    out["reasons"][:] = Basis.WALLS if land.potential.walled else Basis.TORQUE_FREE
    _mark_spins(land, out)
    flat = np.nonzero(flat_mask(land, states))[0]
    if flat.size:
        write_row(out, flat, Fate.SPIN_UP, Basis.PURE_SPIN, -np.inf, land.reduction.axis + 1, land.sense)
        doubtful[flat] = False
    return doubtful


def _mark_spins(land: Landscape, out: Mapping[str, np.ndarray]):
    """Label motions on circles under a torque by their margins; elsewhere walls bound them."""
    if land.sense and not land.potential.walled:
        spins = (out["margins"] <= 0).view(np.int8)
        out["labels"][:] = spins  # `Fate.BOUNDED` or `SPIN_UP`
        # `Basis.BELOW_BARRIER`, `ABOVE_BARRIER` or `NO_BARRIER`
        out["reasons"][:] = spins + np.isneginf(out["margins"])
        out["axis"][:] = spins * np.int8(land.reduction.axis + 1)
        out["sense"][:] = spins * np.int8(land.sense)


def _margins(land, states):
    """(margins (n,) in canonical units, which of them are doubtful (n,)); on an invariant plane NaN."""
    walled, rows = land.potential.walled, np.arange(len(states))
    if land.may_have_barriers():
        margins, doubtful = margins_of(land.reduction, land.orbits, states)
        margins *= float(land.reduction.weight) / land.reduction.energy_unit
        rows = np.nonzero(doubtful)[0]
        margins[rows], states = 0.0, states[rows]
    else:
        margins, doubtful = np.full(len(states), np.inf if walled else -np.inf), np.zeros(len(states), bool)
    if walled and land.conic is not None:
        location = land.start(states)[0]
        on_plane = rows[(location[0] == 0) | (location[1] == 0)]
        margins[on_plane], doubtful[on_plane] = np.nan, True
    return margins, doubtful


def _settled(land: Landscape, states: np.ndarray, margins: np.ndarray, unit: float = 1.0):
    """Settle the margins (n,) of doubtful states (n, 3), in the scene's energy over this unit, where twofold
    numbers are enough; which are left, (n,)."""
    rows = np.nonzero(~np.isnan(margins))[0]  # not on a plane
    results, settled = np.empty(len(states)), np.zeros(len(states), bool)
    function = MARGINS.functions(MARGINS.pays(MARGIN * rows.size))["margins"]
    with np.errstate(all="ignore"):
        function(states, rows, *land.kernel_input, results, settled)
    margins[settled] = results[settled] * (float(land.reduction.weight) / unit)
    return ~settled


MARGINS = Kernel(equilibria_kernel, "margins", 0.9, INLINED, options=ENTRIES, below=BASE)


def at_rest(scene: AnyScene, states: np.ndarray, out: Mapping[str, np.ndarray]):
    """Mark the states at which every rate of change vanishes exactly. Their margins are those of
    `margin_at_rest`."""
    result = equilibrium_mask(scene, states)
    if result.any():
        out["labels"][result], out["reasons"][result] = Fate.EQUILIBRIUM, Basis.AT_REST
        out["axis"][result] = out["sense"][result] = 0
        out["margins"][result] = [margin_at_rest(scene, margin) for margin in out["margins"][result]]


def fate_on_orbit(scene: AnyScene, land: Landscape, states: np.ndarray) -> FateResult:
    """Return the fates of `fates`, with margins against the barriers of the reduction's own orbit.

    The two margins differ only without a torque: there `fates` compares motions of equal momentum, while the
    reduction keeps another invariant. The margin is 0 on an invariant plane, where no barrier stands.
    """
    result = fates(scene, states)
    if land.sense or not len(states):
        return result
    margins, doubtful = _margins(land, states)
    rows = np.nonzero(doubtful)[0]
    some = margins[rows]
    left = _settled(land, states[rows], some, land.reduction.energy_unit)
    margins[rows] = some
    for index in rows[left]:
        if np.isnan(margins[index]):
            margins[index] = 0.0
        else:
            height = decide(Orbit(land.reduction, states[index])).margin
            margins[index] = abs(height) if land.potential.walled and np.isinf(height) else height
    return replace(result, margins=margins * land.reduction.energy_unit)


def flat_mask(land: Landscape, states: np.ndarray):
    """(n,) True where the force does not change along the parabola at all (exactly): nothing holds the spin
    back."""
    if land.conic is None and not land.reduction.kappa:  # a sphere: on all parabolas alike
        flat = land.sense != 0 and len(states) > 0 and _is_flat(land.reduction, states[0])
        return np.full(len(states), flat)
    small = land.nearly_flat(states)
    for index in np.nonzero(small)[0]:
        small[index] = _is_flat(land.reduction, states[index])
    return small


def _is_flat(r: Reduction, state: np.ndarray) -> bool:
    return not any(derivatives_on_parabola(r, *(Fraction(float(state[a])) for a in (r.j, r.k))))
