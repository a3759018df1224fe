"""The nutation and mean precession of a symmetric top, under its weight and in a field.

A heavy symmetric top, by Lagrange's cubic.

A body with D_j = D_k = A turns about a fixed point under its weight, which acts on axis i at the moment P = M
g c; a wheel may turn about that axis. Constant are the momentum about it, L = D_i omega_i + lambda_i, the
momentum about the vertical and the energy. With u the cosine of the lean, between the upward vertical and the
direction from the fixed point to the centre of mass (Landau & Lifshitz, Mechanics, section 35),

    u'^2 = F(u) = (1 - u^2)(eps - beta u) - (kappa - a u)^2,    beta = 2 |P|/A,  a = L/A,
    eps = omega_j^2 + omega_k^2 + beta u,    kappa = (D omega + lambda) . gamma/A, up to its sign.

u goes to and fro between the lower two roots of F, u_1 <= u <= u_2 <= 1 <= u_3: with m = (u_2 - u_1)/(u_3 -
u_1)

    nutation period = 4 K(m) / (beta (u_3 - u_1))^(1/2),

and the axis precesses at the rate (kappa - a u)/(1 - u^2), half the sum of (kappa - a)/(1 - u) and (kappa +
a)/(1 + u), whose means over that period are integrals of the third kind. Where |gamma| = g is not quite one,
u is between -g and g. Exact fractions and balls.

In a field. A Newtonian centre adds f u^2/2 to the potential, f = N (D_i - A), and a charge that follows the
attitude E u to the momentum about the axis (`physics.symmetric_top`). With s the moment of the weight, h the
energy without the spin's, G(u) = -K - L u - E u^2/2 the momentum about the upward vertical that the motion
across the axis has, K the area integral,

    u'^2 = F(u) = (g^2 - u^2) (2/A) (h - s u - f u^2/2) - (G/A)^2,

a quartic, and the axis precesses at g G/(A (g^2 - u^2)). u goes to and fro between the roots u_1, u_2 on
either side of it; with F = (u - u_1)(u_2 - u) R and u = (u_1 + u_2)/2 - (u_2 - u_1)/2 cos z, both periods are
integrals of analytic functions over 0 <= z <= pi, dt = dz/R^(1/2), enclosed by Petras' rule (acb_calc of
Arb)."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from ...numbers.balls import Digits, Unclear, settled
from ...numbers.polynomial import Poly
from ...numbers.vectors import CYCLE, cross, dot
from ...physics.scene import Scene
from ...physics.symmetric_top import SymmetricTop, top_rates
from ...reasons import Sentence
from .result import (
    FIELD_TOP,
    SEPARATRIX,
    TOP,
    Attitude,
    bits_of,
    narrow,
    steady,
    with_periods,
)

if TYPE_CHECKING:
    from flint import acb, arb

UPRIGHT = Sentence(
    "top-through-vertical", "the axis passes through the vertical, where it has no precession")()
ON_VERTICAL = Sentence("top-on-vertical", "the axis stands on the vertical")()
TO_AND_FRO = Sentence(
    "top-nutates", "the lean goes to and fro between two roots of Lagrange's cubic")()
STEADY_LEAN = Sentence("top-precesses-steadily", "the axis keeps its lean and precesses about the vertical")()
NEARLY_STEADY = Sentence(
    "top-precesses-steadily-nearly", "the axis keeps its lean, but for what the rounding of its start to "
    "doubles adds, and precesses about the vertical")()
TO_VERTICAL = Sentence(
    "top-tends-to-vertical", "the axis comes ever closer to the vertical and does not come back")()
IN_A_FIELD = Sentence(
    "top-nutates-in-a-field", "the lean goes to and fro between two roots of a quartic, Lagrange's cubic "
    "with the field and the charge")()
TO_STEADY = Sentence(
    "top-tends-to-steady-precession", "the lean comes ever closer to that of an unstable steady precession "
    "and does not come back")()
EVALUATIONS = 4000  # of an integral, at most, for each bit
SPARE = 12  # bits of an integrand that may be its rounding

AT_REST_IN_AZIMUTH = Sentence(
    "top-without-precession", "the axis stays in one vertical plane and does not precess")()
ROUNDED = 1e-13  # rad, of a lean: less comes of rounding


def axis_of_top(scene: Any) -> int | None:
    """The axis of a heavy symmetric top, which its weight and its wheels act on alone; None of other scenes.
    """
    if {effect.name for effect in scene.effects} - {"gyrostat"} != {"gravity"}:
        return None
    D, wheel = scene.body.exact, scene.vector("gyrostat")
    along = [i for i, weight in enumerate(scene.vector("gravity")) if weight]
    if len(along) != 1:
        return None
    j, k = CYCLE[along[0]]
    return along[0] if D[j] == D[k] and not wheel[j] and not wheel[k] else None


def of_top(scene: Scene, form: SymmetricTop, start: Sequence[Fraction], base: Attitude,
           digits: int | None = None) -> Attitude:
    """form: of the scene; base: what is known at the start, three rates and the vertical; digits: of the
    periods."""
    axis = axis_of_top(scene)
    top: _Top | _FieldTop = _FieldTop(form, scene, start) if axis is None else _Top(scene, axis, start)
    base = replace(base, top=top_rates(scene, start))
    if top.vertical:
        return replace(steady(base, start[:3], digits), reason=ON_VERTICAL)
    balls: list[Any] = settled(
        lambda numbers: [None if item is None else narrow(item, digits) for item in top.answer(numbers)],
        bits_of(digits))
    smallest, greatest, nutation, precession = balls
    if smallest is None and not top.steady:
        return replace(base, mode=SEPARATRIX, reason=top.tends)
    nearly = nutation is not None and float(greatest - smallest) < ROUNDED
    steadily = STEADY_LEAN if top.steady else NEARLY_STEADY if nearly else top.nutates
    reason = steadily.then(top.without_precession if precession is None else None)
    nutation = None if nearly else nutation
    result = replace(base, mode=TOP if axis is not None else FIELD_TOP,
                     lean=(float(smallest.mid()), float(greatest.mid())), reason=reason)
    return with_periods(result, {"nutation_period": nutation, "precession_period": precession}, digits)


class _Top:
    """The constants of the cubic, of u = +-gamma_i."""

    nutates, tends, without_precession = TO_AND_FRO, TO_VERTICAL, UPRIGHT

    def __init__(self, scene: Scene, axis: int, start: Sequence[Fraction]) -> None:
        j, k = CYCLE[axis]
        D, wheel = scene.body.exact, scene.vector("gyrostat")
        omega, gamma = start[:3], start[3:]
        arm = scene.vector("gravity")[axis]  # times the weight, N m
        momentum = [d * w + l for d, w, l in zip(D, omega, wheel)]
        up = -1 if arm > 0 else 1  # gamma is the direction of the weight
        u, self.square = up * gamma[axis], dot(gamma, gamma)
        beta, self.a = 2 * abs(arm) / D[j], momentum[axis] / D[j]
        self.kappa = up * dot(momentum, gamma) / D[j]
        eps = omega[j] ** 2 + omega[k] ** 2 + beta * u
        self.u, self.beta = u, beta
        self.cubic = (self.square * eps - self.kappa**2, 2 * self.kappa * self.a - self.square * beta,
                      -eps - self.a**2, beta)
        slope = self.cubic[1] + 2 * self.cubic[2] * u + 3 * beta * u * u
        self.steady = not slope and not sum(c * u**n for n, c in enumerate(self.cubic))
        self.vertical = self.steady and u * u == self.square
        # at u = g and u = -g the cubic is -(kappa -+ a g)^2
        tie, sign = self.kappa**2 == self.a**2 * self.square, self.kappa * self.a
        self.down = tie and sign <= 0
        self.up = tie and sign >= 0 and eps > 0 and eps**2 > beta**2 * self.square

    def answer(self, numbers: Digits) -> tuple[Any, Any, Any, Any]:
        """(least, greatest lean, nutation period, precession period) in balls; None what it does not have."""
        g, a, kappa = numbers.ball(self.square).sqrt(), numbers.ball(self.a), numbers.ball(self.kappa)
        if self.steady:
            u, turns = numbers.ball(self.u), self.kappa != self.a * self.u
            rate = g * (kappa - a * u) / (g * g - u * u)
            return _lean(u / g), _lean(u / g), None, _period(numbers, rate) if turns else None
        roots = [(root, many) for root, many in numbers.real_roots(self.cubic) for _ in range(many)]
        if len(roots) < 3:
            raise Unclear
        (low, _), (high, many), (far, _) = roots
        if many > 1:
            return None, None, None, None
        low, high = -g if self.down else low, g if self.up else high
        swing, m = high - low, (high - low) / (far - low)
        ends = (numbers.ball(0) if self.up else _lean(high / g),
                numbers.pi() if self.down else _lean(low / g))
        full, _ = numbers.elliptic(numbers.ball(0), m)
        nutation = 4 * full / (numbers.ball(self.beta) * (far - low)).sqrt()
        if self.up or self.down:
            return *ends, nutation, None
        ahead = numbers.elliptic(swing / (g - low), m)[1] / (full * (g - low))
        behind = numbers.elliptic(-swing / (g + low), m)[1] / (full * (g + low))
        return *ends, nutation, _period(numbers, ((kappa - a * g) * ahead + (kappa + a * g) * behind) / 2)


class _FieldTop:
    """The constants of the quartic F, of u = -gamma . e."""

    nutates, tends, without_precession = IN_A_FIELD, TO_VERTICAL, UPRIGHT

    def __init__(self, form: SymmetricTop, scene: Scene, start: Sequence[Fraction]) -> None:
        omega, gamma, e, A = start[:3], start[3:6], form.direction, form.A
        H = [d * w + l for d, w, l in zip(scene.body.exact, omega, scene.vector("gyrostat"))]
        along, self.square, self.A = dot(omega, e), dot(gamma, gamma), A
        u = self.u = -dot(gamma, e)
        L = form.momentum(along, Fraction(0))
        half = form.charge / 2
        K = dot(H, gamma) - half * u * u
        h = A * (dot(omega, omega) - along * along) / 2 + form.weight * u + form.field * u * u / 2
        self.G = Poly((-K, -L, -half))
        self.F = (Poly((self.square, 0, -1)) * Poly((h, -form.weight, -form.field / 2)) * (2 / A)
                  - self.G * self.G * (1 / (A * A)))
        self.rises = -dot(cross(gamma, omega), e)  # u'
        self.slope = self.F.derivative()(u)
        self.steady = not self.slope and not self.F(u)
        self.vertical = self.steady and u * u == self.square
        # F is -(G/A)^2 at u = g and u = -g
        middle = K + half * self.square
        tie = middle * middle == L * L * self.square
        self.up, self.down = tie and middle * L <= 0, tie and middle * L >= 0
        if self.steady and not self.G(u) or not self.G:
            self.without_precession = AT_REST_IN_AZIMUTH

    def answer(self, numbers: Digits) -> tuple[Any, Any, Any, Any]:
        """As of `_Top`."""
        g = numbers.ball(self.square).sqrt()
        if self.steady:
            u = numbers.ball(self.u)
            rate = g * numbers.ball(self.G(self.u)) / (numbers.ball(self.A) * (g * g - u * u))
            return _lean(u / g), _lean(u / g), None, _period(numbers, rate) if self.G(self.u) else None
        (low, double_below), (high, double_above) = self._ends(numbers)
        up, down = self.up and high.overlaps(g), self.down and low.overlaps(-g)
        low, high = -g if down else low, g if up else high
        if double_below or double_above:
            above = double_above and (not double_below or (self.rises or self.slope) > 0)
            self.tends = TO_VERTICAL if up and above or down and not above else TO_STEADY
            return None, None, None, None
        ends = numbers.ball(0) if up else _lean(high / g), numbers.pi() if down else _lean(low / g)
        rest = self._rest(numbers, low, high)
        half_time = _integral(numbers, lambda u, analytic: 1 / rest(u).sqrt(analytic), low, high)
        if up or down or not self.G:
            return *ends, 2 * half_time, None
        G, A = [numbers.ball(c) for c in self.G.c], numbers.ball(self.A)

        def turned(u: acb, analytic: bool) -> acb:
            momentum = sum((c * u**n for n, c in enumerate(G)), 0 * u)
            return g * momentum / (A * (g * g - u * u) * rest(u).sqrt(analytic))
        return *ends, 2 * half_time, _period(numbers, _integral(numbers, turned, low, high) / half_time)

    def _ends(self, numbers: Digits) -> list[tuple[arb, bool]]:
        """(root, whether it is a multiple one) of F on either side of the start, the lower one first."""
        u, roots = numbers.ball(self.u), numbers.real_roots(self.F.c)
        if self.F(self.u):
            n = sum(1 for root, _ in roots if root < u)
            if n + sum(1 for root, _ in roots if root > u) < len(roots) or not 0 < n < len(roots):
                raise Unclear
        else:  # at a turning point, from which F rises
            n, *others = (i for i, (root, _) in enumerate(roots) if root.overlaps(u))
            if others:
                raise Unclear
            n += self.slope > 0
        return [(root, many > 1) for root, many in roots[n - 1:n + 1]]

    def _rest(self, numbers: Digits, low: arb, high: arb) -> Callable[[acb], acb]:
        """R of F = (u - low)(high - u) R."""
        *_, c2, c3, c4 = (numbers.ball(c) for c in (*self.F.c, *[Fraction(0)] * (5 - len(self.F.c))))
        both = low + high
        constant = c2 + c3 * both + c4 * (low * low + low * high + high * high)
        return lambda u: -(constant + (c3 + c4 * both) * u + c4 * u * u)


def _integral(numbers: Digits, rate: Callable[[Any, bool], Any], low: arb, high: arb) -> arb:
    """Integral of a function of u over 0 <= z <= pi."""
    from flint import acb, arb
    middle, half, pi = (low + high) / 2, (high - low) / 2, numbers.pi()
    at = lambda part: middle - half * (pi * part).cos()
    sizes = [rate(acb(at(arb(n) / 4)), False).real for n in range(5)]
    if not all(size.is_finite() for size in sizes):
        raise Unclear
    largest = max((size.abs_upper() for size in sizes), key=float)
    # pieces below the rounding of the function would be halved for ever
    rounding = max((size.rad() for size in sizes), key=float)
    grain = arb(2) ** (SPARE - numbers.bits)
    value = acb.integral(lambda z, analytic: rate(at(z), analytic), 0, 1, rel_tol=grain,
                         abs_tol=rounding * 2**SPARE + largest * grain,
                         eval_limit=EVALUATIONS * numbers.bits).real * pi
    if not value.is_finite():
        raise Unclear
    return value


def _period(numbers: Digits, rate: Any) -> Any:
    return 2 * numbers.pi() / abs(rate)


def _lean(cosine: Any) -> Any:
    """Its angle, without loss where it is near one."""
    return 2 * ((1 - cosine) / 2).sqrt().asin()


