"""Homoclinic loops on circles, as straight lines of floats: one loop's end, and whole graded sheets for numba to compile.

A place is (x, z) on its circle, g the numbers (G, c, d, mu) of the force mu + G x z + c z + d x. `loop` asks for one loop at a
time and loads neither NumPy nor numba; `sheet_grid` says what the grading means; `fast_sheets` compiles. All in one file:
numba's cache on disk watches no other. Arrays come from the caller.
"""
from __future__ import annotations

from math import acos, atan, atan2, copysign, cos, log1p, pi, sin, sinh, sqrt

EPS = 2.220446049250313e-16
TURN = 2 * pi
NONE, ENDS, SHARED = 0, 1, 2  # what a loop does: it is none, it ends at a turning point, or at a saddle as high
OWN = 1e-9                    # offsets below this are the saddle itself
LEVEL = 64 * EPS              # barriers that differ less from the saddle's height, relative to the energy's terms, are as high
SPREAD = 1e-3                 # of the largest root of a cubic: smaller ones the closed form, a difference of numbers of its size, loses digits of
LOST = 1e-4                   # of a cubic's terms: a discriminant that is less may have the other sign
SHARPEST = 1e3                # bends tighter than the loop's length over this are not resolved
TINY = 2.2250738585072014e-308
# of a strip: where its branch begins and ends, on which line (ON_LINE 0: on the hyperbola)
START, END, ON_LINE, X0, Z0, DX, DZ = range(7)


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
        return y * t * (1 / 6) * (1 - t * (1 / 20) * (1 - t * (1 / 42) * (1 - t * (1 / 72) * (1 - t * (1 / 110) * (
            1 - t * (1 / 156))))))
    return y - sin(y)


def rise(g, x, z, y):
    """V at the offset y over V at an equilibrium (x, z)."""
    half = sin(0.5 * y)
    b = -2 * half * half
    dx = z * sin(y) + x * b
    return -g[3] * y_minus_sin(y) - b * (g[0] * x * x + g[1] * x - g[2] * z) - 0.5 * g[0] * dx * dx


def risen(g, x, z, y):
    """(`rise`, the place there), with one sine and one cosine."""
    half = 0.5 * y
    sine = sin(half)
    s, b = 2 * sine * cos(half), -2 * sine * sine
    dx = z * s + x * b
    lag = y - s if abs(y) >= 0.7 else y_minus_sin(y)
    return -g[3] * lag - b * (g[0] * x * x + g[1] * x - g[2] * z) - 0.5 * g[0] * dx * dx, x + dx, z + (z * b - x * s)


def risen_row(g, x, z, y, height, there_x, there_z):
    """Fill height, there_x and there_z (m,) with `risen` of offsets y (m,) up to a turn; sine and cosine of a quarter by their series, which, having no
    branch, are formed four at a time."""
    curved, half_G, mu = g[0] * x * x + g[1] * x - g[2] * z, 0.5 * g[0], g[3]
    for a in range(len(y)):
        v = 0.25 * y[a]
        q = v * v
        sine = v * (1 - q * (1 / 6) * (1 - q * (1 / 20) * (1 - q * (1 / 42) * (1 - q * (1 / 72) * (1 - q * (1 / 110) * (1 - q * (1 / 156) * (
            1 - q * (1 / 210) * (1 - q * (1 / 272) * (1 - q * (1 / 342) * (1 - q * (1 / 420) * (1 - q * (1 / 506))))))))))))
        cosine = 1 - q * (1 / 2) * (1 - q * (1 / 12) * (1 - q * (1 / 30) * (1 - q * (1 / 56) * (1 - q * (1 / 90) * (1 - q * (1 / 132) * (
            1 - q * (1 / 182) * (1 - q * (1 / 240) * (1 - q * (1 / 306) * (1 - q * (1 / 380) * (1 - q * (1 / 462)))))))))))
        half_sine, half_cosine = 2 * sine * cosine, 1 - 2 * sine * sine
        s, b = 2 * half_sine * half_cosine, -2 * half_sine * half_sine
        w = y[a] * y[a]
        near = y[a] * w * (1 / 6) * (1 - w * (1 / 20) * (1 - w * (1 / 42) * (1 - w * (1 / 72) * (1 - w * (1 / 110) * (1 - w * (1 / 156))))))
        lag = near if w < 0.49 else y[a] - s
        dx = z * s + x * b
        height[a] = -mu * lag - b * curved - half_G * dx * dx
        there_x[a], there_z[a] = x + dx, z + (z * b - x * s)


def departure_row(g, x, z, y, there_x, there_z, here_x, here_z, w, size_x, size_z, out):
    """Fill out (m,) with the energy of rounded places (here_x, here_z) with W w above the saddle's, relative to the size of the energy's terms; they lie
    beside the places there_x, there_z at the offsets y, and their sizes are those of the places and of the shifts size_x, size_z."""
    Q = x * x + z * z
    inverse, curved, half_G, mu = 1 / Q if Q > 0 else 0.0, g[0] * x * x + g[1] * x - g[2] * z, 0.5 * g[0], g[3]
    size_G, slopes = abs(g[0]), abs(g[1]) + abs(g[2])
    for a in range(len(y)):
        px, pz = here_x[a], here_z[a]
        s, b = (px * z - pz * x) * inverse, (px * x + pz * z) * inverse - 1
        seen = y[a] + (px * there_z[a] - pz * there_x[a]) * inverse
        dx = px - x
        kinetic = 0.5 * w[a] * w[a]
        off = abs(kinetic - mu * (seen - s) - b * curved - half_G * dx * dx)
        wide, high = abs(px) + size_x, abs(pz) + size_z
        out[a] = off / (kinetic + size_G * (wide * wide + high * high) + slopes * (wide + high) + abs(mu))


def place_of(x, z):
    return x, z


def xz(x, z):
    return x, z


def invariant(x, z):
    return x * x + z * z


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

    Along the orbit F(y) = 2 sin(y/2) (a0 C^3 + a1 C^2 S + a2 C S^2 + a3 S^3) with C = cos(y/2), S = sin(y/2): a cubic for the
    tangent, or for the cotangent where the tangent may be infinite.
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
    """Real roots of a t^3 + b t^2 + c t + d, nan in place of those that are not, each with a step of Newton's method for
    what the closed form lost."""
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
        first, second, last = (better(p, q, r, -2 * size * cos(angle) - third), better(p, q, r, -2 * size * cos(angle + TURN / 3) - third),
                               better(p, q, r, -2 * size * cos(angle - TURN / 3) - third))
        most = first if abs(first) >= max(abs(second), abs(last)) else second if abs(second) >= abs(last) else last
        if min(abs(first), abs(second), abs(last)) < SPREAD * abs(most):
            return beside_largest(p, q, r, most)
        return first, second, last
    single = -copysign((abs(half) + sqrt(rest)) ** (1 / 3), half)
    only = better(p, q, r, single + (square / single if single != 0 else 0.0) - third)
    return beside_largest(p, q, r, only) if rest <= LOST * half * half and only * only * abs(only) * SPREAD > abs(r) else (only, nan, nan)


def beside_largest(p, q, r, t):
    """The largest root t of t^3 + p t^2 + q t + r with the two much smaller ones, of which the closed form keeps no digit: those of the quadratic that is left,
    from its low powers up. nan where they are not real."""
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
    """(distance along the circle from a saddle to the far end of its loop on one side (-1, +1), distance to the deepest well
    inside, NONE or ENDS or SHARED).

    The loop ends where the potential beyond its wells is back at the saddle's height. sense: 0 without torque, where it may
    end at a barrier as high (SHARED), or at the saddle itself, one turn on; with torque the saddle then stands higher, or
    lower, by 2 pi mu.
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
    return crossing(g, x, z, side, low, high), centre, ENDS


def crossing(g, x, z, side, low, high):
    """Where the potential rises through the saddle's height between a well at `low` and `high`: Newton's method in a bracket.

    The first guess is exact for the cubic potential next to a fold, whose loop is half as long again as the way to the well.
    """
    t = min(1.5 * low, 0.5 * (low + high))
    for _ in range(200):
        value = rise(g, x, z, side * t)
        if value > 0:
            high = t
        elif value < 0:
            low = t
        else:
            return t
        there_x, there_z = moved(x, z, side * t)
        steep = -side * force(g, there_x, there_z)
        new = t - value / steep if steep > 0 else low
        if abs(new - t) <= 1e-9 * t:
            return new  # convergence is quadratic: the next step would be 1e-18
        if not low < new < high:
            new = 0.5 * (low + high)
            if not low < new < high:
                return new
        t = new
    return t


# --- whole sheets: a strip is a branch of saddles with one side of loops, its grid n rows of the first halves of m columns
def saddle_at(conic, strip, s):
    """The saddle at the parameter s of a branch."""
    G, c, K, shift = conic
    t = strip[START] + (strip[END] - strip[START]) * s
    if strip[ON_LINE] != 0:
        return strip[X0] + t * strip[DX], strip[Z0] + t * strip[DZ]
    return (K / t - c) / G, t - shift


def trial_rows(conic, strip, fold_size, dense, s, way):
    """Fill s with the parameters of trial rows: equal steps of the saddle near the fold, equal factors far out. fold_size: how
    far from it steps are equal, as a share of its radius. way: room for `dense` numbers."""
    x0, z0 = saddle_at(conic, strip, 0.0)
    start, length = fold_size * sqrt(x0 * x0 + z0 * z0), 0.0
    x, z = x0, z0
    for i in range(dense):
        x1, z1 = saddle_at(conic, strip, 0.5 - 0.5 * cos(pi * i / (dense - 1)))
        length += sqrt((x1 - x) ** 2 + (z1 - z) ** 2)
        way[i], x, z = length, x1, z1
    start = max(start, 0.03 * length)
    for i in range(dense):
        way[i] = log1p(way[i] / start)
    last, row = way[dense - 1], 1
    s[0], s[len(s) - 1] = 0.0, 1.0
    for i in range(1, dense):
        here, before = 0.5 - 0.5 * cos(pi * i / (dense - 1)), 0.5 - 0.5 * cos(pi * (i - 1) / (dense - 1))
        while row < len(s) - 1 and last * row / (len(s) - 1) <= way[i]:
            part = (last * row / (len(s) - 1) - way[i - 1]) / (way[i] - way[i - 1])
            s[row] = before + part * (here - before)
            row += 1


def fill_row(g, conic, sense, units, strip, side, s, u, place, points, off):
    """One row: place gets saddle, centre, offset of the far end; points (m, 3) the loop at columns u; off (m,), unless it is
    empty, their `departure`. Returns whether there is a loop."""
    x, z = saddle_at(conic, strip, s)
    x, z = settled(g, x, z) if s > 0 else (x, z)
    end, deep, kind = loop_end(g, sense, x, z, side) if s > 0 else (0.0, 0.0, ENDS)
    end, (cx, cz) = side * end, moved(x, z, side * deep)
    cx, cz = settled(g, cx, cz) if deep > 0 else (cx, cz)
    place[0], place[1], place[2], place[3], place[4] = x, z, cx, cz, end
    far_x, far_z = moved(x, z, end)
    pull = abs(force(g, far_x, far_z))
    sharp = abs(end) * slope(g, far_x, far_z) / pull if pull > 0 else 0.0 if end == 0 else SHARPEST
    sharp = min(max(sharp, 1e-8), SHARPEST)
    q = sharp + sqrt(sharp * (sharp + 2))  # arccosh(1 + sharp) = log(1 + q)
    half = 0.5 * log1p(q)
    per_x, shift_j, per_z, shift_k, per_w, shift_i, j, k, i = units
    m = len(u)
    for a in range(m):
        share = sinh(half * (1 - u[a])) / sinh(half)
        y = end * (1 - share * share)
        w = side * sqrt(2 * max(-rise(g, x, z, y), 0.0)) if 0 < a < m - 1 else 0.0
        px, pz = moved(x, z, y)
        points[a, j], points[a, k], points[a, i] = per_x * px - shift_j, per_z * pz - shift_k, per_w * w - shift_i
        if len(off):
            off[a] = departure(g, units, x, z, y, points[a])
    return kind != NONE


def departure(g, units, x, z, y, point):
    """Energy of a rounded point above its saddle's, (x, z), relative to the size of the energy's terms; y: its offset."""
    per_x, shift_j, per_z, shift_k, per_w, shift_i, j, k, i = units
    px, pz, w = (point[j] + shift_j) / per_x, (point[k] + shift_k) / per_z, (point[i] + shift_i) / per_w
    angle = atan2(px * z - pz * x, px * x + pz * z)
    seen = angle + TURN * round((y - angle) / TURN)
    size_x, size_z = abs(px) + abs(shift_j / per_x), abs(pz) + abs(shift_k / per_z)
    scale = (0.5 * w * w + abs(g[0]) * (size_x * size_x + size_z * size_z) + (abs(g[1]) + abs(g[2])) * (size_x + size_z)
             + abs(g[3]))
    return abs(0.5 * w * w + rise(g, x, z, seen)) / scale


def chord_sag(before, between, last):
    """How far the chord between two rows strays from the sheet, from a row in between."""
    sag = 0.0
    for a in range(1, len(before) - 1):
        c0, c1, c2 = last[a, 0] - before[a, 0], last[a, 1] - before[a, 1], last[a, 2] - before[a, 2]
        w0, w1, w2 = between[a, 0] - before[a, 0], between[a, 1] - before[a, 1], between[a, 2] - before[a, 2]
        r0, r1, r2 = (between[a + 1, 0] - between[a - 1, 0], between[a + 1, 1] - between[a - 1, 1],
                      between[a + 1, 2] - between[a - 1, 2])
        n0, n1, n2 = c1 * r2 - c2 * r1, c2 * r0 - c0 * r2, c0 * r1 - c1 * r0
        part = (w0 * c0 + w1 * c1 + w2 * c2) / max(c0 * c0 + c1 * c1 + c2 * c2, TINY)
        part = min(max(part, 0.1), 0.9)
        size = max(sqrt(n0 * n0 + n1 * n1 + n2 * n2), TINY)
        sag = max(sag, abs(w0 * n0 + w1 * n1 + w2 * n2) / size / (4 * part * (1 - part)))
    return sag


def second_forms(r, row, a, axis):
    """(L, M, N) at an inner vertex of points r (n, m, 3) with the column beyond the last one mirrored."""
    m = r.shape[1]
    beyond = a + 1 == m
    b = a - 1 if beyond else a + 1
    e0, e1, e2 = r[row + 1, a, 0] - r[row - 1, a, 0], r[row + 1, a, 1] - r[row - 1, a, 1], r[row + 1, a, 2] - r[row - 1, a, 2]
    across = twist = down = 0.0
    n0 = n1 = n2 = 0.0
    # differences round the loop in this row and its neighbours; the mirror image flips the component along the axis
    d0, d1, d2 = r[row, b, 0] - r[row, a - 1, 0], r[row, b, 1] - r[row, a - 1, 1], r[row, b, 2] - r[row, a - 1, 2]
    if beyond:
        flip = 2 * (r[row, a, axis] - r[row, a - 1, axis])
        d0, d1, d2 = (flip if axis == 0 else 0.0), (flip if axis == 1 else 0.0), (flip if axis == 2 else 0.0)
    n0, n1, n2 = e1 * d2 - e2 * d1, e2 * d0 - e0 * d2, e0 * d1 - e1 * d0
    size = 1 / max(sqrt(n0 * n0 + n1 * n1 + n2 * n2), TINY)
    n0, n1, n2 = n0 * size, n1 * size, n2 * size
    for c in range(3):
        n = n0 if c == 0 else n1 if c == 1 else n2
        here, left = r[row, a, c], r[row, a - 1, c]
        after = r[row, b, c]
        up = r[row + 1, b, c] - r[row + 1, a - 1, c]
        under = r[row - 1, b, c] - r[row - 1, a - 1, c]
        if beyond and c == axis:
            after = 2 * here - left
            up, under = 2 * (r[row + 1, a, c] - r[row + 1, a - 1, c]), 2 * (r[row - 1, a, c] - r[row - 1, a - 1, c])
        across += n * (after - 2 * here + left)
        twist += n * 0.25 * (up - under)
        down += n * (r[row + 1, a, c] - 2 * here + r[row - 1, a, c])
    return across, twist, down


def outline_bend(r, a, axis):
    """How a row of points r (m, 3) bends at a column, in the sheet too."""
    square = length = product = 0.0
    for c in range(3):
        before, here = r[a - 1, c], r[a, c]
        after = r[a + 1, c] if a + 1 < len(r) else 2 * here - before if c == axis else before
        bend, way = after - 2 * here + before, after - before
        square, length, product = square + bend * bend, length + way * way, product + bend * way
    return sqrt(max(square - product * product / max(length, TINY), 0.0))


def stray(across, twist, down, cut):
    """Largest distance of a quad's edges' mid-points and facets' centres from the surface."""
    diagonal = across + down + 2 * cut * twist
    edges = max(abs(diagonal), max(abs(across), abs(down)))
    return max(edges / 8, abs(across + down + diagonal) / 18)


def fill_strip(g, conic, sense, units, strip, side, s, u, found, places, points, off, spare):
    """All rows of a strip; how far the chords between the last two rows stray. spare: room for a row's points."""
    n = len(s)
    for row in range(n):
        found[row] = fill_row(g, conic, sense, units, strip, side, s[row], u, places[row], points[row], off[row])
    m, half_way = len(u), 0.5 * (s[n - 2] + s[n - 1])
    between = fill_row(g, conic, sense, units, strip, side, half_way, u, spare[m], spare[:m, :3], off[0, :0])
    return chord_sag(points[n - 2, :m], spare[:m, :3], points[n - 1, :m]) if between and found[n - 2] and found[n - 1] else 0.0


def lengths(density, floor, straight, out):
    """Add the floor to densities and fill out with their integral from the first on."""
    mean = 0.0
    for a in range(len(density)):
        mean += density[a]
    for a in range(len(density)):
        density[a] += floor * mean / len(density) + sqrt(straight)
    out[0] = 0.0
    for a in range(1, len(density)):
        out[a] = out[a - 1] + 0.5 * (density[a] + density[a - 1])


def trial(g, conic, sense, units, strips, sides, grading, s, columns, rows, room):
    """Fill s, columns, rows (k, t): trial rows and the integrals of the densities. grading: (floor, straight, fold's size, dense); room: arrays for
    a strip."""
    floor, share, fold_size, dense = grading
    u, way, found, places, points, off, spare, density = room
    k, t = s.shape
    largest = 0.0
    for strip in range(k):
        trial_rows(conic, strips[strip], fold_size, dense, s[strip], way)
        edge = fill_strip(g, conic, sense, units, strips[strip], sides[strip], s[strip], u, found[strip], places,
                          points[strip], off, spare)
        density[strip, 0, 0] = edge
        for row in range(t):
            for a in range(t):
                for c in range(3):
                    largest = max(largest, abs(points[strip, row, a, c]))
    straight = share * largest
    for strip in range(k):
        edge = density[strip, 0, 0]
        density[strip] = 0.0
        for row in range(1, t - 1):
            whole = found[strip, row - 1] and found[strip, row] and found[strip, row + 1]
            for a in range(1, t):
                across, _, down = second_forms(points[strip], row, a, units[8]) if whole else (0.0, 0.0, 0.0)
                density[strip, 0, a] = max(density[strip, 0, a], sqrt(abs(across)))
                density[strip, 1, row] = max(density[strip, 1, row], sqrt(abs(down)))
        if found[strip, t - 1]:
            for a in range(1, t):
                density[strip, 0, a] = max(density[strip, 0, a], sqrt(outline_bend(points[strip, t - 1], a, units[8])))
        density[strip, 0, 0], density[strip, 1, 0] = density[strip, 0, 1], density[strip, 1, 1]
        density[strip, 1, t - 1] = max(density[strip, 1, t - 2], sqrt(8 * edge))
        lengths(density[strip, 0], floor, straight, columns[strip])
        lengths(density[strip, 1], floor, straight, rows[strip])


def even_steps(length, at, out):
    """Fill out with parameters between those of `at` at even steps of `length`."""
    last, knot = length[len(length) - 1], 0
    for a in range(len(out)):
        want = last * a / (len(out) - 1)
        while knot < len(length) - 2 and length[knot + 1] < want:
            knot += 1
        out[a] = at[knot] + (at[knot + 1] - at[knot]) * ((want - length[knot]) / (length[knot + 1] - length[knot]))
    out[len(out) - 1] = at[len(at) - 1]


def finished(g, conic, sense, units, strips, sides, s, even, columns, rows, at, u, found, places, points, residual, strays,
             spare):
    """The graded loops: points (k, n, 2 m - 1, 3) all round with their residual, places (k, n, 5), strays (2, k) of both
    cuts."""
    k, n, m = len(strips), len(at), len(u)
    axis = units[8]
    for strip in range(k):
        even_steps(rows[strip], s[strip], at)
        even_steps(columns[strip], even, u)
        edge = fill_strip(g, conic, sense, units, strips[strip], sides[strip], at, u, found[strip], places[strip],
                          points[strip], residual[strip], spare)
        strays[0, strip] = strays[1, strip] = edge
        for row in range(n):
            for a in range(m, 2 * m - 1):
                b = 2 * m - 2 - a
                residual[strip, row, a] = residual[strip, row, b]
                for c in range(3):
                    points[strip, row, a, c] = points[strip, row, b, c]
                points[strip, row, a, axis] = -2 * units[5] - points[strip, row, b, axis]
        for row in range(1, n - 1):
            if found[strip, row - 1] and found[strip, row] and found[strip, row + 1]:
                for a in range(1, m):
                    across, twist, down = second_forms(points[strip][:, :m], row, a, axis)
                    strays[0, strip] = max(strays[0, strip], stray(across, twist, down, 1.0))
                    strays[1, strip] = max(strays[1, strip], stray(across, twist, down, -1.0))
