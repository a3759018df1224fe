"""The charged, nearly axisymmetric body at small divisors: zero frequency, zero spin, resonance, instability,
late times."""
from __future__ import annotations

import math

import numpy as np

from stabilab.theories.charged import solution
from tests.hard.row import UNIT, Row
from tests.theories.charged.test_closed_form import D1, D2, D3, R0, RESONANT, START, K, body_of

USUAL = START | dict(D1=D1, D2=D2, D3=D3, k=K)


def by_partial_fractions(v):
    """psi + i phi: the transforms' residues over the poles 0, -i r0, i w, -i w. With a, b in doubles."""
    a = ((v["D3"] - v["D2"]) * v["r0"] + v["lambda3"] - v["k"]) / v["D1"]
    b = ((v["D3"] - v["D1"]) * v["r0"] + v["lambda3"] - v["k"]) / v["D2"]
    w, r0, t = np.sqrt(complex(a * b)), v["r0"], v["t"]
    p0, q0, m1, m2, start = v["p0"], v["q0"], v["M1"] / v["D1"], v["M2"] / v["D2"], complex(v["psi0"],
                                                                                            v["phi0"])
    # p, q = (s p0 - a q0 + m1 - a m2/s)/(s^2 + w^2), (s q0 + b p0 + m2 + b m1/s)/(s^2 + w^2)
    # and Gamma = (p + iq + start)/(s + i r0)
    top = lambda s: s * (s * (p0 + 1j * q0) - a * q0 + 1j * b * p0 + m1 + 1j * m2) - a * m2 + 1j * b * m1
    poles = np.array([0, -1j * r0, 1j * w, -1j * w])
    others = lambda m: np.prod([poles[m] - z for n, z in enumerate(poles) if n != m])
    with np.errstate(all="ignore"):
        tilt = sum(top(s) * np.exp(s * t) / others(m) for m, s in enumerate(poles))
        tilt += start * np.exp(-1j * r0 * t)
    return [tilt.real, tilt.imag]


def by_matrix_exponential(v):
    """psi + i phi: exp of the matrix of p, q, psi, phi and 1."""
    from scipy.linalg import expm
    a = ((v["D3"] - v["D2"]) * v["r0"] + v["lambda3"] - v["k"]) / v["D1"]
    b = ((v["D3"] - v["D1"]) * v["r0"] + v["lambda3"] - v["k"]) / v["D2"]
    r0 = v["r0"]
    A = np.array([[0, -a, 0, 0, v["M1"] / v["D1"]], [b, 0, 0, 0, v["M2"] / v["D2"]], [1, 0, 0, r0, 0],
                  [0, 1, -r0, 0, 0],
                  [0.0] * 5])
    return (expm(A * v["t"]) @ [v["p0"], v["q0"], v["psi0"], v["phi0"], 1.0])[2:4].tolist()


def tilt_row(case, wrong, v, naive):
    """psi, phi; exact and condition from the exponential of the full system's matrix in balls."""
    from flint import arb, ctx

    from tests.oracles.axisymmetric import BITS, conditioned
    exact, effect = conditioned(v)
    with ctx.workprec(BITS):
        size = max(abs(float(e.mid())) for e in exact[2:4])
        away = lambda pair: max(abs(float((arb(float(x)) - e).mid())) for x,
                                e in zip(pair, exact[2:4])) / size
        found = naive(v)
        return Row(case, "tilt", wrong, away(found) if np.isfinite(found).all() else math.inf,
                   away(solution(body_of(v), v["t"]).angles[:2]), max(effect[2:4]) / size + UNIT)


def slow_spin(r0):
    """r0 = 0 and next to it."""
    return tilt_row(f"charged body, spin {r0:g} rad/s",
                    "partial fractions: 1/r0^2 stands against an answer near 1",
                    USUAL | dict(lambda3=1.25, r0=r0, t=7.0), by_partial_fractions)


def near(name, distance, t=7.0, wrong="partial fractions: poles that meet"):
    v = USUAL | dict(r0=R0, lambda3=RESONANT[name] * (1 + distance), t=t)
    return tilt_row(f"charged body, {f'{distance:g} from' if distance else 'exactly'} {name}", wrong, v,
                    by_partial_fractions)


def zero_frequency(distance):
    """omega = 0 by a = 0: p, q grow, the poles i w, -i w, 0 meet."""
    return near("a = 0", distance)


def resonance_plus(distance):
    """r0^2 = omega^2, i.e. X Y = 0, by Y = 0."""
    return near("Y = 0", distance)


def resonance_minus(distance):
    """r0^2 = omega^2 by X = 0."""
    return near("X = 0", distance)


def unstable_band(distance):
    """a b < 0: the square root of a negative product; next to the band's edge its poles meet as well."""
    v = USUAL | dict(r0=R0, lambda3=RESONANT["b = 0"] - distance * K, t=7.0)
    assert RESONANT["a = 0"] < v["lambda3"] < RESONANT["b = 0"]
    return tilt_row(f"charged body, {distance:g} inside the band ab < 0",
                    "partial fractions: poles that meet", v,
                    by_partial_fractions)


def late(t):
    """t up to 1e9 s."""
    return tilt_row(f"charged body at t = {t:g} s", "matrix exponential: squared 30 times over",
                    USUAL | dict(r0=R0, lambda3=1.25, t=t), by_matrix_exponential)
