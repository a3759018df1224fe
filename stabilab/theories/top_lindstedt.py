"""The periodic motion of a fast top in a Newtonian field by the Poincare-Lindstedt expansion, to any
order: a power series in the small parameter, each coefficient a Fourier sum.

The expansion has no free wobble in it (source: Amer et al. 2023, fast top; its first order is printed
wrongly, see `top`). A start therefore gives r and gamma at t = 0, and the periodic motion through them says
what p and q must be; `departure` is how far the given p and q are from that. A start elsewhere wobbles
about the periodic motion at the frequency Omega r0 with an amplitude of that size, which the expansion
leaves out."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError
from ..numbers.vectors import Float3
from ..physics.states import numbers_in_a_row
from ..reasons import PerSecond, Quantity, Rate, Reason, Reasoned, Sentence, chained
from .top_expansion import Expansion, FastTop, expand, fast_top

if TYPE_CHECKING:
    from ..physics.scene import AnyScene

HIGHEST_ORDER = 24  # the cost grows as the fourth power of the order; double precision is used up long before
# orders beyond the one asked for, by which it is judged: without l_x, l_y odd ones hold p, q alone, even ones
# the rest
FURTHER = 2
# a divisor Omega - m this small makes the coefficients grow tenfold and more, order by order
SMALL_DIVISOR = 0.1
SETTLED = 1e-12  # terms below are rounding, and do not fall any more
ROUNDING = 1e-14  # of the spin: a departure this small is none
NEAR_SLACK = 1e-9  # so that a distance of 0.1 itself, rounded, is named


WHOLE_NUMBER = Sentence("top-resonance", "Ω = {harmonic}")
FIRST_OF_SPIN = Sentence("top-resonance-no-spin", "Ω = 1, C* = 0")()
FIRST_OF_MOMENTS = Sentence("top-resonance-of-moments", "Ω = 1, C* = A + B")()
ONE_MOMENT = Sentence("top-moment", "C* = {moment}")
EQUAL_MOMENT = Sentence("top-moment-met", "C* = A or C* = B")()
NEAR_RESONANCE = Sentence(
    "near-resonance", "near the resonance {resonance} (distance {distance}): its small divisor magnifies the "
    "terms")
NOT_FAST = Sentence(
    "top-not-fast", "{terms}: the top is not fast enough for this expansion (small parameter {small})")
MISSES = Sentence(
    "series-misses", "the series misses the equations of motion by {residual} of the spin, so it may be off "
    "by {turned} after a revolution; its last terms are {terms}")
UNSTABLE = Sentence(
    "periodic-motion-unstable", "Ω² = {square} < 0 (C* lies between A and B): the periodic motion is "
    "unstable, neighbours leave it at {rate}")
EXACTLY_RESONANT = Sentence(
    "exact-resonance", "exact resonance ({resonance}) under a forcing: {end}, order {order} does not exist")
ENDS_AT = Sentence("expansion-ends", "the expansion ends at order {order}")
NO_START = Sentence("no-periodic-motion", "there is no periodic motion to start from")()
DO_NOT_FALL = Sentence("terms-do-not-fall", "the terms do not fall {terms}")
NEXT_DO_NOT_FALL = Sentence("next-terms-do-not-fall", "the terms do not fall, {terms} and then {ahead}")
MISSES_MORE = Sentence(
    "series-misses-more", "the series misses the equations of motion by {residual} of the spin, no less than "
    "its last terms, {terms}")
DIFFERS = Sentence(
    "start-differs-from-series", "the start's p, q differ by {change} from a series that does not converge "
    "there")
LIES_ON = Sentence(
    "start-on-periodic-motion", "the start lies on the periodic motion to within what this order leaves out "
    "there, {error}")
IS_OFF = Sentence(
    "start-off-periodic-motion", "the start is not on the periodic motion: p, q differ by {change}, a free "
    "wobble of that size which the expansion leaves out")


@dataclass(frozen=True)
class Resonance:
    """A resonance in reach of the orders asked for: harmonic m, its condition, |Omega - m| (for m =
    0 the relative distance of C* from A or B)."""

    harmonic: int
    condition: Reason
    distance: float


@dataclass(frozen=True)
class LindstedtMotion(Reasoned):
    """The periodic motion at the times t (s).

    omega: (n, 3) rad/s, body frame; gamma: (n, 3), of length 1 up to the order's error. order: what was
    reached; epsilon: the paper's sqrt(M g L |gamma0''|/C)/r0; size: what the expansion is in (see
    `FastTop.size`); frequency: nu r0, rad/s (with the sign of r0); period: s; Omega2: square of the free
    wobble's frequency over r0; resonances: those in reach, nearest first; terms: size of each order's term
    relative to the spin, 0 ... order; ahead: those of the next two orders, where they exist; residual:
    largest residual over one revolution of the scaled equations (above); departure:
    (2,) given minus periodic p, q at t = 0, rad/s; left_out: what p, q at t = 0 change by in the next two
    orders, rad/s (by the residual, where these do not exist).

    status: "asymptotic", "near resonance", "unstable" (Omega^2 < 0), "diverging" (the terms do not fall, or
    the equations of motion are missed by more than the last terms), "resonant" (a divisor is 0: the expansion
    ends below the order asked for; with order -1 there is no motion at all and the arrays are empty); reason:
    in words.
    """

    t: np.ndarray
    omega: np.ndarray
    gamma: np.ndarray
    order: int
    epsilon: float
    size: float
    frequency: float
    period: float
    Omega2: float
    resonances: tuple[Resonance, ...]
    terms: tuple[float, ...]
    ahead: tuple[float, ...]
    residual: float
    departure: np.ndarray
    left_out: float
    status: str
    r0: float
    expansion: Expansion = field(repr=False, compare=False)

    def at(self, times):
        """(omega (n, 3), gamma (n, 3)) at other times, s."""
        return _evaluate(self.expansion, self.r0, np.asarray(times, float))


def lindstedt(scene: AnyScene, state: Mapping[str, Float3], times: np.ndarray | Sequence[float],
              order: int = 2) -> LindstedtMotion:
    """The periodic motion of a fast top with r and gamma of `state` at t = 0, expanded to `order`.

    scene: a body with any of gravity, Newtonian field, gyrostat (whatever its direction), spinning about axis
    3. state: {"omega": (3,) rad/s, "gamma": (3,) unit vector along the weight}, or the six numbers; its p and
    q are not free (see the module's text). times: (n,), s, of any sign and order. Nothing is expanded in
    1/r0: l_z enters through C* = C + l_z/r0, and A, B are the body's own. A weight along axis 3 (no tilt) and
    one across it (gamma0'' = 0 or negative) are covered. Raises InputError for other effects, a zero third
    component of omega, and no whole order from 0 to 24.
    """
    if isinstance(order, bool) or not isinstance(order, (int, np.integer)) or not 0 <= order <= HIGHEST_ORDER:
        raise InputError(f"order: expected a whole number from 0 to {HIGHEST_ORDER}, got {order!r}")
    times = numbers_in_a_row(times, "times")
    top = fast_top(scene, state)
    expansion, further, r0 = expand(top, int(order)), expand(top, int(order) + FURTHER), float(top.r0)
    exists = expansion.order >= 0
    times = times if exists else times[:0]
    omega, gamma = _evaluate(expansion, r0, times)
    nu = expansion.sums()[0] if exists else 1.0
    start, better = ((_evaluate(e, r0, np.zeros(1))[0][0, :2] if exists else np.zeros(2))
                     for e in (expansion, further))
    departure = np.array([float(x) for x in top.omega[:2]]) - start
    residual = _residual(top, expansion) if exists else float("inf")
    beyond = further.order > expansion.order
    left_out = float(np.hypot(*(better - start))) if beyond else abs(r0) * top.size * residual
    nearby, ahead = _resonances(top, int(order)), further.terms[len(expansion.terms):]
    status, reason = _verdict(top, expansion, nearby, int(order), ahead, residual)
    if exists:
        wobble = departure - (better - start) if beyond else departure
        reason = chained(reason, _how_far(departure, wobble, left_out, abs(r0), status))
    return LindstedtMotion(times, omega, gamma, expansion.order, top.epsilon, top.size, nu * r0,
                           2 * np.pi / abs(nu * r0),
                           float(top.Omega2), nearby, expansion.terms, ahead, residual, departure, left_out,
                           status, r0, expansion, reason=reason or NO_START)


def _evaluate(expansion: Expansion, r0: float, times: np.ndarray):
    if expansion.order < 0:
        return np.empty((0, 3)), np.empty((0, 3))
    nu, coefficients = expansion.sums()
    u, v, w, G, g3 = _fourier(coefficients, nu * r0 * times)
    omega = np.stack([r0 * expansion.size * u.real, r0 * expansion.size * v.real, r0 * w.real], -1)
    return omega, np.stack([G.real, G.imag, g3.real], -1)


def _fourier(coefficients: np.ndarray, s: np.ndarray):
    """Sums of Fourier coefficients (..., 2K+1) at the phases s (n,): (..., n)."""
    z, total = np.exp(1j * s), np.zeros(coefficients.shape[:-1] + s.shape, complex)
    for k in range(coefficients.shape[-1] - 1, -1, -1):  # by Horner's rule: no array over times and harmonics
        total = total * z + coefficients[..., k, None]
    return total * np.exp(-1j * (coefficients.shape[-1] // 2) * s)


def _residual(top: FastTop, expansion: Expansion) -> float:
    """Largest residual of the six scaled equations on a grid fine enough for every product."""
    nu, fields = expansion.sums()
    K, e = fields.shape[-1] // 2, expansion.size
    s = np.linspace(0, 2 * np.pi, 8 * K, endpoint=False)
    u, v, w, G, g3 = _fourier(fields, s)
    du, dv, dw, dG, dg3 = nu * _fourier(fields * (1j * np.arange(-K, K + 1)), s)
    a, b, c = float(top.a), float(top.b), float(top.wheel)
    A1, B1, C1 = float((1 - top.b) / top.a), float((top.a - 1) / top.b), float(top.b - top.a)
    F, k, y = [float(f) / e**2 for f in top.force], float(top.field) / e**2, [float(t) / e for t in top.tilt]
    g1, g2 = G.real, G.imag
    rates = (du + (A1 * w + c / a) * v - w * y[1] / a - e * ((F[1] * g3 - F[2] * g2) / a + k * A1 * g2 * g3),
             dv + (B1 * w - c / b) * u + w * y[0] / b - e * ((F[2] * g1 - F[0] * g3) / b + k * B1 * g1 * g3),
             dw - e**2 * (-C1 * u * v + y[0] * v - y[1] * u + F[0] * g2 - F[1] * g1 + k * C1 * g1 * g2),
             dG + 1j * w * G - 1j * e * (u + 1j * v) * g3, dg3 - e * (v * g1 - u * g2))
    return float(max(np.abs(r).max() for r in rates))


def _resonances(top: FastTop, order: int) -> tuple[Resonance, ...]:
    """Those within SMALL_DIVISOR whose harmonic the orders reach; C* = A and C* = B concern every order."""
    rows = [Resonance(0, ONE_MOMENT(moment=name), abs(float(top.spin / moment - 1)))
             for name, moment in (("A", top.a), ("B", top.b))]
    if top.Omega2 > 0:
        Omega = float(top.Omega2) ** 0.5
        for m in range(1, order + 1):
            # (Omega^2 - m^2)/(Omega + m) keeps the digits of a small distance
            rows.append(Resonance(m, _condition(top, m), abs(float(top.Omega2 - m * m)) / (Omega + m)))
    return tuple(sorted((r for r in rows if r.distance <= SMALL_DIVISOR * (1 + NEAR_SLACK)),
                        key=lambda r: r.distance))


def _condition(top, m) -> Reason:
    """For m = 1 the distance Omega^2 - 1 is C*(C* - A - B)/(A B): name the factor that is small."""
    if m != 1:
        return WHOLE_NUMBER(harmonic=m)
    return FIRST_OF_SPIN if abs(top.spin) < abs(top.spin - top.a - top.b) else FIRST_OF_MOMENTS


def _verdict(top, expansion, nearby, order, ahead, residual) -> tuple[str, Reason | None]:
    r0, reasons, status = abs(float(top.r0)), [], "asymptotic"
    if nearby:
        status = "near resonance"
        reasons += [NEAR_RESONANCE(resonance=r.condition, distance=Quantity(r.distance, digits=3))
                    for r in nearby if r.distance]
    if terms := _diverging(expansion.terms, ahead, residual):
        status = "diverging"
        reasons.append(NOT_FAST(terms=terms, small=Quantity(expansion.size, digits=3)))
    elif expansion.order >= 0:
        reasons.append(MISSES(residual=Quantity(residual, digits=2),
                              turned=Quantity(2 * np.pi * residual, digits=2),
                              terms=Quantity(tuple(expansion.terms[-2:]), digits=2)))
    if top.Omega2 < 0:
        status = "unstable"
        square = float(top.Omega2)
        reasons.append(UNSTABLE(square=Quantity(square, digits=3),
                                rate=PerSecond(r0 * abs(square)**0.5, digits=3)))
    if expansion.stopped is not None:
        status = "resonant"
        what = _condition(top, expansion.stopped) if expansion.stopped else EQUAL_MOMENT
        end = ENDS_AT(order=expansion.order) if expansion.order >= 0 else NO_START
        reasons.append(EXACTLY_RESONANT(resonance=what, end=end, order=order))
    return status, chained(*reasons)


def _diverging(terms, ahead, residual) -> Reason | None:
    """Why the series up to these terms is no approximation, None where it is: what is left out must be
    smaller than the last terms kept, by the terms of the next two orders and by the residual of the equations
    of motion."""
    if not terms or (retained := max(terms[-2:])) < SETTLED:
        return None
    # a term is measured against the two before it: one of them may hold nothing
    if len(terms) > 1 and terms[-1] > 0 and terms[-1] >= max(terms[-3:-1]):
        return DO_NOT_FALL(terms=Quantity(tuple(terms[-3:]), digits=3))
    if ahead and max(ahead) > 0 and max(ahead) >= retained:
        return NEXT_DO_NOT_FALL(terms=Quantity(tuple(terms[-2:]), digits=3),
                                ahead=Quantity(tuple(ahead), digits=3))
    if residual >= retained:
        return MISSES_MORE(residual=Quantity(residual, digits=3), terms=Quantity(retained, digits=3))
    return None


def _how_far(departure, wobble, left_out, r0, status) -> Reason:
    """What the given p, q say of the start; wobble: their departure from the series two orders further."""
    change = Rate(tuple(map(float, departure)))
    if status == "diverging":
        return DIFFERS(change=change)
    if float(np.hypot(*wobble)) <= left_out + ROUNDING * r0:
        return LIES_ON(error=Rate(left_out, digits=2))
    return IS_OFF(change=change)
