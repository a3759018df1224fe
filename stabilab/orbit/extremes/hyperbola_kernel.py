"""Extremes and periods of many bounded orbits on hyperbolas, as straight lines of floats that numba compiles.

Lane by lane without branches, as `circle_kernel`, so that the loops vectorise. A branch of a hyperbola has one well, or a barrier between two: their
places come from a table over the invariant, Newton's method along the orbit and a last step in twofold numbers. In xi = X + Z, which grows by
t = exp(y) on the way y, and eta = X - Z, which decays, the potential is a polynomial in t and 1/t and a multiple of log t: turning points are told from
the nearest equilibrium by Halley's method for t, and the period is summed over nodes with E - V told from the nearer turning point, which half-way must
agree with the other. What doubles cannot settle is marked and left to the rows in twofold numbers. Every function is plain Python too. A block is a
table: one row a quantity, one column a lane. All in one file, with copies of what other kernels say: numba's cache on disk watches no other.
"""
from __future__ import annotations

from math import pi

import numpy as np

EPS = 2.220446049250313e-16
TURN = 2 * pi
INFINITY = float("inf")
BOX, PERIOD = 1, 2  # bits: wanted, and left open, as in `circle_kernel`
SPLITTER = 134217729.0
DIGITS, PERIOD_DIGITS = 1e-12, 1e-11  # as in `guards` and `period.arrays`
HELD = 1e-14  # of a state's terms: a smaller xi or eta leaves 32 digits too little
CLEAR = 64.0  # times its error: so far a height is from the energy where the barrier's side is certain
SLACK = 6.0  # roundings of a sum of four products by its terms, with room to spare
FINE = 2.0**-92  # of the terms of a force in twofold numbers, as in `rows_kernel`
NARROW = 0.7  # shorter ways take the form that keeps the slope at their beginning, and series where closed forms cancel
NEWTON_STEPS, HALLEY_STEPS = 4, 4
SOLVED, HELD_STEPS = 1e-7, 100  # relative last step in a bracket, which one of Newton's follows; most steps there
LAST_STEP = 1e-5  # of a way, towards its end
TWOFOLD_STEP = 1e-7  # of theta, the correction of an equilibrium in twofold numbers, which leaves its cube
CELLS, OCTAVES, COLUMNS = 16, 80, 8  # of the table: cells an octave of the invariant's size, octaves, columns (kind, places, what they change by)
ENOUGH, SETTLED, FLOOR = 1e-9, 1e-13, 1e-15  # of sums over nodes, as in `circle_kernel`
LANES = 256
MAGIC = 6755399441055744.0  # 1.5 * 2^52: added, it leaves an integer in the last bits
LOG2E, LN2_HIGH, LN2_LOW = 1.4426950408889634, 6.93147180369123816490e-01, 1.90821492927058770002e-10

# rows of a block: the orbit
XI, XI_LOW, ETA, ETA_LOW, X, Z, W, KINETIC, UNCLEAR, FASTEST, CLOSEST, UNSURE, PASSED = range(13)
# rows of an equilibrium: its place; t - 1, t and log t from there to the state; the coefficients of the rise about it; E - V there and its error; dF/dtheta;
# the force that is left there
AT_XI, WAY, GROWN, LOG_WAY, GROW, GROW_2, DECAY, DECAY_2, OVER, HAZE, BEND, LEFT_OVER = range(12)
LEFT, BARRIER, RIGHT = range(3)
# rows of a turning point: the coefficients of the rise about its anchor, towards it; the level; t - 1 there and as far as it may go; |F|, dF/dtheta, errors of
# theta there and of the energy; of the state its way, t - 1 and t from the anchor; the way from it to the end, t - 1 and t there; whether the end is
# ahead; sizes of the terms of the rise, then of F by F; the last step; the force that is left at the anchor;
# the way from there
(E_GROW, E_GROW_2, E_DECAY, E_DECAY_2, E_BEND, LEVEL, SIGN, AT, REACH, PULL, END_BEND, BLUR, FOG, BASE, BASE_WAY, BASE_GROWN, OFFSET, CHANGED, RATIO, TOWARDS,
 TERMS, STEP, REST, WAY_THERE) = range(24)
# rows of the period's table: half the interval, then of either end |F|, dF/dtheta and the coefficients of the rise, towards the other
(RHO, L_PULL, L_BEND, L_GROW, L_GROW_2, L_DECAY, L_DECAY_2, R_PULL, R_BEND, R_GROW, R_GROW_2, R_DECAY, R_DECAY_2, SUM, BEFORE, CHANGE, EARLIER, ROW, GOOD,
 LEAST) = range(20)


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


def times(a, b):
    p, e = exact_product(a[0], b[0])
    return exact_sum(p, e + (a[0] * b[1] + a[1] * b[0]))


def logarithm(t):
    """log t, t > 0, to a unit in the last place: the method and the coefficients of fdlibm (Sun Microsystems, 1993)."""
    bits = np.float64(t).view(np.int64) + 0x95F619980C433  # the bits of 1 less those of sqrt(1/2)
    k = np.int64(((bits >> 52) & 2047) | 0x4330000000000000).view(np.float64) - 4503599627371519.0
    f = np.int64((bits & 0x000FFFFFFFFFFFFF) + 0x3FE6A09E667F3BCD).view(np.float64) - 1.0
    s = f / (2.0 + f)
    z = s * s
    rest = z * (6.666666666666735130e-01 + z * (3.999999999940941908e-01 + z * (2.857142874366239149e-01 + z * (2.222219843214978396e-01 + z * (
        1.818357216161805012e-01 + z * (1.531383769920937332e-01 + z * 1.479819860511658591e-01))))))
    half = 0.5 * f * f
    return k * LN2_HIGH - ((half - (s * (half + rest) + k * LN2_LOW)) - f)


def log_of(m, t):
    """log t, m = t - 1: the better known one counts."""
    return logarithm(t) + ((m - (t - 1)) / t if abs(m) < 0.5 else 0.0)


def grown(y):
    """exp(y) - 1, |y| < 700, to a unit in the last place."""
    whole = y * LOG2E + MAGIC
    k = whole - MAGIC
    r = (y - k * LN2_HIGH) - k * LN2_LOW
    p = r + r * r * (1 / 2 + r * (1 / 6 + r * (1 / 24 + r * (1 / 120 + r * (1 / 720 + r * (1 / 5040 + r * (1 / 40320 + r * (1 / 362880 + r * (
        1 / 3628800 + r * (1 / 39916800 + r * (1 / 479001600 + r * (1 / 6227020800))))))))))))
    scale = np.int64((np.float64(whole).view(np.int64) << 52) + 0x3FF0000000000000).view(np.float64)
    return scale * p + (scale - 1.0)


def sinh_lag(y):
    """sinh y - y, |y| <= 0.7, without cancellation."""
    t = y * y
    return y * t * (1 / 6) * (1 + t * (1 / 20) * (1 + t * (1 / 42) * (1 + t * (1 / 72) * (1 + t * (1 / 110) * (1 + t * (1 / 156) * (1 + t * (1 / 210)))))))


def rise(m, t, y, mu, bend, grow, grow_2, decay, decay_2):
    """V at the way y from an equilibrium, exp(y) = t = 1 + m, less V there; and the size of its terms.

    V falls by grow (m - y) + grow_2 m^2 + decay (y - n) + decay_2 n^2, n = m/(1 + m); short ways take the same told by the slope, the sum
    grow + decay + 2 grow_2 + 2 decay_2 that may cancel: bend (cosh y - 1) - mu (sinh y - y) + 2 (cosh y - 1) (grow_2 m - decay_2 n)."""
    n = m / t
    near = abs(y) < NARROW
    lag, fold = (sinh_lag(y) if near else 0.0), 0.5 * m * n
    one, two = (bend * fold if near else grow * (m - y)), (-mu * lag if near else decay * (y - n))
    three, four = (2 * fold * grow_2 * m if near else grow_2 * m * m), (-2 * fold * decay_2 * n if near else decay_2 * n * n)
    return -(one + two + three + four), abs(one) + abs(two) + abs(three) + abs(four)


def orbit_rows(m, states, fine, form, axes, numbers, lane):
    """Canonical place and rate; what is unclear already."""
    j, k, i = axes
    beside = numbers[6]
    xi, eta, w, kinetic, unclear = lane[XI], lane[ETA], lane[W], lane[KINETIC], lane[UNCLEAR]
    xi_low, eta_low, at_x, at_z = lane[XI_LOW], lane[ETA_LOW], lane[X], lane[Z]
    extra = abs(fine[8] * fine[12]) + abs(fine[10] * fine[14])
    for a in range(m):
        x = times(add((fine[8], fine[9]), (states[a, j], 0.0)), (fine[12], fine[13]))
        z = times(add((fine[10], fine[11]), (states[a, k], 0.0)), (fine[14], fine[15]))
        at_x[a], at_z[a] = x[0], z[0]
        xi[a], xi_low[a] = add(x, z)
        eta[a], eta_low[a] = add(x, (-z[0], -z[1]))
        s, e = exact_sum(states[a, i], form[3])
        w[a] = (s + (e + form[4])) / form[2]
    for a in range(m):
        x, z = at_x[a], at_z[a]
        kinetic[a] = 0.5 * w[a] * w[a]
        wide = abs(x) + abs(z) + extra
        least = min(abs(xi[a]), abs(eta[a]))
        good = (least > HELD * wide) & (np.sqrt(abs(xi[a])) * np.sqrt(abs(eta[a])) > beside) & (wide < INFINITY)
        unclear[a] = 0.0 if good else 1.0


def looked_up(m, lane, cells, first_cell, knots, graded, spots, three):
    """First guesses of |xi| at the equilibria, from the cells of the tables, the graded one beside folds; where these have none, the row is unclear.
    three: 1 where there is a barrier between two wells, else 0."""
    for a in range(m):
        xi, eta = lane[XI, a], lane[ETA, a]
        size = abs(xi * eta)
        branch = (2 if xi > 0 else 0) + (1 if eta > 0 else 0)
        cell = (np.float64(size).view(np.int64) >> 48) - first_cell
        share = (np.float64(size).view(np.int64) & 0x0000FFFFFFFFFFFF) * 3.552713678800501e-15  # 2^-48
        table = cells
        if not 0 <= cell < CELLS * OCTAVES or cells[branch, cell, 0] == 0.0:
            edges, table = knots[1 if branch == 0 or branch == 3 else 0], graded
            cell, high = 0, len(edges) - 1
            while high - cell > 1:
                middle = (cell + high) // 2
                if edges[middle] <= size:
                    cell = middle
                else:
                    high = middle
            share = (size - edges[cell]) / (edges[cell + 1] - edges[cell])
            if not 0 <= share <= 1 or graded[branch, cell, 0] == 0.0:
                lane[UNCLEAR, a], three[a] = 1.0, 0.0
                for s in range(3):
                    spots[s, AT_XI, a] = abs(xi)
                continue
        for s in range(3):
            spots[s, AT_XI, a] = table[branch, cell, 1 + s] + share * table[branch, cell, 4 + s]
        three[a] = 1.0 if table[branch, cell, 0] == 3.0 else 0.0


def place(m, barrier, twofold, numbers, lane, spot):
    """Polish an equilibrium along the orbits, at last in twofold numbers, and tell E - V there from the state; without end is the error where it is none."""
    half_grow, half_decay, eighth, mu = numbers[7], numbers[8], numbers[9], numbers[3]
    mu_low, grow_high, grow_low, decay_high, decay_low, quarter, quarter_low = twofold[1:]
    at, left_over, bend, way, grown_by = spot[AT_XI], spot[LEFT_OVER], spot[BEND], spot[WAY], spot[GROWN]
    at_grow, at_grow_2, at_decay, at_decay_2 = spot[GROW], spot[GROW_2], spot[DECAY], spot[DECAY_2]
    at_xi, xi_low, at_eta, eta_low = lane[XI], lane[XI_LOW], lane[ETA], lane[ETA_LOW]
    for a in range(m):
        xi, eta = at_xi[a], at_eta[a]
        x = at[a] if xi > 0 else -at[a]
        q = xi * eta
        y = q / x
        for _ in range(NEWTON_STEPS):
            one, two, three_, four = half_grow * x, half_decay * y, 2 * eighth * x * x, 2 * eighth * y * y
            last = -(mu + one + two + three_ - four) / (one - two + 2 * (three_ + four))
            x += x * (last * (1 + 0.5 * last))
            y = q / x
        at[a] = x
    for a in range(m):
        xi, x = (at_xi[a], xi_low[a]), at[a]
        q = times(xi, (at_eta[a], eta_low[a]))
        y = q[0] / x
        p, e = exact_product(y, x)
        y = exact_sum(y, ((q[0] - p) - e + q[1]) / x)
        p, e = exact_product(grow_high, x)
        grow, decay = exact_sum(p, e + grow_low * x), times((decay_high, decay_low), y)
        square, other = exact_product(x, x), times(y, y)
        square, other = times((quarter, quarter_low), square), times((quarter, quarter_low), other)
        force = add(add((mu, mu_low), add(grow, decay)), add(square, (-other[0], -other[1])))
        slope = add(add(grow, (-decay[0], -decay[1])), (2 * square[0], 2 * square[1]))
        slope = add(slope, (2 * other[0], 2 * other[1]))
        one, two, three_, four = grow[0], decay[0], square[0], other[0]
        second, third = one + two + 4 * (three_ - four), one - two + 8 * (three_ + four)
        terms = mu + abs(one) + abs(two) + abs(three_) + abs(four)
        move = -force[0] / slope[0]
        move -= 0.5 * second / slope[0] * move * move
        bent = slope[0] + move * (second + 0.5 * move * third)
        good = (abs(move) < TWOFOLD_STEP) & ((bent > 0) == barrier)
        # t of the state, where x is the place before the last move
        t, off, back = xi[0] / x, ((xi[0] - x) + xi[1]) / x, move * (1 - 0.5 * move)
        grown_by[a], way[a] = t - t * back, off - t * back
        x += x * move
        at[a], bend[a], left_over[a] = x, bent, (FINE * terms + 8 * terms * abs(move * move * move) if good else INFINITY)
        move = 2 * move
        three_, four = three_ * (1 + move), four * (1 - move)
        at_grow[a], at_grow_2[a] = one * (1 + 0.5 * move) + three_, 0.5 * three_
        at_decay[a], at_decay_2[a] = four - two * (1 - 0.5 * move), 0.5 * four
    for a in range(m):
        way, t = spot[WAY, a], spot[GROWN, a]
        log_way = log_of(way, t)
        up, size = rise(way, t, log_way, mu, bend[a], spot[GROW, a], spot[GROW_2, a], spot[DECAY, a], spot[DECAY_2, a])
        spot[LOG_WAY, a], spot[OVER, a] = log_way, lane[KINETIC, a] + up
        spot[HAZE, a] = SLACK * EPS * ((1 + abs(log_way)) * size + lane[KINETIC, a]) + left_over[a] * abs(log_way)


def enclose(m, lane, spots, three):
    """Which equilibria stop a motion; what is unclear because they are out of order or a barrier is as high as the energy. PASSED: 1 where the motion passes a
    barrier, 0 where there is none or it stops the motion."""
    left, barrier, right = spots[LEFT], spots[BARRIER], spots[RIGHT]
    unclear, closest, unsure, fastest, passed = lane[UNCLEAR], lane[CLOSEST], lane[UNSURE], lane[FASTEST], lane[PASSED]
    for a in range(m):
        has, over = three[a] > 0, barrier[OVER, a]
        ordered = (left[LOG_WAY, a] > barrier[LOG_WAY, a]) & (barrier[LOG_WAY, a] > right[LOG_WAY, a])
        sure = (abs(over) > CLEAR * barrier[HAZE, a]) & ordered
        unclear[a] = 1.0 if has and not sure else unclear[a]
        closest[a], unsure[a] = (abs(over) if has else INFINITY), (barrier[HAZE, a] if has else 0.0)
        blocked = has and over <= 0
        passed[a] = 1.0 if has and not blocked else 0.0
        # a barrier on the right leaves the well on the left, and the other way round
        on_right = barrier[LOG_WAY, a] < 0
        best_left = left[OVER, a] if not (blocked and not on_right) else right[OVER, a]
        best_right = right[OVER, a] if not (blocked and on_right) else left[OVER, a]
        fastest[a] = max(lane[KINETIC, a], max(best_left, best_right))
        unclear[a] = unclear[a] if best_left > 0 and best_right > 0 else 1.0


def searched(level, sign, mu, bend, grow, grow_2, decay, decay_2, reach):
    """exp(y) - 1 of the way y from an anchor, up to `reach`, where the rise is the level: Newton's method for y, held in a bracket."""
    high = log_of(reach, 1 + reach) if reach < INFINITY else 1.0
    while reach == INFINITY and high < 600 and sign * rise(grown(high), 1 + grown(high), high, mu, bend, grow, grow_2, decay, decay_2)[0] < level:
        high *= 2
    low, y, before = 0.0, 0.5 * high, INFINITY
    for _ in range(HELD_STEPS):
        m = grown(y)
        t = 1 + m
        over = sign * rise(m, t, y, mu, bend, grow, grow_2, decay, decay_2)[0] - level
        if over > 0:
            high = y
        else:
            low = y
        step = -over / (sign * m * (grow + 2 * grow_2 * t + (decay + 2 * decay_2 / t) / t))
        if abs(step) <= SOLVED * y:
            break
        if low <= y - step <= high and abs(step) < 0.5 * before:
            before, y = abs(step), y - step
        else:
            before, y = high - low, 0.5 * (low + high)
    return grown(y)


def turn(m, side, mu, lane, spots, three, end):
    """Turning points on one side, from the well next to it or from the barrier behind it, whichever is nearer in height; AT nan where none is found."""
    left, barrier, right = spots[LEFT], spots[BARRIER], spots[RIGHT]
    outer, inner = (right, left) if side > 0 else (left, right)
    at, grow, grow_2, decay, decay_2, bend = end[AT], end[E_GROW], end[E_GROW_2], end[E_DECAY], end[E_DECAY_2], end[E_BEND]
    level, sign, reach, towards, step = end[LEVEL], end[SIGN], end[REACH], end[TOWARDS], end[STEP]
    for a in range(m):
        over = barrier[OVER, a]
        held = three[a] > 0 and over <= 0 and barrier[LOG_WAY, a] * side < 0
        g, g2 = (inner[GROW, a] if held else outer[GROW, a]), (inner[GROW_2, a] if held else outer[GROW_2, a])
        f, f2 = (inner[DECAY, a] if held else outer[DECAY, a]), (inner[DECAY_2, a] if held else outer[DECAY_2, a])
        under, haze = (inner[OVER, a] if held else outer[OVER, a]), (inner[HAZE, a] if held else outer[HAZE, a])
        way, slope = (inner[LOG_WAY, a] if held else outer[LOG_WAY, a]), (inner[BEND, a] if held else outer[BEND, a])
        rest, base = (inner[LEFT_OVER, a] if held else outer[LEFT_OVER, a]), (inner[WAY, a] if held else outer[WAY, a])
        up = inner[GROWN, a] if held else outer[GROWN, a]
        high = held and -over < under
        wide = abs(way - barrier[LOG_WAY, a])
        # of an end between barrier and well, as in `circle_kernel`
        whole = under - over
        root = np.sqrt(min(abs(over), abs(under)) / abs(whole))
        square = root * root
        psi = 2 / pi * root * (1 + square * (1 / 6 + square * (3 / 40 + square * (5 / 112 + square * 0.06))))
        at_b, at_w = pi / wide * np.sqrt(0.5 * abs(whole / barrier[BEND, a])), pi / wide * np.sqrt(0.5 * abs(whole / slope))
        near, far = (at_b if high else at_w), (at_w if high else at_b)
        share = psi * (near * (1 - psi) * (1 - psi) + psi * (3 - 2 * psi) - far * psi * (1 - psi))
        share = min(max(share, 0.01 * psi), 0.9)
        g, g2 = (barrier[GROW, a] if high else g), (barrier[GROW_2, a] if high else g2)
        f, f2 = (barrier[DECAY, a] if high else f), (barrier[DECAY_2, a] if high else f2)
        forward = (side > 0) != high
        grow[a], grow_2[a], decay[a], decay_2[a] = (g if forward else f), (g2 if forward else f2), (f if forward else g), (f2 if forward else g2)
        level[a], sign[a], towards[a] = (-over if high else under), (-1.0 if high else 1.0), (1.0 if forward else -1.0)
        end[BASE, a], end[BASE_WAY, a] = (-barrier[LOG_WAY, a] if high else -way), (barrier[WAY, a] if high else base)
        end[BASE_GROWN, a] = barrier[GROWN, a] if high else up
        end[FOG, a], end[REST, a] = (barrier[HAZE, a] if high else haze), (barrier[LEFT_OVER, a] if high else rest)
        bend[a] = barrier[BEND, a] if high else slope
        # of one against the wall: the root of the rise is between m sqrt(bend/2) and m sqrt(its growing term)
        out = np.sqrt(level[a] if level[a] > 0 else 0.0)
        begin_, finally_ = np.sqrt(0.5 * abs(slope)), np.sqrt(abs(grow_2[a]))
        second = out / (finally_ + (begin_ - finally_) / (1 + 0.5 * out / begin_))
        at[a] = grown(min(share * wide, 600.0)) if held else second
        reach[a] = grown(min(wide, 600.0)) if held else INFINITY
    for rest in range(HALLEY_STEPS, -1, -1):
        last = 0.0 if rest == 0 else 1.0
        for a in range(m):
            n = at[a]
            t, inverse = 1 + n, 1 / (1 + n)
            y = log_of(n, t)
            up, size = rise(n, t, y, mu * towards[a], bend[a], grow[a], grow_2[a], decay[a], decay_2[a])
            up *= sign[a]
            up = up if up > 0 else 1e-300
            inside = grow[a] + 2 * grow_2[a] * t + inverse * (decay[a] + 2 * decay_2[a] * inverse)
            slope = -sign[a] * n * inside * inverse  # of the rise, by t
            bent = -sign[a] * (grow[a] + 2 * grow_2[a] * (2 * t - 1) + inverse * inverse * (decay[a] + 2 * decay_2[a] * (2 - t) * inverse))  # by y, over t
            second = (bent - slope) * inverse
            root = np.sqrt(up)
            off = 2 * (up - root * np.sqrt(level[a]))
            # Halley's step for the root of the rise, which is nearly straight in t
            move = -2 * off * slope / (2 * slope * slope - off * (second - 0.5 * slope * slope / up))
            at[a] = min(max(n + move * last, 0.25 * n), min(0.5 * (n + reach[a]), 16 * n))
            step[a], end[TERMS, a] = (up - level[a]) / (slope * t), size
    for a in range(m):
        if level[a] > 0 and not abs(step[a]) <= SOLVED * min(at[a], 1.0):
            at[a] = searched(level[a], sign[a], mu * towards[a], bend[a], grow[a], grow_2[a], decay[a], decay_2[a], reach[a])
            t = 1 + at[a]
            y = log_of(at[a], t)
            up, end[TERMS, a] = rise(at[a], t, y, mu * towards[a], bend[a], grow[a], grow_2[a], decay[a], decay_2[a])
            step[a] = -(sign[a] * up - level[a]) / (sign[a] * at[a] * (grow[a] + 2 * grow_2[a] * t + (decay[a] + 2 * decay_2[a] / t) / t))
    settle_end(m, mu, end)


def settle_end(m, mu, end):
    """The last step of an end, which is Newton's: it leaves its square over the way to where the force vanishes, at most some four times. Then what is known
    of the end; a few quantities a loop, else none vectorises."""
    at, way, step, towards, bend = end[AT], end[WAY_THERE], end[STEP], end[TOWARDS], end[E_BEND]
    grow, grow_2, decay, decay_2 = end[E_GROW], end[E_GROW_2], end[E_DECAY], end[E_DECAY_2]
    pull, end_bend, blur, fog, terms = end[PULL], end[END_BEND], end[BLUR], end[FOG], end[TERMS]
    for a in range(m):
        before, move = at[a], -step[a]
        way[a], at[a] = log_of(before, 1 + before) + move, before + (1 + before) * move * (1 + 0.5 * move)
    for a in range(m):  # F, as the fall of the rise over short ways and over long ones
        n, slope, mu_on = at[a], bend[a], mu * towards[a]
        t, inverse = 1 + n, 1 / (1 + n)
        back = n * inverse
        near = way[a] < NARROW
        first, second = 2 * grow_2[a] * (n + 0.5 * back), 2 * decay_2[a] * back * (inverse + 0.5)
        one, two, three, four = grow[a], 2 * grow_2[a] * t, inverse * decay[a], 2 * decay_2[a] * inverse * inverse
        inside = slope * (1 - 0.5 * back) - 0.5 * mu_on * back + first - second if near else one + two + three + four
        sizes = abs(slope) + 0.5 * mu * back + abs(first) + abs(second) if near else abs(one) + abs(two) + abs(three) + abs(four)
        pull[a], blur[a] = abs(n * inside), sizes / abs(inside)
    for a in range(m):  # dF/dtheta, of short ways
        n, mu_on = at[a], mu * towards[a]
        t, inverse = 1 + n, 1 / (1 + n)
        back = n * inverse
        fold, s = 0.5 * n * back, 0.5 * (n + back)
        end_bend[a] = bend[a] * (1 + fold) - mu_on * s + 2 * grow_2[a] * ((1 + fold) * n + (2 * s + fold) * t) - 2 * decay_2[a] * (
            (1 + fold) * back + (2 * s - fold) * inverse)
    base, base_way, base_grown, offset, ratio, changed = end[BASE], end[BASE_WAY], end[BASE_GROWN], end[OFFSET], end[RATIO], end[CHANGED]
    for a in range(m):
        n, inverse, ahead = at[a], 1 / (1 + at[a]), towards[a] > 0
        by = (1 + n if ahead else inverse) / base_grown[a]
        changed[a] = ((n if ahead else -n * inverse) - base_way[a]) / base_grown[a] if abs(base_way[a]) < 0.5 else by - 1
        ratio[a], offset[a] = by, base[a] + towards[a] * way[a]
    level, rest = end[LEVEL], end[REST]
    for a in range(m):
        y, move, known = way[a], step[a], fog[a]
        found = (abs(move) < LAST_STEP * min(y, 1.0)) & (level[a] > CLEAR * known) & (y > 0)
        fog[a] = known + SLACK * EPS * (1 + y) * terms[a] + rest[a] * y
        at[a] = at[a] if found else np.nan
    for a in range(m):
        y, move = way[a], step[a]
        terms[a], blur[a] = blur[a], fog[a] / pull[a] + 2 * EPS * (abs(base[a]) + y) + 4 * move * move / y


def sort_out(m, wanted, lane, left_end, right_end, left_open):
    """What stays open: unclear lanes, and those with an end that was not found or is not on its side of the state."""
    for a in range(m):
        good = (lane[UNCLEAR, a] == 0.0) & (left_end[AT, a] > 0) & (right_end[AT, a] > 0) & (left_end[BLUR, a] + right_end[BLUR, a] < 1e-6) & (
            left_end[OFFSET, a] <= left_end[BLUR, a]) & (right_end[OFFSET, a] >= -right_end[BLUR, a])
        left_open[a] = 0 if good else wanted


def write_boxes(m, states, form, axes, lane, left_end, right_end, boxes, left_open):
    """The ranges of settled lanes; what has not its digits stays open. A coordinate is stationary where xi and eta are alike in size: if both have one sign
    that is X, else Z."""
    j, k, i = axes
    per_x, per_z, per_w, shift = form[0], form[1], form[2], form[3]
    for a in range(m):
        xi, eta = lane[XI, a], lane[ETA, a]
        on, off = left_end[CHANGED, a], right_end[CHANGED, a]
        left_t, right_t = left_end[RATIO, a], right_end[RATIO, a]
        one, two, three, four = 0.5 * xi * on, -0.5 * eta * on / left_t, 0.5 * xi * off, -0.5 * eta * off / right_t
        lx, le, rx, re = xi * left_t, eta / left_t, xi * right_t, eta / right_t
        inside = (abs(lx) < abs(le)) & (abs(rx) > abs(re))
        alike = (xi > 0) == (eta > 0)
        # the vertex, less the state: a difference of roots, for the shift may be many times as long
        root = (lane[Z, a] if alike else lane[X, a]) / (np.sqrt(abs(xi)) + np.sqrt(abs(eta)))
        vertex = -2 * root * root if xi > 0 else 2 * root * root
        at_x, at_z = (vertex if inside and alike else 0.0), (vertex if inside and not alike else 0.0)
        x_low, x_high = min(min(one + two, three + four), min(at_x, 0.0)), max(max(one + two, three + four), max(at_x, 0.0))
        z_low, z_high = min(min(one - two, three - four), min(at_z, 0.0)), max(max(one - two, three - four), max(at_z, 0.0))
        rounding = 4 * EPS * max(abs(one) + abs(two), abs(three) + abs(four))
        off_x = 0.5 * max(abs(lx - le) * left_end[BLUR, a], abs(rx - re) * right_end[BLUR, a]) + rounding
        off_z = 0.5 * max(abs(lx + le) * left_end[BLUR, a], abs(rx + re) * right_end[BLUR, a]) + rounding
        u, v = per_x * x_low, per_x * x_high
        low, high = states[a, j] + min(u, v), states[a, j] + max(u, v)
        good = abs(per_x) * off_x + 4 * EPS * (abs(states[a, j]) + max(abs(u), abs(v))) <= DIGITS * max(abs(low), abs(high))
        boxes[a, j, 0], boxes[a, j, 1] = low, high
        u, v = per_z * z_low, per_z * z_high
        low, high = states[a, k] + min(u, v), states[a, k] + max(u, v)
        good = good & (abs(per_z) * off_z + 4 * EPS * (abs(states[a, k]) + max(abs(u), abs(v))) <= DIGITS * max(abs(low), abs(high)))
        boxes[a, k, 0], boxes[a, k, 1] = low, high
        top = np.sqrt(2 * lane[FASTEST, a])
        u, v = per_w * top - shift, -per_w * top - shift
        boxes[a, i, 0], boxes[a, i, 1] = min(min(u, v), states[a, i]), max(max(u, v), states[a, i])
        rate = abs(per_w) * top
        fog = max(left_end[FOG, a], right_end[FOG, a]) + SLACK * EPS * lane[FASTEST, a]
        good = good & (fog / lane[FASTEST, a] * rate + 2 * EPS * (rate + abs(shift)) <= DIGITS * max(abs(u), abs(v)))
        left_open[a] = left_open[a] if good else left_open[a] | BOX


def gather(m, numbers, lane, left_end, right_end, left_open, narrow, table):
    """The settled lanes whose period doubles can tell, packed; how many. narrow: which half-widths."""
    half_grow, half_decay, eighth = numbers[7], numbers[8], numbers[9]
    count = 0
    for a in range(m):
        rho = 0.5 * (right_end[OFFSET, a] - left_end[OFFSET, a])
        if left_open[a] & PERIOD or (rho < NARROW) != narrow:
            continue
        blur = left_end[BLUR, a] + right_end[BLUR, a]
        level = max(left_end[FOG, a] / left_end[LEVEL, a], right_end[FOG, a] / right_end[LEVEL, a])
        noise = SLACK * EPS * max(left_end[TERMS, a], right_end[TERMS, a])
        if not (blur <= 0.25 * PERIOD_DIGITS * rho and noise <= 0.5 * PERIOD_DIGITS and level <= 0.5 * PERIOD_DIGITS
                and lane[UNSURE, a] <= 0.5 * PERIOD_DIGITS * lane[CLOSEST, a] and rho < 300):
            left_open[a] |= PERIOD
            continue
        table[RHO, count], table[ROW, count] = rho, a
        for side in range(2):
            end, at = (right_end, R_PULL) if side else (left_end, L_PULL)
            xi, eta = lane[XI, a] * end[RATIO, a], lane[ETA, a] / end[RATIO, a]
            three, four = 2 * eighth * xi * xi, 2 * eighth * eta * eta
            grow, decay = half_grow * xi + three, four - half_decay * eta
            table[at, count], table[at + 1, count] = end[PULL, a], end[END_BEND, a]
            table[at + 2, count], table[at + 3, count] = (decay if side else grow), 0.5 * (four if side else three)
            table[at + 4, count], table[at + 5, count] = (grow if side else decay), 0.5 * (three if side else four)
        table[LEAST, count] = lane[CLOSEST, a] if lane[PASSED, a] > 0 else INFINITY
        count += 1
    return count


def kinetic(narrow, y, m, mu, pull, bend, grow, grow_2, decay, decay_2):
    """E - V at the way y from an end, exp(y) - 1 = m, and the size of its terms: as `rise`."""
    n = m / (1 + m)
    if narrow:
        fold, s = 0.5 * m * n, 0.5 * (m + n)
        one, two, three, four, five = pull * s, -mu * sinh_lag(y), bend * fold, 2 * fold * grow_2 * m, -2 * fold * decay_2 * n
    else:
        one, two, three, four, five = pull * y, grow * (m - y), grow_2 * m * m, decay * (y - n), decay_2 * n * n
    return one + two + three + four + five, abs(one) + abs(two) + abs(three) + abs(four) + abs(five)


def add_node(count, share, mu, narrow, table):
    """Add 1/np.sqrt(2 H), H = (E - V)/((theta - l)(r - theta)), where theta - l = 2 rho share and at the mirror image, each told from the nearer end."""
    rho, total = table[RHO], table[SUM]
    lf, lb, lg, lg2, ld, ld2 = table[L_PULL], table[L_BEND], table[L_GROW], table[L_GROW_2], table[L_DECAY], table[L_DECAY_2]
    rf, rb, rg, rg2, rd, rd2 = table[R_PULL], table[R_BEND], table[R_GROW], table[R_GROW_2], table[R_DECAY], table[R_DECAY_2]
    factor = np.sqrt(2 * share * (1 - share))
    for a in range(count):
        y = 2 * rho[a] * share
        m = grown(y)
        near, _ = kinetic(narrow, y, m, mu, lf[a], lb[a], lg[a], lg2[a], ld[a], ld2[a])
        far, _ = kinetic(narrow, y, m, -mu, rf[a], rb[a], rg[a], rg2[a], rd[a], rd2[a])
        total[a] += factor * rho[a] * (np.sqrt(near) + np.sqrt(far)) / np.sqrt(near * far)


def begin(count, mu, narrow, table):
    """The node at both ends, and the one half-way, where what is told from either end must agree within the period's digits."""
    for a in range(count):
        rho = table[RHO, a]
        m = grown(rho)
        near, terms = kinetic(narrow, rho, m, mu, table[L_PULL, a], table[L_BEND, a], table[L_GROW, a], table[L_GROW_2, a], table[L_DECAY, a],
                              table[L_DECAY_2, a])
        far, others = kinetic(narrow, rho, m, -mu, table[R_PULL, a], table[R_BEND, a], table[R_GROW, a], table[R_GROW_2, a], table[R_DECAY, a],
                              table[R_DECAY_2, a])
        least = min(min(near, far), table[LEAST, a])
        good = (abs(near - far) <= 0.25 * PERIOD_DIGITS * least) & (SLACK * EPS * max(terms, others) <= 0.5 * PERIOD_DIGITS * least)
        table[GOOD, a] = 1.0 if good else 0.0
        ends, middle = np.sqrt(rho / table[L_PULL, a]) + np.sqrt(rho / table[R_PULL, a]), rho * np.sqrt(0.5) * (1 / np.sqrt(near) + 1 / np.sqrt(far))
        table[SUM, a] = 0.5 * (ends + middle)
        table[BEFORE, a] = table[SUM, a] * (0.5 * TURN)


def converged(now, last, middle, first):
    """As in `circle_kernel`."""
    c, b, a = last / now, middle / now + FLOOR, first / now + FLOOR
    a2, b2 = a * a, b * b
    return (c <= ENOUGH) & (c * c * c <= SETTLED * b2) & (c * b2 * b2 <= SETTLED * a2 * a2) & (b * c * c <= SETTLED * a2) & (
        b2 * b2 * b2 * b <= SETTLED * a2 * a2 * a2)


def add_nodes(count, nodes, first, last, mu, narrow, table):
    for node in range(first, last):
        if narrow:
            add_node(count, nodes[node], mu, True, table)
        else:
            add_node(count, nodes[node], mu, False, table)


def librations(count, nodes, mu, narrow, table, periods, left_open):
    """Periods of the packed lanes, written to their places; what is not settled by 1024 nodes stays open."""
    if narrow:
        begin(count, mu, True, table)
    else:
        begin(count, mu, False, table)
    add_nodes(count, nodes, 2, 3, mu, narrow, table)
    for a in range(count):
        now = table[SUM, a] * (0.25 * TURN)
        table[EARLIER, a], table[BEFORE, a] = abs(now - table[BEFORE, a]), now
    add_nodes(count, nodes, 1, 2, mu, narrow, table)
    add_nodes(count, nodes, 3, 4, mu, narrow, table)
    kept = 0
    for a in range(count):
        now = table[SUM, a] * (0.125 * TURN)
        table[CHANGE, a], table[BEFORE, a] = abs(now - table[BEFORE, a]), now
        if table[GOOD, a] > 0:
            for row in range(ROW + 1):
                table[row, kept] = table[row, a]
            kept += 1
        else:
            left_open[int(table[ROW, a])] |= PERIOD
    count, size, first = kept, 8, 5
    while first < len(nodes) and count:
        add_nodes(count, nodes, first, first + size // 2, mu, narrow, table)
        first, size = first + size // 2, 2 * size
        kept = 0
        for a in range(count):
            now = table[SUM, a] * (TURN / size)
            change = abs(now - table[BEFORE, a])
            if converged(now, change, table[CHANGE, a], table[EARLIER, a]):
                periods[int(table[ROW, a])] = now
            else:
                table[EARLIER, a], table[CHANGE, a], table[BEFORE, a] = table[CHANGE, a], change, now
                for row in range(ROW + 1):
                    table[row, kept] = table[row, a]
                kept += 1
        count = kept
    for a in range(count):
        left_open[int(table[ROW, a])] |= PERIOD


def orbits(states, fine, form, axes, numbers, twofold, cells, first_cell, knots, graded, wanted, nodes, boxes, periods, left_open):
    """Fill boxes (n, 3, 2) and periods (n,) as far as wanted; left_open (n,): the bits that stay open.

    fine, form, axes and the first of numbers: as `rows_kernel.rows` takes them, then (c + d)/2, (d - c)/2 and G/8; twofold: high and low parts of mu, of these
    two and of G/4; cells and knots, graded: the tables of equilibria.
    """
    lane, spots, ends, table = np.empty((13, LANES)), np.empty((3, 12, LANES)), np.empty((2, 24, LANES)), np.empty((20, LANES))
    three, mu = np.empty(LANES), numbers[3]
    for start in range(0, len(states), LANES):
        stop = min(start + LANES, len(states))
        m, part, open_ = stop - start, states[start:stop], left_open[start:stop]
        orbit_rows(m, part, fine, form, axes, numbers, lane)
        looked_up(m, lane, cells, first_cell, knots, graded, spots, three)
        for s in range(3):
            place(m, s == BARRIER, twofold, numbers, lane, spots[s])
        enclose(m, lane, spots, three)
        turn(m, -1.0, mu, lane, spots, three, ends[0])
        turn(m, 1.0, mu, lane, spots, three, ends[1])
        sort_out(m, wanted, lane, ends[0], ends[1], open_)
        if wanted & BOX:
            write_boxes(m, part, form, axes, lane, ends[0], ends[1], boxes[start:stop], open_)
        if wanted & PERIOD:
            for narrow in (False, True):
                packed = gather(m, numbers, lane, ends[0], ends[1], open_, narrow, table)
                librations(packed, nodes, mu, narrow, table, periods[start:stop], open_)
