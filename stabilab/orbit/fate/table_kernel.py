"""The barrier ahead of a state from tables: the arithmetic, the same for arrays (NumPy) and for one state
(compiled).

Every function here is made of correctly rounded operations alone (+ - * / sqrt floor, comparisons) in a fixed
order, so that both ways of running it give the same bytes; the angle and the logarithm are therefore written
out as polynomials. On hyperbolas a margin that doubles leave less than twelve digits is formed in twofold
numbers, from the barrier's place.
"""
from __future__ import annotations

import math

import numpy as np

# Of an orbit's range of sizes (radius A of a circle, invariant Q of a hyperbola) on which one barrier stands:
# low < size <= high; v = u/(bend u + width), u = sqrt(side (size - origin)), measured from the fold at
# `origin`;
# growth: the part of the height that is linear in A. Hyperbola: lead = +1 where xi keeps the sign `sign`, -1
# where
# eta does; steep: bound of d height/dQ; bulk: size of the height's terms.
LOW, HIGH, ORIGIN, SIDE, BEND, WIDTH, GROWTH, LEAD, SIGN, STEEP, BULK = range(11)
# coefficients 0..5 of a height, then 6..7 of the barrier's angle in turns, on hyperbolas of its place: one
# cache line
DEGREE, ANGLE = 5, 6

SIGN_BOUND = 320 * 2.0**-52  # five times the units of rounding that the general formula allows for
# Terms smaller than these shares of the rounding's scale are left to the general formula, to keep a margin to
# 1e-12 of its
# terms: that allows 9 units of rounding of the scale on circles, 1.8 on hyperbolas, whose scale is a cruder
# bound;
# of the curves' own terms the check of a cell allows 4.
MARGIN_BOUND, CONE_MARGIN_BOUND = 2e-3, 4e-4
FOLD_BOUND = 1e-10  # nearer to a fold, relative, the general formula answers
# so near to a barrier, in turns, it is not clear here whether it stands ahead or a turn away
TURN_BOUND = 1e-4
FORCE_BOUND = 1e-11  # a force so small may be an equilibrium's
PLANE_BOUND = 1e-9  # so near to an invariant plane the general formula answers
FAR = 1e6  # rounding of the place may be this many times the radius

# Of a parabola, whose height has a dozen and a half roundings; of the distance from the fold, relative, what
# its rounding may be; and of the last step
# of Newton's method beside that distance, which leaves less than its square.
PARABOLA_MARGIN_BOUND, PAIR_BOUND, STEP_BOUND = 4e-3, 1e6 * 2.0**-52, 1e-3
STEP_LEFT = 1e-6  # of the energy that the last step is worth, as much as its rounding could matter

# Of a margin in twofold numbers: what it may be off by, against the kinetic energy and the barrier's height
# (half of what `fate` admits), and against itself;
# the last step to the barrier, which leaves its square; the units of rounding of a product and of y - sinh y,
# whose y is a logarithm; those of a place
# and of a sum of products in twofold numbers; |y| up to which y - sinh y is a series.
FINE_SHARE, FINE_ROUNDINGS, FINE_STEP, FINE_ROUNDED, LAG_ROUNDED, TWOFOLD, FINE, LAG = (
    5e-13, 64.0, 1e-12, 4.0, 12.0, 2.0**-100, 2.0**-96, 1.0)
# The 21 numbers of `fine`: high parts, each before its low part, of G, c, d, mu, sj, sk, the factors of X and
# Z, (flip n)^2/2 and the shift of the third
# component; and how small an invariant Q is not to be answered, because an equilibrium may stand by the
# centre.
SPLITTER = 134217729.0  # 2^27 + 1
EPS = 2.0**-52

TURN, TURNS = 2 * math.pi, 1 / (2 * math.pi)
_TAN_PI_8, _PI_4, _PI_2, _PI = math.tan(math.pi / 8), math.pi / 4, math.pi / 2, math.pi
_SQRT_HALF, _LOG_2 = math.sqrt(0.5), math.log(2.0)


def pick(condition, yes, no):
    """yes where the condition holds, else no."""
    return np.where(condition, yes, no)


def angle(x, z):
    """atan2(x, z) to a unit of rounding of pi: reduced to |q| <= tan(pi/8), there a polynomial (Chebyshev,
    3e-18)."""
    ax, az = np.abs(x), np.abs(z)
    small, large = np.minimum(ax, az), np.maximum(ax, az)
    near = small > _TAN_PI_8 * large
    q = pick(near, small - large, small) / pick(near, small + large, large)
    t = q * q
    p = -0.050854078345894844 + t * (0.03923044778479309 + t * -0.019175404711104935)
    p = -0.0666451052550892 + t * (0.05858140904866328 + t * p)
    p = -0.0909090457530649 + t * (0.07692183125376892 + t * p)
    p = -0.14285714284665682 + t * (0.11111111015187018 + t * p)
    p = -0.3333333333333333 + t * (0.19999999999995516 + t * p)
    value = q + q * (t * p)
    value = pick(near, _PI_4 + value, value)
    value = pick(ax > az, _PI_2 - value, value)
    value = pick(z < 0, _PI - value, value)
    return pick(x < 0, -value, value)


def logarithm(mantissa, exponent):
    """log(mantissa 2^exponent) for mantissas in [1/2, 1): reduced to [sqrt 1/2, sqrt 2), there 2 artanh
    (Chebyshev, 2e-18)."""
    low = mantissa < _SQRT_HALF
    m = pick(low, 2 * mantissa, mantissa)
    n = pick(low, exponent - 1.0, exponent + 0.0)
    return n * _LOG_2 + logarithm_of((m - 1) / (m + 1))


def cell_position(size, side, origin, bend, width, count):
    """Position in [0, count] of an orbit's size along the cells of a range; inside the range it is exact."""
    u = np.sqrt(np.maximum(side * (size - origin), 0.0))
    return np.minimum(u / (bend * u + width), 1.0) * count


def height_polynomial(c0, c1, c2, c3, c4, c5, t):
    return c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5))))


def angle_polynomial(c6, c7, t):
    return c6 + t * c7


def circle_height(x, z, phase, form):
    """Minus the potential of a place on a circle, but for the part that the barrier shares (sqrt of Q) or
    grows with."""
    G, c, d, mu = form
    y = pick(G > 0, x, z)
    return mu * phase + 0.5 * abs(G) * y * y + c * x - d * z


def force(x, z, form):
    G, c, d, mu = form
    return mu + (G * x + c) * z + d * x


def terms(rounding, form):
    """Size of the terms of the potential but its tilt, at places whose magnitudes add up to `rounding`."""
    G, c, d, mu = form
    return rounding * (abs(G) * rounding + abs(c) + abs(d))


def ahead(barrier_angle, turns):
    """(turns from the state to the barrier, rounded down; whether that is clear)."""
    offset = barrier_angle - turns
    whole = np.floor(offset)
    return whole, np.abs((offset - whole) - 0.5) < 0.5 - TURN_BOUND


def trusted(margin, height, energy, scale, margin_bound):
    """True where the sign of a margin is certain and its digits are as good as the general formula's; false
    for NaN."""
    whole = scale + energy
    return (np.abs(margin) > SIGN_BOUND * whole) & (np.abs(height) + energy > margin_bound * whole)


def fold_is_clear(size, origin, rounding):
    return np.abs(size - origin) > FOLD_BOUND * (rounding + abs(origin))


def exact_sum(x, y):
    s = x + y
    back = s - x
    return s, (x - (s - back)) + (y - back)


def exact_product(x, y):
    p = x * y
    big = SPLITTER * x
    xh = big - (big - x)
    xl = x - xh
    big = SPLITTER * y
    yh = big - (big - y)
    yl = y - yh
    return p, ((xh * yh - p) + xh * yl + xl * yh) + xl * yl


def add(a, b):
    """Of twofold numbers, pairs of a high and a low part."""
    s, e = exact_sum(a[0], b[0])
    t, f = exact_sum(a[1], b[1])
    s, e = exact_sum(s, e + t)
    return exact_sum(s, e + f)


def less(a, b):
    return add(a, (-b[0], -b[1]))


def times(a, b):
    p, e = exact_product(a[0], b[0])
    return exact_sum(p, e + (a[0] * b[1] + a[1] * b[0]))


def scaled(a, factor):
    """A twofold number times a double."""
    p, e = exact_product(a[0], factor)
    return exact_sum(p, e + a[1] * factor)


def fine_place(state_i, state_j, state_k, fine):
    """(X, Z, kinetic energy) of a state, twofold."""
    x = times(add((fine[8], fine[9]), (state_j, 0.0 * state_j)), (fine[12], fine[13]))
    z = times(add((fine[10], fine[11]), (state_k, 0.0 * state_k)), (fine[14], fine[15]))
    turn = add((fine[18], fine[19]), (state_i, 0.0 * state_i))
    return x, z, times((fine[16], fine[17]), times(turn, turn))


def double_step(u, v, size, form):
    """(u, v) brought onto the hyperbola Z^2 - X^2 = size and then nearer to an equilibrium by a step of
    Newton's method, in doubles."""
    G, c, d, mu = form
    off = ((v - u) * (v + u) - size) / (2 * (u * u + v * v))
    u, v = u + off * u, v - off * v
    step = -(mu + (G * u + c) * v + d * u) / (v * (G * v + d) + u * (G * u + c))
    half = 0.5 * step * step
    return u + v * step + u * half, v + u * step + v * half


def fine_step(u, v, Q, fine):
    """(u, v, step, slope of the force there) after such a step in twofold numbers from the doubles (u, v);
    the step is a double."""
    G, c, d, mu = (fine[0], fine[1]), (fine[2], fine[3]), (fine[4], fine[5]), (fine[6], fine[7])
    u, v = (u, 0.0 * u), (v, 0.0 * v)
    beside = less(less(times(v, v), times(u, u)), Q)
    off = (beside[0] + beside[1]) / (2 * (u[0] * u[0] + v[0] * v[0]))
    u, v = add(u, exact_product(off, u[0])), add(v, exact_product(-off, v[0]))
    across, pull = fine_force(u, v, G, c, d, mu)
    slope = fine_slope(u, v, G, d, across)
    step = -(pull[0] + pull[1]) / (slope[0] + slope[1])
    half = 0.5 * step * step
    u, v = add(add(u, scaled(v, step)), scaled(u, half)), add(add(v, scaled(u, step)), scaled(v, half))
    return u, v, step, fine_slope(u, v, G, d, add(times(G, u), c))


def fine_force(u, v, G, c, d, mu):
    """(G u + c, force) at a place."""
    across = add(times(G, u), c)
    return across, add(add(times(v, across), mu), times(d, u))


def fine_slope(u, v, G, d, across):
    """Slope of the force at a place, across: G u + c."""
    return add(times(v, add(times(G, v), d)), times(u, across))


def over(a, b):
    """A twofold number over another."""
    first = a[0] / b[0]
    rest = less(a, scaled(b, first))
    return exact_sum(first, (rest[0] + rest[1]) / b[0])


def ratio_of(X, Z, u, v):
    """(which of the two coordinates that grow and decay is larger, +1 or -1; it at (u, v), a double; it at
    (X, Z) as a share of that, less 1, twofold)."""
    side = pick(X[0] * Z[0] < 0, -1.0, 1.0)
    start, end = add(X, (side * Z[0], side * Z[1])), add(u, (side * v[0], side * v[1]))
    return side, end[0], over(less(start, end), end)


def fine_margin(X, Z, kinetic, u, v, step, slope, side, end, grown, mantissa, exponent, rounding, fine):
    """(margin, whether it is certain) of a state on a hyperbola against a barrier (u, v).

    From the barrier, y away, the potential falls by 2 h^2 (F' + A S + 2 B h^2) + mu (y - S) with S = sinh y
    and h = sinh(y/2), which the ratio of the places' larger coordinates, 1 + grown = mantissa 2^exponent,
    gives without an exponential. The sum in brackets may cancel, and is twofold.
    """
    G, c, d, mu, x, z, at_x, at_z = fine[0], fine[2], fine[4], fine[6], X[0], Z[0], u[0], v[0]
    one, g = (1.0 + 0.0 * side, 0.0 * side), grown[0]
    ratio = add(grown, one)
    half = over(one, add(ratio, ratio))
    # |sinh y|, 2 sinh(y/2)^2
    s, bow = times(times(grown, add(ratio, one)), half), times(times(grown, grown), half)
    s = side * s[0], side * s[1]
    y = side * pick(np.abs(g) < 0.25, logarithm_of(g / (2 + g)), logarithm(mantissa, exponent))
    twist, bend = times(times((fine[0], fine[1]), times(u, v)),
                        s), times(times((0.5 * fine[0], 0.5 * fine[1]), add(times(u, u), times(v, v))), bow)
    inner = add(add(slope, twist), bend)
    fall, tilt, energy = bow[0] * (inner[0] + inner[1]), mu * less_sinh(y, s[0]), kinetic[0]
    margin = (fall + tilt) - energy
    far = np.abs(at_x) + np.abs(at_z)
    steep = abs(G) * far + abs(c) + abs(d)
    off = TWOFOLD * (far + rounding * rounding / far)
    pull = steep * off + TWOFOLD * mu + (2 * abs(G) * far + steep) * far * step * step
    astray = TWOFOLD * rounding / np.abs(x + side * z) + off / np.abs(end)
    error = (EPS * (FINE_ROUNDED * (np.abs(fall) + energy) + (LAG_ROUNDED + 2 * np.abs(y)) * np.abs(tilt))
             + pull * np.abs(s[0]))
    error = (error + bow[0] * ((abs(G) * far + steep) * off
                               + FINE * (steep * far + np.abs(twist[0]) + np.abs(bend[0]))))
    error = error + np.abs(mu + (G * x + c) * z + d * x) * astray
    sure = (slope[0] > 0) & (np.abs(step) <= FINE_STEP) & (ratio[0] > 0) & (
        np.abs(margin) > FINE_ROUNDINGS * error)
    return margin, sure & (error <= FINE_SHARE * (np.abs(margin + energy) + energy))


def logarithm_of(q):
    """2 artanh q, log((1 + q)/(1 - q)), for |q| <= 0.1716."""
    t = q * q
    p = 0.15331710618210773 + t * 0.14616585424888623
    p = 0.22222211130259878 + t * (0.18182889455674947 + t * p)
    p = 0.39999999999899444 + t * (0.2857142862600327 + t * p)
    return 2 * q + q * (t * (0.666666666666667 + t * p))


def less_sinh(y, s):
    """y - sinh y; s = sinh y."""
    t = y * y
    series = 1 + t * (1 / 110) * (1 + t * (1 / 156) * (1 + t * (1 / 210) * (1 + t * (1 / 272))))
    series = -y * t * (1 / 6) * (1 + t * (1 / 20) * (1 + t * (1 / 42) * (1 + t * (1 / 72) * series)))
    return pick(np.abs(y) < LAG, series, y - s)


def middle_root(g):
    """1 - x for the root x in (0, 1) of x^3 - 3 x + 2 s = 0, 0 <= s < 1; g = 2 (1 - s): that of e^2 (3 - e) =
    g.

    A polynomial in sqrt(g/3) (Chebyshev, 3e-5), then a step of Newton's method.
    """
    z = np.sqrt(g / 3)
    e = z * (0.9999789403426903 + z * (0.16839955168602871 + z * (0.04686614963071462
              + z * (0.1405440318552184 + z * (-0.1767290819337927 + z * 0.1599218763072062)))))
    return e - (e * e * (3 - e) - g) / (3 * e * (2 - e))


def parabola_height(u, v, form, numbers):
    """(height of the barrier over a place, +inf without one; size of its terms; whether all that is certain)
    on parabolas.

    The place moves with u' = p v + p0, v' = b. The force along it is a cubic that falls at both ends: the
    middle one of three roots is the barrier. A cosine would give it; in correctly rounded operations it is
    taken from its distance from the fold.
    """
    kappa, rho, sigma, m = form
    p, p0, b = numbers
    a, ks, hs = p * v + p0, kappa * v + sigma, kappa * u + rho
    f0, f1, f2, f3 = ks * u + (rho * v
                               + m), ks * a + hs * b, b * (2 * kappa * a + p * ks), 3 * kappa * p * b * b
    a_size, k_size = np.abs(p * v) + abs(p0), np.abs(kappa * v) + abs(sigma)
    s0 = k_size * np.abs(u) + (np.abs(rho * v) + abs(m))
    s1 = k_size * a_size + (np.abs(kappa * u) + abs(rho)) * abs(b)
    s2, s3 = abs(b) * (2 * abs(kappa) * a_size + abs(p) * k_size), abs(f3)
    # about the middle of the roots: r + d t + (f3/6) t^3
    middle, far = -f2 / f3, s2 / s3
    d, r = f1 + 0.5 * middle * f2, f0 + middle * (f1 + middle * f2 / 3)
    cubed, square = 4 * d * d * d, -4.5 * f3 * r * r
    apart = cubed - square
    told = (np.abs(apart) > PAIR_BOUND
            * (12 * d * d * (s1 + 0.5 * far * s2) - 9 * f3 * np.abs(r) * (s0 + far * (s1 + far * s2 / 3))))
    three = (d > 0) & (apart > 0)
    reach = np.sqrt(-2 * d / f3)
    s = 1.5 * np.abs(r) / (d * reach)
    e = middle_root(2 * (apart / cubed) / (1 + s))
    root = reach * (1 - e)
    y = middle - pick(r > 0, root, -root)
    slope = f1 + y * (f2 + y * (0.5 * f3))
    step = (f0 + y * (f1 + y * (0.5 * f2 + y * (f3 / 6)))) / slope
    y = y - step
    height = -y * (f0 + y * (0.5 * f1 + y * (f2 / 6 + y * (f3 / 24))))
    way = np.abs(y)
    scale = way * (s0 + way * (0.5 * s1 + way * (s2 / 6 + way * (s3 / 24)))) + STEP_LEFT * slope * step * step
    clear = (told & (np.abs(f0) > FORCE_BOUND * s0)
             & ((np.abs(step) < STEP_BOUND * reach * e) | (three ^ True)))
    return pick(three, height, np.inf), pick(three, scale, 0.0), clear


# --- loops for the compiler: short passes over blocks that stay in the cache, each simple enough to run on
# whole vectors

BLOCK = 512


def circle_loop(states, axes, frame, form, ranges, cells, unit, margins, labels, reasons, unsure):
    """Margins, labels and reasons of states (n, 3) on circles; unsure: where the general formula has to
    answer."""
    x, z, energy, size = np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)
    phase, best, height, barrier_angle = np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)
    t, cell, clear = np.empty(BLOCK), np.empty(BLOCK, np.int32), np.empty(BLOCK, np.bool_)
    for start in range(0, states.shape[0], BLOCK):
        m = min(BLOCK, states.shape[0] - start)
        places(states[start:start + m], axes, frame, x, z, energy)
        polar(x, z, size, phase, best, clear, m)
        for b in range(ranges.shape[0]):
            positions(size, ranges[b], cells.shape[1], cell, t, m)
            looked_up(cells[b], cell, t, height, barrier_angle, m)
            raise_best(size, phase, height, barrier_angle, ranges[b, LOW], ranges[b, HIGH], ranges[b, GROWTH],
                       form[3], best,
                       clear, m)
            keep_off_fold(x, z, size, ranges[b, ORIGIN], frame[6], clear, m)
        circle_margins(x, z, energy, size, phase, best, frame[6], form, unit, margins[start:start + m], clear)
        circle_labels(margins[start:start + m], best, clear, labels[start:start + m],
                      reasons[start:start + m],
                      unsure[start:start + m])


def places(states, axes, frame, x, z, energy):
    i, j, k = axes
    for n in range(states.shape[0]):
        x[n], z[n] = (states[n, j] + frame[0]) * frame[1], (states[n, k] + frame[2]) * frame[3]
        w = (states[n, i] + frame[4]) * frame[5]
        energy[n] = 0.5 * w * w


def polar(x, z, size, phase, best, clear, m):
    for n in range(m):
        size[n], phase[n] = np.sqrt(x[n] * x[n] + z[n] * z[n]), angle(x[n], z[n])
        best[n], clear[n] = -np.inf, True


def positions(size, span, count, cell, t, m):
    """Each state's cell of a range, and its place in it from -1 to 1."""
    for n in range(m):
        position = cell_position(size[n], span[SIDE], span[ORIGIN], span[BEND], span[WIDTH], count)
        cell[n] = np.int32(np.minimum(np.floor(position), count - 1.0))
        t[n] = 2 * (position - cell[n]) - 1


def looked_up(cells, cell, t, height, barrier_angle, m):
    """What the table says: the one pass that cannot run on whole vectors, so it holds nothing else."""
    for n in range(m):
        c = np.uint64(cell[n])
        height[n] = height_polynomial(cells[c, 0], cells[c, 1], cells[c, 2], cells[c, 3], cells[c, 4],
                                      cells[c, 5], t[n])
        barrier_angle[n] = angle_polynomial(cells[c, 6], cells[c, 7], t[n])


def raise_best(size, phase, height, barrier_angle, low, high, growth, mu, best, clear, m):
    """Raise `best` to the height of this barrier where it stands."""
    for n in range(m):
        whole, known = ahead(barrier_angle[n], phase[n] * TURNS)
        value = height[n] + growth * size[n]
        value = value + mu * TURN * whole
        inside = (low < size[n]) & (size[n] <= high)
        clear[n] = clear[n] & ((known & (value == value)) | (inside ^ True))
        best[n] = pick(inside & (value > best[n]), value, best[n])


def keep_off_fold(x, z, size, origin, shift, clear, m):
    for n in range(m):
        clear[n] = clear[n] & fold_is_clear(size[n], origin, np.abs(x[n]) + np.abs(z[n]) + shift)


def circle_margins(x, z, energy, size, phase, best, shift, form, unit, margins, clear):
    for n in range(margins.shape[0]):
        rounding = np.abs(x[n]) + np.abs(z[n]) + shift
        height = best[n] + circle_height(x[n], z[n], phase[n], form)
        scale = form[3] * (TURN + rounding / size[n]) + terms(rounding, form)
        margin = height - energy[n]
        margins[n] = margin * unit
        clear[n] = (clear[n] & (rounding < FAR * size[n])
                    & (np.abs(force(x[n], z[n], form)) > FORCE_BOUND * scale)
                    & trusted(margin, height, energy[n], scale, MARGIN_BOUND))


def circle_labels(margins, best, clear, labels, reasons, unsure):
    for n in range(margins.shape[0]):
        above = margins[n] < 0
        labels[n], reasons[n] = above, above + (best[n] == -np.inf)
        unsure[n] = not clear[n]


def hyperbola_loop(states, axes, frame, form, ranges, cells, unit, margins, labels, reasons, unsure, fine):
    """As `circle_loop`, on hyperbolas: margins to the barrier nearest in height, +inf without one; all are
    bounded. fine: the constants in 32 digits."""
    x, z, energy, size, nearest = np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK), np.empty(
        BLOCK), np.empty(BLOCK)
    clear, inside = np.empty(BLOCK, np.bool_), np.empty(BLOCK, np.bool_)
    for start in range(0, states.shape[0], BLOCK):
        m = min(BLOCK, states.shape[0] - start)
        places(states[start:start + m], axes, frame, x, z, energy)
        cone(x, z, frame[6], form, size, nearest, clear, m)
        for b in range(ranges.shape[0]):
            keep_off_cone_fold(x, z, size, ranges[b, ORIGIN], frame[6], clear, m)
            on_range(x, z, size, ranges[b], inside, m)
            lower_nearest(states[start:start + m], axes, x, z, energy, size, ranges[b], cells[b], frame[6],
                          form, fine, inside, nearest, clear, m)
        for n in range(m):
            margins[start + n] = nearest[n] * unit
            unsure[start + n] = clear[n] ^ True


def cone(x, z, shift, form, size, nearest, clear, m):
    for n in range(m):
        xi, eta, rounding = x[n] + z[n], x[n] - z[n], np.abs(x[n]) + np.abs(z[n]) + shift
        size[n], nearest[n] = -xi * eta, np.inf
        clear[n] = ((np.minimum(np.abs(xi), np.abs(eta)) > PLANE_BOUND * rounding)
                    & (np.abs(force(x[n], z[n], form)) > FORCE_BOUND * (terms(rounding, form) + form[3])))


def keep_off_cone_fold(x, z, size, origin, shift, clear, m):
    for n in range(m):
        rounding = np.abs(x[n]) + np.abs(z[n]) + shift
        clear[n] = clear[n] & fold_is_clear(size[n], origin, rounding * rounding)


def on_range(x, z, size, span, inside, m):
    low, high, lead, sign = span[LOW], span[HIGH], span[LEAD], span[SIGN]
    for n in range(m):
        inside[n] = (low < size[n]) & (size[n] <= high) & ((x[n] + lead * z[n]) * sign > 0)


def lower_nearest(states, axes, x, z, energy, size, span, cells, shift, form, fine, inside, nearest, clear,
                  m):
    """Bring the margin of this barrier into `nearest` where it stands: few states, so one by one."""
    G, c, d, mu = form
    lead = span[LEAD]
    for n in range(m):
        if inside[n]:
            place = x[n] + lead * z[n]
            rounding = np.abs(x[n]) + np.abs(z[n]) + shift
            position = cell_position(size[n], span[SIDE], span[ORIGIN], span[BEND], span[WIDTH],
                                     cells.shape[0])
            cell = min(int(position), cells.shape[0] - 1)
            t = 2 * (position - cell) - 1
            mantissa, exponent = math.frexp(np.abs(place))
            tilt = mu * lead * logarithm(mantissa, exponent)
            height = height_polynomial(cells[cell, 0], cells[cell, 1], cells[cell, 2], cells[cell, 3],
                                       cells[cell, 4],
                                       cells[cell, 5], t) + tilt
            height = height + ((0.5 * G * x[n] + c) * x[n] + d * z[n])
            margin = height - energy[n]
            scale = hyperbola_scale(terms(rounding, form), tilt, rounding, place, mu, span[STEEP], span[BULK])
            if not trusted(margin, height, energy[n], scale, CONE_MARGIN_BOUND) and clear[n]:
                margin, clear[n] = fine_one(states[n], axes,
                                            angle_polynomial(cells[cell, 6], cells[cell, 7], t), lead,
                                            rounding, form, fine)
            if np.abs(margin) < np.abs(nearest[n]):
                nearest[n] = margin


def fine_one(state, axes, place, lead, rounding, form, fine):
    """`fine_margin` of one state against the barrier of this place, whatever rounding left of the state's
    own."""
    i, j, k = axes
    X, Z, kinetic = fine_place(state[i], state[j], state[k], fine)
    Q = fine_invariant(X, Z)
    u, v = guessed(place, lead, Q[0])
    u, v = double_step(u, v, Q[0], form)
    u, v = double_step(u, v, Q[0], form)
    at_x, at_z, step, slope = fine_step(u, v, Q, fine)
    side, end, grown = ratio_of(X, Z, at_x, at_z)
    mantissa, exponent = math.frexp(1 + grown[0])
    margin, sure = fine_margin(X, Z, kinetic, at_x, at_z, step, slope, side, end, grown, mantissa, exponent,
                               rounding, fine)
    return margin, sure & (np.abs(Q[0]) > fine[20])


def fine_invariant(X, Z):
    return less(times(Z, Z), times(X, X))


def guessed(place, lead, size):
    """(u, v) of the barrier whose coordinate that keeps its sign is `place`, on the hyperbola of this size.
    """
    other = -size / place
    return 0.5 * (place + other), 0.5 * lead * (place - other)


def hyperbola_scale(scale, tilt, rounding, place, mu, steep, bulk):
    return scale + np.abs(tilt) + mu * (1 + rounding / np.abs(place)) + steep * rounding * rounding + bulk


def parabola_loop(states, axes, frame, form, ranges, cells, unit, margins, labels, reasons, unsure):
    """As `hyperbola_loop`, on parabolas, whose barriers need no table: `ranges` holds the numbers along which
    a place moves."""
    i, j, k = axes
    numbers = ranges[0, 0], ranges[0, 1], ranges[0, 2]
    for n in range(states.shape[0]):
        w = (states[n, i] + frame[4]) * frame[5]
        energy = 0.5 * w * w
        height, scale, clear = parabola_height((states[n, j] + frame[0]) * frame[1],
                                               (states[n, k] + frame[2]) * frame[3], form, numbers)
        margin = height - energy
        margins[n] = margin * unit
        unsure[n] = (clear & ((height == np.inf)
                              | trusted(margin, height, energy, scale, PARABOLA_MARGIN_BOUND))) ^ True
