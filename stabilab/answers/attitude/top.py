"""How a heavy symmetric top turns: nutation and mean precession, by Lagrange's cubic.

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
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from ...numbers.balls import Digits, Unclear, settled
from ...numbers.vectors import CYCLE, dot
from ...physics.scene import Scene
from .result import SEPARATRIX, TOP, Attitude, narrow, steady, with_periods

UPRIGHT = "the axis passes through the vertical, where it has no precession"


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


def of_top(scene: Scene, axis: int, start: Sequence[Fraction], base: Attitude, digits: int | None = None
           ) -> Attitude:
    """base: what is known at the start, three rates and the vertical; digits: of the periods."""
    top = _Top(scene, axis, start)
    if top.vertical:
        return replace(steady(base, start[:3], digits), because="the axis stands on the vertical")
    balls: list[Any] = settled(
        lambda numbers: [None if one is None else narrow(one, digits) for one in top.answer(numbers)])
    least, greatest, nutation, precession = balls
    words = "the lean goes to and fro between two roots of Lagrange's cubic"
    if top.steady:
        words = "the axis keeps its lean and precesses about the vertical"
    elif least is None:
        return replace(base, mode=SEPARATRIX, because="the axis comes ever closer to the vertical and does "
                                                      "not come back")
    found = replace(base, mode=TOP, lean=(float(least.mid()), float(greatest.mid())),
                    because=words if precession is not None else f"{words}; {UPRIGHT}")
    return with_periods(found, {"nutation_period": nutation, "precession_period": precession}, digits)


class _Top:
    """The constants of the cubic, of u = +-gamma_i."""

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
        whole, _ = numbers.elliptic(numbers.ball(0), m)
        nutation = 4 * whole / (numbers.ball(self.beta) * (far - low)).sqrt()
        if self.up or self.down:
            return *ends, nutation, None
        ahead = numbers.elliptic(swing / (g - low), m)[1] / (whole * (g - low))
        behind = numbers.elliptic(-swing / (g + low), m)[1] / (whole * (g + low))
        return *ends, nutation, _period(numbers, ((kappa - a * g) * ahead + (kappa + a * g) * behind) / 2)


def _period(numbers: Digits, rate: Any) -> Any:
    return 2 * numbers.pi() / abs(rate)


def _lean(cosine: Any) -> Any:
    """Its angle, without loss where it is near one."""
    return 2 * ((1 - cosine) / 2).sqrt().asin()
