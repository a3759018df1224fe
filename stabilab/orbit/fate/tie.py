"""Is a state exactly on the separatrix? Algebra says so where precision never could.

With a torque and a circle or hyperbola the answer is no, but for the equilibrium itself, by Lindemann's theorem (proof:
docs/mathematics/separatrix.md). Without a torque, and on a parabola, everything is a rational function of one root of a rational polynomial, and
a greatest common divisor decides.
"""
from __future__ import annotations

from fractions import Fraction

from ...numbers.balls import polynomial, rational, shares_root


def exact_tie(orbit) -> bool:
    """Whether each barrier that the balls of `orbit` (a BallOrbit) cannot tell from the energy equals it exactly.

    To be asked at the working precision at which the orbit was made; inputs are exact. False where a torque acts on a
    circle or a hyperbola. A barrier whose ball is clear of the energy plays no part.
    """
    close = [s for s in orbit.barriers() if 0 in orbit.height(s.y) - orbit.energy]
    if not close:
        return False
    tied = _on_parabola if orbit.r.e == 0 else _on_conic
    return all(tied(orbit, spot) for spot in close)


def _on_parabola(orbit, spot) -> bool:
    """F and V - E share the root: both are polynomials in the offset."""
    f = orbit.taylor
    height = polynomial(0, *(-Fraction(c) / (n + 1) for n, c in enumerate(f)))
    speed = Fraction(orbit.state[orbit.r.axis]) + orbit.r.s
    return shares_root(polynomial(*f), height - polynomial(speed * speed / 2), spot.y)


def _on_conic(orbit, spot) -> bool:
    """Without torque V is a polynomial in U = omega_j + s_j and V = omega_k + s_k, and U a rational function of V (or the
    equilibria lie on two lines); under a torque never."""
    r = orbit.r
    if r.sense:
        return False
    ap, aq, sp = abs(r.p), abs(r.q), 1 if r.p > 0 else -1
    (sj, sk), (rho, sigma), m = r.centre, r.across, r.torque
    u0, v0, speed = orbit.u + sj, orbit.v + sk, Fraction(orbit.state[r.axis]) + r.s
    at_u, at_v = orbit.components(spot.y)
    U, V = at_u + orbit.shift_j, at_v + orbit.shift_k

    def excess(u, v, one):
        """Height minus energy, with u, v polynomials over the polynomial `one`, times its square; in units of w^2/(ap aq)."""
        q = rational
        rise = q(-sp * aq * r.kappa / 2) * (u * u - q(u0 * u0) * one * one) - q(sp * aq * rho) * (u * one - q(u0) * one * one)
        return rise - q(Fraction(r.e) * sp * ap * sigma) * (v * one - q(v0) * one * one) - q(ap * aq * speed * speed / 2) * one * one

    x, one = polynomial(0, 1), polynomial(1)
    if r.kappa and r.kappa * m == rho * sigma:
        line_v, line_u = -sigma / r.kappa, -rho / r.kappa
        if V.contains(rational(line_v)) and shares_root(polynomial(line_v**2 / aq - orbit.Q, 0, Fraction(-r.e) / ap), excess(x, polynomial(line_v), one), U):
            return True
        return U.contains(rational(line_u)) and shares_root(
            polynomial(-orbit.Q - r.e * line_u**2 / ap, 0, 1 / aq), excess(polynomial(line_u), x, one), V)
    if r.kappa or sigma:
        top, bottom = polynomial(m, rho), polynomial(sigma, r.kappa)
        equation = polynomial(-orbit.Q, 0, 1 / aq) * bottom * bottom - rational(Fraction(r.e) / ap) * top * top
        return shares_root(equation, excess(-top, x * bottom, bottom), V)
    line_v = -m / rho
    return shares_root(polynomial(line_v**2 / aq - orbit.Q, 0, Fraction(-r.e) / ap), excess(x, polynomial(line_v), one), U)
