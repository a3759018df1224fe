"""A sheet whose flat facets stay within an asked-for distance, as straight lines of floats for numba to compile: `within`, a sheet at a time.

`loop_points` is what `homoclinic_arrays.loops` does for one row, `shapes` and `quads` what `within._Forms` says of a grid, `graded` its better rows and
columns, `sheet` the rounds of `within.grids_within`. The names of the geometry, from `place_of` to `departure`, are those of `circle_kernel`;
`hyperbola_kernel` has others under the same names.
"""
from __future__ import annotations

from math import ceil, log1p, sinh, sqrt

import numpy as np

from ..circle_kernel import (
    END,
    ENDS,
    NONE,
    ON_LINE,
    SHARPEST,
    START,
    departure_row,
    force,
    invariant,
    loop_end,
    moved,
    others,
    place_of,
    rise,
    risen_row,
    saddle_at,
    settled,
    slope,
    xz,
)
from .far_kernel import FLIP, NEAR_CENTRE, RATE, far_departures, far_ends, far_orbit, far_row, far_sharpness, far_way, far_well

GAP, SAFER, GROWTH, MOST_ROUNDS, RIM_SHARE, MOST_LINES, SAG, FIRST, NARROW, BEND = 0.1, 1.05, 6.0, 14, 0.1, 1025, 1e-6, 17, 0.02, 0.25
TINY, SMALL = 2.2250738585072014e-308, 1e-200
MIXES = (0.7, 1.0, 1.5, 2.0)
# of a part: which side, its first and last row, -1 or +1 where one of these is a seam, whether loops pass a second saddle, whether `reach` cuts it off
SIDE, LOW, HIGH, SEAM, OVER, CUT_OFF = range(6)
# of a row: saddle, centre, far end, whether there is a loop; whether it is told by `far_kernel`, the way to its saddle, the well's alpha, and its side there
SADDLE, CENTRE, FAR_END, FOUND, TOLD_FAR, WAY, DEEP, TURNED = 0, 2, 4, 5, 6, 7, 9, 10
ROW_NUMBERS = 11


def row_at(part, t):
    """s at the parameter t of a part (`seams.Part.rows`)."""
    if part[SEAM] == 0:
        return t
    if part[SEAM] < 0:
        return part[LOW] + (part[HIGH] - part[LOW]) * t * t
    return part[HIGH] - (part[HIGH] - part[LOW]) * (1 - t) * (1 - t)


def loop_points(g, conic, sense, units, far, strip, part, t, u, place, x_j, x_k, x_i, offset, first, second):
    """Fill place (ROW_NUMBERS,), components x_j, x_k, x_i (m,), offset (m,) and coordinates of places first, second (m,) with one loop at the parameter t and
    columns u."""
    side, s = part[SIDE], row_at(part, t)
    x, z = saddle_at(conic, strip, s)
    x, z = place_of(x, z)
    end, deep, kind = 0.0, 0.0, ENDS
    if s > 0:
        x, z = settled(g, x, z)
    place[TOLD_FAR] = 0.0
    if far[NEAR_CENTRE] > 0 and strip[ON_LINE] == 0:
        place[SADDLE], place[SADDLE + 1] = x, z
        if far_points(units, far, part, strip[START] + (strip[END] - strip[START]) * s, s == 0, u, place, x_j, x_k, x_i, offset, first, second):
            return
    if s > 0:
        end, deep, kind = loop_end(g, sense, x, z, side)
    cx, cz = x, z
    if deep > 0:
        cx, cz = moved(x, z, side * deep)
        cx, cz = settled(g, cx, cz)
    end *= side
    place[0], place[1], place[2], place[3], place[4], place[5] = x, z, cx, cz, end, 0.0 if kind == NONE else 1.0
    columns(g, part, x, z, end, u, offset)
    risen_row(g, x, z, offset, x_i, first, second)
    per_x, shift_j, per_z, shift_k, per_w, shift_i, j, k, i = units
    sided, last = per_w * side, len(u) - 1
    for a in range(last + 1):
        px, pz = xz(first[a], second[a])
        x_j[a] = per_x * px - shift_j
        x_k[a] = per_z * pz - shift_k
        x_i[a] = sided * sqrt(2 * max(-x_i[a], 0.0)) - shift_i
    x_i[0] = x_i[last] = -shift_i


def far_points(units, far, part, h, rests, u, place, x_j, x_k, x_i, offset, first, second):
    """The same of a loop whose orbit is centred far away, from its saddle at h: whether it is one. The offsets are those of `far_kernel`, the places the
    components themselves."""
    x, z, told = far_way(far, h)
    if not told:
        return False
    turned = 1.0 if part[SIDE] * far[FLIP] > 0 else -1.0
    end, deep, told = far_ends(far, x, z, turned, rests)
    if not told:
        return False
    orbit = far_orbit(far, x, z)
    sharpest = SHARPEST if part[SEAM] == 0 else 1 / NARROW
    sharp = 0.0 if rests else far_sharpness(far, orbit, end)
    by_turning(sharp, sharpest, end, u, offset)
    far_row(far, orbit, turned, offset, first, second, x_i)
    shift_i = units[5]
    for a in range(len(u)):
        x_j[a], x_k[a], x_i[a] = first[a], second[a], x_i[a] - shift_i
    place[FAR_END], place[FOUND], place[TOLD_FAR], place[WAY], place[WAY + 1] = end * far[RATE] * far[FLIP], 1.0, 1.0, x, z
    place[DEEP], place[TURNED] = deep, turned
    return True


def columns(g, part, x, z, end, u, offset):
    """Fill offset (m,): where columns u of a loop stand (`homoclinic_arrays._shares`, `seams.pinched_shares`)."""
    if part[SEAM] != 0 and part[OVER] != 0:
        pinched(g, part, x, z, end, u, offset)
        return
    far_x, far_z = moved(x, z, end)
    pull = abs(force(g, far_x, far_z))
    sharpest = SHARPEST if part[SEAM] == 0 else 1 / NARROW
    sharp = abs(end) * slope(g, far_x, far_z) / pull if pull > 0 else 0.0 if end == 0 else sharpest
    by_turning(sharp, sharpest, end, u, offset)


def by_turning(sharp, sharpest, end, u, offset):
    """Fill offset (m,) with ways to a far end that turn the loop evenly (`homoclinic_arrays._by_turning`)."""
    sharp = min(max(sharp, 1e-8), sharpest)
    half = 0.5 * log1p(sharp + sqrt(sharp * (sharp + 2)))
    inverse = 1 / sinh(half)
    for a in range(len(u)):
        v = half * (1 - u[a]) * (1 / 16)
        more = v * (1 + v * (1 / 2) * (1 + v * (1 / 3) * (1 + v * (1 / 4) * (1 + v * (1 / 5) * (1 + v * (1 / 6) * (1 + v * (1 / 7) * (
            1 + v * (1 / 8) * (1 + v * (1 / 9) * (1 + v * (1 / 10) * (1 + v * (1 / 11)))))))))))
        more *= 2 + more  # exp - 1 of the double
        more *= 2 + more
        more *= 2 + more
        more *= 2 + more
        share = 0.5 * (more + more / (1 + more)) * inverse
        offset[a] = end * (1 - share * share)
    offset[0], offset[len(u) - 1] = 0.0, end


def pinched(g, part, x, z, end, u, offset):
    far, side = abs(end), part[SIDE]
    at, width = 0.5 * far, far
    for t in others(g, x, z, side):
        if t < float("inf"):
            there_x, there_z = moved(x, z, side * t)
            steep = slope(g, there_x, there_z)
            if steep > 0:
                if t < far:
                    at, width = t, sqrt(max(-2 * rise(g, x, z, side * t) / steep, 0.0))
                break
    behind, last = far - at, len(u) - 1
    before_width, behind_width = max(width / at, NARROW), max(width / behind, NARROW)
    q, p = arcsinh(1 / before_width), arcsinh(1 / behind_width)
    for a in range(1, last):
        if u[a] <= 0.5:
            share = at * (1 - sinh(q * (1 - 2 * u[a])) * before_width)
        else:
            v = 2 - 2 * u[a]
            share = at + behind * (sinh(p * (1 - v * v)) * behind_width)
        offset[a] = end * (share / far)
    offset[0], offset[last] = 0.0, end


def arcsinh(x):
    return log1p(x + x * x / (1 + sqrt(x * x + 1)))


def sag(r, first, last, between, m):
    """How far the chords between two rows stray from the sheet, by the row in between, the first of `between`."""
    most = 0.0
    for a in range(1, m - 1):
        c0, c1, c2 = r[0, last, a] - r[0, first, a], r[1, last, a] - r[1, first, a], r[2, last, a] - r[2, first, a]
        w0, w1, w2 = between[0, 0, a] - r[0, first, a], between[1, 0, a] - r[1, first, a], between[2, 0, a] - r[2, first, a]
        r0, r1, r2 = (between[0, 0, a + 1] - between[0, 0, a - 1], between[1, 0, a + 1] - between[1, 0, a - 1],
                      between[2, 0, a + 1] - between[2, 0, a - 1])
        n0, n1, n2 = c1 * r2 - c2 * r1, c2 * r0 - c0 * r2, c0 * r1 - c1 * r0
        share = (w0 * c0 + w1 * c1 + w2 * c2) / max(c0 * c0 + c1 * c1 + c2 * c2, TINY)
        share = min(max(share, 0.1), 0.9)
        most = max(most, abs(w0 * n0 + w1 * n1 + w2 * n2) / max(sqrt(n0 * n0 + n1 * n1 + n2 * n2), TINY) / (4 * share * (1 - share)))
    return most


def gathered(before, first, second, behind):
    """`within._gathered` of four curvatures, an edge between the second and the third."""
    share = min((abs(before) + abs(behind)) / max(abs(first) + abs(second), SMALL), 1.0)
    return 1 + 3 * (1 - share * share) / (1 + 35 * share)


def beyond(first, second):
    """`within._before`."""
    on = 2 * first - second
    return on if abs(on) > abs(first) else first


def along(x, y, z, whole, bend, out):
    """Fill out (n - 1,) with how far the edges between points x, y, z (n,) of a curve stray from it (`within._along`); whole (n,): whether there is a
    point; bend: room for n."""
    n = len(x)
    for a in range(n - 1):
        dx, dy, dz = x[a + 1] - x[a], y[a + 1] - y[a], z[a + 1] - z[a]
        out[a] = max(sqrt(dx * dx + dy * dy + dz * dz), TINY)
    for a in range(1, n - 1):
        bend[a] = 0.0
        if whole[a - 1] > 0 and whole[a] > 0 and whole[a + 1] > 0:
            p, q = 1 / out[a], 1 / out[a - 1]
            p0, p1, p2 = (x[a + 1] - x[a]) * p, (y[a + 1] - y[a]) * p, (z[a + 1] - z[a]) * p
            q0, q1, q2 = (x[a] - x[a - 1]) * q, (y[a] - y[a - 1]) * q, (z[a] - z[a - 1]) * q
            n0, n1, n2 = p1 * q2 - p2 * q1, p2 * q0 - p0 * q2, p0 * q1 - p1 * q0
            bend[a] = 2 * sqrt(n0 * n0 + n1 * n1 + n2 * n2) / (out[a] + out[a - 1])
    bend[0], bend[n - 1] = abs(beyond(bend[1], bend[2 if n > 3 else 1])), bend[n - 2]
    for a in range(n - 1):
        factor = gathered(bend[max(a - 1, 0)], bend[a], bend[a + 1], bend[min(a + 2, n - 1)])
        out[a] = (bend[a + 1] + bend[a]) * out[a] * out[a] / 16 * factor


def normals(r, found, normal):
    """Fill normal (3, n, m) of r (3, n, m + 1) (`within._normals`)."""
    n, m = normal.shape[1:]
    for row in range(n):
        up, down = max(row - 1, 0), min(row + 1, n - 1)
        whole = 1.0 if found[up] > 0 and found[row] > 0 and found[down] > 0 else 0.0
        for a in range(m):
            before = a - 1 if a > 0 else 0
            a0, a1, a2 = r[0, down, a] - r[0, up, a], r[1, down, a] - r[1, up, a], r[2, down, a] - r[2, up, a]
            b0, b1, b2 = r[0, row, a + 1] - r[0, row, before], r[1, row, a + 1] - r[1, row, before], r[2, row, a + 1] - r[2, row, before]
            n0, n1, n2 = a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0
            size = whole / max(sqrt(n0 * n0 + n1 * n1 + n2 * n2), TINY)
            normal[0, row, a], normal[1, row, a], normal[2, row, a] = n0 * size, n1 * size, n2 * size


def row_bends(r, normal, row, bend, wide):
    """Fill bend (m,), curvatures along a row, and wide (m,), its edges' squares."""
    m = len(bend)
    for a in range(m):
        d0, d1, d2 = r[0, row, a + 1] - r[0, row, a], r[1, row, a + 1] - r[1, row, a], r[2, row, a + 1] - r[2, row, a]
        wide[a] = d0 * d0 + d1 * d1 + d2 * d2
    for a in range(1, m):
        d0 = r[0, row, a + 1] - 2 * r[0, row, a] + r[0, row, a - 1]
        d1 = r[1, row, a + 1] - 2 * r[1, row, a] + r[1, row, a - 1]
        d2 = r[2, row, a + 1] - 2 * r[2, row, a] + r[2, row, a - 1]
        bend[a] = (d0 * normal[0, row, a] + d1 * normal[1, row, a] + d2 * normal[2, row, a]) / max(sqrt(wide[a] * wide[a - 1]), TINY)
    bend[0] = beyond(bend[1], bend[2])


def column_bends(r, normal, row, bend):
    """Fill bend (m,), curvatures along the columns at an inner row."""
    for a in range(len(bend)):
        p0, p1, p2 = r[0, row + 1, a] - r[0, row, a], r[1, row + 1, a] - r[1, row, a], r[2, row + 1, a] - r[2, row, a]
        q0, q1, q2 = r[0, row, a] - r[0, row - 1, a], r[1, row, a] - r[1, row - 1, a], r[2, row, a] - r[2, row - 1, a]
        turn = (p0 - q0) * normal[0, row, a] + (p1 - q1) * normal[1, row, a] + (p2 - q2) * normal[2, row, a]
        bend[a] = turn / max(sqrt((p0 * p0 + p1 * p1 + p2 * p2) * (q0 * q0 + q1 * q1 + q2 * q2)), TINY)


def shapes(r, part, found, edges, normal, bend_s, forms, across, downward, outline, room):
    """Fill forms (5, n - 1, m - 1), what `facets` takes of every quad (along rows, along columns, twist, what narrow bends add to both), across (m - 1,) and
    downward (n - 1,), how far edges along rows and along columns stray at most, and outline (m - 1,); edges: of the first and the last rows, measured.

    Loops over a row have no branch and few arrays, so that they are compiled to work on several columns at once."""
    n, m = normal.shape[1:]
    normals(r, found, normal)
    for row in range(1, n - 1):
        column_bends(r, normal, row, bend_s[row])
    bend_s[0], bend_s[n - 1] = bend_s[1], bend_s[n - 2]
    bend, wide, rest, before = room[0, :m + 2], room[1, :m], room[2, :m - 1], room[3, :m - 1]
    across[:] = 0.0
    for row in range(n):
        row_bends(r, normal, row, bend[1:m + 1], wide)
        bend[0], bend[m + 1] = bend[1], bend[m - 1]  # beyond the far end the loop comes back
        edge_forms(bend[:m - 1], bend[1:m], bend[2:m + 1], bend[3:m + 2], wide, before, rest, across)
        if row > 0:
            halves(before, forms[0, row - 1])
            larger(rest, forms[3, row - 1])
        if row < n - 1:
            forms[0, row], forms[3, row] = before, rest
    signed, more, edge, kept = room[0, :m], room[1, :m], room[2, :m], room[6]
    along(r[0, :, 0], r[1, :, 0], r[2, :, 0], found, room[3, :n], kept[:n - 1])
    for row in range(n - 1):
        downward[row] = kept[row]
        lengths(r, row, signed)
        if 0 < row < n - 2:
            edge[:] = 0.0
            edge_forms(bend_s[row - 1], bend_s[row], bend_s[row + 1], bend_s[row + 2], signed, signed, more, edge)
            more[0] += max(kept[row] - edge[0], 0.0)
            downward[row] = max(downward[row], most_of(edge))
        else:
            limit = edges[0] if row == 0 else edges[1]
            for a in range(m):
                signed[a] = min(max(0.5 * (bend_s[row, a] + bend_s[row + 1, a]) * signed[a], -8 * limit), 8 * limit)
                more[a] = 0.0
            downward[row] = max(downward[row], limit)
        pairs(signed, more, forms[1, row], forms[4, row])
        twists(r, normal, row, forms[2, row])
    rims(r, part, found, kept, room[4], room[5], outline)


def lengths(r, row, out):
    """Fill out (m,) with the squares of a row's edges along the columns."""
    for a in range(len(out)):
        d0, d1, d2 = r[0, row + 1, a] - r[0, row, a], r[1, row + 1, a] - r[1, row, a], r[2, row + 1, a] - r[2, row, a]
        out[a] = d0 * d0 + d1 * d1 + d2 * d2


def edge_forms(before, first, second, behind, square, signed, rest, most):
    """Of edges with squares of lengths between the curvatures first and second: fill signed with eight times how far an even bend would stray, rest with
    what a narrow one adds, and raise most to how far they stray."""
    for a in range(len(rest)):
        c, d, l = first[a], second[a], square[a]
        share = min((abs(before[a]) + abs(behind[a])) / max(abs(c) + abs(d), SMALL), 1.0)
        edge = (abs(d) + abs(c)) * l / 16 * (1 + 3 * (1 - share * share) / (1 + 35 * share))
        even = 0.5 * (d + c) * l
        signed[a], rest[a], most[a] = even, edge - abs(even) / 8, max(most[a], edge)


def halves(other, out):
    for a in range(len(out)):
        out[a] = 0.5 * (other[a] + out[a])


def larger(other, out):
    for a in range(len(out)):
        out[a] = max(other[a], out[a])


def pairs(signed, more, mean, most):
    """Fill mean and most (m - 1,) with the mean of neighbours of signed (m,), and the larger of those of more."""
    for a in range(len(mean)):
        mean[a] = 0.5 * (signed[a + 1] + signed[a])
        most[a] = max(more[a + 1], more[a])


def twists(r, normal, row, out):
    """Fill out (m - 1,) with the twist of quads between two rows."""
    for a in range(len(out)):
        d0 = (r[0, row + 1, a + 1] - r[0, row + 1, a]) - (r[0, row, a + 1] - r[0, row, a])
        d1 = (r[1, row + 1, a + 1] - r[1, row + 1, a]) - (r[1, row, a + 1] - r[1, row, a])
        d2 = (r[2, row + 1, a + 1] - r[2, row + 1, a]) - (r[2, row, a + 1] - r[2, row, a])
        n0 = (normal[0, row + 1, a + 1] + normal[0, row, a + 1]) + (normal[0, row + 1, a] + normal[0, row, a])
        n1 = (normal[1, row + 1, a + 1] + normal[1, row, a + 1]) + (normal[1, row + 1, a] + normal[1, row, a])
        n2 = (normal[2, row + 1, a + 1] + normal[2, row, a + 1]) + (normal[2, row + 1, a] + normal[2, row, a])
        out[a] = 0.25 * (d0 * n0 + d1 * n1 + d2 * n2)


def rims(r, part, found, kept, bend, first, last):
    """Fill last (m - 1,) with how far edges stray from the outline (`within._rims`); kept, bend, first: room for m + 1."""
    n, m = r.shape[1], r.shape[2] - 1
    share = RIM_SHARE if part[CUT_OFF] != 0 else 1.0
    kept[:m + 1] = found[0]
    along(r[0, 0], r[1, 0], r[2, 0], kept[:m + 1], bend[:m + 1], first[:m])
    kept[:m + 1] = found[n - 1]
    beyond_rim = kept[m + 1:2 * m + 1]
    along(r[0, n - 1], r[1, n - 1], r[2, n - 1], kept[:m + 1], bend[:m + 1], beyond_rim)
    if part[OVER] == 0 and part[SEAM] != 0:  # the second saddle, a corner and no bend
        if part[SEAM] < 0:
            first[m - 2] = 0.0
        else:
            beyond_rim[m - 2] = 0.0
    for a in range(m - 1):
        last[a] = max(first[a], share * beyond_rim[a])


def facets(forms, p, q, worst):
    """How far diagonals and facets' centres of quads stray at most, for the cut 1 and for the cut -1, where columns are denser by p (m - 1,) and rows by
    q (n - 1,); worst: two rows of room."""
    n, m = forms.shape[1:]
    for a in range(m):
        worst[0, a] = worst[1, a] = 0.0
    for row in range(n):
        t = 1 / q[row]
        for a in range(m):
            v = 1 / p[a]
            u, s = forms[0, row, a] * (v * v), forms[1, row, a] * (t * t)
            both, twist = u + s, 2 * (forms[2, row, a] * (v * t))
            more = forms[3, row, a] * (v * v) + forms[4, row, a] * (t * t)
            first, second = both + twist, both - twist
            worst[0, a] = max(worst[0, a], max(abs(first) / 8, abs(both + first) / 18) + more)
            worst[1, a] = max(worst[1, a], max(abs(second) / 8, abs(both + second) / 18) + more)
    return most_of(worst[0, :m]), most_of(worst[1, :m])


def most_of(values):
    """The largest of numbers that are not negative, of four at a time."""
    n, first, second, third, fourth = len(values), 0.0, 0.0, 0.0, 0.0
    for a in range(0, n - 3, 4):
        first, second = max(first, values[a]), max(second, values[a + 1])
        third, fourth = max(third, values[a + 2]), max(fourth, values[a + 3])
    for a in range(n - n % 4, n):
        first = max(first, values[a])
    return max(max(first, second), max(third, fourth))


def density(strays, straight, out):
    """Fill out with `within._density`."""
    n, total = len(strays), 0.0
    for a in range(n):
        before, here, behind = sqrt(8 * strays[max(a - 1, 0)]), sqrt(8 * strays[a]), sqrt(8 * strays[min(a + 1, n - 1)])
        out[a] = max(here, 0.5 * (behind + before))
        total += out[a]
    for a in range(n):
        out[a] += GAP * total / n + straight


def placed(weights, at, number):
    """Parameters, so many as asked, between those of `at`, spaced evenly by the density of its cells."""
    count = int(min(max(ceil(number), 3.0), float(MOST_LINES)))
    length = np.zeros(len(at))
    for a in range(len(weights)):
        length[a + 1] = length[a] + weights[a]
    out, knot, last = np.empty(count), 0, length[len(weights)]
    for a in range(count):
        want = last * a / (count - 1)
        while knot < len(weights) - 1 and length[knot + 1] < want:
            knot += 1
        out[a] = at[knot] + (at[knot + 1] - at[knot]) * ((want - length[knot]) / (length[knot + 1] - length[knot]))
    out[0], out[count - 1] = at[0], at[len(at) - 1]
    return out


def graded(forms, across, downward, s, u, straight, accuracy, safety, first, again, worst):
    """(rows, columns) that `accuracy` needs, as far as a grid tells (`within._Forms.graded`); across: with the outline; first: how far the first row's edges
    stray, measured; again: whether an earlier grading was to keep to the accuracy."""
    c, q = np.empty(len(u) - 1), np.empty(len(s) - 1)
    density(across, straight, c)
    density(downward, straight, q)
    q[0] *= max(first / accuracy, 1.0)**BEND
    if again:
        for a in range(len(q)):
            q[a] *= max(downward[a] / accuracy, 1.0)**BEND
    p, rows, columns_, fewest = np.empty(len(c)), 0.0, 0.0, float("inf")
    for mix in MIXES:
        least = 0.0
        for a in range(len(c)):
            p[a] = mix * c[a]
            least = max(least, across[a] / p[a]**2)
        for a in range(len(q)):
            least = max(least, downward[a] / q[a]**2)
        total_q, total_p, size = q.sum(), p.sum(), safety * sqrt(least / accuracy)
        if (size * total_q + 1) * (size * total_p + 1) >= fewest:
            continue  # facets can but ask for more
        for stray in facets(forms, p, q, worst):
            size = safety * sqrt(max(least, stray) / accuracy)
            down, round_ = size * total_q + 1, size * total_p + 1
            if down * round_ < fewest:
                rows, columns_, fewest = down, round_, down * round_
    less = min(sqrt(GROWTH * len(s) * len(u) / (rows * columns_)), 1.0)
    return placed(q, s, rows * less), placed(c, u, columns_ * less)


def points_of(g, conic, sense, units, far, strip, part, s, u, places, r, offsets, spots, edges):
    """Fill places (n, ROW_NUMBERS), r (3, n, m + 1), the last column beyond the far end, offsets (n, m), coordinates of places spots (2, n, m), and edges (2,)
    with the loops at rows s and columns u."""
    n, m, j, k, i = len(s), len(u), units[6], units[7], units[8]
    for row in range(n):
        loop_points(g, conic, sense, units, far, strip, part, s[row], u, places[row], r[j, row, :m], r[k, row, :m], r[i, row, :m], offsets[row], spots[0, row],
                    spots[1, row])
        for c in range(3):
            r[c, row, m] = r[c, row, m - 2]
        r[i, row, m] = 2 * r[i, row, m - 1] - r[i, row, m - 2]
    between, spare, place = np.empty((3, 1, m)), np.empty((3, m)), np.empty(ROW_NUMBERS)
    for which in range(2):
        first, last = (0, 1) if which == 0 else (n - 1, n - 2)
        loop_points(g, conic, sense, units, far, strip, part, 0.5 * (s[first] + s[last]), u, place, between[j, 0], between[k, 0], between[i, 0], spare[0],
                    spare[1], spare[2])
        whole = places[first, FOUND] > 0 and places[last, FOUND] > 0 and place[FOUND] > 0
        edges[which] = sag(r, first, last, between, m) if whole else 0.0


def sheet(g, conic, sense, units, far, strip, part, s, u, accuracy, kept):
    """(points (n, 2 m - 1, 3) of the loops all round, their residual, equilibria (2, n, 3), saddles and centres, invariants (n,), found (n,), cut, how far
    facets stray) of a part of a sheet, from its trial rows s and columns u on; kept: room for grids, as large as one may keep."""
    safety, best, stray = 1.0, 1.0, 0.0
    for attempt in range(MOST_ROUNDS):
        n, m = len(s), len(u)
        whole = n * m
        if 15 * whole + 3 * n > len(kept):
            kept = np.empty(15 * whole + 3 * n)
        r, normal, spots = kept[:3 * (whole + n)].reshape(3, n, m + 1), cut_out(kept, 3 * n, 3, 6, n, m), cut_out(kept, 3 * n, 6, 8, n, m)
        places, offsets, edges = np.empty((n, ROW_NUMBERS)), cut_out(kept, 3 * n, 8, 9, n, m)[0], np.empty(2)
        points_of(g, conic, sense, units, far, strip, part, s, u, places, r, offsets, spots, edges)
        bends, forms = cut_out(kept, 3 * n, 9, 10, n, m)[0], kept[3 * n + 10 * whole:][:5 * (n - 1) * (m - 1)].reshape(5, n - 1, m - 1)
        across, downward, outline = np.empty(m - 1), np.empty(n - 1), np.empty(m - 1)
        room = np.empty((7, 2 * max(n, m) + 2))
        shapes(r, part, places[:, FOUND], edges, normal, bends, forms, across, downward, outline, room)
        for a in range(m - 1):
            across[a] = max(across[a], outline[a])
        rim = max(across.max(), downward.max())
        first, second = facets(forms, np.ones(m - 1), np.ones(n - 1), room)
        best, stray = (1.0, max(rim, first)) if max(rim, first) <= max(rim, second) else (-1.0, max(rim, second))
        if attempt > 0 and (stray <= accuracy or min(n, m) == MOST_LINES):
            break
        if attempt == MOST_ROUNDS - 1:
            break
        safety *= SAFER
        straight = sqrt(8 * SAG * largest(r, m, room[0])) * FIRST / max(n, m)
        s, u = graded(forms, across, downward, s, u, straight, accuracy, safety, edges[0], attempt > 0, room)
    points, residual = np.empty((n, 2 * m - 1, 3)), np.empty((n, 2 * m - 1))
    all_round(g, units, far, places, r, offsets, spots, points, residual)
    equilibria, invariants, found = np.empty((2, n, 3)), np.empty(n), np.empty(n, np.bool_)
    per_x, shift_j, per_z, shift_k, _, shift_i, j, k, i = units
    for row in range(n):
        equilibria[:, row, i] = -shift_i
        if places[row, TOLD_FAR] > 0:
            orbit = far_orbit(far, places[row, WAY], places[row, WAY + 1])
            equilibria[0, row, j], equilibria[0, row, k] = orbit[0], orbit[1]
            equilibria[1, row, j], equilibria[1, row, k] = far_well(far, orbit, places[row, DEEP])
        else:
            for which in range(2):
                px, pz = xz(places[row, 2 * which], places[row, 2 * which + 1])
                equilibria[which, row, j], equilibria[which, row, k] = per_x * px - shift_j, per_z * pz - shift_k
        invariants[row], found[row] = invariant(places[row, 0], places[row, 1]), places[row, FOUND] > 0
    return points, residual, equilibria, invariants, found, best, stray


def cut_out(kept, start, first, last, n, m):
    """(last - first, n, m) of a room, whose arrays (n, m) are numbered from `start` on."""
    return kept[start + first * n * m:start + last * n * m].reshape(last - first, n, m)


def largest(r, m, worst):
    """The size of a sheet."""
    for a in range(m):
        worst[a] = 0.0
    for c in range(3):
        for row in range(r.shape[1]):
            for a in range(m):
                worst[a] = max(worst[a], abs(r[c, row, a]))
    return most_of(worst[:m])


def all_round(g, units, far, places, r, offsets, spots, points, residual):
    """Fill points (n, 2 m - 1, 3) and residual (n, 2 m - 1): the second half of a loop mirrors the first."""
    n, m = offsets.shape
    per_x, shift_j, per_z, shift_k, per_w, shift_i, j, k, i = units
    flip, to_x, to_z, to_w = -2 * shift_i, 1 / per_x, 1 / per_z, 1 / per_w
    size_x, size_z = abs(shift_j * to_x), abs(shift_k * to_z)
    first, second, w = np.empty(m), np.empty(m), np.empty(m)
    for row in range(n):
        x_j, x_k, x_i, off = r[j, row], r[k, row], r[i, row], residual[row]
        if places[row, TOLD_FAR] > 0:
            for a in range(m):
                w[a] = x_i[a] + shift_i
            far_departures(far, far_orbit(far, places[row, WAY], places[row, WAY + 1]), offsets[row], spots[0, row], spots[1, row], x_j, x_k, w, off)
        else:
            for a in range(m):
                first[a], second[a] = place_of((x_j[a] + shift_j) * to_x, (x_k[a] + shift_k) * to_z)
                w[a] = (x_i[a] + shift_i) * to_w
            departure_row(g, places[row, 0], places[row, 1], offsets[row], spots[0, row], spots[1, row], first, second, w, size_x, size_z, off[:m])
        for a in range(m - 1):
            off[2 * m - 2 - a] = off[a]
        for a in range(m):
            points[row, a, j], points[row, a, k], points[row, a, i] = x_j[a], x_k[a], x_i[a]
        for a in range(m - 1):
            back = 2 * m - 2 - a
            points[row, back, j], points[row, back, k], points[row, back, i] = x_j[a], x_k[a], flip - x_i[a]
