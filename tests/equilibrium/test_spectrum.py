"""Tests of `equilibrium/spectrum.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import random
from fractions import Fraction as F

from stabilab.equilibrium.stability import eigenvalues


def cubics():
    """(m, n) of every kind: three real roots, one, double, triple, on the axes, over many decades."""
    rng = random.Random(11)
    for _ in range(150):
        yield tuple(F(rng.randint(-10**6, 10**6)) * F(10) ** rng.randint(-12, 12) for _ in range(2))
    for _ in range(100):  # roots a, b, -a - b: three real ones; a = b among them
        a = F(rng.randint(-99, 99), rng.randint(1, 99))
        b = rng.choice([a, a + F(1, 10**15), F(rng.randint(-99, 99), rng.randint(1, 99))])
        yield a * b - (a + b) ** 2, a * b * (a + b)
    yield from [(F(0), F(0)), (F(2), F(0)), (F(-2), F(0)), (F(1, 10**40), F(0)), (F(0), F(5)), (F(0), F(-1, 10**30)),
                (F(-3), F(2)), (F(-3), F(-2)), (F(-1), F(1, 10**70)), (F(-1), F(-1, 10**70))]


def test_the_three_eigenvalues_together_have_the_coefficients_of_their_cubic():
    """Vieta, exactly: z1 + z2 + z3 = 0, z1 z2 + z1 z3 + z2 z3 = m, z1 z2 z3 = -n, to the rounding of each root."""
    for m, n in cubics():
        roots = [(F(z.real), F(z.imag)) for z in eigenvalues(m, n)]
        times = lambda p, q: (p[0] * q[0] - p[1] * q[1], p[0] * q[1] + p[1] * q[0])
        size = [abs(a) + abs(b) for a, b in roots]
        pairs = [(0, 1), (0, 2), (1, 2)]
        products = [times(roots[i], roots[k]) for i, k in pairs]
        whole = times(products[0], roots[2])
        eps = F(1, 2**51)
        for part in (0, 1):
            assert abs(sum(r[part] for r in roots)) <= eps * max(size)
            second = sum(p[part] for p in products) - (0 if part else m)
            assert abs(second) <= 2 * eps * sum(size[i] * size[k] for i, k in pairs)
            assert abs(whole[part] + (0 if part else n)) <= 3 * eps * size[0] * size[1] * size[2]
