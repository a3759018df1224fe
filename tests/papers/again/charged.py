"""What is wrong in the two papers on the charged body, worked out again: their formulas typed from their texts,
integrals by Gauss' rule, motions by SciPy's DOP853, turns by their matrices. Nothing of the package is used.

CHECKS: paper -> row of the audit -> function that gives (departure of the print, departure of what is so).
"""
from __future__ import annotations

import numpy as np
from numpy import cos, exp, pi, sin, sqrt
from scipy.integrate import solve_ivp

# --- The charged body: complex functions of t; W, r0, A and Pi10 of no figure
r0, W, A, P10 = 0.7, 0.43, 0.31 - 0.2j, 0.17 + 0.4j
U, V, T = W + r0, r0 - W, 1.9
NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)


def integral(f, t):
    """From 0 to t by Gauss' rule of 40 points."""
    return t / 2 * sum(w * f(t / 2 * (1 + x)) for x, w in zip(NODES, WEIGHTS))


def rate(f, t, h=2e-3):
    """By differences of fourth order."""
    return (8 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12 * h)


def Pi1(t):
    """Solves Pi1' = i W Pi1 + A from Pi10."""
    return P10 * exp(1j * W * t) + 1j * A / W * (1 - exp(1j * W * t))


first = lambda t: exp(1j * r0 * t) * Pi1(t)  # the integrands of I1Gamma and I2Gamma
second = lambda t: exp(1j * r0 * t) * np.conj(Pi1(t))
twice = lambda f, t: integral(lambda s: (t - s) * f(s), t)  # the integral of the integral
turned = lambda f: lambda t: exp(-1j * r0 * t) * integral(f, t)


def is_integral(printed, true):
    """How far a printed function is from the integral, of that size; how far the integral's rate is from what it is
    the integral of, (function, its rate)."""
    value, of = true
    return max(abs(printed(t) - value(t)) / abs(value(t)) for t in (T, T / 2)), abs(rate(value, T) - of(T))


ring = lambda t: 1j / r0 * (1 - exp(1j * r0 * t)) - t
NESTED = {  # name -> (function, its rate)
    "I1w": (lambda t: twice(first, t), lambda t: integral(first, t)),
    "I2w": (lambda t: twice(second, t), lambda t: integral(second, t)),
    "I4w": (lambda t: integral(turned(first), t), turned(first)),
    "I5w": (lambda t: integral(turned(second), t), turned(second)),
    "I1e": (lambda t: integral(lambda s: twice(first, s), t), lambda t: twice(first, t)),
    "I2e": (lambda t: integral(lambda s: twice(second, s), t), lambda t: twice(second, t)),
    "I4e": (lambda t: twice(turned(first), t), lambda t: integral(turned(first), t)),
    "I5e": (lambda t: twice(turned(second), t), lambda t: integral(turned(second), t))}
a_, p_ = np.conj(A), np.conj(P10)


def c46():
    """With the zeta that stands in its exponents once too often, and without it."""
    def printed(t, frequency):
        wave = 1j * (exp(1j * t * frequency) - 1) / V - t
        return -1j * p_ / V * wave - a_ / W * (ring(t) / r0 - wave / V)
    return min((is_integral(lambda t: printed(t, f), NESTED["I2w"]) for f in (V, V + 0.05)), key=lambda pair: pair[0])


def _i4(t, over=1j):
    wave = over * (exp(1j * t * U) - 1) / U - t
    return -1j * P10 / U * wave + A / W * (ring(t) / r0 - wave / U)


def _i5(t):
    wave = 1j * (1 - exp(1j * t * V)) / V - t
    return -1j * p_ / V * wave - a_ / W * (ring(t) / r0 - wave / V)


def _parabola(t, wave, frequency):
    return 1j / frequency * (t + wave) - t**2 / 2


def _ring2(t):
    return 1j / r0 * (t - 1j / r0 * (1 - exp(1j * r0 * t))) - t**2 / 2


def c61():
    def printed(t):
        part = _parabola(t, 1j * (1 - exp(1j * t * V) - 1) / V, V)
        return -1j * p_ / V * part - a_ / W * (_ring2(t) / r0 - part / V)
    return is_integral(printed, NESTED["I2e"])


def c65():
    def printed(t):
        part = _parabola(t, 1j * (exp(1j * t * U) - 1) / U, U)
        return -1j * P10 / U * part + A / W * (_ring2(t) / r0 - part / U)
    return is_integral(printed, NESTED["I4e"])


def c66():
    """With Pi10 as printed, and with its conjugate."""
    def printed(t, start):
        part = _parabola(t, 1j * (1 - exp(1j * t * V)) / V, V)
        return -1j * start / V * part - a_ / W * (_ring2(t) / r0 - part / V)
    return min((is_integral(lambda t: printed(t, start), NESTED["I5e"]) for start in (P10, p_)),
               key=lambda pair: pair[0])


def c13():
    zeta1 = 0.29
    value = Pi1(T)
    return (abs((value - np.conj(value)) / (2 * sqrt(zeta1)) - value.imag / sqrt(zeta1)),
            abs((value - np.conj(value)) / (2j * sqrt(zeta1)) - value.imag / sqrt(zeta1)))


def turn(psi, phi, theta):
    """R = Rz(theta) Rx(psi) Ry(phi)."""
    c, s = cos((psi, phi, theta)), sin((psi, phi, theta))
    return (np.array([[c[2], -s[2], 0], [s[2], c[2], 0], [0, 0, 1]])
            @ np.array([[1, 0, 0], [0, c[0], -s[0]], [0, s[0], c[0]]])
            @ np.array([[c[1], 0, s[1]], [0, 1, 0], [-s[1], 0, c[1]]]))


def c30():
    psi, phi, theta = 0.3, 0.5, 0.2
    R = turn(psi, phi, theta)
    return (abs(R[1, 2] - (cos(theta) * sin(phi) - cos(theta) * sin(psi) * cos(phi))),
            abs(R[1, 2] - (sin(theta) * sin(phi) - cos(theta) * sin(psi) * cos(phi))))


def c37():
    """Newton's law: a force of 3 N along z of a body of 10 kg gives 0.3 m/s after 1 s, not 3."""
    v = solve_ivp(lambda t, v: [3.0 / 10.0], (0, 1), [0.0]).y[0, -1]
    return abs(v - 3.0), abs(v - 0.3)


def _small(printed):
    """Departure of first order: the element over a small angle, at angles of 1e-6."""
    e, theta = 1e-6, 0.2
    psi, phi = 0.3 * e, 0.5 * e
    R = turn(psi, phi, theta)
    return (abs(R[1, 2] - printed(psi, phi, theta)) / e,
            abs(R[1, 2] - (phi * sin(theta) - psi * cos(theta))) / e)


def c38():
    return _small(lambda psi, phi, theta: phi * cos(theta) - psi * cos(theta))


def s12():
    """Its element of the matrix, and no mass; `c37`."""
    return min(_small(lambda psi, phi, theta: phi * cos(theta) - psi * sin(theta))[0], c37()[0]), c37()[1]


def c58():
    """The integral of (43) with Gamma0 = 0 and f3 = 0: f and r0 alone, m = 1, theta0 = 0."""
    f = 0.8 + 0.3j
    velocity = lambda t: 1j * f / r0 * (1 - exp(1j * r0 * t))
    printed = lambda t, sign: 1j * f * t / r0 + sign * f / r0**2 * (exp(1j * r0 * t) - 1)
    way = integral(velocity, T)
    return abs(printed(T, 1) - way), abs(printed(T, -1) - way)


def c_fig12():
    """The mean of (35) over a turn."""
    M1, D3 = 4.0, 11.1
    mean = integral(lambda s: 1j * M1 / r0 * (1 - exp(1j * r0 * s)), 2 * pi / r0).imag * r0 / (2 * pi)
    return abs(mean - M1 / (D3 * r0**2)), abs(mean - M1 / r0)


# --- The charged body's linear model, the paper's data
INERTIA, SPIN, FORCE, MASS = (8.7, 8.6, 11.1), 2.7 * 2 * pi / 60, 3.0, 10.0


def _linear(lambda3=1.3, e=0.003, M1=4.0):
    """(matrix, drive) of (p, q, psi, phi), r = r0."""
    D1, D2, D3 = INERTIA
    held = lambda3 - e * 100 * 1.02**2 * cos(0.37)
    matrix = np.array([[0, -((D3 - D2) * SPIN + held) / D1, 0, 0], [((D3 - D1) * SPIN + held) / D2, 0, 0, 0],
                       [1, 0, 0, SPIN], [0, 1, -SPIN, 0]])
    return matrix, np.array([M1 / D1, 0, 0, 0])


def _motion(end=50.0, count=2001, **data):
    """(t, (p, q, psi, phi), transverse velocity, axial velocity, axial way) by DOP853; v' = R f/m for small angles."""
    matrix, drive = _linear(**data)

    def right(t, y):
        theta, (psi, phi) = SPIN * t, y[2:4]
        return [*(matrix @ y[:4] + drive), FORCE / MASS * (phi * cos(theta) + psi * sin(theta)),
                FORCE / MASS * (phi * sin(theta) - psi * cos(theta)), FORCE / MASS, y[6]]
    t = np.linspace(0, end, count)
    y = solve_ivp(right, (0, end), np.zeros(8), method="DOP853", rtol=1e-11, atol=1e-12, t_eval=t).y
    return t, y[:4], y[4:6], y[6], y[7]


def _frequency(**data):
    return abs(np.linalg.eigvals(_linear(**data)[0][:2, :2]).imag).max()


CHARGES, TORQUES, MOMENTA = (0.001, 0.003, 0.005), (4.0, 4.5, 5.0), (1.3, 1.6, 1.9)


def c_fig4():
    """The wavelength grows with the charge: the least step; amplitude and wavelength have one frequency below them."""
    lengths = [2 * pi / _frequency(e=e) for e in CHARGES]
    swings = [np.ptp(_motion(e=e)[1][0]) for e in CHARGES]
    return min(np.diff(lengths)), max(0.0, *(-step for step in np.diff(swings)))


def c_fig6():
    """The amplitude grows in proportion to M1, the frequency stays."""
    swings = [np.ptp(_motion(M1=M1)[1][0]) for M1 in TORQUES]
    return min(np.diff(swings)), abs(swings[2] / swings[0] - 1.25) + abs(_frequency(M1=5.0) - _frequency(M1=4.0))


def c_fig7():
    swings = np.array([np.ptp(_motion(M1=M1)[1][:2], axis=1) for M1 in TORQUES])
    return np.diff(swings, axis=0).min(), np.abs(swings[2] / swings[0] - 1.25).max()


def c_fig17():
    """The radius of (35), half its width."""
    t = np.linspace(0, 2 * pi / SPIN, 4001)
    radii = [np.ptp((1j * M1 / SPIN * (1 - exp(1j * SPIN * t))).real) / 2 for M1 in TORQUES]
    return radii[2] - radii[0], abs(radii[2] / radii[0] - 1.25)


def c_fig21():
    """The growth of the second velocity over that of the third: by the mean of R f/m, from the forced part of the
    linear equations, (p, q, psi, phi) = constant + waves of other frequencies than r0."""
    matrix, drive = _linear()
    values, vectors = np.linalg.eig(matrix)
    weights = np.linalg.solve(vectors, drive) / values  # y = V (e^(l t) - 1) w
    spun = [n for n, value in enumerate(values) if abs(abs(value.imag) - SPIN) < 1e-9]
    def mean(n):
        """Of y_n times cos and sin of r0 t: from the waves of frequency r0."""
        up = sum(vectors[n, k] * weights[k] for k in spun if values[k].imag > 0)
        down = sum(vectors[n, k] * weights[k] for k in spun if values[k].imag < 0)
        return ((up + down) / 2).real, ((up - down) * 1j / 2).real
    (psi_cos, _), (_, phi_sin) = mean(2), mean(3)
    visited = phi_sin - psi_cos
    held = INERTIA[2] * SPIN + 1.3 - 0.003 * 100 * 1.02**2 * cos(0.37)
    return abs(visited / (4 / (INERTIA[2] * SPIN**2)) - 1), abs(visited / (4 / (SPIN * held)) - 1)


def c_axial(values):
    """Whether the axial velocity and way at 50 s differ at all."""
    def check():
        ends = np.array([[_motion(50.0, 3, **data)[n][-1] for n in (3, 4)] for data in values])
        return float(np.ptp(ends, axis=0).max() < 1e-9), np.abs(ends - (15.0, 375.0)).max()
    return check


# --- The short form: its brackets as they stand, marks and exponents as its other lines have them
def s15():
    def printed(t):
        wave = 1j * (1 - exp(1j * t * U)) / U - t
        return -1j * P10 / U * wave + A / W * ring(t) / r0 - wave / U
    return is_integral(printed, NESTED["I1w"])


def s16():
    def printed(t, inside):
        wave = 1j * (exp(1j * t * V) - 1) / V - t
        return -1j * p_ / V * wave - a_ / W * (ring(t) / r0 - inside * wave / V) - (1 - inside) * wave / V
    return min((is_integral(lambda t: printed(t, inside), NESTED["I2w"]) for inside in (0, 1)), key=lambda pair: pair[0])


def _open_ring(t):
    return 1j / r0 * (1 - exp(1j * r0 * t)) / r0 - t


def s20():
    def printed(t):
        wave = 1j * (exp(1j * t * U) - 1) / U - t
        return -1j * P10 / U * wave + A / W * _open_ring(t) - wave / U
    return is_integral(printed, NESTED["I4w"])


def s21():
    def printed(t):
        wave = 1j * (1 - exp(1j * t * V)) / V - t
        return -1j * p_ / V * wave - a_ / W * _open_ring(t) - wave / V
    return is_integral(printed, NESTED["I5w"])


def _open_ring2(t):
    return 1j / r0 * (t - 1j / r0 * (1 - exp(1j * r0 * t))) / r0 - t**2 / 2


def s24():
    def printed(t):
        wave = 1j * (exp(1j * t * U) - 1) / U
        return (-1j * P10 / U * 1j / U * (t + wave - t**2 / 2) + A / W * _open_ring2(t)
                - (-t**2 / 2 + 1j / U * (t + wave)) / U)
    return is_integral(printed, NESTED["I1e"])


def s25():
    def printed(t):
        wave = 1j * (1 - exp(1j * t * V)) / V
        return (-1j * p_ / V * 1j / V * (t + wave - t**2 / 2) - a_ / W * _open_ring2(t)
                - (-t**2 / 2 + 1j / V * (t + wave - t)) / V)
    return is_integral(printed, NESTED["I2e"])


def s28():
    def printed(t):
        wave = 1j * (exp(1j * t * U) - 1) / U
        return (-1j * P10 / U * 1j / U * (t + wave - t**2 / 2) + A / U * _open_ring2(t)
                - (-t**2 / 2 + 1j / U * (t + wave)) / U)
    return is_integral(printed, NESTED["I4e"])


def s29():
    """With W + r0 in the exponents as printed, and with r0 - W."""
    def printed(t, frequency):
        wave = 1j * (1 - exp(1j * t * frequency)) / V
        return (-1j * p_ / V * 1j / V * (t + wave - t**2 / 2) - a_ / W * _open_ring2(t)
                - (-t**2 / 2 + 1j / V * (t + wave)) / V)
    return min((is_integral(lambda t: printed(t, f), NESTED["I5e"]) for f in (U, V)), key=lambda pair: pair[0])


CHARGED = {
    "13": c13, "30": c30, "37": c37, "38": c38, "46": c46, "50": lambda: is_integral(_i4, NESTED["I4w"]),
    "51": lambda: is_integral(_i5, NESTED["I5w"]), "58": c58, "61": c61, "65": c65, "66": c66,
    "text-c1": c_axial([{"lambda3": value} for value in MOMENTA]),
    "text-c2": c_axial([*({"e": value} for value in CHARGES), *({"M1": value} for value in TORQUES)]),
    "text-fig12": c_fig12, "text-fig17": c_fig17, "text-fig21": c_fig21, "text-fig4": c_fig4, "text-fig6": c_fig6,
    "text-fig7": c_fig7}
SHORT = {"12": s12, "15": s15, "16": s16, "20": s20, "21": s21, "22": c58, "24": s24, "25": s25, "28": s28,
         "29": s29}
CHECKS = {"charged-axisymmetric": CHARGED, "charged-axisymmetric-short": SHORT}
