"""Extremes and periods of many orbits on circles, as straight lines of floats that numba compiles.

The mechanics of `turning`, `extremes` and `quadrature`, written lane by lane without branches so that the loops
vectorise: every equilibrium of a lane's circle by Newton's method along the conic; turning points by Halley's method
from the nearest one; the period by divided differences and the trapezoidal rule, whose nodes nest. What doubles cannot
settle is marked and left to the arrays' path, whose last resort is ball arithmetic. Every function is plain Python too.
A block is a table: one row a quantity, one column a lane. All in one file: numba's cache on disk watches no other.
"""
from __future__ import annotations

from math import cos, exp, pi, sin, sqrt

import numpy as np

EPS = 2.220446049250313e-16
TURN = 2 * pi
INFINITY = float("inf")
BOX, PERIOD = 1, 2  # bits: wanted, and left to the arrays' path
LINE = 2.0  # kind of a piece of the conic: 0 solved from Z's asymptote, 1 from X's, 2 a straight line
BOX_SHARE, SPIN_UP_SHARE, PERIOD_SHARE = 1e-7, 1e-4, 1e-5  # as in `extremes` and `quadrature`
DIGITS, PERIOD_DIGITS = 1e-12, 1e-11  # as in `extremes` and `quadrature`
ENOUGH, SETTLED, FLOOR = 1e-9, 1e-13, 1e-15  # relative, of sums over nodes: the last change, the error by estimate, a change that is nothing but rounding
ROUNDINGS = 64  # units of rounding allowed for in a margin, as in `fate`
SHIFT_LIMIT = 1e4  # as in `extremes`
FAR_STEP, LAST_STEP = 1e-3, 1e-5  # largest first and second Newton step along the orbit: cubic errors, 1e-10, then 1e-16
NEWTON_STEPS, HALLEY_STEPS = 9, 4
SOLVED, HELD_STEPS = 1e-6, 60  # relative last step along a piece of the conic, which two steps along the orbit follow; most steps in a bracket
LANES = 256

# rows of a block: the orbit
X, Z, W, Q, RADIUS, ENERGY, SCALE, UNCLEAR, CLOSEST, LOWEST, T, FASTEST, LEFT, RIGHT = range(14)
# rows of a spot: an equilibrium with its offset from the state, E - V there, dF/dtheta there; and the first two a turn earlier
OFFSET, OVER, SPOT_X, SPOT_Z, BEND, BACK_OFFSET, BACK_OVER = range(7)
# rows of a turning point
AT, AT_X, AT_Z, BLUR, HAZE, ANCHOR_X, ANCHOR_Z, LEVEL, GAP, TOWARDS, START = range(11)
# rows of a motion's ends: the spots that decide it
R_BARRIER, L_BARRIER, R_WELL, L_WELL = range(4)


NARROW = 0.5  # half-widths below it take series where closed forms cancel
BOUNDED, SPINNING, OTHER = 0.0, 1.0, 2.0
# rows of the period's table
P1, Q1, P2, Q2, RHO, SINE, COSINE, SUM, BEFORE, LEAST, MIDDLE, ROW, TERMS, MOST, OFF, CHANGE, EARLIER = range(17)


def sinc_cos(u):
    """sin(u)/u and cos u for 0 <= u <= pi/2."""
    t = u * u
    s = 1 - t * (1 / 6) * (1 - t * (1 / 20) * (1 - t * (1 / 42) * (1 - t * (1 / 72) * (1 - t * (1 / 110) * (
        1 - t * (1 / 156) * (1 - t * (1 / 210) * (1 - t * (1 / 272) * (1 - t * (1 / 342) * (1 - t * (1 / 420))))))))))
    k = 1 - t * 0.5 * (1 - t * (1 / 12) * (1 - t * (1 / 30) * (1 - t * (1 / 56) * (1 - t * (1 / 90) * (
        1 - t * (1 / 132) * (1 - t * (1 / 182) * (1 - t * (1 / 240) * (1 - t * (1 / 306) * (1 - t * (1 / 380) * (
            1 - t * (1 / 462)))))))))))
    return s, k


def y_minus_sin(y, sine):
    """y - sin y without cancellation, |y| of any size; sine = sin y."""
    t = y * y
    series = y * t * (1 / 6) * (1 - t * (1 / 20) * (1 - t * (1 / 42) * (1 - t * (1 / 72) * (1 - t * (1 / 110) * (
        1 - t * (1 / 156))))))
    return series if t < 0.49 else y - sine


def angle_of(s, k):
    """atan2(s, k), to two units in the last place: atan's odd series after reduction to |t| <= tan(pi/8)."""
    a, b = abs(s), abs(k)
    low, high = min(a, b), max(a, b)
    big = low > 0.41421356237309503 * high
    t = (low - high if big else low) / (low + high if big else high)
    v = t * t
    # the coefficients of fdlibm's atan (Sun Microsystems, 1993), good to 1e-17 for |t| < 7/16
    tail = v * (3.33333333333329318027e-01 + v * (-1.99999999998764832476e-01 + v * (1.42857142725034663711e-01 + v * (
        -1.11111104054623557880e-01 + v * (9.09088713343650656196e-02 + v * (-7.69187620504482999495e-02 + v * (
            6.66107313738753120669e-02 + v * (-5.83357013379057348645e-02 + v * (4.97687799461593236017e-02 + v * (
                -3.65315727442169155270e-02 + v * 1.62858201153657823623e-02))))))))))
    angle = t - t * tail
    angle = angle + 0.25 * pi if big else angle
    angle = 0.5 * pi - angle if a > b else angle
    angle = pi - angle if k < 0 else angle
    return -angle if s < 0 else angle


def shifted(value, shift, low):
    """value + (shift + low) to a rounding of the sum, however much of it cancels (Knuth's two-sum); numbers or arrays."""
    whole = value + shift
    part = whole - value
    return whole + ((value - (whole - part)) + (shift - part) + low)


def orbit_rows(m, states, numbers, jki, folds, lane):
    """Canonical place and rate, invariant, scales; what is unclear already."""
    G, c, d, mu, K, shift, per_x, shift_j, per_z, shift_k, n, s, flip, thin, low_j, low_k = numbers
    j, k, i = jki
    x, z, w, q, radius, energy = lane[X], lane[Z], lane[W], lane[Q], lane[RADIUS], lane[ENERGY]
    scale, unclear, closest, lowest = lane[SCALE], lane[UNCLEAR], lane[CLOSEST], lane[LOWEST]
    extra, far = abs(shift_j / per_x) + abs(shift_k / per_z), max(abs(shift_j), abs(shift_k))
    for a in range(m):
        u, v, r = states[a, j], states[a, k], states[a, i]
        x[a], z[a] = flip * (shifted(u, shift_j, low_j) / per_x), shifted(v, shift_k, low_k) / per_z
        w[a] = flip * (n * (r + s))
        unclear[a] = 1.0 if far > SHIFT_LIMIT * max(abs(u), abs(v), abs(r)) else 0.0
    for a in range(m):
        q[a] = x[a] * x[a] + z[a] * z[a]
        radius[a], energy[a] = sqrt(q[a]), 0.5 * w[a] * w[a]
        rounding = abs(x[a]) + abs(z[a]) + extra
        ratio = rounding / radius[a]
        scale[a] = energy[a] + mu + abs(G) * q[a] + (abs(c) + abs(d)) * radius[a]
        # the margin must exceed its rounding, next to which everything is left open
        closest[a], lowest[a] = INFINITY, INFINITY
        lane[T, a] = ROUNDINGS * EPS * (energy[a] + mu * (TURN + ratio)
                                        + 2 * (abs(G) * radius[a] + abs(c) + abs(d)) * (rounding + 2 * radius[a]))
        unclear[a] = 1.0 if not (radius[a] > 1e-150 and radius[a] > thin) else unclear[a]
        # a state at rest has a period of 0: whether every rate vanishes is decided exactly, elsewhere
        force = mu + G * x[a] * z[a] + c * z[a] + d * x[a]
        blurred = mu + abs(G * x[a] * z[a]) + abs(c * z[a]) + abs(d * x[a]) + (abs(G) * radius[a] + abs(c) + abs(d)) * rounding
        still = (abs(w[a]) <= ROUNDINGS * EPS * abs(n) * (abs(states[a, i]) + abs(s))) & (abs(force) <= ROUNDINGS * EPS * blurred)
        unclear[a] = 1.0 if still else unclear[a]
        for f in folds:
            unclear[a] = 1.0 if abs(q[a] - f) <= ROUNDINGS * EPS * (rounding * rounding + f) else unclear[a]


def meet(m, piece, K, lane, spot):
    """SPOT_X, SPOT_Z where a piece of the conic meets each circle (not yet on it to rounding); OFFSET inf where it
    does not, LEVEL 1 where the search may have failed.

    piece: kind, side; for a hyperbola a, A, b, B, least Q, guard: its point is (t - a) A, (K/t - b) B in (Z, X) or
    (X, Z); for a line x0, z0, dx, dz.
    """
    kind, side, a0, a1, b0, b1, least, guard = piece
    q, t, offset = lane[Q], lane[T], spot[OFFSET]
    unclear = lane[UNCLEAR]
    if kind == LINE:
        x0, z0, dx, dz = a0, a1, b0, b1
        square, b = dz * dz + dx * dx, z0 * dz + x0 * dx
        for a in range(m):
            room = b * b - square * (z0 * z0 + x0 * x0 - q[a])
            at = (side * sqrt(max(room, 0.0)) - b) / square
            offset[a] = 0.0 if room > 0 else INFINITY
            spot[SPOT_X, a], spot[SPOT_Z, a] = x0 + at * dx, z0 + at * dz
        return
    first, second = (spot[SPOT_Z], spot[SPOT_X]) if kind == 0 else (spot[SPOT_X], spot[SPOT_Z])
    radius = lane[RADIUS]
    begin = side / abs(a1)
    for a in range(m):
        t[a] = a0 + begin * radius[a]
    step = spot[OVER]
    for _ in range(NEWTON_STEPS):
        for a in range(m):
            inverse = 1 / t[a]
            ratio = K * inverse
            f, g = (t[a] - a0) * a1, (ratio - b0) * b1
            step[a] = 0.5 * (f * f + g * g - q[a]) / (f * a1 - g * b1 * ratio * inverse)
            t[a] -= step[a]
    for a in range(m):
        there = q[a] > least
        # not from the asymptote where the piece turns a corner on the way to its fold
        if there and not (abs(step[a]) <= SOLVED * abs(t[a]) and t[a] * side > guard):
            t[a] = side * beyond_fold(side * a0, abs(a1), side * K, b0, b1, q[a], guard, radius[a])
        offset[a] = 0.0 if there else INFINITY
        first[a], second[a] = (t[a] - a0) * a1, (K / t[a] - b0) * b1
        unclear[a] = 1.0 if there and not t[a] * side > guard else unclear[a]


def beyond_fold(a, A, K, b, B, q, fold, radius):
    """h > fold where ((h - a) A)^2 + ((K/h - b) B)^2, which grows with h, is q: Newton's method in log h, held in a bracket; the fold where it is no more."""
    low, high, before = fold, max(abs(a) + radius / A, 2 * fold), INFINITY
    h = high
    for _ in range(HELD_STEPS):
        f, g = (h - a) * A, (K / h - b) * B
        value = f * f + g * g - q
        if value > 0:
            high = h
        else:
            low = h
        step = 0.5 * value / (f * A * h - g * B * K / h)
        new = h - h * step if abs(step) < 0.1 else h * exp(-step)
        if not low <= new <= high or not abs(step) < before:
            new, step = sqrt(low) * sqrt(high), 2.0
        before = 0.7 * abs(step) if step < 1.0 else INFINITY
        h = new
        if abs(step) < SOLVED or high - low <= SOLVED * low:
            break
    return h


def look_ahead(m, numbers, lane, spot):
    """Polish the equilibria of one piece along the orbits; their offsets in (0, 2 pi] and E - V there, and a turn behind."""
    G, c, d, mu = numbers[0], numbers[1], numbers[2], numbers[3]
    x, z, q, energy, unclear = lane[X], lane[Z], lane[Q], lane[ENERGY], lane[UNCLEAR]
    closest, lowest = lane[CLOSEST], lane[LOWEST]
    offset, over, spot_x, spot_z, bend = spot[OFFSET], spot[OVER], spot[SPOT_X], spot[SPOT_Z], spot[BEND]
    back_offset, back_over, fall, bad = spot[BACK_OFFSET], spot[BACK_OVER], TURN * mu, lane[T]
    for a in range(m):
        there = offset[a] == 0.0
        sx, sz = spot_x[a], spot_z[a]
        scale = sqrt(q[a] / (sx * sx + sz * sz))
        sx, sz = sx * scale, sz * scale
        step = -(mu + G * sx * sz + c * sz + d * sx) / (G * (sz - sx) * (sz + sx) - c * sx + d * sz)
        lift = -0.5 * step * step
        sx, sz = sx + (sz * step + sx * lift), sz + (sz * lift - sx * step)
        last = -(mu + G * sx * sz + c * sz + d * sx) / (G * (sz - sx) * (sz + sx) - c * sx + d * sz)
        lift = -0.5 * last * last
        sx, sz = sx + (sz * last + sx * lift), sz + (sz * lift - sx * last)
        curved = G * (sz - sx) * (sz + sx) - c * sx + d * sz
        terms = mu + abs(G * sx * sz) + abs(c * sz) + abs(d * sx)
        # where the force bends within the steps they leave more of it than rounding, over which heights and turning points would be told
        settled = abs(mu + G * sx * sz + c * sz + d * sx) <= ROUNDINGS * EPS * terms
        sure = settled and abs(step) < FAR_STEP and abs(last) < LAST_STEP
        bad[a] = 1.0 if there and not sure else 0.0
        sine, cosine = (sx * z[a] - sz * x[a]), (sx * x[a] + sz * z[a])
        angle = angle_of(sine, cosine)
        norm = 1 / q[a]
        s, k = -sine * norm, cosine * norm  # back from the spot to the state
        b = -s * s / (1 + k) if k > 0 else k - 1
        dx = sz * s + sx * b
        height = (mu * y_minus_sin(angle, -s) - b * (G * sx * sx + c * sx - d * sz) - 0.5 * G * dx * dx)
        # from the nearer copy: a turn more would cost the energy over a well just behind its digits
        ahead, e = angle > 0, energy[a] + height
        offset[a] = (angle if ahead else angle + TURN) if there else INFINITY
        back_offset[a] = (angle - TURN if ahead else angle) if there else INFINITY
        back_e = (e - fall if ahead else e) if there else INFINITY
        e = (e if ahead else e + fall) if there else INFINITY
        over[a], back_over[a], spot_x[a], spot_z[a] = e, back_e, sx, sz
        bend[a] = curved if there else 0.0
    for a in range(m):  # apart from the loop above, which does not vectorise with what it both reads and writes
        near = min(abs(over[a]), abs(back_over[a]))
        closest[a] = near if bend[a] > 0 and near < closest[a] else closest[a]
        lowest[a] = over[a] if over[a] < lowest[a] else lowest[a]
        unclear[a] = bad[a] if bad[a] > 0 else unclear[a]


def keep(m, better, spot, kept, offset, over):
    """Copy a spot with one of its offsets where it is the better one."""
    sx, sz, bend = spot[SPOT_X], spot[SPOT_Z], spot[BEND]
    k_offset, k_over, k_x, k_z, k_bend = kept[OFFSET], kept[OVER], kept[SPOT_X], kept[SPOT_Z], kept[BEND]
    for a in range(m):
        take = better[a] > 0
        k_offset[a] = offset[a] if take else k_offset[a]
        k_over[a] = over[a] if take else k_over[a]
        k_x[a] = sx[a] if take else k_x[a]
        k_z[a] = sz[a] if take else k_z[a]
        k_bend[a] = bend[a] if take else k_bend[a]


def enclose(m, count, spots, lane, ends):
    """The barriers that stop a motion on either side, and the wells next to them inside; FASTEST over the wells."""
    t, fastest = lane[T], lane[FASTEST]
    r_barrier, l_barrier, r_well, l_well = (ends[R_BARRIER, OFFSET], ends[L_BARRIER, OFFSET], ends[R_WELL, OFFSET],
                                            ends[L_WELL, OFFSET])
    for a in range(m):
        r_barrier[a], l_barrier[a], r_well[a], l_well[a] = INFINITY, -INFINITY, -INFINITY, INFINITY
        fastest[a] = lane[ENERGY, a]
    for p in range(count):
        offset, over, bend = spots[p, OFFSET], spots[p, OVER], spots[p, BEND]
        back_offset, back_over = spots[p, BACK_OFFSET], spots[p, BACK_OVER]
        for a in range(m):
            t[a] = 1.0 if (bend[a] > 0) & (over[a] <= 0) & (offset[a] < r_barrier[a]) else 0.0
        keep(m, t, spots[p], ends[R_BARRIER], offset, over)
        for a in range(m):
            t[a] = 1.0 if (bend[a] > 0) & (back_over[a] <= 0) & (back_offset[a] > l_barrier[a]) else 0.0
        keep(m, t, spots[p], ends[L_BARRIER], back_offset, back_over)
    for p in range(count):
        bend = spots[p, BEND]
        for way in range(2):
            offset, over = spots[p, BACK_OFFSET if way else OFFSET], spots[p, BACK_OVER if way else OVER]
            for a in range(m):
                t[a] = 1.0 if (bend[a] < 0) & (offset[a] < r_barrier[a]) & (offset[a] > r_well[a]) else 0.0
            keep(m, t, spots[p], ends[R_WELL], offset, over)
            for a in range(m):
                t[a] = 1.0 if (bend[a] < 0) & (offset[a] > l_barrier[a]) & (offset[a] < l_well[a]) else 0.0
            keep(m, t, spots[p], ends[L_WELL], offset, over)


def turn(m, side, numbers, barrier, well, lane, end):
    """Turning points between a barrier and the well inside it, from whichever is nearer in height: AT, the place there,
    BLUR and HAZE, the rounding errors of the offset and of the energy over the anchor; AT nan where it is not found."""
    G, c, d, mu = numbers[0], numbers[1], numbers[2], numbers[3]
    at, at_x, at_z, blur, haze = end[AT], end[AT_X], end[AT_Z], end[BLUR], end[HAZE]
    anchor_x, anchor_z, level = end[ANCHOR_X], end[ANCHOR_Z], end[LEVEL]
    gap, towards, start, y = end[GAP], end[TOWARDS], end[START], lane[T]
    b_off, b_over, b_x, b_z, b_bend = barrier[OFFSET], barrier[OVER], barrier[SPOT_X], barrier[SPOT_Z], barrier[BEND]
    w_off, w_over, w_x, w_z, w_bend = well[OFFSET], well[OVER], well[SPOT_X], well[SPOT_Z], well[BEND]
    for a in range(m):
        over, under, b_at, w_at, bx, bz, wx, wz = b_over[a], w_over[a], b_off[a], w_off[a], b_x[a], b_z[a], w_x[a], w_z[a]
        high = -over < under
        over, under, wide = min(over, 0.0), max(under, 0.0), abs(b_at - w_at)
        start[a], level[a], towards[a] = (b_at if high else w_at), (over if high else under), (-side if high else side)
        anchor_x[a], anchor_z[a], gap[a] = (bx if high else wx), (bz if high else wz), wide
        whole = under - over
        root = sqrt(min(-over, under) / whole)
        square = root * root
        psi = 2 / pi * root * (1 + square * (1 / 6 + square * (3 / 40 + square * (5 / 112 + square * 0.06))))
        at_b, at_w = pi / wide * sqrt(0.5 * whole / abs(b_bend[a])), pi / wide * sqrt(0.5 * whole / abs(w_bend[a]))
        near, far = (at_b if high else at_w), (at_w if high else at_b)
        guess = wide * way_of_cosine(psi, near, far)
        y[a] = min(max(guess, 0.01 * psi * wide), 0.9 * wide)  # at the far end the slope is 0, and no step leaves it
    for rest in range(HALLEY_STEPS, -1, -1):
        last = 0.0 if rest == 0 else 1.0
        for a in range(m):
            x, z, side_a, here, reach = anchor_x[a], anchor_z[a], towards[a], y[a], gap[a]
            quarter, cosine = sinc_cos(0.25 * here)
            quarter *= 0.25 * here
            half = 2 * quarter * cosine
            sine, b = 2 * half * (1 - 2 * quarter * quarter), -2 * half * half
            s = sine * side_a
            dx = z * s + x * b
            ex, ez = x + dx, z + (z * b - x * s)
            value = -mu * side_a * y_minus_sin(here, sine) - b * (G * x * x + c * x - d * z) - 0.5 * G * dx * dx - level[a]
            first = -side_a * (mu + G * ex * ez + c * ez + d * ex)
            second = -(G * (ez - ex) * (ez + ex) - c * ex + d * ez)
            step = 2 * value * first / (2 * first * first - value * second)
            # a step may not leave the way between barrier and well: half-way to its end instead
            new = min(max(here - step * last, 0.5 * here), 0.5 * (here + reach))
            # Newton's step counts: Halley's is 0 at a barrier too
            y[a], at_x[a], at_z[a], blur[a], haze[a] = new, ex, ez, abs(first), value / first
    for a in range(m):  # the last step is Newton's: it leaves its square over the way to where the force vanishes, at most some four times
        x, z, far, step = anchor_x[a], anchor_z[a], y[a], abs(haze[a])
        on = -towards[a] * haze[a]
        at_x[a], at_z[a] = at_x[a] + at_z[a] * on, at_z[a] - at_x[a] * on
        terms = mu + abs(G * x * z) + abs(c * z) + abs(d * x)  # of the force; where they vanish the potential still has its own
        bulk = abs(G) * (x * x + z * z) + (abs(c) + abs(d)) * (abs(x) + abs(z))
        found = (step < LAST_STEP * far) & (w_over[a] > 0) & (level[a] != 0)
        noise = EPS * (terms * (abs(start[a]) + far) + bulk * (min(start[a] * start[a], 2.0) + min(far * far, 2.0)))
        place = start[a] + towards[a] * far + on
        haze[a], blur[a] = noise, noise / blur[a] + EPS * abs(start[a]) + 4 * step * step / far
        at[a] = place if found else np.nan


def way_of_cosine(psi, near, far):
    """First guess of a turning point between a barrier and a well, as a share of the way: there V is nearly a cosine,
    and in its angle psi (0 to 1) the way is a cubic with the slopes near, far that the curvatures at both ends give."""
    return psi * (near * (1 - psi) * (1 - psi) + psi * (3 - 2 * psi) - far * psi * (1 - psi))


def contains(angle, left, right, at):
    """Whether the directions from left to right about `angle` contain `at`."""
    turns = (angle + left - at) / TURN
    whole = (turns + 6755399441055744.0) - 6755399441055744.0  # to the nearest integer
    whole = whole if whole >= turns else whole + 1
    return whole * TURN + at <= angle + right


def _rules(*halved):
    """sin(phi/2)^2 <= 1/2 at the trapezoidal nodes of 8 intervals, then at the midpoints of so many, each twice as many as before."""
    phi = [np.arange(5) * (np.pi / 8)] + [(np.arange(n // 2) + 0.5) * (np.pi / n) for n in halved]
    return np.sin(0.5 * np.concatenate(phi)) ** 2


NODES = _rules(8, 16, 32, 64)
LANE_NODES = _rules(8, 16, 32, 64, 128, 256, 512)  # in lanes a pair of nodes costs some 4 ns: all of these take less than the double-exponential rule


def sinc_minus_cos(t):
    """sin(u)/u - cos u of t = u^2 <= 1, without cancellation."""
    return t * (1 / 3) * (1 - t * (1 / 10) * (1 - t * (1 / 28) * (1 - t * (1 / 54) * (1 - t * (1 / 88) * (
        1 - t * (1 / 130) * (1 - t * (1 / 180) * (1 - t * (1 / 238) * (1 - t * (1 / 304)))))))))


def sort_out(m, mu, wanted, lane, ends, kind, left_open):
    """Which lanes are bounded, which spin up, and what stays open because the separatrix is too near."""
    closest, scale, unclear = lane[CLOSEST], lane[SCALE], lane[UNCLEAR]
    right, left = ends[R_BARRIER, OFFSET], ends[L_BARRIER, OFFSET]
    for a in range(m):
        bounded = right[a] < INFINITY
        kind[a] = BOUNDED if bounded else (SPINNING if mu > 0 else OTHER)
        near = 0
        if closest[a] <= (BOX_SHARE if bounded else SPIN_UP_SHARE) * scale[a]:
            near |= BOX
        if bounded and closest[a] <= PERIOD_SHARE * scale[a]:
            near |= PERIOD
        if unclear[a] > 0 or kind[a] == OTHER or (bounded and not left[a] > -INFINITY):
            near = wanted
        left_open[a] = near & wanted


def fastest_between(m, count, spots, lane, low, high):
    """Raise FASTEST to the largest W^2/2 at the wells between two offsets."""
    fastest = lane[FASTEST]
    for p in range(count):
        bend = spots[p, BEND]
        for way in range(2):
            offset, over = spots[p, BACK_OFFSET if way else OFFSET], spots[p, BACK_OVER if way else OVER]
            for a in range(m):
                here, e = offset[a], over[a]
                passed = (bend[a] < 0) & (here >= low[a]) & (here <= high[a]) & (e > fastest[a])
                fastest[a] = e if passed else fastest[a]


def bounded_box(m, numbers, lane, left_end, right_end, out):
    """Canonical ranges of lanes between two turning points: rows of out: X low, high, Z low, high, W low, high; and in
    row 6 whether they keep their digits."""
    per_x, shift_j, per_z, shift_k, flip = numbers[6], numbers[7], numbers[8], numbers[9], numbers[12]
    x, z, radius, fastest, left, right = lane[X], lane[Z], lane[RADIUS], lane[FASTEST], lane[LEFT], lane[RIGHT]
    lx, lz, rx, rz = left_end[AT_X], left_end[AT_Z], right_end[AT_X], right_end[AT_Z]
    l_blur, r_blur, l_haze, r_haze = left_end[BLUR], right_end[BLUR], left_end[HAZE], right_end[HAZE]
    angle, quarter = out[6], 0.25 * TURN
    for a in range(m):
        angle[a] = angle_of(x[a], z[a])
    for a in range(m):
        r, at, start, end = radius[a], angle[a], left[a], right[a]
        out[0, a] = -r if contains(at, start, end, -quarter) else min(lx[a], rx[a])
        out[1, a] = r if contains(at, start, end, quarter) else max(lx[a], rx[a])
    for a in range(m):
        r, at, start, end = radius[a], angle[a], left[a], right[a]
        out[2, a] = -r if contains(at, start, end, 2 * quarter) else min(lz[a], rz[a])
        out[3, a] = r if contains(at, start, end, 0.0) else max(lz[a], rz[a])
    for a in range(m):
        x_low, x_high, z_low, z_high = out[0, a], out[1, a], out[2, a], out[3, a]
        top = sqrt(2 * fastest[a])
        out[4, a], out[5, a] = -top, top
        both_l, both_r = EPS * (abs(lx[a]) + abs(lz[a])), EPS * (abs(rx[a]) + abs(rz[a]))
        off_x = max(both_l + abs(lz[a]) * l_blur[a], both_r + abs(rz[a]) * r_blur[a])
        off_z = max(both_l + abs(lx[a]) * l_blur[a], both_r + abs(rx[a]) * r_blur[a])
        size_j = max(abs(flip * per_x * x_low - shift_j), abs(flip * per_x * x_high - shift_j))
        size_k = max(abs(per_z * z_low - shift_k), abs(per_z * z_high - shift_k))
        good = (abs(per_x) * off_x + EPS * abs(shift_j) <= DIGITS * size_j) & (
            abs(per_z) * off_z + EPS * abs(shift_k) <= DIGITS * size_k) & (
                max(l_haze[a], r_haze[a]) + EPS * fastest[a] <= DIGITS * 2 * fastest[a])
        out[6, a] = 1.0 if good else 0.0


def spinning_box(m, lane, kind, out):
    """Canonical ranges of lanes that spin up: the whole circle, W from its least value on."""
    w, radius, lowest, fastest = lane[W], lane[RADIUS], lane[LOWEST], lane[FASTEST]
    for a in range(m):
        if kind[a] == SPINNING:
            out[0, a], out[1, a], out[2, a], out[3, a] = -radius[a], radius[a], -radius[a], radius[a]
            out[4, a] = min(w[a], sqrt(2 * max(lowest[a], 0.0))) if w[a] >= 0 else -sqrt(2 * fastest[a])
            out[5, a], out[6, a] = INFINITY, 1.0


def write_boxes(m, states, numbers, jki, out, boxes):
    """The ranges in the scene's variables; rounding must not exclude the state itself."""
    per_x, shift_j, per_z, shift_k, n, s, flip = (numbers[6], numbers[7], numbers[8], numbers[9], numbers[10], numbers[11],
                                                  numbers[12])
    j, k, i = jki
    for a in range(m):
        u, v = flip * per_x * out[0, a] - shift_j, flip * per_x * out[1, a] - shift_j
        boxes[a, j, 0], boxes[a, j, 1] = min(u, v, states[a, j]), max(u, v, states[a, j])
        u, v = per_z * out[2, a] - shift_k, per_z * out[3, a] - shift_k
        boxes[a, k, 0], boxes[a, k, 1] = min(u, v, states[a, k]), max(u, v, states[a, k])
        u, v = flip * out[4, a] / n - s, flip * out[5, a] / n - s
        boxes[a, i, 0], boxes[a, i, 1] = min(u, v, states[a, i]), max(u, v, states[a, i])


def gather_modes(m, numbers, lane, left_end, right_end, kind, left_open, narrow, table):
    """V's modes about the middle of each bounded lane's interval, packed; how many. narrow: which half-widths."""
    G, c, d = numbers[0], numbers[1], numbers[2]
    x, z, left, right = lane[X], lane[Z], lane[LEFT], lane[RIGHT]
    count = 0
    for a in range(m):
        rho = 0.5 * (right[a] - left[a])
        if kind[a] == BOUNDED and not left_open[a] & PERIOD and (rho < NARROW) == narrow:
            y = 0.5 * (left[a] + right[a])
            half = sin(0.5 * y)
            s, b = 2 * half * cos(0.5 * y), -2 * half * half
            u, v = x[a] + (z[a] * s + x[a] * b), z[a] + (z[a] * b - x[a] * s)
            table[P1, count], table[Q1, count] = -c * u + d * v, -c * v - d * u
            table[P2, count], table[Q2, count] = -0.25 * G * (u - v) * (u + v), -0.5 * G * u * v
            table[RHO, count], table[ROW, count], table[OFF, count] = rho, a, left_end[BLUR, a] + right_end[BLUR, a]
            table[TERMS, count] = (abs(c) + abs(d)) * (abs(u) + abs(v))  # what the first modes are sums of
            count += 1
    for a in range(count):
        f, k = sinc_cos(0.5 * table[RHO, a])
        sh = 0.5 * table[RHO, a] * f
        table[SINE, a], table[COSINE, a], table[SUM, a] = 2 * sh * k, 1 - 2 * sh * sh, 0.0
        table[TERMS, a] += 4 * (abs(table[P2, a]) + abs(table[Q2, a]))
    return count


def divided_pair(u, fu, cu, rho, whole_s, whole_c, p1, q1, p2, q2, narrow):
    """(even, odd): V[l, r, theta] is their sum at the node whose distance from l is 2u, and their difference at its
    mirror image. With v = rho - u the modes cos, sin have the divided differences -sinc u sinc v/2 and
    (cos u sinc v - sinc u cos v)/(2 rho). fu, cu = sinc u, cos u; numbers or arrays; narrow: rho < NARROW."""
    v = rho - u
    su = u * fu
    sv, cv = whole_s * cu - whole_c * su, whole_c * cu + whole_s * su
    fv = sv / v
    even = -0.5 * fu * fv * (p1 + 4 * p2 * cu * cv)
    if narrow:
        gu, gv = sinc_minus_cos(u * u), sinc_minus_cos(v * v)
        g2u, g2v = sinc_minus_cos(4 * u * u), sinc_minus_cos(4 * v * v)
        odd = (0.5 * q1 * (fu * gv - fv * gu) + q2 * (fu * cu * g2v - fv * cv * g2u)) / rho
    else:
        odd = (0.5 * q1 * (cu * fv - fu * cv) + q2 * ((cu * cu - su * su) * fv * cv - fu * cu * (cv * cv - sv * sv))) / rho
    return even, odd


def converged(now, last, middle, first):
    """Whether a sum over nodes is its integral, given what it changed by as its nodes were doubled: the last, the middle and the first of three
    such changes; any numbers.

    Doubling squares the error of the trapezoidal rule, C r^n for n nodes, and of the double-exponential one, so a last change of `ENOUGH` leaves nothing. But
    the sign of an error goes round, and it may be next to nothing by chance. So the rate r^n is told by either ratio of changes too, and a size by its own
    change or by the one before; the larger counts each time, and what these leave must be `SETTLED`: four products, asked without a division.
    """
    c, b, a = last / now, middle / now + FLOOR, first / now + FLOOR
    a2, b2 = a * a, b * b
    return (c <= ENOUGH) & (c * c * c <= SETTLED * b2) & (c * b2 * b2 <= SETTLED * a2 * a2) & (b * c * c <= SETTLED * a2) & (
        b2 * b2 * b2 * b <= SETTLED * a2 * a2 * a2)


def add_node(count, share, weight, narrow, table):
    """Add 1/sqrt(2 H) at the node with left = share and at its mirror image."""
    p1, q1, p2, q2, rho, whole_s, whole_c, total = (table[P1], table[Q1], table[P2], table[Q2], table[RHO], table[SINE],
                                                    table[COSINE], table[SUM])
    least, middle = table[LEAST], table[MIDDLE]
    for a in range(count):
        u = rho[a] * share
        fu, cu = sinc_cos(u)
        even, odd = divided_pair(u, fu, cu, rho[a], whole_s[a], whole_c[a], p1[a], q1[a], p2[a], q2[a], narrow)
        total[a] += weight * (1 / sqrt(2 * (even + odd)) + 1 / sqrt(2 * (even - odd)))
        least[a], middle[a] = even - abs(odd), even


def add_nodes(count, first, last, nodes, narrow, table):
    for node in range(first, last):
        if narrow:
            add_node(count, nodes[node], 1.0, True, table)
        else:
            add_node(count, nodes[node], 1.0, False, table)


def librations(count, nodes, narrow, table, periods, left_open):
    """Periods of the packed lanes, written to their places; what is not settled by 1024 nodes stays open."""
    if narrow:
        add_node(count, nodes[0], 0.5, True, table)
    else:
        add_node(count, nodes[0], 0.5, False, table)
    for a in range(count):
        table[BEFORE, a], table[MOST, a] = table[LEAST, a], 2 * table[MIDDLE, a] - table[LEAST, a]
    if narrow:
        add_node(count, nodes[4], 0.5, True, table)
    else:
        add_node(count, nodes[4], 0.5, False, table)
    for a in range(count):  # at the ends and in the middle H must keep its digits
        noise, ends, middle = EPS * table[TERMS, a], table[BEFORE, a], table[MIDDLE, a]
        sharp = (noise <= PERIOD_DIGITS * ends) & (noise <= PERIOD_DIGITS * middle)
        # and the errors of the turning points must move it by little, as far as it changes on the way between them
        change, least = max(table[MOST, a], middle) - min(ends, middle), min(ends, middle)
        if not sharp & (table[OFF, a] * change <= PERIOD_DIGITS * table[RHO, a] * least):
            left_open[int(table[ROW, a])] |= PERIOD
        table[BEFORE, a] = table[SUM, a] * (0.5 * TURN)
    add_nodes(count, 2, 3, nodes, narrow, table)
    for a in range(count):
        now = table[SUM, a] * (0.25 * TURN)
        table[EARLIER, a], table[BEFORE, a] = abs(now - table[BEFORE, a]), now
    add_nodes(count, 1, 2, nodes, narrow, table)
    add_nodes(count, 3, 4, nodes, narrow, table)
    for a in range(count):
        now = table[SUM, a] * (0.125 * TURN)
        table[CHANGE, a], table[BEFORE, a] = abs(now - table[BEFORE, a]), now
    size, first = 8, 5
    while first < len(nodes) and count:
        add_nodes(count, first, first + size // 2, nodes, narrow, table)
        first, size = first + size // 2, 2 * size
        kept = 0
        for a in range(count):
            now = table[SUM, a] * (TURN / size)
            change = abs(now - table[BEFORE, a])
            if converged(now, change, table[CHANGE, a], table[EARLIER, a]):
                periods[int(table[ROW, a])] = now
            else:
                table[EARLIER, a], table[CHANGE, a], table[BEFORE, a] = table[CHANGE, a], change, now
                for row in (P1, Q1, P2, Q2, RHO, SINE, COSINE, SUM, BEFORE, ROW, CHANGE, EARLIER):
                    table[row, kept] = table[row, a]
                kept += 1
        count = kept
    for a in range(count):
        left_open[int(table[ROW, a])] |= PERIOD


def orbits(states, numbers, jki, pieces, folds, wanted, nodes, boxes, periods, left_open):
    """Fill boxes (n, 3, 2) and periods (n,) as far as wanted; left_open (n,): the bits that stay open."""
    mu, count = numbers[3], len(pieces)
    lane, spots, ends = np.empty((14, LANES)), np.empty((count, 7, LANES)), np.zeros((4, 5, LANES))
    turns, out, table, kind = np.empty((2, 11, LANES)), np.empty((7, LANES)), np.empty((17, LANES)), np.empty(LANES)
    for begin in range(0, len(states), LANES):
        end = min(begin + LANES, len(states))
        m, part, open_ = end - begin, states[begin:end], left_open[begin:end]
        orbit_rows(m, part, numbers, jki, folds, lane)
        for a in range(m):
            kind[a] = lane[T, a]  # rounding of a margin
        for p in range(count):
            meet(m, pieces[p], numbers[4], lane, spots[p])
            look_ahead(m, numbers, lane, spots[p])
        for a in range(m):
            lane[UNCLEAR, a] = 1.0 if lane[CLOSEST, a] <= kind[a] else lane[UNCLEAR, a]
        enclose(m, count, spots, lane, ends)
        sort_out(m, mu, wanted, lane, ends, kind, open_)
        turn(m, 1.0, numbers, ends[R_BARRIER], ends[R_WELL], lane, turns[1])
        turn(m, -1.0, numbers, ends[L_BARRIER], ends[L_WELL], lane, turns[0])
        for a in range(m):
            if kind[a] == BOUNDED:
                lane[LEFT, a], lane[RIGHT, a] = min(turns[0, AT, a], 0.0), max(turns[1, AT, a], 0.0)
                if not turns[1, AT, a] - turns[0, AT, a] > 0:
                    open_[a] = wanted
            else:
                lane[LEFT, a], lane[RIGHT, a] = ends[L_BARRIER, OFFSET, a], 0.0
        if wanted & BOX:
            fastest_between(m, count, spots, lane, lane[LEFT], lane[RIGHT])
            bounded_box(m, numbers, lane, turns[0], turns[1], out)
            spinning_box(m, lane, kind, out)
            write_boxes(m, part, numbers, jki, out, boxes[begin:end])
            for a in range(m):
                if not out[6, a] > 0:
                    open_[a] |= BOX
        if wanted & PERIOD:
            some = periods[begin:end]
            for a in range(m):
                some[a] = INFINITY
            for narrow in (False, True):
                packed = gather_modes(m, numbers, lane, turns[0], turns[1], kind, open_, narrow, table)
                librations(packed, nodes, narrow, table, some, open_)
