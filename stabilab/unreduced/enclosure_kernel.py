"""Validated steps of a gyrostat under a constant torque, as straight lines of floats that numba compiles.

The motion w' = f(w), f_i = kappa_i w_j w_k + rho_i w_k + sigma_i w_j + m_i (cyclic), from every start of the
set c + B r, |r_i| <= rad_i, is enclosed one step h further by a set of the same kind: B goes along with the
derivative of the motion, and where its columns become too nearly parallel it is made orthogonal (Lohner). The
centre c is a sum of two doubles.

A step. p = sum of a_n s^n, n <= N, is the Taylor polynomial of the motion w of the centre as it is computed;
its residue is d = p' - f(p). Below degree N the residue is rounding alone: the computed coefficients obey the
recursion but for FINE times the sum of the sizes of what is added up. From degree N on it is what the
products of coefficients leave over. With alpha_n = |a_n| h^n, P their sum, and the tails of these sums, the
integral of |d| over the step is at most

    h [FINE (|kappa| P_j P_k + |rho| P_k + |sigma| P_j + |m|) + (|kappa| sum over m + n >= N of alpha_j,m
    alpha_k,n + |rho| alpha_k,N + |sigma| alpha_j,N)/(N + 1)].

The error e = w - p obeys e' = A(p) e + (kappa e e) - d, A the derivative of f. Let G = exp(h A+), A+ the
matrix of the sizes of A's entries for rates of at most S+ = S + margin, where S bounds the rates over the
step: by P, or by the energy, since |D^(1/2) w| grows at most at the rate |D^(-1/2) M|. By Gronwall's
inequality for such (cooperative) systems |e| <= G times the integral of |d|, as long as twice the result
stays below half the margin. No box has to be guessed, and the step is as long as the polynomial allows:
whatever turns gently costs no more than a plain integrator's step.

The difference u = w(c + B r) - w(c) obeys u' = A(w) u + (kappa u u), so |u| <= G |B| rad =: U as long as U is
below half the margin, and it is the linear part J B r (J' = A(w) J) up to h G (kappa U U). V = J B is
computed in doubles as a polynomial; its residue is bounded as above with COARSE, and also by |e|, and
Gronwall's inequality bounds its error. The radii are of the size 1e-27 where a motion is not sensitive, so
doubles are enough for all but the centre.

Between the times: |w(c + B r) - p| <= |e| + U, all along the step.

A direction n at rest in space, n' = n x w, |n| = 1, goes along where one is given, about a polynomial q that
is made with p. Its error g = n - q obeys g' = g x w + q x (w - p) - d, d = q' - q x p the residue, which is
bounded as that of p. As g x w is normal to g, and |q| <= |n| + |g|, |g| grows over a step by at most 2.5 h
times the bound of |w - p| and the integral of |d|, as long as it stays below 1.

Rounding. Doubles to nearest, no operation fused with another or rearranged (numba without fastmath gives LLVM
no leave to; a test holds it). A sum of at most N + 1 products of twofold numbers, exact products and sums
(Dekker, Knuth) with what they leave gathered in one double, errs by less than 2^-93 of the sum of sizes: 4 (N
+ 1) additions to a corrective sum, each within 2^-53 of a sum of at most (N + 4)
2^-53 of the sizes. FINE = 2^-92 holds the twofold products with coefficients and the division beside it;
scenes' numbers are rounded to two doubles (2^-105). COARSE = 2^-44 holds N + 1 products in doubles. Bounds
are sums and products of numbers that are not negative, fewer than
2^20 roundings each: WIDER. TINY, far below all that counts, holds what underflow could take. Everything is in
the scene's natural unit, and the time of a step's polynomials in a power of two, so that nothing comes near
the ends of the range; what does is given up.
"""
from __future__ import annotations

from math import frexp, inf, ldexp, sqrt

import numpy as np

from ..numbers.error_free import add, exact_product, exact_sum, halves, less, scaled, times

ORDER = 36
FINE, COARSE, WIDER, TINY = 2.0**-92, 2.0**-44, 1.0 + 2.0**-30, 1e-200
MARGIN = 2.0**-12
PARALLEL = 2.0**12  # of directions that are kept: sizes in the product of their matrix with its inverse
LEAST, MOST = 1e-30, 1e30  # sizes of rates in natural units that are followed
HALVINGS = 12
# at its time; out of steps; the set is too wide; steps below the time's grain
DONE, GOING, LOST, ENDLESS = 0, 1, 2, 3


def divided(x: tuple[float, float], n: float):
    """A twofold number over a small whole number."""
    q = x[0] / n
    p, e = exact_product(q, n)
    return exact_sum(q, ((x[0] - p) - e + x[1]) / n)


def series(numbers: np.ndarray, low_numbers: np.ndarray, unit: float, a: np.ndarray, low: np.ndarray):
    """Taylor coefficients a + low, (3, N + 1) each, of the motion from a[:, 0] + low[:, 0], in time over
    `unit` (a power of two)."""
    high, rest = np.empty((3, ORDER + 1)), np.empty((3, ORDER + 1))
    for i in range(3):
        high[i, 0], rest[i, 0] = halves(a[i, 0])
    for n in range(ORDER):
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            total, rest_of_total = 0.0, 0.0
            for m in range(n + 1):
                x, y = a[j, m], a[k, n - m]
                x1, x2, y1, y2 = high[j, m], rest[j, m], high[k, n - m], rest[k, n - m]
                p = x * y
                e = ((x1 * y1 - p) + x1 * y2 + x2 * y1) + x2 * y2
                total, f = exact_sum(total, p)
                rest_of_total += f + (e + (x * low[k, n - m] + low[j, m] * y))
            v = times(exact_sum(total, rest_of_total), (numbers[0, i], low_numbers[0, i]))
            v = add(v, times((a[k, n], low[k, n]), (numbers[1, i], low_numbers[1, i])))
            v = add(v, times((a[j, n], low[j, n]), (numbers[2, i], low_numbers[2, i])))
            if n == 0:
                v = add(v, (numbers[3, i], low_numbers[3, i]))
            v = divided((v[0] * unit, v[1] * unit), n + 1.0)
            a[i, n + 1], low[i, n + 1] = v
            high[i, n + 1], rest[i, n + 1] = halves(v[0])


def variations(numbers: np.ndarray, unit: float, a: np.ndarray, B: np.ndarray, V: np.ndarray):
    """Taylor coefficients V (N + 1, 3, 3) of the solution of V' = A(w) V, V = B at first, in doubles."""
    for i in range(3):
        for c in range(3):
            V[0, i, c] = B[i, c]
    for n in range(ORDER):
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            s0, s1, s2 = 0.0, 0.0, 0.0
            for m in range(n + 1):
                x, y = a[j, n - m], a[k, n - m]
                s0 += x * V[m, k, 0] + y * V[m, j, 0]
                s1 += x * V[m, k, 1] + y * V[m, j, 1]
                s2 += x * V[m, k, 2] + y * V[m, j, 2]
            over = unit / (n + 1.0)
            V[n + 1, i, 0] = (numbers[0, i] * s0 + numbers[1, i] * V[n, k, 0]
                              + numbers[2, i] * V[n, j, 0]) * over
            V[n + 1, i, 1] = (numbers[0, i] * s1 + numbers[1, i] * V[n, k, 1]
                              + numbers[2, i] * V[n, j, 1]) * over
            V[n + 1, i, 2] = (numbers[0, i] * s2 + numbers[1, i] * V[n, k, 2]
                              + numbers[2, i] * V[n, j, 2]) * over


def product_term(x: np.ndarray, low_x: np.ndarray, y: np.ndarray, low_y: np.ndarray, n: int):
    """The coefficient of power n of a product of two series of twofold numbers."""
    total, rest = 0.0, 0.0
    for m in range(n + 1):
        p, e = exact_product(x[m], y[n - m])
        total, f = exact_sum(total, p)
        rest += f + (e + (x[m] * low_y[n - m] + low_x[m] * y[n - m]))
    return exact_sum(total, rest)


def series_of_direction(unit: float, a: np.ndarray, low: np.ndarray, c: np.ndarray, low_c: np.ndarray):
    """Taylor coefficients c + low_c, (3, N + 1) each, of n' = n x w from c[:, 0] + low_c[:, 0], w those of
    `series`."""
    for n in range(ORDER):
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            v = less(product_term(c[j], low_c[j], a[k], low[k], n),
                     product_term(c[k], low_c[k], a[j], low[j], n))
            c[i, n + 1], low_c[i, n + 1] = divided((v[0] * unit, v[1] * unit), n + 1.0)


def longest(a: np.ndarray, tolerance: float):
    """The step, in the unit of the coefficients, that the last two of them allow: the tail is the tolerance
    of the state's size."""
    size = max(abs(a[0, 0]), abs(a[1, 0]), abs(a[2, 0]))
    size = max(size, abs(a[0, 1]), abs(a[1, 1]), abs(a[2, 1])) if size == 0.0 else size
    shortest = 16.0
    for n in (ORDER - 1, ORDER):
        top = max(abs(a[0, n]), abs(a[1, n]), abs(a[2, n]))
        if top > 0.0:
            shortest = min(shortest, (tolerance * size / top) ** (1.0 / n))
    return shortest


def beyond(alpha: np.ndarray, beta: np.ndarray, tails: np.ndarray):
    """Sums of alpha_m beta_n over m + n >= N, m, n <= N; tails: those of beta, (N + 2,)."""
    total = 0.0
    for n in range(ORDER, -1, -1):
        tails[n] = tails[n + 1] + beta[n]
    for m in range(ORDER + 1):
        total += alpha[m] * tails[ORDER - m]
    return total


def bound_of_flow(M: np.ndarray, G: np.ndarray):
    """G >= exp(M) for a matrix of numbers that are not negative: its powers by halves, then squares."""
    norm, halves = 0.0, 0
    for i in range(3):
        norm = max(norm, M[i, 0] + M[i, 1] + M[i, 2])
    if not norm < 512.0:
        for i in range(3):  # a slice would take the compiler a second
            for j in range(3):
                G[i, j] = inf
        return
    while norm > 0.25:
        norm, halves = norm * 0.5, halves + 1
    part = ldexp(1.0, -halves)
    term, new = np.zeros((3, 3)), np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            term[i, j] = 1.0 if i == j else 0.0
            G[i, j] = term[i, j] + 1e-12  # what is left of the series from degree 10 on: 0.25^10/10! and less
    for n in range(1, 10):
        for i in range(3):
            for j in range(3):
                new[i, j] = (term[i, 0] * M[0, j] + term[i, 1] * M[1, j] + term[i, 2] * M[2, j]) * (part / n)
        for i in range(3):
            for j in range(3):
                term[i, j] = new[i, j]
                G[i, j] += new[i, j]
    for _ in range(halves):
        for i in range(3):
            for j in range(3):
                new[i, j] = G[i, 0] * G[0, j] + G[i, 1] * G[1, j] + G[i, 2] * G[2, j]
        for i in range(3):
            for j in range(3):
                G[i, j] = new[i, j] * WIDER


def length_of(x: float, y: float, z: float):
    """The length of a vector. By products: a power of two is one for the compiler, and need not be for the
    interpreter."""
    return sqrt(x * x + y * y + z * z)


def judged(numbers: np.ndarray, energy: np.ndarray, a: np.ndarray, V: np.ndarray, B: np.ndarray,
           rad: np.ndarray, h: float, x: float, error: np.ndarray, spread: np.ndarray, moved: np.ndarray,
           E: np.ndarray, P: np.ndarray):
    """Bounds of one step of length h (x in the unit of the coefficients a, V): |w - p| (error), |u| (spread),
    what it is beside V's part (moved), the error of each column of V (E), the sums P; True where they hold.
    """
    alpha = np.empty((3, ORDER + 1))
    P[0], P[1], P[2] = 0.0, 0.0, 0.0
    v, vsum, tails = np.empty((3, 3, ORDER + 1)), np.zeros((3, 3)), np.zeros(ORDER + 2)
    power = 1.0
    for n in range(ORDER + 1):
        for i in range(3):
            alpha[i, n] = abs(a[i, n]) * power * WIDER
            P[i] += alpha[i, n]
            for c in range(3):
                v[i, c, n] = abs(V[n, i, c]) * power * WIDER
                vsum[i, c] += v[i, c, n]
        power *= x
    size, S = 0.0, np.zeros(3)
    start = length_of(a[0, 0] * energy[0], a[1, 0] * energy[1], a[2, 0] * energy[2]) + energy[3] * h
    for i in range(3):
        S[i] = P[i] * WIDER
        if energy[i] > 0.0:
            S[i] = min(S[i], start / energy[i] * WIDER)
        size = max(size, S[i])
    margin = MARGIN * size
    M, G, d = np.zeros((3, 3)), np.empty((3, 3)), np.zeros(3)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        kappa, rho, sigma, m = abs(numbers[0, i]), abs(numbers[1, i]), abs(numbers[2, i]), abs(numbers[3, i])
        M[i, k] = (kappa * (S[j] + margin) + rho) * h * WIDER
        M[i, j] = (kappa * (S[k] + margin) + sigma) * h * WIDER
        rounding = FINE * (kappa * P[j] * P[k] + rho * P[k] + sigma * P[j] + m)
        tail = kappa * beyond(alpha[j], alpha[k], tails) + rho * alpha[k, ORDER] + sigma * alpha[j, ORDER]
        d[i] = h * (rounding + tail / (ORDER + 1)) * WIDER + TINY
    bound_of_flow(M, G)
    reach = np.zeros(3)
    for i in range(3):
        reach[i] = abs(B[i, 0]) * rad[0] + abs(B[i, 1]) * rad[1] + abs(B[i, 2]) * rad[2]
    for i in range(3):
        error[i] = (G[i, 0] * d[0] + G[i, 1] * d[1] + G[i, 2] * d[2]) * WIDER
        spread[i] = (G[i, 0] * reach[0] + G[i, 1] * reach[1] + G[i, 2] * reach[2]) * WIDER
    for i in range(3):
        if not (error[i] <= 0.125 * margin and spread[i] <= 0.25 * margin):
            return False
    quadratic = np.zeros(3)
    for i in range(3):
        quadratic[i] = h * abs(numbers[0, i]) * spread[(i + 1) % 3] * spread[(i + 2) % 3]
    D = np.zeros((3, 3))
    for c in range(3):
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            kappa, rho, sigma = abs(numbers[0, i]), abs(numbers[1, i]), abs(numbers[2, i])
            rounding = (COARSE * (kappa * (P[j] * vsum[k, c] + P[k] * vsum[j, c]) + rho * vsum[k, c]
                                  + sigma * vsum[j, c]))
            moving = kappa * (error[j] * vsum[k, c] + error[k] * vsum[j, c])
            tail = (kappa * (beyond(alpha[j], v[k, c], tails) + beyond(alpha[k], v[j, c], tails))
                    + rho * v[k, c, ORDER] + sigma * v[j, c, ORDER])
            D[i, c] = h * (rounding + moving + tail / (ORDER + 1)) * WIDER
    for i in range(3):
        moved[i] = (G[i, 0] * quadratic[0] + G[i, 1] * quadratic[1] + G[i, 2] * quadratic[2]) * WIDER
        moved[i] += (error[i] + FINE * P[i]) * WIDER + TINY
        for c in range(3):
            E[i, c] = (G[i, 0] * D[0, c] + G[i, 1] * D[1, c] + G[i, 2] * D[2, c]
                       + COARSE * vsum[i, c]) * WIDER
    return True


def strayed(a: np.ndarray, c: np.ndarray, h: float, x: float, error: np.ndarray, spread: np.ndarray,
            off: float, C: np.ndarray):
    """A bound of the error of the direction all along a step, that of its start being `off`; C: the sums of
    sizes of its polynomials c. Of `judged`: h, x, error, spread."""
    alpha, gamma, tails = np.empty((3, ORDER + 1)), np.empty((3, ORDER + 1)), np.zeros(ORDER + 2)
    P, d, power = np.zeros(3), np.empty(3), 1.0
    C[0], C[1], C[2] = 0.0, 0.0, 0.0
    for n in range(ORDER + 1):
        for i in range(3):
            alpha[i, n], gamma[i, n] = abs(a[i, n]) * power * WIDER, abs(c[i, n]) * power * WIDER
            P[i] += alpha[i, n]
            C[i] += gamma[i, n]
        power *= x
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        tail = beyond(gamma[j], alpha[k], tails) + beyond(gamma[k], alpha[j], tails)
        d[i] = h * (FINE * (C[j] * P[k] + C[k] * P[j]) + tail / (ORDER + 1)) * WIDER + TINY
    rates = length_of(error[0] + spread[0], error[1] + spread[1], error[2] + spread[2])
    return (off + 2.5 * h * rates + length_of(d[0], d[1], d[2])) * WIDER


def radii_in(Y: np.ndarray, slip: float, M: np.ndarray, rest: np.ndarray, rad: np.ndarray):
    """Radii rad of the set {M r + rest}, |r| <= rad, |rest_i| <= rest, in directions B whose inverse is Y but
    for the slip: y = Y x + (1 - Y B) y."""
    new, widest = np.empty(3), 0.0
    for i in range(3):
        total = 0.0
        for c in range(3):
            x, y, z = Y[i, 0] * M[0, c], Y[i, 1] * M[1, c], Y[i, 2] * M[2, c]
            total += (abs(x + y + z) + 2.0**-48 * (abs(x) + abs(y) + abs(z))) * rad[c]
        new[i] = total + abs(Y[i, 0]) * rest[0] + abs(Y[i, 1]) * rest[1] + abs(Y[i, 2]) * rest[2]
        widest = max(widest, new[i])
    for i in range(3):
        rad[i] = (new[i] + 3.0 * slip / (1.0 - 3.0 * slip) * widest) * WIDER


def taken_along(M: np.ndarray, rest: np.ndarray, rad: np.ndarray, B: np.ndarray):
    """The set {M r + rest}, |r| <= rad, |rest_i| <= rest, with M's own columns, of length 1, as directions B:
    nothing is wrapped but `rest`. False, and B and rad as they were, where these are too nearly parallel."""
    N, Y = np.empty((3, 3)), np.empty((3, 3))
    for c in range(3):
        length = length_of(M[0, c], M[1, c], M[2, c]) + TINY
        for i in range(3):
            N[i, c] = M[i, c] / length
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        for c in range(3):
            d, e = (c + 1) % 3, (c + 2) % 3
            Y[c, i] = N[j, d] * N[k, e] - N[j, e] * N[k, d]
    volume = N[0, 0] * Y[0, 0] + N[1, 0] * Y[0, 1] + N[2, 0] * Y[0, 2]
    if not abs(volume) * PARALLEL > 1.0:
        return False
    slip, parallel = 0.0, 0.0
    for i in range(3):
        for j in range(3):
            Y[i, j] /= volume
    for i in range(3):
        for c in range(3):
            x, y, z = Y[i, 0] * N[0, c], Y[i, 1] * N[1, c], Y[i, 2] * N[2, c]
            slip = max(slip, abs(x + y + z - (1.0 if i == c else 0.0)))
            parallel = max(parallel, abs(x) + abs(y) + abs(z))
    slip += 2.0**-48 * parallel
    if not parallel < PARALLEL or not slip < 1e-6:
        return False
    radii_in(Y, slip, M, rest, rad)
    for i in range(3):
        for c in range(3):
            B[i, c] = N[i, c]
    return True


def turned(M: np.ndarray, rest: np.ndarray, rad: np.ndarray, B: np.ndarray):
    """New directions B and radii rad of the set {M r + rest}, |r| <= rad, |rest_i| <= rest: orthogonal, the
    longest edge first (Lohner)."""
    edges = np.empty(3)
    for c in range(3):
        edges[c] = length_of(M[0, c], M[1, c], M[2, c]) * rad[c]
    first = 0 if edges[0] >= edges[1] and edges[0] >= edges[2] else (1 if edges[1] >= edges[2] else 2)
    item, two = (first + 1) % 3, (first + 2) % 3
    second = item if edges[item] >= edges[two] else two
    q, r, s, Y = np.empty(3), np.empty(3), np.empty(3), np.empty((3, 3))
    length = length_of(M[0, first], M[1, first], M[2, first]) + TINY
    for i in range(3):
        q[i] = M[i, first] / length
        r[i] = M[i, second]
    for _ in range(2):
        along = q[0] * r[0] + q[1] * r[1] + q[2] * r[2]
        for i in range(3):
            r[i] -= along * q[i]
        length = length_of(r[0], r[1], r[2]) + TINY
        for i in range(3):
            r[i] /= length
    s[0], s[1], s[2] = q[1] * r[2] - q[2] * r[1], q[2] * r[0] - q[0] * r[2], q[0] * r[1] - q[1] * r[0]
    for i in range(3):
        B[i, 0], B[i, 1], B[i, 2] = q[i], r[i], s[i]
    slip = 0.0
    for i in range(3):
        for j in range(3):
            dot = B[0, i] * B[0, j] + B[1, i] * B[1, j] + B[2, i] * B[2, j]
            slip = max(slip, abs(dot - (1.0 if i == j else 0.0)))
    slip += 2.0**-48
    if not slip < 1e-6:  # an edge without length or direction: a box along the axes
        for i in range(3):
            q[i] = abs(M[i, 0]) * rad[0] + abs(M[i, 1]) * rad[1] + abs(M[i, 2]) * rad[2] + rest[i]
        for i in range(3):
            rad[i] = q[i] * WIDER
            for c in range(3):
                B[i, c] = 1.0 if i == c else 0.0
        return
    for i in range(3):
        for c in range(3):
            Y[i, c] = B[c, i]
    radii_in(Y, slip, M, rest, rad)


def at_end(a: np.ndarray, low: np.ndarray, x: float, centre: np.ndarray, low_centre: np.ndarray):
    """The polynomials' values at x in twofold numbers, by Horner's rule: within 2^-93 of the sum of sizes."""
    for i in range(3):
        v = a[i, ORDER], low[i, ORDER]
        for n in range(ORDER - 1, -1, -1):
            v = add(scaled(v, x), (a[i, n], low[i, n]))
        centre[i], low_centre[i] = v


def end_of_variations(V: np.ndarray, x: float, M: np.ndarray):
    """The values of V's polynomials at x."""
    for i in range(3):
        for c in range(3):
            value = V[ORDER, i, c]
            for n in range(ORDER - 1, -1, -1):
                value = value * x + V[n, i, c]
            M[i, c] = value


def on_grain(length: float, grain: float):
    """The greatest whole number of grains that is not above a length."""
    return float(int(length / grain)) * grain


def advance(numbers: np.ndarray, low_numbers: np.ndarray, energy: np.ndarray, tolerance: float, t: float,
            t_end: float, grain: float, steps: int, centre: np.ndarray, low_centre: np.ndarray, B: np.ndarray,
            rad: np.ndarray, direction: np.ndarray, low_direction: np.ndarray, off: np.ndarray,
            times: np.ndarray, polynomials: np.ndarray, radii: np.ndarray):
    """Carry the set on by at most so many steps, or to t_end. numbers, low_numbers: (4, 3) kappa, rho, sigma,
    m as twofold numbers; energy: (4,) roots of the moments and the growth of |D^(1/2) w|, zeros where there
    is none; grain: every time is a multiple of it. direction, low_direction: (3,) at rest in space, (0,)
    where none is followed; off: (1,) a bound of its error. centre, low_centre, B, rad and these change in
    place. Where `times` (n,) is not empty the steps' ends, polynomials (n, 3, N + 1) in (t - start)/h from 0
    to 1 and radii (n, 3) go there, those of the direction behind them. Returns (status, time, steps)."""
    a, low, V = np.zeros((3, ORDER + 1)), np.zeros((3, ORDER + 1)), np.empty((ORDER + 1, 3, 3))
    error, spread, moved, P, E, M = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(
        (3, 3)), np.empty((3, 3))
    c, low_c, C, strays = np.zeros((3, ORDER + 1)), np.zeros((3, ORDER + 1)), np.zeros(3), 0.0
    dense, followed = len(times) > 0, len(direction) > 0
    for number in range(steps):
        if t >= t_end:
            return DONE, t, number
        size = max(abs(centre[0]), abs(centre[1]), abs(centre[2]))
        if not size < MOST:
            return LOST, t, number
        fastest = sqrt(max(abs(numbers[3, 0]), abs(numbers[3, 1]), abs(numbers[3, 2])))
        for i in range(3):
            fastest = max(fastest, abs(numbers[0, i]) * size, abs(numbers[1, i]), abs(numbers[2, i]))
        if not LEAST < fastest < MOST:
            return LOST, t, number
        unit = ldexp(1.0, -frexp(fastest)[1])
        for i in range(3):
            a[i, 0], low[i, 0] = centre[i], low_centre[i]
        series(numbers, low_numbers, unit, a, low)
        variations(numbers, unit, a, B, V)
        reach = longest(a, tolerance)
        if followed:
            for i in range(3):
                c[i, 0], low_c[i, 0] = direction[i], low_direction[i]
            series_of_direction(unit, a, low, c, low_c)
            reach = min(reach, longest(c, tolerance))
        h = reach * unit
        holds = False
        for _ in range(HALVINGS):
            h = min(h, t_end - t)
            if h < t_end - t:
                h = on_grain(h, grain)
            if not h > 0.0:
                return ENDLESS, t, number
            holds = judged(numbers, energy, a, V, B, rad, h, h / unit, error, spread, moved, E, P)
            if holds:
                break
            h *= 0.5
        if not holds:
            return LOST, t, number
        x = h / unit
        if followed:
            strays = strayed(a, c, h, x, error, spread, off[0], C)
            if not strays < 1.0:
                return LOST, t, number
            at_end(c, low_c, x, direction, low_direction)
            off[0] = (strays + FINE * length_of(C[0], C[1], C[2])) * WIDER
        end_of_variations(V, x, M)
        at_end(a, low, x, centre, low_centre)
        for i in range(3):
            moved[i] += (E[i, 0] * rad[0] + E[i, 1] * rad[1] + E[i, 2] * rad[2]) * WIDER
        if not taken_along(M, moved, rad, B):
            turned(M, moved, rad, B)
        t = t + h
        if dense:
            times[number] = t
            for i in range(3):
                power = 1.0
                for n in range(ORDER + 1):
                    polynomials[number, i, n] = a[i, n] * power
                    power *= x
                radii[number, i] = (error[i] + spread[i] + 2.0**-46 * P[i]) * WIDER
                if followed:
                    power = 1.0
                    for n in range(ORDER + 1):
                        polynomials[number, 3 + i, n] = c[i, n] * power
                        power *= x
                    radii[number, 3 + i] = (strays + 2.0**-46 * C[i]) * WIDER
    return (DONE if t >= t_end else GOING), t, steps
