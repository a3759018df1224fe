"""Loops whose orbits are centred far away, as straight lines of floats for numba to compile: what `far_centre` does for the rows of arrays, a row at a time.

far holds the numbers `FAR_NUMBERS` names of a landscape, way a saddle (u, v) as `far_centre.Orbits` takes it.
"""
from __future__ import annotations

from math import copysign, isfinite, sqrt

FAR_TURN, FAR_STEPS, LEAST = 0.1, 10, 2.2250738585072014e-308
# p, q, p0, q0, kappa, rho, sigma, m; the asymptotes and the product of the ways from them; Z's scale; the size of places from which on the centre is near
# (negative: no row is far), that of the asymptotes; n, and the sign of theta
FAR_NUMBERS = range(16)
P, Q, P0, Q0, KAPPA, RHO, SIGMA, CONSTANT, FIRST_LINE, SECOND_LINE, PRODUCT, SCALE, NEAR_CENTRE, LINES, RATE, FLIP = FAR_NUMBERS


def far_way(far, h):
    """(u, v, whether it is much nearer than the centre) of the saddle at h on the hyperbola of equilibria (`far_centre.saddles_of`)."""
    u, v = far[PRODUCT] / h, far[SCALE] * h
    return u, v, abs(u) + abs(v) + far[LINES] < far[NEAR_CENTRE]


def far_orbit(far, u, v):
    """(u, v, a, b, steep, bent, both, curl) of `far_centre.Orbits`."""
    here_u, here_v = u + far[FIRST_LINE], v + far[SECOND_LINE]
    p, q, kappa = far[P], far[Q], far[KAPPA]
    a, b = p * here_v + far[P0], q * here_u + far[Q0]
    return here_u, here_v, a, b, kappa * (a * v + b * u), kappa * (p * b * v + q * a * u), kappa * a * b, 0.5 * kappa * (q * a * a + p * b * b)


def far_series(pq, alpha):
    t = pq * alpha * alpha
    return (1 + t * (1 / 6) * (1 + t * (1 / 20) * (1 + t * (1 / 42) * (1 + t * (1 / 72)))),
            0.5 * (1 + t * (1 / 12) * (1 + t * (1 / 30) * (1 + t * (1 / 56) * (1 + t * (1 / 90))))),
            (1 / 6) * (1 + t * (1 / 20) * (1 + t * (1 / 42) * (1 + t * (1 / 72) * (1 + t * (1 / 110))))))


def far_moved(far, orbit, alpha):
    """(omega_j, omega_k) at alpha."""
    u, v, a, b, _, _, _, _ = orbit
    s, c, _ = far_series(far[P] * far[Q], alpha)
    S, C = s * alpha, c * alpha * alpha
    return u + (a * S + far[P] * b * C), v + (b * S + far[Q] * a * C)


def far_fall(far, orbit, alpha):
    """How far the potential lies below the saddle's height, over alpha^2."""
    _, _, _, _, steep, bent, both, curl = orbit
    s, c, third = far_series(far[P] * far[Q], alpha)
    return steep * c + (bent * third + both * (s * c - third)) * alpha + curl * c * c * alpha * alpha


def far_force(far, orbit, alpha):
    """The force over alpha."""
    _, _, a, b, steep, bent, _, _ = orbit
    s, c, _ = far_series(far[P] * far[Q], alpha)
    du, dv = a * s + far[P] * b * c * alpha, b * s + far[Q] * a * c * alpha
    return steep * s + bent * c * alpha + far[KAPPA] * du * dv * alpha


def far_root(far, orbit, side, first, second, third, of_force):
    """The root on one side of what is nearly first + second x + third x^2, with first > 0 > third: of the force, or of the fall; nan where there is none."""
    if not (first > 0 and third < 0):
        return float("nan")
    half = -0.5 * (second + copysign(sqrt(second * second - 4 * first * third), second))
    one, other = half / third, first / half
    x = one if one * side > 0 else other
    for _ in range(FAR_STEPS):
        value = far_force(far, orbit, x) if of_force else far_fall(far, orbit, x)
        step = value / (second + 2 * third * x)
        if abs(step) < 0.5 * abs(x):  # else, and where it is no number, x stays
            x -= step
        if not abs(step) > 1e-17 * abs(x):
            break
    return x if x * side > 0 else float("nan")


def far_ends(far, u, v, side, rests):
    """(alpha of the far end, alpha of the well, whether both are told well) of the loop of the saddle (u, v); rests: at the fold, where the loop is a point."""
    orbit = far_orbit(far, u, v)
    _, _, _, _, steep, bent, both, curl = orbit
    end, deep = 0.0, 0.0
    if not rests:
        end = far_root(far, orbit, side, steep / 2, bent / 6 + both / 3, curl / 4, False)
        deep = far_root(far, orbit, side, steep, bent / 2 + both, curl, True)
    if not (isfinite(end) and isfinite(deep) and far[RATE] * abs(end) < FAR_TURN):
        return 0.0, 0.0, False
    first, second = far_moved(far, orbit, end)
    return end, deep, max(abs(first), abs(second)) < far[NEAR_CENTRE]


def far_sharpness(far, orbit, end):
    """How sharply the loop bends at its far end: the way there times the bend of the potential over its slope."""
    u, v = far_moved(far, orbit, end)
    a, b = far[P] * v + far[P0], far[Q] * u + far[Q0]
    kappa, rho, sigma = far[KAPPA], far[RHO], far[SIGMA]
    pull = abs(kappa * u * v + rho * v + sigma * u + far[CONSTANT])
    return abs(end) * (kappa * (a * v + u * b) + rho * b + sigma * a) / max(pull, LEAST)


def far_row(far, orbit, side, alpha, first, second, w):
    """Fill first and second (m,) with omega_j and omega_k at alpha (m,), and w (m,) with omega_i + s there."""
    u, v, a, b, steep, bent, both, curl = orbit
    p, q = far[P], far[Q]
    for n in range(len(alpha)):
        x = alpha[n]
        s, c, third = far_series(p * q, x)
        S, C = s * x, c * x * x
        first[n], second[n] = u + (a * S + p * b * C), v + (b * S + q * a * C)
        w[n] = side * (abs(x) * sqrt(2 * max(steep * c + (bent * third + both * (s * c - third)) * x + curl * c * c * x * x, 0.0)))
    w[0] = w[len(alpha) - 1] = 0.0


def far_well(far, orbit, alpha):
    """(omega_j, omega_k) of the well at alpha (`far_centre.Orbits.wells`)."""
    u, v = far_moved(far, orbit, alpha)
    first, second, product = u - far[FIRST_LINE], v - far[SECOND_LINE], far[PRODUCT] * far[SCALE]
    if abs(second) > abs(first):
        return product / second + far[FIRST_LINE], v
    return u, product / first + far[SECOND_LINE]


def far_departures(far, orbit, alpha, first, second, x_j, x_k, w, out):
    """Fill out (m,) with the residuals of rounded places x_j, x_k, w (m,) beside those told at alpha (`far_centre.residual_far`)."""
    p, q, p0, q0 = far[P], far[Q], far[P0], far[Q0]
    kappa, rho, sigma, constant = abs(far[KAPPA]), abs(far[RHO]), abs(far[SIGMA]), abs(far[CONSTANT])
    for n in range(len(alpha)):
        along, across = p * second[n] + p0, q * first[n] + q0
        off_j, off_k = x_j[n] - first[n], x_k[n] - second[n]
        square = max(along * along + across * across, LEAST)
        j, k, kinetic = abs(x_j[n]), abs(x_k[n]), 0.5 * w[n] * w[n]
        beside = abs(off_j * across - off_k * along) / sqrt(square) / max(j + k, LEAST)
        x = alpha[n] + (off_j * along + off_k * across) / square
        departure = abs(kinetic - x * x * far_fall(far, orbit, x))
        terms = kinetic + (kappa * j * k + rho * k + sigma * j + constant) * abs(x)
        out[n] = max(departure / max(terms, LEAST) if departure > 0 else 0.0, beside if beside > 0 else 0.0)
