"""What is wrong in the papers on the liquid cavity and on the fast top, worked out again: their formulas typed from
their texts, means by sums over a turn, motions by SciPy's DOP853. Nothing of the package is used.

CHECKS: paper -> row of the audit -> function that gives (departure of the print, departure of what is so).
"""
from __future__ import annotations

import numpy as np
from numpy import arccos, cos, pi, sin, sqrt
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

# --- The cavity: d1, d2 for D1', D2', g for lambda3' - e H l1'^2 cos theta; numbers of no figure
J0, d1, d2, g, ep, Lam, zt, M1, M2, M3 = 2.0, 2.9, 0.9, 0.3, 0.2, 0.21, 0.4, 0.13, 0.17, -0.6
TURN = 2 * pi * np.arange(64) / 64  # sums over it are means, exact for the harmonics that occur


def omega(r):
    return sqrt((d2 * r - g) * (d1 * r - g)) / J0


def ratio(r):
    return (d1 * r - g) / (d2 * r - g)


def eq18(a, r, ph):
    """The paper's rate of a before its average."""
    return (ep * (d1 - d2) / J0 * a * omega(r) * sin(ph) * cos(ph)
            - ep * (zt * a - M1 / J0 * cos(ph) + M2 / J0 / sqrt(ratio(r)) * sin(ph))
            + Lam * a * (r**2 * (d1 * cos(ph)**2 * (J0 + ep * d1) + d2 * sin(ph)**2 * (J0 + ep * d2) - ep * d1 * d2)
                         + a**2 * sin(ph)**2 * cos(ph)**2 * (d1 - d2)
                         * ((J0 + ep * (d1 + 2 * d2)) * ratio(r) - (J0 + ep * (2 * d1 + d2)))))


def eq17(a, r, ph):
    """The paper's rate of r before its average."""
    return ((d2 - d1) / J0 * sqrt(ratio(r)) * a**2 * sin(ph) * cos(ph) - ep * (zt * r - M3 / J0)
            - Lam * r * a**2 * (d2 * (J0 + ep * (2 * d2 - d1)) * ratio(r) * sin(ph)**2
                                + d1 * (J0 + ep * (2 * d1 - d2)) * cos(ph)**2))


def f1(a, r):
    return eq18(a, r, TURN).mean()


def f2(a, r):
    return eq17(a, r, TURN).mean()


def _brackets(r):
    return (J0 * (d1 + d2) + ep * (d1 - d2)**2, J0 + ep * (d1 + 2 * d2), J0 + ep * (2 * d1 + d2))


def mean20(a, r, share):
    """The print has share = 1/4, the mean of a^2 sin^2 cos^2 is a^2/8."""
    whole, one, two = _brackets(r)
    return Lam * a * (r**2 / 2 * whole + share * (d1 - d2) * (one * ratio(r) - two)) - ep * zt * a


def eq20():
    a, r = 0.8, 1.1
    return abs(mean20(a, r, 1 / 4) - f1(a, r)), abs(mean20(a, r, a**2 / 8) - f1(a, r))


def along(f, a, r, h=1e-3):
    """The rate of f(a, r) along the averaged motion, by differences."""
    step = lambda s: f(a + s * f1(a, r), r + s * f2(a, r))
    return (8 * (step(h) - step(-h)) - (step(2 * h) - step(-2 * h))) / (12 * h)


def eq24():
    """The second coefficient, with the true f1 and with the printed (27)."""
    a, r = 0.8, 1.1
    (whole, one, two), speed = _brackets(r), f2(a, r)

    def printed(F):
        return ((Lam * F * r**2 / 2 + Lam * a * r * speed) * whole
                + one * (F * ratio(r) + a * (d2 - d1) * g * speed / (d2 * r - g)**2) * Lam * (d1 - d2) / 4
                - Lam * F * (d1 - d2) / 4 * two - ep * zt * F)
    exact = along(f1, a, r)
    return (min(abs(printed(F) - exact) for F in (f1(a, r), mean20(a, r, 1 / 4))),
            abs(exact - along(lambda a, r: mean20(a, r, a**2 / 8), a, r)))


def eq13a():
    """q of (13) at phi0: the sine of the phase from q(0)."""
    a, r, phi0 = 0.8, 1.1, 0.6
    q0 = -J0 * a * omega(r) * sin(phi0) / (d2 * r - g)
    return abs(sin(phi0) - q0 / a / sqrt(ratio(r))), abs(sin(phi0) + q0 / a / sqrt(ratio(r)))


def _phase_rate(a, r, ph):
    """phi' from (15) and (16) as two linear equations for a' and phi'."""
    w = omega(r)
    right = [-(1 - ep * d1 / J0) * a * w * sin(ph) - ep * (zt * a * cos(ph) - M1 / J0) + Lam * a * cos(ph)
             * (d1 * (J0 + ep * (d1 - d2)) * r**2 + (d1 - d2) * (J0 + ep * (d1 + 2 * d2)) * ratio(r) * a**2 * sin(ph)**2),
             (1 - ep * d2 / J0) * a * w * cos(ph) - ep * (zt * a * sin(ph) + M2 / J0 / sqrt(ratio(r))) + Lam * a * sin(ph)
             * ((d2 - d1) * (J0 + ep * (2 * d1 + d2)) * a**2 * cos(ph)**2 + d2 * (J0 + ep * (d2 - d1)) * r**2)]
    return np.linalg.solve([[cos(ph), -a * sin(ph)], [sin(ph), a * cos(ph)]], right)[1]


def eq19():
    """Its letter A' has no meaning: the one value that makes it right is D1', by the root of the difference; any other
    letter of the paper, D2' or J0, is off."""
    a, r, ph = 0.8, 1.1, 0.6

    def printed(letter):
        w = omega(r)
        return (w - ep * w / J0 * (d1 * sin(ph)**2 + d2 * cos(ph)**2)
                - ep / a * (M2 / J0 * sqrt((d2 * r - g) / (letter * r - g)) * cos(ph) + M1 / J0 * sin(ph))
                + Lam * sin(ph) * cos(ph) * (d2 - d1) * ((J0 + ep * (d1 + d2)) * r**2 + a**2
                * ((J0 + ep * (2 * d1 + d2)) * cos(ph)**2 + (J0 + ep * (d1 + 2 * d2)) * ratio(r) * sin(ph)**2)))
    exact = _phase_rate(a, r, ph)
    found = brentq(lambda letter: printed(letter) - exact, 0.5, 4)
    return min(abs(found - other) for other in (d2, J0)), abs(found - d1)


def eq25():
    """The same of its letter B': D2' is meant."""
    a, r = 0.8, 1.1
    turned = lambda a, r: omega(r) * (1 - ep * (d1 + d2) / (2 * J0))

    def printed(letter):
        return (1 / (2 * J0) * (1 - ep * (d1 + d2) / (2 * J0)) * (2 * d1 * d2 * r - (d1 + d2) * g) * f2(a, r)
                / sqrt((letter * r - g) * (d1 * r - g)))
    exact = along(turned, a, r)
    found = brentq(lambda letter: printed(letter) - exact, 0.5, 4)
    return min(abs(found - other) for other in (d1, J0)), abs(found - d2)


def text4a():
    """P0 = 8 pi h^7/525 = 1.9: the frozen liquid's moment against the 9 kg m^2 of the whole body."""
    h = brentq(lambda h: 8 * pi * h**7 / 525 - 1.9, 1, 3)
    mass = 1250 * 4 / 3 * pi * h**3
    return 2 / 5 * mass * h**2 / 9 - 1, abs(8 * pi * h**7 / 525 / 1.9 - 1)


def paper_motion(zeta=2.0, torque=-6.0, wheel=0.1, charge=0.01, end=20.0):
    """a at the end by (24) as printed: tau = eps t, primes by (4), (5)."""
    first, eps, inertia = 9.0, 0.1, (9.51, 9.3)
    p1, p2 = ((value - first) / eps for value in inertia)
    G = (wheel - charge * 100 * 0.01**2 * cos(0.3)) / eps
    L, a, r, tau = 1250 * 1.9 / 1000 / first**3, 1.0, 1.0, eps * end
    share = (p1 * r - G) / (p2 * r - G)
    whole = first * (p1 + p2) + eps * (p1 - p2)**2
    one, two = first + eps * (p1 + 2 * p2), first + eps * (2 * p1 + p2)
    F1 = L * a * (r**2 / 2 * whole + (p1 - p2) / 4 * (one * share - two)) - eps * zeta * a
    F2 = (-L * r * a**2 / 2 * (p2 * (first + eps * (2 * p2 - p1)) * share + p1 * (first + eps * (2 * p1 - p2)))
          - eps * (zeta * r - torque / first))
    second = ((L * F1 * r**2 / 2 + L * a * r * F2) * whole
              + one * (F1 * share + a * (p2 - p1) * G * F2 / (p2 * r - G)**2) * L * (p1 - p2) / 4
              - L * F1 * (p1 - p2) / 4 * two - eps * zeta * F1)
    return a + tau * F1 + tau**2 / 2 * second


def textc2():
    """A weaker resistance lowers nothing: by (24) a at 20 s is the larger the smaller zeta, for each wheel."""
    ends = np.array([[paper_motion(zeta=zeta, wheel=wheel) for zeta in (1.5, 2, 2.5)] for wheel in (0.1, 15, 20, 25)])
    return (-np.diff(ends)).min(), max(0.0, np.diff(ends).max())


def textc4():
    """The frequency of (3) about r = 1, by its eigenvalues, from e = 0.01 to 10,000 C: the least change of all wheels;
    and that the charge takes e H l'^2 cos theta off the wheel."""
    def size(wheel, charge):
        held = wheel - charge * 100 * 0.01**2 * cos(0.3)
        matrix = [[0, -((9 - 9.3) + held) / 9.51], [-((9.51 - 9) - held) / 9.3, 0]]
        return abs(np.linalg.eigvals(matrix)).max()
    off = [abs(size(wheel, 1e4) / size(wheel, 0.01) - 1) for wheel in (0.1, 15, 20, 25)]
    same = [size(wheel, 1e4) / size(wheel - 1e4 * 0.01 * cos(0.3), 0) - 1 for wheel in (0.1, 15, 20, 25)]
    return min(off), max(map(abs, same))


# --- The fast top
def top1():
    """The field's torque on four masses by Newton's law, far off: the part that does not vanish with the mean force is
    3 mu/R^3 times Lambda x I Lambda, the other sign of N (I Lambda x Lambda)."""
    R, mu = 1e3, 1.0
    # a pair on each axis, about the fixed point, of moments 1.3, 1.1, 0.7 there
    squares = np.linalg.solve([[0, 2, 2], [2, 0, 2], [2, 2, 0]], [1.3, 1.1, 0.7])
    axis = np.array([0.36, 0.48, 0.8])
    torque = np.zeros(3)
    for n, square in enumerate(squares):
        for sign in (1, -1):
            x = sign * sqrt(square) * np.eye(3)[n]
            away = R * axis - x
            torque += np.cross(x, mu * away / np.linalg.norm(away)**3)
    N, moment = 3 * mu / R**3, np.array([1.3, 1.1, 0.7]) * axis
    printed = N * np.cross(moment, axis)
    return np.abs(torque - printed).max() / N, np.abs(torque + printed).max() / N


def _expanded(eps):
    """S2 by (7) with (16), (17), and the S21 of (9) as printed, with a for its 2, and as it is."""
    a, b, X = 1.4, 1.2, 1.7
    lam, lam1, lam2, rho1, rho2, ys, y1 = 0.2, 0.5, 0.3, 0.7, 0.4, 0.1, 0.35
    p20, p2, gm20, gm2, pd20, pd2, gd20, gd2 = 0.5, 0.3, 0.9, 0.4, 0.2, 0.6, 0.1, 0.7
    p = lambda p2, gm: p2 + eps * (lam + lam1 * gm)
    q = lambda pd, gd: -X * pd + eps * X * (ys / a - lam2 * gd)
    g1 = lambda p2, gm: gm + eps * rho1 * p2
    g2 = lambda pd, gd: gd + eps * rho2 * pd
    S2 = (a * (p(p20, gm20) * g1(p20, gm20) - p(p2, gm2) * g1(p2, gm2))
          + b * (q(pd20, gd20) * g2(pd20, gd20) - q(pd2, gd2) * g2(pd2, gd2))
          + y1 * (g1(p20, gm20) - g1(p2, gm2)))
    first = p20 * gm20 - p2 * gm2, pd20 * gd20 - pd2 * gd2, gm20 - gm2
    printed21 = 2 * first[0] - b * X * (first[1] + y1 * first[2])
    meant21 = a * first[0] - b * X * first[1] + y1 * first[2]
    return S2, printed21, a * first[0] - b * X * (first[1] + y1 * first[2]), meant21


def top9():
    """S21, the constant term of S2 (with 1 - gamma'' = -eps S21, of first order): as printed, with a in the place of
    its 2, and as it is."""
    S2, printed, bracket, meant = _expanded(1e-9)
    return min(abs(S2 - printed), abs(S2 - bracket)), abs(S2 - meant)


def top19():
    """gamma1^2 + gamma1'^2 + gamma1''^2 - 1 over eps, less the first-order terms: rho2 gamma2' p2' is left out."""
    eps, rho1, rho2, p2, pd2, gm2, gd2, S21 = 1e-6, 0.7, 0.4, 0.3, 0.6, 0.4, 0.7, 0.2
    left = (gm2 + eps * rho1 * p2)**2 + (gd2 + eps * rho2 * pd2)**2 + (1 + eps * S21)**2 - 1 - gm2**2 - gd2**2
    return (abs(left / eps - 2 * (rho1 * gm2 * p2 + S21)),
            max(0.0, abs(left / eps - 2 * (rho1 * gm2 * p2 + rho2 * gd2 * pd2 + S21)) - 1e-5))


def top37():
    """p2' a period and alpha later, of p2'' + Omega^2 p2 = C A1 y1/B, less that at 0, over alpha."""
    Om, drive, p0, v0, al = 1.3, 0.45, 0.6, 0.2, 1e-6
    rest = drive / Om**2
    speed = lambda t: -(p0 - rest) * Om * sin(Om * t) + v0 * cos(Om * t)
    change = (speed(2 * pi / Om + al) - speed(0)) / al
    return abs(change - (Om**2 * p0 + drive)), max(0.0, abs(change - (drive - Om**2 * p0)) - 1e-5)


def top38():
    """The last of (37) for alpha: the change of gamma2' over a turn, eps H1'(T0), over M3 + beta3 - l_x/(B r0); with
    gamma2 = M cos(tau) + eps H, H = tau^2, for which another F = tau is off."""
    eps, M, drive = 1e-7, 0.9, 0.3
    speed = lambda t: -M * sin(t) + drive * sin(t) + eps * 2 * t  # gamma2'' + gamma2 = drive at eps = 0
    al = brentq(lambda al: speed(2 * pi + al) - speed(0), -0.1, 0.1, xtol=1e-16) / eps
    return abs(al - 1 / (M - drive)), max(0.0, abs(al - 4 * pi / (M - drive)) - 1e-4)


def top41gamma():
    """gamma1' of (41) at tau = 0 over eps^2: X y0'/a is left; without it the sum starts from 0."""
    X, y0, a, lam2, M = 1.7, 0.3, 1.4, 0.4, 0.8
    at = lambda tau: X * (y0 / a + lam2 * M * sin(tau)) + M / 2 * sin(tau)
    return abs(at(0.0)), abs(at(0.0) - X * y0 / a)


def top43():
    """The nutation of (5) without weight and field, l_z = 0: by DOP853 at eps = 1e-4, over eps. (43) has y1 =
    l_x/(C s) where the steady tilt is P0 = l_x/(s (C - A)), whether the body starts with this tilt or with p1 = 0."""
    a, b, c, s, lx, eps, theta0 = 1.0, 1.1, 1.6, 1.0, 0.3, 1e-4, 0.9
    y1, P0, M = lx / (c * s), lx / (s * (c - a)), np.tan(theta0)
    A1, B1 = (c - b) / a, (a - c) / b

    def right(t, y):
        p, q, r, g1, g2, g3 = y
        return [-A1 * q * r, -B1 * r * p - lx / (b * s) * r, eps**2 * (lx / (c * s) * q - (b - a) / c * p * q),
                r * g2 - eps * q * g3, eps * p * g3 - r * g1, eps * (q * g1 - p * g2)]
    t, off = np.linspace(0, 6, 61), []
    for p in (P0, 0.0):
        y = solve_ivp(right, (0, 6), [p, 0, 1, M, 0, 1], method="DOP853", rtol=1e-13, atol=1e-14, t_eval=t).y
        theta = (arccos(y[5] * cos(theta0)) - theta0) / eps
        printed = y1 * (cos(t) - 1)  # theta0 - eps (theta1(t) - theta1(0)), theta1 = -y1 cos
        off.append(np.abs(theta - printed).max())
        if p:
            true = max(0.0, np.abs(theta - P0 * (cos(t) - 1)).max() - 1e-3)  # of second order
    return min(off), true


def table1a():
    return abs(np.linalg.norm((0.7, 0.3, 0.1)) - 1), abs(np.linalg.norm((0.7, 0.3, 0.1))**2 - 0.59)


def table1b():
    """gamma0 by its own (36), M3 = gamma0/gamma0'' = tan theta0."""
    vertical = 0.001
    gamma = vertical * sqrt(1 - vertical**2) / vertical
    return abs(gamma - 0.001), abs(gamma**2 + vertical**2 - 1)


def text41a():
    """lambda1 of (10) as C nears A + B, where Omega, of A1 and B1, is 1: its size grows as 1/(1 - Omega^2)."""
    def lam1(C):
        A, B = 1.0, 1.1
        A1, B1 = (C - B) / A, (A - C) / B
        square = -A1 * B1
        return (0.1 * (A1 / (B / C) - 1 / (A / C)) + 0.2 * (A1 - square)) / (1 - square), square
    (near, at), (closer, there) = lam1(2.1 - 1e-5), lam1(2.1 - 1e-7)
    return abs(closer / near) - 50, max(0.0, abs(closer * (1 - there) / (near * (1 - at)) - 1) - 1e-3)


CAVITY = {"19": eq19, "20": eq20, "24": eq24, "25": eq25, "27": eq20, "text-13a": eq13a, "text-4a": text4a,
          "text-c2": textc2, "text-c4": textc4}
TOP = {"1": top1, "9": top9, "19": top19, "37": top37, "38": top38, "41-gamma": top41gamma, "43": top43,
       "table-1a": table1a, "table-1b": table1b, "text-41a": text41a}
CHECKS = {"liquid-cavity": CAVITY, "newtonian-field-top": TOP}
