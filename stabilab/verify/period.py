"""The period of a motion between two turning points: verified quadrature, with the root at each end bounded by hand."""
from __future__ import annotations

from .numbers import ball, hull, sign
from .zeros import Open, above, below


def period_of(orbit, ends, goal):
    """T = 2 int_l^r dalpha / sqrt(2 (E - U)) as a ball, to about `goal` bits. Raises Open where the precision does not do."""
    left, right = ends
    length = below(right) - above(left)
    if not length > 0:
        raise Open
    step = length / 2**(2 * goal // 3)  # this part of the way at each end is bounded by the force's range instead
    inner_left, inner_right = above(left) + step, below(right) - step
    total = _end(orbit, left, inner_left) + _end(orbit, right, inner_right)
    return 2 * (total + _integral(orbit, ball(inner_left), ball(inner_right), goal))


def round_once(orbit, goal):
    """Time of one turn of a circle without torque, over every barrier."""
    return _integral(orbit, ball(0), orbit.turn, goal)


def _integral(orbit, low, high, goal):
    """int dalpha / sqrt(2 (E - U)) where E - U is positive."""
    from flint import acb

    def integrand(z, analytic):
        # mean-value form: U's terms cancel, and over a wide ball their sum alone would be far too wide
        centre = z.mid()
        return _rsqrt(2 * (orbit.force(z) * (z - centre) - orbit.excess(centre)), analytic)
    value = acb.integral(integrand, acb(low), acb(high), rel_tol=2.0**-goal, eval_limit=200_000)
    if not value.is_finite():
        raise Open
    return value.real


def _rsqrt(w, analytic):
    """1/sqrt(w); not a number where the ball meets the branch cut and analyticity is asked for."""
    from flint import acb
    if analytic and not w.real > 0 and 0 in w.imag:
        return acb("nan")
    return w.rsqrt()


def _end(orbit, turning, inner):
    """int from the turning point to `inner` of dalpha/sqrt(2 (E - U)): E - U is between f and F times the distance."""
    outer = below(turning) if ball(inner) > turning else above(turning)
    force = abs(orbit.force(hull(*sorted((outer, inner)))))
    if sign(force) != 1:
        raise Open
    distance = abs(ball(inner) - turning)
    # int_0^d dx/sqrt(2 f x) = sqrt(2 d/f), f somewhere in the range of the force
    return (2 * distance / force).sqrt()
