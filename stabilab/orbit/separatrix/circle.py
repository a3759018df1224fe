"""A homoclinic loop on a circle in plain floats: its far end, one loop at a time, without NumPy.

A place is (x, z) on its circle, g the numbers (G, c, d, mu) of the force mu + G x z + c z + d x.
"""
from __future__ import annotations

from math import acos, atan, atan2, copysign, cos, pi, sin, sqrt

EPS = 2.220446049250313e-16
TURN = 2 * pi
# what a loop does: it is none, it ends at a turning point, or at a saddle as high
NONE, ENDS, SHARED = 0, 1, 2
OWN = 1e-9                    # offsets below this are the saddle itself
# barriers that differ less from the saddle's height, relative to the energy's terms, are as high
LEVEL = 64 * EPS
# of the largest root of a cubic: smaller ones the closed form, a difference of numbers of its size, loses
# digits of
SPREAD = 1e-3
LOST = 1e-4                   # of a cubic's terms: a discriminant that is less may have the other sign
SHARPEST = 1e3                # bends tighter than the loop's length over this are not resolved


def force(g, x, z):
    return g[3] + g[0] * x * z + g[1] * z + g[2] * x


def slope(g, x, z):
    """dF/dtheta; positive at a barrier."""
    return g[0] * (z - x) * (z + x) - g[1] * x + g[2] * z


def moved(x, z, y):
    half = sin(0.5 * y)
    s, b = sin(y), -2 * half * half
    return x + (z * s + x * b), z + (z * b - x * s)


def y_minus_sin(y):
    """y - sin y without cancellation."""
    t = y * y
    if t < 0.49:
        return y * t * (1 / 6) * (1 - t * (1 / 20)
                                  * (1 - t * (1 / 42) * (1 - t * (1 / 72) * (1 - t * (1 / 110) * (
            1 - t * (1 / 156))))))
    return y - sin(y)


def rise(g, x, z, y):
    """V at the offset y over V at an equilibrium (x, z)."""
    half = sin(0.5 * y)
    b = -2 * half * half
    dx = z * sin(y) + x * b
    return -g[3] * y_minus_sin(y) - b * (g[0] * x * x + g[1] * x - g[2] * z) - 0.5 * g[0] * dx * dx


def settled(g, x, z):
    """The place moved along its circle to where the force vanishes, if that is near."""
    for _ in range(3):
        curved = slope(g, x, z)
        step = -force(g, x, z) / curved if curved != 0 else 0.0
        if not abs(step) < 0.5:
            break
        x, z = moved(x, z, step)
        if abs(step) < 1e-12:
            break
    return x, z


def others(g, x, z, side):
    """Distances to the other equilibria within one turn on one side, ascending, inf where there is none.

    Along the orbit F(y) = 2 sin(y/2) (a0 C^3 + a1 C^2 S + a2 C S^2 + a3 S^3) with C = cos(y/2), S = sin(y/2):
    a cubic for the tangent, or for the cotangent where the tangent may be infinite.
    """
    along, across = g[0] * (z - x) * (z + x), g[2] * z - g[1] * x
    a0, a3 = along + across, -(g[1] * z + g[2] * x)
    a1, a2 = a3 - 4 * g[0] * x * z, across - along
    if abs(a0) > abs(a3):
        first, second, third = real_cubic(a0, a1, a2, a3)
        first, second, third = 2 * atan2(1.0, first), 2 * atan2(1.0, second), 2 * atan2(1.0, third)
    else:
        first, second, third = real_cubic(a3, a2, a1, a0)
        first, second, third = 2 * atan(first), 2 * atan(second), 2 * atan(third)
    first, second, third = ahead(side * first), ahead(side * second), ahead(side * third)
    low, high = min(first, second), max(first, second)
    return min(low, third), max(low, min(high, third)), max(high, third)


def ahead(y):
    """An angle in (OWN, 2 pi]; inf for the saddle itself and for nan."""
    y = y + TURN if y < 0 else y
    return y if y > OWN else float("inf")


def real_cubic(a, b, c, d):
    """Real roots of a t^3 + b t^2 + c t + d, nan in place of those that are not, each with a step of Newton's
    method for what the closed form lost."""
    nan = float("nan")
    if a == 0:
        if b == 0:
            return (-d / c if c != 0 else nan), nan, nan
        disc = c * c - 4 * b * d
        if disc < 0:
            return nan, nan, nan
        far = -0.5 * (c + copysign(sqrt(disc), c))
        return (far / b, d / far, nan) if far != 0 else (0.0, nan, nan)
    p, q, r = b / a, c / a, d / a
    third = p / 3
    square, half = third * third - q / 3, third * (third * third - 0.5 * q) + 0.5 * r
    rest = half * half - square * square * square
    if rest < 0:
        size = sqrt(square)
        angle = acos(max(-1.0, min(1.0, half / (size * size * size)))) / 3
        first, second, last = (better(p, q, r, -2 * size * cos(angle) - third),
                               better(p, q, r, -2 * size * cos(angle + TURN / 3) - third),
                               better(p, q, r, -2 * size * cos(angle - TURN / 3) - third))
        most = (first if abs(first) >= max(abs(second), abs(last)) else second if abs(second) >= abs(last)
                else last)
        if min(abs(first), abs(second), abs(last)) < SPREAD * abs(most):
            return beside_largest(p, q, r, most)
        return first, second, last
    single = -copysign((abs(half) + sqrt(rest)) ** (1 / 3), half)
    only = better(p, q, r, single + (square / single if single != 0 else 0.0) - third)
    return (beside_largest(p, q, r, only) if rest <= LOST * half * half
            and only * only * abs(only) * SPREAD > abs(r) else (only, nan, nan))


def beside_largest(p, q, r, t):
    """The largest root t of t^3 + p t^2 + q t + r with the two much smaller ones, of which the closed form
    keeps no digit: those of the quadratic that is left, from its low powers up. nan where they are not
    real."""
    nan = float("nan")
    product = -r / t
    total = (q - product) / t
    disc = total * total - 4 * product
    if disc < 0:
        return t, nan, nan
    far = 0.5 * (total + copysign(sqrt(disc), total))
    return t, better(p, q, r, far), better(p, q, r, product / far) if far != 0 else 0.0


def better(p, q, r, t):
    """A root of t^3 + p t^2 + q t + r after one step of Newton's method."""
    steep = (3 * t + 2 * p) * t + q
    step = (((t + p) * t + q) * t + r) / steep if steep != 0 else 0.0
    return t - step if abs(step) < 1e-4 * abs(t) else t


def loop_end(g, sense, x, z, side):
    """(distance along the circle from a saddle to the far end of its loop on one side (-1, +1), distance to
    the deepest well inside, NONE or ENDS or SHARED).

    The loop ends where the potential beyond its wells is back at the saddle's height. sense: 0 without
    torque, where it may end at a barrier as high (SHARED), or at the saddle itself, one turn on; with torque
    the saddle then stands higher, or lower, by 2 pi mu.
    """
    low, high, deep, centre = 0.0, TURN, float("inf"), 0.0
    for t in others(g, x, z, side):
        if t == float("inf"):
            continue
        over = rise(g, x, z, side * t)
        there_x, there_z = moved(x, z, side * t)
        if slope(g, there_x, there_z) > 0:
            level = False
            if sense == 0:
                size = x * x + z * z
                level = abs(over) <= LEVEL * (abs(g[0]) * size + (abs(g[1]) + abs(g[2])) * sqrt(size))
            if level and low > 0:
                return t, centre, SHARED
            if over >= 0 or level:
                high = t
                break
        else:
            low = t
            if over < deep:
                deep, centre = over, t
    if low == 0:
        return 0.0, 0.0, NONE
    if high == TURN and sense == 0:
        return TURN, centre, SHARED
    if not rise(g, x, z, side * high) > 0:  # towards the torque the next turn lies lower
        return 0.0, 0.0, NONE
    end = crossing(lambda t: rise(g, x, z, side * t), lambda t: -side * force(g, *moved(x, z, side * t)), low,
                   high)
    return end, centre, ENDS


def crossing(height, slope_at, low, high):
    """Where the potential rises through the saddle's height between a well at `low` and `high`, distances
    from the saddle: Newton's method in a bracket. height, slope_at: of a distance.

    The first guess is exact for the cubic potential next to a fold, whose loop is half as long again as the
    way to the well.
    """
    t = min(1.5 * low, 0.5 * (low + high))
    for _ in range(200):
        value = height(t)
        if value > 0:
            high = t
        elif value < 0:
            low = t
        else:
            return t
        steep = slope_at(t)
        new = t - value / steep if steep > 0 else low
        if abs(new - t) <= 1e-9 * t:
            return new  # convergence is quadratic: the next step would be 1e-18
        if not low < new < high:
            new = 0.5 * (low + high)
            if not low < new < high:
                return new
        t = new
    return t
