"""A certificate of spin-up: an inequality between numbers of one state that, once true, stays true for
ever.

Theorem (proof: docs/mathematics/spin-up.md). Let x be the spin of a form, D1 x' = V(x) + what oscillates,
zeta its amplitude, Om(x) > 0 increasing (the rate of the phase up to a constant), V >= drive from z on, and
let, by elimination, for all x >= z and |zeta| <= A

    Y  = D1 int Om dx + (added),             Y' = Om V + (left),       |added| <= e,  |left|/Om <= k,
    B  = w(x) |zeta|^2 + (added),            |added| <= b,             int |B'| dx <= r,    w >= w_ > 0.

(e, k, b: sums of |c| A^(j+k) times the greatest value of the factor of x from z on; r the same with the
factor's integral.) If at one time

    x > z, |zeta| < A;    D1 int_z^x Om + added > e;    eta = drive - k > 0;    F = [B + b + r D1/eta]/w_ <
    A^2,

then at all later times |zeta| < A and x >= z + eta t/D1, x <= z+ + eta+ t/D1 with D1 int_x^(z+) Om = added +
e, eta+ = greatest V + k.

For the fixed centre Om = x, V = M1 + m*/x, and orders (0, 2) without the weight w = 1 + m*/(M1 x) are the
classical E + Im/X and B + R/(om X) + Psi/(D1 om^2 X^3), with k formed from the sums as they come out. Then
also D1 y' >= M1 + (m* - z k)/y and D1 y+' <= M1 + (m* + z k)/y+, for k x falls: the sharper clock (`clock`).
Since Om is concave, int_z^x Om >= (x - z)(Om(x) + Om(z))/2, which is what is tested (equal for the fixed
centre), and int_x^(z+) Om >= (z+ - x) Om(x) gives z+.

Rounding. The place of a state is known within its blur (rounding and, asked for, a ball of states about it):
x and |zeta| are taken at their worse ends and each term at the start within the change that the blur can make
of it. Coefficients hold their rounding (`centres`), sums of positive numbers are off by less than 2^-40
of themselves, and every comparison leaves SLACK = 2^-30 of the sum of the sizes in it.

A and z are searched from the smallest that could do, by `kernel`: compiled, or as it is written.

Bodies with equal moments: what is exact, and the second fate, spin-up in the equatorial plane. Axis 1 the
axis of symmetry, D2 = D3 = D, d = D1 - D, no transverse wheel (l2 = l3 = 0): D1 omega1' = M1 exactly, and
with X = omega1 + l1/d, xi = omega2 + i omega3, mu = (M2 + i M3)/D the other two are xi' = i (d/D) X xi +
mu.

* M1 != 0: every state spins up about the axis, in the direction of M1; nothing is integrated, and
  |xi(t)| <= |xi(0)| + 8 |mu|/sqrt(|d| |M1|/(D D1)).
* M1 = 0: X is constant. X != 0: xi goes round a circle about i mu D/(d X): bounded. X = 0: xi = xi(0) + mu t,
  it grows along the transverse torque (or stands still without one).

Sphere, D omega' = M - omega x l: without a wheel omega grows along M; with one spin-up along sgn(M.l) l,
bounded where M.l = 0.

A transverse wheel l_perp (and D2 = D3): besides axis 1 the motion may spin up in the equator, along e =
-sgn(D1 - D2) l_perp/|l_perp|, where (M_perp.l_perp)(D1 - D2) < 0. In the frame (e, a1 x e, a1) the form about
the moving centre has d2 = 0, q = |l_perp|, p = a3 x + |l_perp|, both positive for great x = omega.e exactly
with that sign of e, and M.e > 0. Its certificate is the theorem. Proofs:
docs/mathematics/spin-up.md."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ...numbers.exact import sqrt_fraction
from ...numbers.numba_door import Kernel
from ...numbers.vectors import dot
from ...orbit.result import Fate
from ...reasons import Reasoned, Sentence
from . import kernel, steps
from .centres import FixedCentre, MovingCentre, moving_centre
from .elimination import ELIMINATE
from .form import forms_of
from .result import WIDER, SpinUp, SteadyTrap

if TYPE_CHECKING:
    from ...physics.scene import AnyScene


# --- The kernels, compiled or as written
# of tests, of steps
BARE: dict[str, object] = {"allocating": False,
                           "entries": {"advance", "run", "measure", "decide"}}
DECIDE = Kernel(kernel, "decide", 3.9, options=BARE)
ADVANCE = Kernel(steps, "run", 6.5, inlined={"power_of_two", "logarithm", "two_to", "ended"},
                 variant=f"{steps.SIDE_BY_SIDE}_", options=BARE | {"LANES": steps.SIDE_BY_SIDE})


# s of a processor: making a test by NumPy, about a fixed and about a moving centre
TABLES = 3e-3, 1e-2


# --- Equal moments
def axis_of_symmetry(D: Sequence[Fraction]) -> int | None:
    """The index of the axis whose two others have equal moments; None for three different moments and for a
    sphere."""
    rows = [i for i in range(3) if D[(i + 1) % 3] == D[(i + 2) % 3]]
    return rows[0] if len(rows) == 1 else None


NO_TORQUE = Sentence("closed-no-torque", "without a torque the energy is constant and the motion bounded")()
SPHERE_ALONE = Sentence("closed-sphere", "a sphere without a wheel: the rate grows along the torque")()
SPHERE_WHEEL_ACROSS = Sentence(
    "closed-sphere-wheel-across", "a sphere with a wheel across the torque: the rate goes round the wheel's "
    "momentum")()
SPHERE_WHEEL = Sentence(
    "closed-sphere-wheel", "a sphere with a wheel: the rate grows along the wheel's momentum, by the "
    "torque's component there")()
SYMMETRIC_LINEAR = Sentence(
    "closed-symmetric-linear", "the axis of symmetry bears a torque and there is no transverse wheel: the "
    "spin about it is linear in time")()
SYMMETRIC_TURNS = Sentence(
    "closed-symmetric-turns", "the spin about the axis of symmetry is constant and turns the transverse "
    "torque round")()
SYMMETRIC_GROWS = Sentence(
    "closed-symmetric-grows", "the spin about the axis of symmetry is the one at which the transverse rate "
    "keeps its direction: it grows along the transverse torque")()


@dataclass(frozen=True)
class Closed(Reasoned):
    """A closed solution, in exact numbers (roots to 240 bits). law: its name; direction: of the growth, any
    length, None where the motion is bounded; gain: the rate grows at least so fast along it; most: what is
    across it, or the whole rate of a bounded motion, is never larger; reason: why it is closed."""

    law: str
    direction: Sequence[Fraction] | None
    gain: Fraction | None
    most: Fraction

    @property
    def about(self) -> tuple[int, int]:
        """(axis 1, 2, 3, sense) of the growth; (0, 1) where it is along none, (0, 0) where bounded."""
        along = [n for n, v in enumerate(self.direction or ()) if v]
        if len(along) != 1:
            return 0, int(bool(along))
        return along[0] + 1, 1 if self.direction[along[0]] > 0 else -1


def closed(scene: AnyScene, state: Sequence[float | Fraction]) -> Closed | None:
    """The closed solution from a state, three exact numbers; None where the scene has none."""
    if scene.variables == "scaled":
        return None
    D, l, M = scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")
    x = [Fraction(v) for v in state]
    if not any(M):
        return Closed("free", None, None, sqrt_fraction(dot(D, [v * v for v in x]) / min(D)),
                      reason=NO_TORQUE)
    if D[0] == D[1] == D[2]:
        return _sphere(D[0], l, M, x)
    i = axis_of_symmetry(D)
    return None if i is None or l[(i + 1) % 3] or l[(i + 2) % 3] else _symmetric(i, D, l, M, x)


def _sphere(D, l, M, x):
    if not any(l):
        return Closed("sphere", M, _size(M) / D, _across(x, M),
                      reason=SPHERE_ALONE)
    along, across = dot(l, M), _across(x, l) + 2 * _across(M, l) / _size(l)
    if not along:
        return Closed("sphere", None, None, across + abs(dot(x, l)) / _size(l),
                      reason=SPHERE_WHEEL_ACROSS)
    return Closed("sphere", [v if along > 0 else -v for v in l], abs(along) / _size(l) / D, across,
                  reason=SPHERE_WHEEL)


def _symmetric(i: int, D: Sequence[Fraction], l: Sequence[Fraction], M: Sequence[Fraction],
               x: Sequence[Fraction]):
    """`Closed` of a body whose axis of symmetry is i, without a transverse wheel."""
    j, law, flat = (i + 1) % 3, "axis of symmetry", [v * (n != i) for n, v in enumerate(M)]
    push, cone = _size(flat) / D[j], _size([v * (n != i) for n, v in enumerate(x)])
    if M[i]:
        turning = abs(D[i] - D[j]) * abs(M[i]) / (D[i] * D[j])  # of the turn's own rate
        return Closed(law, [Fraction((n == i) * (1 if M[i] > 0 else -1)) for n in range(3)],
                      abs(M[i]) / D[i], cone + 8 * push / sqrt_fraction(turning),
                      reason=SYMMETRIC_LINEAR)
    turn = ((D[i] - D[j]) * x[i] + l[i]) / D[j]
    if turn:
        return Closed(law, None, None, cone + 2 * push / abs(turn) + abs(x[i]),
                      reason=SYMMETRIC_TURNS)
    return Closed(law, flat, push, _across(x, flat),
                  reason=SYMMETRIC_GROWS)


def _size(vector: Sequence[Fraction]):
    return sqrt_fraction(Fraction(dot(vector, vector)))


def _across(vector, along):
    """The size of the part of a vector across another."""
    return sqrt_fraction(Fraction(dot(vector, vector))
                         - Fraction(dot(vector, along)) ** 2 / dot(along, along))


def exactly(scene, state) -> SpinUp | None:
    """The fate of a state where a closed solution tells it; None elsewhere. state: three floats, at their
    word."""
    result = closed(scene, state)
    if result is None:
        return None
    (axis, sense), direction, trap = result.about, None, None
    if result.direction:
        size = _size(result.direction)
        direction = tuple(float(v / size) for v in result.direction)
    if result.law == "axis of symmetry" and axis - 1 == axis_of_symmetry(scene.body.exact):
        largest, start = float(result.most) * (1 + WIDER), float(sense * state[axis - 1])
        bounded = [(-largest, largest)] * 3
        bounded[axis - 1] = (start, math.inf) if sense > 0 else (-math.inf, -start)
        trap = SteadyTrap(axis, sense, start, float(result.gain), tuple(bounded))
    return SpinUp(Fate.SPIN_UP if direction else Fate.BOUNDED, axis, sense, direction, "exact", trap, 0.0,
                  tuple(map(float, state)), 0, 1.0, reason=result.reason)


def equatorial(scene) -> MovingCentre | None:
    """The form for spin-up in the equator of a symmetric body; None where the scene has none."""
    if scene.variables == "scaled":
        return None
    D, l, M = scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")
    i = axis_of_symmetry(D)
    if i is None:
        return None
    j, k = (i + 1) % 3, (i + 2) % 3
    along, d = l[j] * M[j] + l[k] * M[k], D[i] - D[j]
    if not along * d < 0:
        return None
    s = 1 if d < 0 else -1
    L = sqrt_fraction(l[j] ** 2 + l[k] ** 2)
    e = (s * l[j] / L, s * l[k] / L)  # good to 240 bits: less than the rounding that the coefficients hold
    basis = [[0, 0, 0] for _ in range(3)]
    basis[0][j], basis[0][k], basis[1][j], basis[1][k], basis[2][i] = e[0], e[1], -e[1], e[0], 1
    torque = (abs(along) / L, e[0] * M[k] - e[1] * M[j], M[i])
    return MovingCentre((D[j], D[j], D[i]), (s * L, Fraction(0), l[i]), torque,
                        [[float(v) for v in row] for row in basis], s)


# --- The certificate
# Orders of energy and amplitude. About the fixed centre: tested always (what (0, 2) decides they decide as
# well), and sparsely; the series is asymptotic, higher ones gain nothing. About the moving one: last, seldom.
ORDERS, HIGH_ORDERS, HIGHEST_ORDERS = (4, 6), (12, 14), (16, 18)
MOVING_ORDERS, LAST_ORDERS = (4, 6), (8, 10)
EQUATORIAL_ORDERS = ((2, 4), (4, 6))


class Certifier:
    """The inequality of the theorem in one field (`centres`) at one pair of orders, by the functions of the
    kernel over tables that are made once."""

    def __init__(self, field: FixedCentre | MovingCentre, orders: tuple[int, int], fast: bool = False):
        """fast: tables by compiled code."""
        with np.errstate(all="ignore"):  # what overflows is not finite, and certifies nothing
            energy = field.energy.to(orders[0], field.parts, fast)
            amplitude = field.amplitude.to(orders[1], field.parts, fast)
        (a, b), size, parts = field.algebra.turn, field.turn_size, field.parts
        reach = 5 + max(energy.reach, amplitude.reach)
        # of arrays to work in: powers of zeta, pairs of its exponents, columns
        self.powers = max(len(energy.sums), len(amplitude.sums))
        self.terms = max(energy.degrees.shape[1], amplitude.degrees.shape[1])
        self.columns = max(item.shape[1] for tables in (energy, amplitude)
                           for item in (tables.exponents, tables.left_exponents))
        drive = [(m * parts // 4, n * parts // 4) for _, _, m, n in field.G0]
        form = kernel.Form(field.D1, field.M1, field.a2, field.a3, *field.offsets, parts, a * parts // 4,
                           b * parts // 4, size, reach)
        self.numbers = (field.basis, np.array(field.frame, float), np.array(form, float),
                        np.ascontiguousarray(np.array(drive).T), np.array([*field.G0.values()], float),
                        *energy[:5], *amplitude[:5], *amplitude[5:7], *energy[5:7])

    def decide(self, rows: np.ndarray, states: np.ndarray, reach: np.ndarray, fired: np.ndarray, number: int,
               found: np.ndarray, fast: bool = False, work: tuple[np.ndarray, ...] | None = None) -> int:
        """The test for those of rows that no test has fired for, balls of radius reach (n,) about states (n,
        3): fired (n,) becomes number, found (6, n) the constants A, z, eta, z_up, eta_up, k of the
        theorem; returns for how many it does not hold. work: of `work`, new ones where there are none."""
        arguments = rows, states, reach, fired, number, found, *self.numbers, *(work or self.work())
        if fast:  # compiled code warns of nothing
            return DECIDE.functions(True)["decide"](*arguments)
        with np.errstate(all="ignore"):
            return DECIDE.functions(False)["decide"](*arguments)

    def work(self) -> tuple[np.ndarray, ...]:
        """Arrays to work in. No two threads may share them, as they may share the test."""
        row = np.zeros((2, self.columns))
        return (np.ones((4, 2 * kernel.MIDDLE + 1)), np.zeros(self.powers, complex),
                np.zeros((2, self.terms)), row[0], row[1], np.zeros(6))

    def constants(self, state: np.ndarray, near: float = 0.0, fast: bool = False) -> tuple[float, ...] | None:
        """The six constants for all states of the ball of radius `near` about one (3,); None where the
        inequality does not hold."""
        fired, result = np.full(1, -1), np.full((6, 1), np.nan)
        self.decide(np.arange(1), np.array([state], float), np.array([near], float), fired, 0, result, fast)
        return None if fired[0] else tuple(result[:, 0].tolist())


class Tests:
    """The certificates of a scene (in natural units), each made when it is first asked for.

    often: those of low order; high: with high orders about the fixed centre; all: with the highest, and the
    moving centre where a wheel takes it elsewhere; last: with those that take long to make. Each is a prefix
    of the next. asked: those that were.
    """

    def __init__(self, scene: AnyScene):
        self.scene, self.forms, round_ = scene, forms_of(scene), equatorial(scene)
        self.fixed = [FixedCentre(form) for form in self.forms]
        self.equatorial = [round_] if round_ else []
        self.made: dict[tuple, Certifier] = {}
        self.asked: list[tuple] = []
        low = [(field, ORDERS) for field in self.fixed]
        self.often = low + [(field, EQUATORIAL_ORDERS[0]) for field in self.equatorial]
        self.high = self.often + [(field, HIGH_ORDERS) for field in self.fixed]

    @cached_property
    def moving(self):
        result = (moving_centre(form, self.scene) for form in self.forms)
        return [moving for moving in result if moving]

    @cached_property
    def all(self):
        # the centre moves far where there is a wheel
        wheeled = [field for field in self.moving if field.wheeled]
        return (self.high + [(field, HIGHEST_ORDERS) for field in self.fixed] +
                [(field, MOVING_ORDERS) for field in wheeled] +
                [(field, EQUATORIAL_ORDERS[1]) for field in self.equatorial])

    @cached_property
    def last(self):
        still = [(field, MOVING_ORDERS) for field in self.moving if not field.wheeled]
        return self.all + still + [(field, LAST_ORDERS) for field in self.moving]

    def __bool__(self):
        return bool(self.often)

    def certifier(self, field: FixedCentre | MovingCentre, orders: tuple[int, int],
                  fast: bool | None = None) -> Certifier:
        """The test itself, made by compiled code or not (None: as `ELIMINATE` has it). What others made does
        not alter an answer."""
        key = id(field), orders
        if key not in self.made:
            # before it is made: another thread that finds it made looks for its number
            if (field, orders) not in self.asked:
                self.asked.append((field, orders))
            self.made[key] = Certifier(field, orders, ELIMINATE.pays(TABLES[not field.sharp], fast))
        return self.made[key]


@lru_cache(maxsize=32)
def tests_of(scene: AnyScene) -> Tests:
    """The tests of a scene, kept for the next state of the same one."""
    return Tests(scene)
