"""The fate of one state: margins in balls, ties decided exactly, reasons; no arrays.

The orbit, its equilibria and its turning points (`one_orbit`) are asked with 64 bits first and in many digits
where these leave a question open, so that every answer is certain to at least twelve digits.

Is a state exactly on the separatrix? With a torque and a circle or hyperbola it is not, but for the
equilibrium itself, by Lindemann's theorem. Without a torque, and on a parabola, everything is a rational
function of one root of a rational polynomial, and a greatest common divisor decides.

A free body has the saddles on its momentum sphere. H = s omega at a permanent rotation; where no component of
lambda vanishes omega_i = lambda_i/(s - D_i), and on the sphere |H| = h the speeds s are the roots of the
sextic

    P(s) = (h(s)^2 - h^2) prod (s - D_i)^2,     h(s)^2 = sum s^2 lambda_i^2/(s - D_i)^2;

components that vanish, and the shared factors of equal moments, drop out of both products. A root is a saddle
iff s P'(s) prod (s - D_i) > 0, at a multiple root with the sign of P beyond it; one of even multiplicity is a
fold. Where lambda_i = 0 there are the rotations s = D_i as well; they are saddles iff D_i lies strictly
between the other moments. The margin is the nearest saddle's energy minus the motion's, at the same momentum:
positive where the motion has less energy than the saddle (without a wheel: turns about the major axis).

Proofs: docs/mathematics/separatrix.md.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from enum import IntEnum
from fractions import Fraction
from math import isinf, nan
from typing import TYPE_CHECKING, NamedTuple

from ..numbers.balls import (
    DOUBLE_BITS,
    FIRST_BITS,
    START_BITS,
    Digits,
    Unclear,
    polynomial,
    rational,
    settled,
    shares_root,
    sign,
    working,
)
from ..numbers.polynomial import Poly
from ..numbers.vectors import Number
from ..physics.scene import AnyScene, rests
from ..reasons import Reason, Sentence
from .one_orbit import MOST_BITS, BallOrbit, Orbit
from .result import Fate

if TYPE_CHECKING:
    import numpy as np
    from flint import arb, fmpq_poly

    from .reduction import Reduction


def exact_tie(orbit: BallOrbit) -> bool:
    """Whether each barrier that the balls of `orbit` (a BallOrbit) cannot tell from the energy equals it
    exactly.

    To be asked at the working precision at which the orbit was made; inputs are exact. False where a torque
    acts on a circle or a hyperbola. A barrier whose ball is clear of the energy plays no part.
    """
    close = [s for s in orbit.barriers() if 0 in orbit.height(s.y) - orbit.energy]
    if not close:
        return False
    tied = _ties_on_parabola if orbit.r.e == 0 else _on_conic
    return all(tied(orbit, point) for point in close)


def _ties_on_parabola(orbit, point) -> bool:
    """F and V - E share the root: both are polynomials in the offset."""
    f = orbit.taylor
    height = polynomial(0, *(-Fraction(c) / (n + 1) for n, c in enumerate(f)))
    speed = Fraction(orbit.state[orbit.r.axis]) + orbit.r.s
    return shares_root(polynomial(*f), height - polynomial(speed * speed / 2), point.y)


def _on_conic(orbit, point) -> bool:
    """Without torque V is a polynomial in U = omega_j + s_j and V = omega_k + s_k, and U a rational function
    of V (or the equilibria lie on two lines); under a torque never."""
    r = orbit.r
    if r.sense:
        return False
    ap, aq, sp = abs(r.p), abs(r.q), 1 if r.p > 0 else -1
    (sj, sk), (rho, sigma), m = r.centre, r.across, r.torque
    u0, v0, speed = orbit.u + sj, orbit.v + sk, Fraction(orbit.state[r.axis]) + r.s
    at_u, at_v = orbit.components(point.y)
    U, V = at_u + orbit.shift_j, at_v + orbit.shift_k

    def excess(u: fmpq_poly, v: fmpq_poly, entry: fmpq_poly):
        """Height minus energy, with u, v polynomials over the polynomial `entry`, times its square; in units
        of w^2/(ap aq)."""
        q = rational
        rise = (q(-sp * aq * r.kappa / 2) * (u * u - q(u0 * u0) * entry * entry)
                - q(sp * aq * rho) * (u * entry - q(u0) * entry * entry))
        return (rise - q(Fraction(r.e) * sp * ap * sigma) * (v * entry - q(v0) * entry * entry)
                - q(ap * aq * speed * speed / 2) * entry * entry)

    x, item = polynomial(0, 1), polynomial(1)
    if r.kappa and r.kappa * m == rho * sigma:
        line_v, line_u = -sigma / r.kappa, -rho / r.kappa
        on_line = polynomial(line_v**2 / aq - orbit.Q, 0, Fraction(-r.e) / ap)
        if V.contains(rational(line_v)) and shares_root(on_line, excess(x, polynomial(line_v), item), U):
            return True
        return U.contains(rational(line_u)) and shares_root(
            polynomial(-orbit.Q - r.e * line_u**2 / ap, 0, 1 / aq), excess(polynomial(line_u), x, item), V)
    if r.kappa or sigma:
        top, bottom = polynomial(m, rho), polynomial(sigma, r.kappa)
        equation = (polynomial(-orbit.Q, 0, 1 / aq) * bottom * bottom
                    - rational(Fraction(r.e) / ap) * top * top)
        return shares_root(equation, excess(-top, x * bottom, bottom), V)
    line_v = -m / rho
    return shares_root(polynomial(line_v**2 / aq - orbit.Q, 0, Fraction(-r.e) / ap),
                       excess(x, polynomial(line_v), item), U)


# --- The sign of the margin of one state is decided in balls, with as many digits as that takes
MARGIN_TOLERANCE = 1e-12  # of a margin: with less certainty balls do not settle it
EXACT_BITS = 512  # from these bits on algebra is asked whether two energies are equal


class Tie(NamedTuple):
    """Sign of a margin, settled with `bits` bits; 0 on the separatrix itself (by algebra: `exact_tie`)."""

    sign: int
    margin: float
    bits: int


def decide(orbit: Orbit, bits: int = START_BITS) -> Tie:
    """Sign of the margin of one state, doubling the bits until it is clear; sign -1 with margin -inf: no
    barrier.

    bits: at first. The margin comes with at least twelve digits, whatever bits settle its sign.

    Margin: see `BallOrbit.margin`.
    """
    def question(orbit):
        margin, bits = orbit.margin(), orbit.numbers.bits
        if margin is None:
            return Tie(-1, float("-inf"), bits)
        if _ties(orbit, margin):
            return Tie(0, 0.0, bits)
        if not MARGIN_TOLERANCE * abs(margin) > margin.rad():
            raise Unclear
        return Tie(sign(margin), float(margin.mid()), bits)
    return orbit.settled(question, bits)


def _ties(orbit: BallOrbit, margin: arb) -> bool:
    """Whether a margin that cannot be distinguished from zero is zero; where algebra denies it, the
    most bits settle the matter."""
    if not any(0 in m for m in orbit.margins_to_tie(margin)):
        return False
    if orbit.numbers.bits < EXACT_BITS:
        raise Unclear
    return exact_tie(orbit) or (0 in margin and orbit.numbers.bits >= MOST_BITS)


def precise_margin(orbit: Orbit, digits: int):
    """The margin of one state to `digits` decimal digits, as a ball in the scene's energy; None where there
    is no barrier, and on the separatrix, where no digit of it is known but that all vanish."""
    unit = orbit.reduction.exact_energy_unit

    def question(orbit):
        margin = orbit.margin()
        if margin is None or _ties(orbit, margin):
            return None
        if not 10 ** digits * margin.rad() < abs(margin):
            raise Unclear
        return margin * orbit.numbers.ball(unit)
    bits = max(START_BITS, int(3.33 * digits) + FIRST_BITS)
    return orbit.settled(question, bits)


# --- Whether a state is on the separatrix exactly, where no search of the nearest point could end: algebra
# says so
def on_separatrix(orbit) -> bool:
    """Whether the motion rests at a saddle or a fold, or tends to one; False where that is not decided.

    Under a torque along circles and hyperbolas no state in rational numbers tends to a saddle (Lindemann's
    theorem, docs/mathematics/separatrix.md).
    """
    r = orbit.reduction
    u, v, speed = (Fraction(orbit.state[axis]) for axis in (r.j, r.k, r.axis))
    force, *slopes = _force(r, u, v)
    if speed + r.s == 0 and force == 0:
        return _saddle(*slopes)
    if r.geometry.centred and (r.sense or (u + r.centre[0], v + r.centre[1]) == (0, 0)):
        return False
    if not r.geometry.centred and not any(orbit.settled(lambda result: result.taylor[1:], FIRST_BITS)):
        return False
    return decide(orbit, FIRST_BITS).sign == 0


def _force(r: Reduction, u: Fraction, v: Fraction):
    """The rate of omega_i over its factor at components u, v, and its first three derivatives along the
    orbit, exactly."""
    along = [(u, v)]
    for n in range(3):
        a, b = along[-1]
        along.append((r.p * b + (0 if n else r.p0), r.q * a + (0 if n else r.q0)))
    (u, v), (u1, v1), (u2, v2), (u3, v3) = along
    return (r.kappa * u * v + r.rho * v + r.sigma * u + r.m,
            r.kappa * (u1 * v + u * v1) + r.rho * v1 + r.sigma * u1,
            r.kappa * (u2 * v + 2 * u1 * v1 + u * v2) + r.rho * v2 + r.sigma * u2,
            r.kappa * (u3 * v + 3 * u2 * v1 + 3 * u1 * v2 + u * v3) + r.rho * v3 + r.sigma * u3)


def _saddle(first: Fraction, second: Fraction, third: Fraction) -> bool:
    """Whether a place without force is a maximum of the potential or a fold, where a branch of maxima ends.
    """
    return first > 0 or first == 0 and (second != 0 or third > 0)


EQUAL_BITS = 512  # two distances in energy that agree to so many bits count as equal
FREE_SHARE = 1e-12  # of the margin: with less certainty 64 bits do not settle it


def is_free(scene: AnyScene) -> bool:
    """Whether a scene is a body with its moments and no torque; scaled variables have no moments, and no
    sphere."""
    return scene.variables == "physical" and not any(scene.vector("constant_torque"))


def free_middle(D: Sequence[Fraction], lam: Sequence[Fraction]) -> Fraction | None:
    """The moment strictly between the other two, where the gyrostatic moment has no component about it; else
    None."""
    middle = sorted(D)[1]
    return middle if D.count(middle) == 1 and not lam[D.index(middle)] else None


class FreeMargin(NamedTuple):
    """Energy of the saddle nearest in energy on the momentum sphere, minus the state's; of two as near the
    one above. ball: None where the sphere has no saddle; tie: the two are equal, by algebra."""

    ball: Number
    tie: bool

    def __float__(self):
        return float("inf") if self.ball is None else float(self.ball.mid())

    @property
    def double(self) -> float:
        """The margin as a double; NaN where it is none, or would be 0 without a tie."""
        height = float(self)
        return nan if self.ball is not None and not self.tie and (height == 0 or isinf(height)) else height


def free_margin(scene: AnyScene, state: np.ndarray | Sequence[float | Fraction], digits: int = 17,
                doubles: bool = False) -> FreeMargin:
    """The margin of one state (three floats or Fractions, taken exactly) to `digits` decimal digits, in J.

    scene: physical, with no torque. doubles: 64 bits will do where the margin is certain to twelve digits.
    """
    body = _Momenta(scene, state)

    def question(numbers):
        bits = numbers.bits
        sharp = 10**digits if bits > FIRST_BITS else 1 / FREE_SHARE
        excesses = [(height - numbers.ball(body.energy), same) for height, same in body.saddles(numbers)]
        for excess, same in excesses:
            if 0 in excess:
                if bits == FIRST_BITS:
                    raise Unclear
                if same():
                    return FreeMargin(excess * 0, True)
                raise Unclear
        if not excesses:
            return FreeMargin(None, False)
        nearest = _nearest([excess for excess, _ in excesses], bits)
        if not abs(nearest) > sharp * nearest.rad():
            raise Unclear
        return FreeMargin(nearest, False)
    return settled(question, FIRST_BITS if doubles else START_BITS)


def _nearest(excesses: Sequence[arb], bits: int):
    """The one of least size; the greater where `EQUAL_BITS` do not tell two sizes apart."""
    best = excesses[0]
    for other in excesses[1:]:
        apart = abs(other) - abs(best)
        if 0 in apart and bits < EQUAL_BITS and sign(other) != sign(best):
            raise Unclear
        if apart < 0 or (0 in apart and other > best):
            best = other
    return best


class _Momenta:
    """The momentum sphere of one state: moments D, squares w of the gyrostatic moment about each different
    moment, h^2 and energy."""

    def __init__(self, scene, state):
        self.D, lam = scene.body.exact, scene.vector("gyrostat")
        self.middle = free_middle(self.D, lam)
        omega = [Fraction(v) for v in state]
        self.energy = sum(d * v * v for d, v in zip(self.D, omega)) / 2
        self.squared = sum((d * v + l) ** 2 for d, v, l in zip(self.D, omega, lam))
        self.w = {}
        for d, l in zip(self.D, lam):
            if l:
                self.w[d] = self.w.get(d, 0) + l * l
        self.sphere = self._numerator(self.w, Poly((0, 0, 1)), self.squared)

    def _numerator(self, weights: Mapping[Fraction, Fraction], top: Poly, value: Fraction | float) -> Poly:
        """sum weights_d top/(s - d)^2 - value, times prod (s - d)^2 over the moments d with a gyrostatic
        moment."""
        square = {d: Poly((d * d, -2 * d, 1)) for d in self.w}
        full = Poly((-value,))
        for d in square:
            full = full * square[d]
        for d, weight in weights.items():
            part = top * weight
            for other in square:
                part = part if other == d else part * square[other]
            full = full + part
        return full

    def saddles(self, numbers: Digits):
        """[(energy as a ball, whether it is the motion's)], the second a function without arguments."""
        level = self._numerator({d: d * w for d, w in self.w.items()}, Poly((1,)), 2 * self.energy)
        same = lambda s: lambda: shares_root(polynomial(*self.sphere.c), polynomial(*level.c), s)
        rows = [(self._height(s, numbers.ball), same(s)) for s in self._speeds(numbers)]
        middle = self._about_middle()
        return rows if middle is None else [*rows, (numbers.ball(middle), lambda: middle == self.energy)]

    def _about_middle(self) -> Fraction | None:
        """Energy of the rotations s = D_i about a middle axis without a gyrostatic moment; None where the
        sphere has none."""
        middle = self.middle
        if middle is None or not self.squared:
            return None
        across = sum(w * (middle / (middle - d)) ** 2 for d, w in self.w.items())
        if across > self.squared:
            return None
        along = (self.squared - across) / middle  # D_i omega_i^2
        return (along + sum(d * w / (middle - d) ** 2 for d, w in self.w.items())) / 2

    def _speeds(self, numbers: Digits) -> list:
        """The speeds s of the other saddles, as balls."""
        roots = numbers.real_roots(self.sphere.c) if self.w else []
        gaps = [b - a for (a, _), (b, _) in zip(roots, roots[1:])]
        if not all(gap > 0 for gap in gaps):
            raise Unclear
        result, beyond = [], 1 if not roots else sign(numbers.ball(self.sphere.c[-1]))
        for s, many in reversed(roots):
            if many % 2:
                result += [s] if self._is_saddle(s, beyond, numbers.ball) else []
                beyond = -beyond
        return result

    def _is_saddle(self, s: arb, beyond: int, ball: Callable[[float | Fraction], arb]) -> bool:
        if s.is_zero():
            return False
        side = beyond * sign(s)
        for d in self.D:
            gap = s - ball(d)
            if 0 in gap and not self.sphere(d):
                return False  # where the rotations s = D_i begin: those count, and only about a middle axis
            side *= sign(gap)
        return side > 0

    def _height(self, s: arb, ball: Callable[[float | Fraction], arb]):
        """Kinetic energy of the permanent rotation of speed s."""
        gaps = [(s - ball(d), d * w) for d, w in self.w.items()]
        return sum((ball(weight) / (gap * gap) for gap, weight in gaps), ball(0)) / 2


# --- Why a motion has the fate it has, in words; and whether a state is at rest, decided exactly
class Basis(IntEnum):
    """Why a label was given; `REASONS` has the words."""

    BELOW_BARRIER = 0
    ABOVE_BARRIER = 1
    NO_BARRIER = 2
    WALLS = 3
    PLANE_CAPTURED = 4
    PLANE_ESCAPES = 5
    PURE_SPIN = 6
    TIE = 7
    AT_REST = 8
    TORQUE_FREE = 9
    UNBOUNDED_LAW = 10
    OFF_AXIS = 11
    TURN_ROUNDS = 12
    CERTIFIED = 13
    CLOSED_FORM = 14


REASONS: dict[Basis, Reason] = {
    Basis.BELOW_BARRIER: Sentence(
        "below-barrier", "the energy is below the barrier ahead, the next maximum of the reduced potential "
        "in the direction of the torque")(),
    Basis.ABOVE_BARRIER: Sentence(
        "above-barrier", "the energy exceeds every barrier of the reduced potential within one turn ahead, "
        "and each later turn is lower still")(),
    Basis.NO_BARRIER: Sentence(
        "no-barrier", "no barrier is ahead: no equilibrium has this value of the first integral Q, so the "
        "reduced potential falls for ever in the direction of the torque")(),
    Basis.WALLS: Sentence(
        "walls", "the reduced potential grows without bound on both sides of the motion")(),
    Basis.PLANE_CAPTURED: Sentence(
        "plane-captured", "on the invariant plane Q = 0, below the barrier ahead")(),
    Basis.PLANE_ESCAPES: Sentence(
        "plane-escapes", "on the invariant plane Q = 0 that decays in the direction of the torque, above any "
        "barrier: a set of measure zero")(),
    Basis.PURE_SPIN: Sentence(
        "pure-spin", "pure spin about the torque's axis: the angular acceleration about it is constant")(),
    Basis.TIE: Sentence(
        "energy-of-barrier",
        "the energy equals the barrier's: the motion tends to the saddle equilibrium")(),
    Basis.AT_REST: Sentence("at-equilibrium", "the state is an equilibrium, exactly")(),
    Basis.TORQUE_FREE: Sentence(
        "torque-free", "no torque: the kinetic energy is constant, and it is positive definite")(),
    Basis.UNBOUNDED_LAW: Sentence(
        "unbounded-law",
        "|H|²/2 - Dᵢ T grows steadily at the rate λᵢ Mᵢ: no motion is bounded")(),
    Basis.OFF_AXIS: Sentence(
        "off-axis-open", "the torque is off the principal axes, where no first integral is known, and no "
        "certificate of spin-up was met")(),
    Basis.TURN_ROUNDS: Sentence(
        "turn-rounds", "the energy is within 1e-36 of a barrier's, and the turn that puts the torque on an "
        "axis has irrational numbers, carried to 240 bits")(),
    Basis.CERTIFIED: Sentence(
        "off-axis-certified", "the torque is off the principal axes, where no first integral is known")(),
    Basis.CLOSED_FORM: Sentence(
        "off-axis-closed",
        "the torque is off the principal axes, and equal moments give a closed solution")(),
}


def margin_at_rest(scene: AnyScene, margin: float) -> float:
    """The margin of an equilibrium from the barriers that `margin` knows, those beyond the state itself.

    Where these are lower and a torque acts, its neighbours on one side are released and it is not: it lies on
    the separatrix.
    """
    return max(margin, 0.0) if any(scene.quadratic().m) else margin


INF = math.inf


class OneFate(NamedTuple):
    """Fate of one state: as in `fate_arrays.FateResult`, the margin in the scene's energy."""

    label: Fate
    basis: Basis
    margin: float
    axis: int = 0
    sense: int = 0

    @property
    def reason(self) -> Reason:
        return REASONS[self.basis]

    @property
    def because(self) -> str:
        return self.reason.text()


def fate_of(scene: AnyScene, orbit: Orbit, nearby: Orbit | None = None) -> OneFate:
    """The fate of one state of a scene with this orbit.

    nearby: the orbit in a unit in which to compare energies; the margin is in it then.
    """
    reduction, state = orbit.reduction, orbit.state
    if is_free(scene):  # in the scene's unit, whatever its size
        result = free_fate(scene, state)
    else:
        result = {-1: _on_circle, 1: _on_hyperbola, 0: _on_parabola}[reduction.e](nearby or orbit)
        # its sign is known, and it is too small for a double
        lost = result.margin == 0 and result.label != Fate.SEPARATRIX
        result = result._replace(margin=math.nan if lost else result.margin * reduction.energy_unit)
    return at_rest(scene, result) if rests(scene.quadratic(), state) else result


def at_rest(scene: AnyScene, result: OneFate) -> OneFate:
    """The fate of an equilibrium, given what its energy alone says."""
    return OneFate(Fate.EQUILIBRIUM, Basis.AT_REST, margin_at_rest(scene, result.margin))


def free_fate(scene: AnyScene, state: Sequence[float | Fraction]) -> OneFate:
    """The fate without a torque: bounded, whatever the margin, or on a separatrix of the momentum sphere."""
    margin = free_margin(scene, state, doubles=True)
    return _tie() if margin.tie else OneFate(Fate.BOUNDED, Basis.TORQUE_FREE, margin.double)


def _spin_up(r: Reduction, basis: Basis, margin: float) -> OneFate:
    return OneFate(Fate.SPIN_UP, basis, margin, r.axis + 1, r.sense)


def _tie() -> OneFate:
    return OneFate(Fate.SEPARATRIX, Basis.TIE, 0.0)


def _on_circle(orbit: Orbit) -> OneFate:
    r = orbit.reduction
    if _shifted(orbit) == (0, 0):  # the circle is a point: pure spin, and nothing stands in its way
        result = None
    else:
        result = decide(orbit, FIRST_BITS)
        if result.sign == 0:
            return _tie()
    margin = -INF if result is None else result.margin
    if r.sense == 0:
        return OneFate(Fate.BOUNDED, Basis.TORQUE_FREE, margin)
    if result is not None and result.sign > 0:
        return OneFate(Fate.BOUNDED, Basis.BELOW_BARRIER, margin)
    return _spin_up(r, Basis.NO_BARRIER if margin == -INF else Basis.ABOVE_BARRIER, margin)


def _shifted(orbit: Orbit) -> tuple[Fraction, Fraction]:
    """(omega_j + s_j, omega_k + s_k), exactly."""
    r, state = orbit.reduction, orbit.state
    sj, sk = r.centre
    return Fraction(state[r.j]) + sj, Fraction(state[r.k]) + sk


def _valley(orbit: Orbit) -> OneFate:
    """Between walls: bounded on either side of a barrier, if there is one."""
    tie = decide(orbit, FIRST_BITS)
    if tie.sign == 0:
        return _tie()
    return OneFate(Fate.BOUNDED, Basis.WALLS, INF if tie.margin == -INF else tie.margin)


def _on_hyperbola(orbit: Orbit) -> OneFate:
    r, (u, v) = orbit.reduction, _shifted(orbit)
    if v * v * abs(r.p) != u * u * abs(r.q):
        return _valley(orbit)
    if u == 0:
        return _spin_up(r, Basis.PURE_SPIN, -INF)
    if (u > 0) == (v > 0) and r.sense * r.p > 0 or (u > 0) != (v > 0) and r.sense * r.p < 0:
        # eta = 0: it grows ahead, and the torque's tilt rises behind
        return OneFate(Fate.BOUNDED, Basis.WALLS, INF)
    tie = decide(orbit, FIRST_BITS)
    if tie.sign > 0:
        return OneFate(Fate.BOUNDED, Basis.PLANE_CAPTURED, tie.margin)
    return _tie() if tie.sign == 0 else _spin_up(r, Basis.PLANE_ESCAPES, tie.margin)


def _on_parabola(orbit) -> OneFate:
    if not any(orbit.settled(lambda result: result.taylor[1:], FIRST_BITS)):
        return _spin_up(orbit.reduction, Basis.PURE_SPIN, -INF)  # the force is the same all along the orbit
    return _valley(orbit)


def as_double(value: Fraction) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.nan


def scaled_double(value: Number, k: int) -> float:
    """The double nearest to 2^k times a ball or float; its own double may have underflowed in the other unit.
    """
    if not k or isinstance(value, float):
        return float(value)
    middle = float(value)
    if abs(middle) > 2.0**-900:
        return as_double(Fraction(middle) * Fraction(2) ** k)
    with working(DOUBLE_BITS) as numbers:
        return float(value * numbers.ball(Fraction(2) ** k))
