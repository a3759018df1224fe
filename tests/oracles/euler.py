"""Motions of the other papers' bodies in mpmath, their equations typed in by hand: no code shared with the
program.

Taylor series of the solution by recursive differentiation would need the equations' structure; a
Richardson-extrapolated midpoint rule (Gragg-Bulirsch-Stoer) of high order needs the rates alone and reaches
any accuracy.
"""
from __future__ import annotations

import mpmath as mp


def cross(u, v):
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def integrate(rates, start, end, steps, columns=12, digits=40):
    """State at `end` from `start` at 0: `steps` big steps, each extrapolated from `columns` midpoint runs
    (order 2 columns)."""
    with mp.workdps(digits):
        y, h = [mp.mpf(v) for v in start], mp.mpf(end) / steps
        counts = [2 * (i + 1) for i in range(columns)]
        for _ in range(steps):
            table = [_midpoint(rates, y, h, n) for n in counts]
            for k in range(1, columns):
                for i in range(columns - 1, k - 1, -1):
                    ratio = (mp.mpf(counts[i]) / counts[i - k]) ** 2 - 1
                    table[i] = [a + (a - b) / ratio for a, b in zip(table[i], table[i - 1])]
            y = table[-1]
        return y


def _midpoint(rates, y, h, n):
    small = h / n
    before, now = y, [a + small * f for a, f in zip(y, rates(y))]
    for _ in range(n - 1):
        before, now = now, [a + 2 * small * f for a, f in zip(before, rates(now))]
    # Gragg's smoothing keeps the error expansion even
    return [(a + b + small * f) / 2 for a, b, f in zip(before, now, rates(now))]


def charged(D, k, momentum, torque):
    """omega, then psi, phi, theta by their own kinematic equations (singular where cos psi = 0)."""
    def rates(y):
        w, (psi, phi, _) = y[:3], y[3:6]
        spin = [d * v + l for d, v, l in zip(D, w, momentum)]
        total = [a + k * b + m for a, b, m in zip(cross(spin, w), cross(w, [0, 0, 1]), torque)]
        level = w[2] * mp.cos(phi) - w[0] * mp.sin(phi)
        return [t / d for t, d in zip(total, D)] + [w[0] * mp.cos(phi) + w[2] * mp.sin(phi),
                                                    w[1] - level * mp.tan(psi), level / mp.cos(psi)]
    return rates


def top(D, momentum, arm, field):
    """omega, gamma: (D w + l) x w + arm x gamma + field gamma x D gamma."""
    def rates(y):
        w, g = y[:3], y[3:]
        spin = [d * v + l for d, v, l in zip(D, w, momentum)]
        total = [a + b + field * c for a, b,
                 c in zip(cross(spin, w), cross(arm, g), cross(g, [d * v for d, v in zip(D, g)]))]
        return [t / d for t, d in zip(total, D)] + cross(g, w)
    return rates


def liquid(D, gamma3, kappa, drag, torque):
    """omega with constant Gamma along axis 3: w0'' by the chain rule on w0' = D^-1 [(D w + Gamma e3) x w], by
    hand."""
    def first(w, v):
        """Derivative of (D w + G e3) x w / D in direction v, and the value for v = w (bilinear plus linear).
        """
        spin_w, spin_v = [d * a for d, a in zip(D, w)], [d * a for d, a in zip(D, v)]
        spin_w = [spin_w[0], spin_w[1], spin_w[2] + gamma3]
        total = [a + b for a, b in zip(cross(spin_v, w), cross(spin_w, v))]
        return [t / d for t, d in zip(total, D)]

    def rates(w):
        spin = [D[0] * w[0], D[1] * w[1], D[2] * w[2] + gamma3]
        free = cross(spin, w)
        one = [t / d for t, d in zip(free, D)]
        two = first(w, one)
        lift = cross(w, one)
        return [(f + kappa * (a + b) - drag * d * v + m) / d
                for f, a, b, d, v, m in zip(free, two, lift, D, w, torque)]
    return rates
