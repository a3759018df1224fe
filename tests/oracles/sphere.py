"""Torque-free motions on their momentum sphere in many digits: all permanent rotations of a momentum, and
which are saddles.

With H = D w + lambda fixed in size, T is stationary where w = H/s, that is (s - D_i) w_i = lambda_i. The
roots s of |H|^2 = h^2 come from mpmath's roots of a polynomial; the sign of the second derivative of T from
its matrix on a basis of the tangent plane.
"""
from fractions import Fraction

import mpmath as mp


def num(value):
    return mp.mpf(Fraction(value).numerator) / Fraction(value).denominator


def margin(D, lam, state, digits=60):
    """Energy of the saddle nearest in energy minus the state's, mpf; None where the sphere has no saddle.
    Exact arguments."""
    with mp.workdps(digits):
        energy = num(sum(Fraction(d) * Fraction(w) ** 2 for d, w in zip(D, state))) / 2
        apart = [e - energy for e, saddle in rotations(D, lam, state) if saddle]
        return min(apart, key=abs) if apart else None


def rotations(D, lam, state):
    """[(energy, whether a saddle)] of the permanent rotations with the momentum of a state, at mpmath's
    working precision."""
    D, lam = [Fraction(d) for d in D], [Fraction(l) for l in lam]
    square = sum((d * Fraction(w) + l) ** 2 for d, w, l in zip(D, state, lam))
    found = [(s, [num(l) / (s - num(d)) if l else mp.mpf(0) for d, l in zip(D, lam)])
             for s in _speeds(D, lam, square)]
    for i in range(3):
        if lam[i] == 0 and all(D[j] != D[i] for j in range(3) if j != i):  # s = D_i, with any w_i
            w = [Fraction(0) if j == i else lam[j] / (D[i] - D[j]) for j in range(3)]
            rest = square / D[i] ** 2 - sum(v * v for v in w)
            if rest > 0:
                found.append((num(D[i]), [mp.sqrt(num(rest)) if j == i else num(w[j]) for j in range(3)]))
    return [(sum(num(d) * v * v for d, v in zip(D, w)) / 2, _is_saddle(D, s, w)) for s, w in found]


def _speeds(D, lam, square):
    acting = sorted({d for d, l in zip(D, lam) if l})
    weight = {d: sum(l * l for e, l in zip(D, lam) if e == d) for d in acting}
    whole = [-square]
    for d in acting:
        whole = _times(whole, [d * d, -2 * d, 1])
    for d in acting:
        part = [0, 0, weight[d]]
        for other in acting:
            part = part if other == d else _times(part, [other * other, -2 * other, 1])
        whole = [a + b for a, b in zip(whole + [0] * 9, part + [0] * 9)][:max(len(whole), len(part))]
    while whole and not whole[-1]:
        whole.pop()
    if len(whole) < 2:
        return []
    roots = mp.polyroots([num(c) for c in whole[::-1]], maxsteps=2000, extraprec=2 * mp.mp.prec)
    return [mp.re(s) for s in roots if abs(mp.im(s)) <= abs(s) * mp.mpf(10) ** (-mp.mp.dps // 3) and s != 0]


def _times(a, b):
    out = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, v in enumerate(a):
        for j, w in enumerate(b):
            out[i + j] += v * w
    return out


def _is_saddle(D, s, w):
    """Whether diag(1/D - 1/s) has both signs across w."""
    size = mp.sqrt(sum(v * v for v in w))
    n = [v / size for v in w]
    i = min(range(3), key=lambda a: abs(n[a]))
    one = [(1 if a == i else 0) - n[i] * n[a] for a in range(3)]
    two = [n[1] * one[2] - n[2] * one[1], n[2] * one[0] - n[0] * one[2], n[0] * one[1] - n[1] * one[0]]
    bend = lambda a, b: sum((1 / num(d) - 1 / s) * u * v for d, u, v in zip(D, a, b))
    return bend(one, one) * bend(two, two) - bend(one, two) ** 2 < 0
