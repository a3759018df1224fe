"""A body with a wheel and a sphere in a viscous fluid inside it, as two bodies in space: the attitude of the
body as a quaternion and the angular momentum of the sphere in space; that of the body and its wheel is what
remains of the constant total. In plain floats, which are quicker. Shares no code with stabilab."""
from __future__ import annotations

from functools import cache

import numpy as np
from scipy.integrate import solve_ivp


@cache
def brute(D, k, c, wheel, omega, until, level=None, rtol=1e-11):
    """(times of the energy's fall to a level, the total in the body at the end, the energy then).

    D: moments of both, k: of the sphere, c: the coefficient of the fluid.
    """
    A = p, q, r = [d - k for d in D]
    l, m, n = wheel
    total = H, I, J = [d * w + h for d, w, h in zip(D, omega, wheel)]  # frames agree, the sphere turns with the body

    def parts(y):
        """Rows of the matrix from body to space, the body's rates."""
        a, b, c_, d = y[:4]
        size = 2 / (a * a + b * b + c_ * c_ + d * d)
        R = ((1 - size*(c_*c_ + d*d), size*(b*c_ - a*d), size*(b*d + a*c_)),
             (size*(b*c_ + a*d), 1 - size*(b*b + d*d), size*(c_*d - a*b)),
             (size*(b*d - a*c_), size*(c_*d + a*b), 1 - size*(b*b + c_*c_)))
        (e, f, g), (h, i, j), (s, t, u) = R
        x, y, z = H - y[4], I - y[5], J - y[6]
        return R, ((e*x + h*y + s*z - l) / p, (f*x + i*y + t*z - m) / q, (g*x + j*y + u*z - n) / r)

    def rates(_, y):
        y = y.tolist()
        R, (u, v, w) = parts(y)
        a, b, c_, d = y[:4]
        return [0.5 * (-b*u - c_*v - d*w), 0.5 * (a*u + c_*w - d*v), 0.5 * (a*v + d*u - b*w), 0.5 * (a*w + b*v - c_*u),
                *(-c * (s / k - e*u - f*v - g*w) for s, (e, f, g) in zip(y[4:], R))]

    def energy(y):
        y = y.tolist()
        return (sum(d * v * v for d, v in zip(A, parts(y)[1])) + sum(s * s for s in y[4:]) / k) / 2

    def height(_, y):
        return energy(y) - level
    height.terminal = True
    run = solve_ivp(rates, (0, until), np.array([1, 0, 0, 0, *(k * w for w in omega)], float), method="DOP853",
                    rtol=rtol, atol=rtol * 1e-3, events=None if level is None else height)
    times = run.t_events[0].tolist() if level is not None else []
    y = run.y_events[0][0] if times else run.y[:, -1]
    R, _ = parts(y.tolist())
    return times, [sum(row[i] * h for row, h in zip(R, total)) for i in range(3)], energy(y)


def crossing(D, k, c, omega, until, rtol=1e-11):
    """(time at which 2 T D2 = |H|^2, D2 the middle moment, sign of H along the major axis then), without a wheel."""
    level = sum((d * w)**2 for d, w in zip(D, omega)) / (2 * sorted(D)[1])
    (time,), total, _ = brute(D, k, c, (0.0, 0.0, 0.0), omega, until, level, rtol)
    return time, int(np.sign(total[D.index(max(D))]))
