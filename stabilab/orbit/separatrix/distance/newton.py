"""Newton's method for the nearest point of a sheet."""
from __future__ import annotations

import math
from fractions import Fraction


def descent(chart, t, y, w0, steps=30, exact=False):
    """Places on the way of Newton's method for the conditions of a least distance in (t, y, W - w0, k): stationary R + (W - w0)^2 on
    phi = W^2, which are regular where W = 0 too; it stays in the rectangle and yields each place.

    exact: with points in balls and places as Fractions; the slopes' own slopes in doubles cost steps, not digits.
    """
    (t0, t1), (y0, y1) = chart.t, chart.y
    point, step_of = (chart.exact_point, Fraction) if exact else (chart.point, float)
    t, y, p = step_of(t), step_of(y), point(t, y)
    gap = p.gap
    k = gap / (w0 + gap) if w0 + gap > 0 else 0.0
    last = math.inf
    for _ in range(steps):
        rows = _conditions(p, chart.bends(float(t), 0.0, float(y), 0.0), w0, gap, k)
        gt, gy = -rows[0][4], -rows[1][4]
        free_t = not ((t <= t0 and gt > 0) or (t >= t1 and gt < 0)) and t1 > t0
        free_y = not ((y <= y0 and gy > 0) or (y >= y1 and gy < 0))
        keep = [n for n, free in enumerate((free_t, free_y, True, True)) if free]
        moves = _solved([[rows[i][j] for j in (*keep, 4)] for i in keep])
        if moves is None:
            return
        step = [0.0] * 4
        for n, move in zip(keep, moves):
            step[n] = move
        share = min(1.0, 0.25 * (t1 - t0) / abs(step[0]) if step[0] else 1.0, 0.25 * (y1 - y0) / abs(step[1]) if step[1] else 1.0)
        if not math.isfinite(share * (step[0] + step[1])):
            return
        t, y = min(max(t + step_of(share * step[0]), t0), t1), min(max(y + step_of(share * step[1]), y0), y1)
        gap, k = gap + share * step[2], k + share * step[3]
        gap = gap if w0 + gap >= 0 else -2 * w0 - gap
        if chart.folded(float(t), 0.0, float(y), 0.0):
            return
        p = point(t, y)
        if not all(map(math.isfinite, (gap, k, p.apart, p.phi))):
            return
        yield t, y
        size = abs(step[0]) / (abs(t1 - t0) + 1e-300) + abs(step[1]) / (abs(y1 - y0) + 1e-300)
        if size < (1e-40 if exact else 1e-15) or (size >= last and size < 1e-10):
            return
        last = size


def _conditions(p, bends, w0, gap, k):
    """Rows of the linear system for steps of (t, y, W - w0, k) to where L = R + (W - w0)^2 + k (phi - W^2) is stationary; the
    right-hand side last."""
    (r_tt, _), (r_ty, _), (r_yy, _), (f_tt, _), (f_ty, _), (f_yy, _) = bends
    w = w0 + gap
    lift = (gap - p.gap) * (2 * w0 + gap + p.gap) if p.phi > 0 else w * w - p.phi  # W^2 - phi without cancellation
    return [[r_tt + k * f_tt, r_ty + k * f_ty, 0.0, p.phi_t, -(p.apart_t + k * p.phi_t)],
            [r_ty + k * f_ty, r_yy + k * f_yy, 0.0, p.phi_y, -(p.apart_y + k * p.phi_y)],
            [0.0, 0.0, 2 - 2 * k, -2 * w, -2 * gap + 2 * k * w], [p.phi_t, p.phi_y, -2 * w, 0.0, lift]]


def _solved(rows):
    """The solution of a small linear system, rows with the right-hand side last; None where it is singular."""
    n = len(rows)
    for i in range(n):
        best = max(range(i, n), key=lambda r: abs(rows[r][i]))
        if not rows[best][i]:
            return None
        rows[i], rows[best] = rows[best], rows[i]
        for r in range(i + 1, n):
            f = rows[r][i] / rows[i][i]
            rows[r] = [a - f * b for a, b in zip(rows[r], rows[i])]
    out = [0.0] * n
    for i in reversed(range(n)):
        out[i] = (rows[i][n] - sum(rows[i][j] * out[j] for j in range(i + 1, n))) / rows[i][i]
    return out
