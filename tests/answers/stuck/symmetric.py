"""Symmetric starts (rest, spins about one axis, states of one plane) under a torque on a principal axis, and
their fate by the balance of energy.

Per unit of the angle alpha about the torque's axis i Euler's equations are linear, w_j' = P w_k + l_k/D_j and
w_k' = Q w_j - l_j/D_k, and what the work of the torque leaves to the spin about i is

    S(x) = D_i w_i^2/2 + |M| x - (T(x) - T(0)),   T = (D_j w_j^2 + D_k w_k^2)/2,

x the angle along the torque. The motion is bounded exactly if S < 0 for an x > 0 (on a circle within one
turn). In numbers of mpmath; nothing of the package is used.
"""
from fractions import Fraction

from mpmath import arg, mp, mpf, pi, polyroots, sqrt, workdps

DIGITS = 40
BODIES = ("generic", "generic", "nearly equal", "two equal")
STARTS = ("rest", "rest", "spin about the torque", "spin across", "no rate about the torque",
          "no rate across")
AXES = ((1, 0), (0, 1), (Fraction(3, 5), Fraction(4, 5)), (Fraction(-12, 13), Fraction(5, 13)))


def scene(rng):
    """(moments, axis i of the torque, torque, momentum of other wheels, start, axis of the wheel).

    Exact; rng: a `random.Random`.
    """
    i = rng.randrange(3)
    j, k = (i + 1) % 3, (i + 2) % 3
    D, torque = moments(rng), some(rng, 1, 300) * Fraction(rng.choice([-1, 1]), rng.choice([1, 10, 100]))
    kind = rng.choice(STARTS)
    w = [some(rng, -200, 200) for _ in range(3)]
    keep = {"rest": (), "spin about the torque": (i,), "spin across": (rng.choice([j, k]),),
            "no rate about the torque": (j, k), "no rate across": (i, rng.choice([j, k]))}[kind]
    w = [v if n in keep else Fraction(0) for n, v in enumerate(w)]
    l, axis = [Fraction(0)] * 3, [Fraction(0)] * 3
    if rng.random() < 0.25:
        l[rng.choice([j, k])] = some(rng, -300, 300)
    axis[j], axis[k] = map(Fraction, rng.choice(AXES))
    return D, i, torque, l, w, axis


def moments(rng):
    """That keep the triangle inequality."""
    kind = rng.choice(BODIES)
    a, b, c = (some(rng, 20, 500) for _ in range(3))
    if kind == "generic":
        return [b + c, a + c, a + b]
    near = Fraction(0) if kind == "two equal" else a * Fraction(1, 10 ** rng.randint(2, 6))
    D = [a, a + near, min(b, a)]
    rng.shuffle(D)
    return D


def some(rng, low, high):
    """Hundredths of a whole number in the range, not zero."""
    value = 0
    while not value:
        value = rng.randint(low, high)
    return Fraction(value, 100)


def least(D, i, M, l, w):
    """The least S ahead, an mpf; -inf where it falls for ever. D, l, w: three exact numbers each, l_i = 0."""
    j, k = (i + 1) % 3, (i + 2) % 3
    P, Q, sign = Fraction(D[k] - D[i]) / D[j], Fraction(D[i] - D[j]) / D[k], 1 if M > 0 else -1
    with workdps(DIGITS):
        start, work = number(D[i] * w[i] ** 2) / 2, number(abs(M))
        weights = number(D[j]) / 2, number(D[k]) / 2
        if not P * Q:
            return along_a_parabola(D, j, k, sign * P, sign * Q, l, w, sign, start, work)
        centre = Fraction(l[j]) / (D[i] - D[j]), -Fraction(l[k]) / (D[k] - D[i])
        u, v, n = w[j] - centre[0], w[k] - centre[1], sqrt(number(abs(P * Q)))
        parts = ((number(centre[0]), number(u), sign * number(P * v) / n),
                 (number(centre[1]), number(v), sign * number(Q * u) / n))
        if P * Q < 0:
            return round_a_circle(parts, weights, n, start, work)
        decays = u * u * Q == v * v * P and sign * u * v * P <= 0  # u' = sign P v against u, exactly
        return towards_the_centre(parts, weights, n, start, work) if decays else mpf("-inf")


def number(v):
    v = Fraction(v)
    return mpf(v.numerator) / v.denominator


def round_a_circle(parts, weights, n, start, work):
    """w = c + a cos nx + b sin nx: S' is a quartic in e^(inx)."""
    cos_1 = sum(2 * m * c * a for m, (c, a, b) in zip(weights, parts))
    sin_1 = sum(2 * m * c * b for m, (c, a, b) in zip(weights, parts))
    cos_2 = sum(m * (a * a - b * b) / 2 for m, (c, a, b) in zip(weights, parts))
    sin_2 = sum(m * a * b for m, (c, a, b) in zip(weights, parts))
    S = lambda y: (start + work * y / n - cos_1 * (mp.cos(y) - 1) - sin_1 * mp.sin(y)
                   - cos_2 * (mp.cos(2 * y) - 1) - sin_2 * mp.sin(2 * y))
    quartic = [-sin_2 - 1j * cos_2, -(sin_1 + 1j * cos_1) / 2, work / n, -(sin_1 - 1j * cos_1) / 2,
               -sin_2 + 1j * cos_2]
    while quartic and abs(quartic[0]) < mpf(10) ** -35 * abs(work / n):
        quartic = quartic[1:-1]
    roots = polyroots(quartic, maxsteps=400, extraprec=200) if len(quartic) > 1 else []
    return min(S(y) for y in [2 * pi, *(arg(z) % (2 * pi) for z in roots)])


def towards_the_centre(parts, weights, n, start, work):
    """w = c + a t, t = e^(-nx) from 1 to 0: t S' is a quadratic."""
    first = sum(2 * m * c * a for m, (c, a, b) in zip(weights, parts))
    second = sum(m * a * a for m, (c, a, b) in zip(weights, parts))
    S = lambda t: start - work * mp.log(t) / n - first * (t - 1) - second * (t * t - 1)
    roots = polyroots([2 * second, first, work / n]) if second else []
    return min([start, *(S(z.real) for z in roots if abs(z.imag) < mpf(10) ** -30 and 0 < z.real < 1)])


def along_a_parabola(D, j, k, P, Q, l, w, sign, start, work):
    """One rate is linear in x, the other quadratic, all exact: bounded but where T is linear."""
    first = P * w[k] + Fraction(sign * l[k]) / D[j], Q * w[j] - Fraction(sign * l[j]) / D[k]
    rows = (w[j], first[0], P * first[1] / 2), (w[k], first[1], Q * first[0] / 2)
    T = [Fraction(0)] * 5
    for m, row in zip((D[j], D[k]), rows):
        for a, x in enumerate(row):
            for b, y in enumerate(row):
                T[a + b] += Fraction(m) / 2 * x * y
    return start if not any(T[2:]) and work >= number(T[1]) else mpf("-inf")
