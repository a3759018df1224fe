"""The numbers of a fast top, and the Poincare-Lindstedt expansion of its periodic motion to any order.

The numbers say what gravity, the field and a gyrostatic moment weigh against the spin. They are formed from
exact fractions: near a resonance the divisors Omega^2 - m^2 keep all their digits.

With e = `size`, p = e r0 u, q = e r0 v, r = r0 w, s = nu r0 t, a dash for d/ds and hats for quantities over
their power of e, the Euler-Poisson equations (Amer et al. 2023, fast top: eq. (5), there for gamma/gamma0'')
are

    nu u' = -(A1 w + l_z/(A r0)) v + w y2/a + e [(F2 g3 - F3 g2)/a + k A1 g2 g3]
    nu v' = -(B1 w - l_z/(B r0)) u - w y1/b + e [(F3 g1 - F1 g3)/b + k B1 g1 g3]
    nu w' = e^2 [-C1 u v + y1 v - y2 u + F1 g2 - F2 g1 + k C1 g1 g2]
    nu G' = -i w G + i e (u + i v) g3,  G = g1 + i g2,        nu g3' = e (v g1 - u g2)

A1 = (C-B)/A, B1 = (A-C)/B, C1 = (B-A)/C, y = tilt, F = force, k = field. At order 0 G turns as exp(-is) and
u, v are at rest; the kernel of the linear part is the size and phase of G and the means of w and g3, four
constants that the start gamma, r sets. The harmonic exp(-is) of the order n equation of G settles nu_n; the
other three conditions of solvability hold by the three integrals (`defect` keeps how well)."""
from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError, told
from ..numbers.exact import exact, mpmath_alone
from ..numbers.vectors import Exact3, Float3

if TYPE_CHECKING:
    from ..physics.scene import AnyScene


# --- The numbers of the top
COVERED = ("gravity", "newtonian_field", "gyrostat")
UNIT_SLACK = 1e-6  # a vertical given to six decimals counts as a unit vector


@dataclass(frozen=True)
class FastTop:
    """A top turning fast about axis 3, in units of its own spin: time tau = r0 t, rates p/r0, q/r0, r/r0.

    a = A/C, b = B/C; force = M g (centre of mass)/(C r0^2); field = N/r0^2; tilt = (l_x, l_y)/(C r0); wheel =
    l_z/(C r0). omega: rad/s and gamma: unit vector, the start. All exact.
    """

    r0: Fraction
    a: Fraction
    b: Fraction
    force: Exact3
    field: Fraction
    tilt: tuple[Fraction, Fraction]
    wheel: Fraction
    omega: Exact3
    gamma: Exact3

    @property
    def spin(self) -> Fraction:
        """C*/C with C* = C + l_z/r0: everything depends on l_z through it alone."""
        return 1 + self.wheel

    @property
    def alpha(self) -> Fraction:
        """(C* - B)/A."""
        return (self.spin - self.b) / self.a

    @property
    def beta(self) -> Fraction:
        """(A - C*)/B."""
        return (self.a - self.spin) / self.b

    @property
    def Omega2(self) -> Fraction:
        """Square of the free precession's frequency over the spin, -alpha beta."""
        return -self.alpha * self.beta

    @property
    def size(self) -> float:
        """What the expansion is in: the largest of sqrt(M g L/C)/r0, sqrt|N|/r0 and |l_x, l_y|/(C r0)."""
        weight = math.hypot(*map(float, self.force))
        return max(math.sqrt(weight), math.sqrt(abs(self.field)), math.hypot(*map(float, self.tilt)))

    @property
    def epsilon(self) -> float:
        """The paper's small parameter sqrt(M g L |gamma0''|/C)/r0 (Amer et al. 2023, fast top: eq. (4))."""
        return math.sqrt(math.hypot(*map(float, self.force)) * abs(self.gamma[2]))


def fast_top(scene: AnyScene, state: Mapping[str, Float3]) -> FastTop:
    """The numbers of a scene and a start.

    state: {"omega": (3,) rad/s, "gamma": (3,) unit vector}, body frame, or the six numbers in a row. Raises
    InputError where the scene has other effects than gravity, Newtonian field and gyrostat, and for a top
    without spin.
    """
    other = [e.name for e in scene.effects if e.name not in COVERED]
    if other or scene.variables != "physical":
        raise InputError("the expansion of the fast top covers gravity, a Newtonian field and a gyrostat; "
                         f"the scene has {', '.join(other) or 'scaled variables'}")
    omega, gamma = _start(state)
    r0 = omega[2]
    if r0 == 0:
        raise InputError("angular_velocity: the third component is 0; the expansion is about a fast rotation "
                         "around axis 3")
    A, B, C = scene.body.exact
    weight, field = scene.effect("gravity"), scene.effect("newtonian_field")
    arm = weight.exact if weight else (Fraction(0),) * 3
    lx, ly, lz = scene.vector("gyrostat")
    return FastTop(r0, A / C, B / C, tuple(f / (C * r0**2) for f in arm),
                   (field.exact if field else Fraction(0)) / r0**2,
                   (lx / (C * r0), ly / (C * r0)), lz / (C * r0), omega, gamma)


def _start(state):
    expected = 'state: expected {"omega": three numbers, "gamma": three numbers}, or the six numbers in a row'
    try:
        rows = (state["omega"], state["gamma"]) if isinstance(state, dict) else (state[:3], state[3:])
        omega, gamma = (tuple(exact(v) for v in row) for row in rows)
    except (KeyError, TypeError, IndexError):
        raise InputError(f"{expected}; got {told(state)}") from None
    if len(omega) != 3 or len(gamma) != 3:
        raise InputError(f"{expected}; got {len(omega)} and {len(gamma)}")
    length = math.hypot(*map(float, gamma))
    if abs(length - 1) > UNIT_SLACK:
        raise InputError(f"gamma: expected a unit vector, got one of length {length:.12g}")
    return omega, gamma


# --- The expansion
ROUNDED = 3  # digits lost to rounding: a forcing whose share of the largest one lies below the others is none
# Where the weight's tilt sin(theta0) is below what the first orders add to it, the orders of nu are small
# differences over the tilt: each order loses that ratio, so they are formed in many digits. A top that needs
# it for more is not fast.
SMALL_TILT = 0.5
LEAST_TILT = 1e-18  # stands for a weight along axis 3 exactly; the series is continuous there


@dataclass(frozen=True)
class Expansion:
    """Coefficients of the periodic motion.

    nu: (n+1,) orders of the frequency over r0; fields: (n+1, 5, 2K+1) Fourier coefficients -K..K of u, v, w,
    G, g3 by order (G complex, the others real functions); order: the highest that exists, at most the one
    asked for, -1 where there is not even a generating motion; stopped: the harmonic m whose divisor Omega^2 -
    m^2 is 0 under a forcing, or None; defect: largest violation of the conditions of solvability, relative;
    terms: size of each order's term.
    """

    size: float
    nu: np.ndarray
    fields: np.ndarray
    order: int
    stopped: int | None
    defect: float
    terms: tuple[float, ...]

    def sums(self):
        """(nu, (5, 2K+1) Fourier coefficients) with the powers of the small parameter summed up."""
        powers = self.size ** np.arange(self.order + 1)
        return float(powers @ self.nu), np.tensordot(powers, self.fields, 1)


@lru_cache(maxsize=16)
def expand(top: FastTop, order: int) -> Expansion:
    """The expansion of a `FastTop` to `order`, kept: a comparison asks for the same one again and again."""
    if _nearly_upright(top):
        digits = 30 + 20 * (order + 1)
        with mpmath_alone() as mpmath, mpmath.workdps(digits):
            return _Solver(top, order, lambda x: mpmath.mpf(x.numerator) / x.denominator, mpmath.mpc,
                           digits).run()
    return _Solver(top, order, float, complex, 16).run()


def _nearly_upright(top: FastTop) -> bool:
    rest = [float(y / d) if d else 0.0 for y, d in zip(top.tilt, (top.b * top.beta, top.a * top.alpha))]
    return (float(np.hypot(float(top.gamma[0]),
                           float(top.gamma[1]))) < min(SMALL_TILT, top.size + abs(rest[0]) + abs(rest[1])))


class _Solver:
    def __init__(self, top, order, number, cplx, digits):
        self.exact, self.N, self.K = top, order, order + 2
        self.number, self.complex, self.rounding = number, cplx, number(Fraction(1, 10**(digits - ROUNDED)))
        self.e = top.size or 1.0
        e = Fraction(self.e)
        self.a, self.b = number(top.a), number(top.b)
        self.A1, self.B1, self.C1 = (number(x)
                                     for x in ((1 - top.b) / top.a, (top.a - 1) / top.b, top.b - top.a))
        self.alpha, self.beta = number(top.alpha), number(top.beta)
        self.F, self.k = tuple(number(f / e**2) for f in top.force), number(top.field / e**2)
        self.y = tuple(number(y / e) for y in top.tilt)
        self.m = np.arange(-self.K, self.K + 1)
        zero = cplx(0)
        dtype = complex if cplx is complex else object
        self.u, self.v, self.w, self.G, self.g1, self.g2, self.g3 = (
            np.full((order + 1, 2 * self.K + 1), zero, dtype) for _ in range(7))
        self.nu = [number(Fraction(1))] + [number(Fraction(0))] * order
        self.defect, self.reached, self.stopped = 0.0, -1, None

    def run(self) -> Expansion:
        if self.generate():
            self.reached = 0
            for n in range(1, self.N + 1):
                if not self.step(n):
                    break
                self.reached = n
        keep = self.reached + 1
        fields = np.stack([self.u, self.v, self.w, self.G, self.g3], 1)[:keep].astype(complex)
        sizes = tuple(float(np.abs(f * np.array([self.e, self.e, 1, 1, 1])[:, None]).sum(1).max()) * self.e**n
                      for n, f in enumerate(fields))
        return Expansion(self.e, np.array(self.nu[:keep], float), fields, self.reached, self.stopped,
                         self.defect, sizes)

    def generate(self) -> bool:
        """Order 0: the weight turns round the top, the spin axis rests beside axis 3 by the tilt of l_x, l_y.
        """
        K, (g1, g2, g3) = self.K, self.exact.gamma
        if (self.exact.beta == 0 and self.exact.tilt[0]) or (self.exact.alpha == 0 and self.exact.tilt[1]):
            self.stopped = 0
            return False
        if self.exact.tilt[0]:
            self.u[0, K] = -self.y[0] / (self.b * self.beta)
        if self.exact.tilt[1]:
            self.v[0, K] = self.y[1] / (self.a * self.alpha)
        self.w[0, K] = self.complex(1)
        self.g3[0, K] = self.complex(self.number(g3))
        smallest = 0 if self.complex is complex or g1 or g2 else LEAST_TILT
        self.set_G(0, {K - 1: self.complex(self.number(g1) + smallest, self.number(g2))})
        return True

    def set_G(self, n: int, values: Mapping[int, complex]):
        """Order n of G, and of its real and imaginary parts g1, g2."""
        for k, value in values.items():
            self.G[n, k] = value
        mirrored = np.conjugate(self.G[n, ::-1])
        self.g1[n] = (self.G[n] + mirrored) / 2
        self.g2[n] = (self.G[n] - mirrored) / self.complex(0, 2)

    def product(self, f: np.ndarray, g: np.ndarray, n: int, first: int = 0):
        """Order n of f g, the orders of f running from `first` on. Order j holds harmonics up to j + 1 only
        (G; the others up to j), by induction over the products below."""
        K, total = self.K, self.u[0] * 0
        for j in range(first, n + 1):
            low, high = f[j, K - j - 1:K + j + 2], g[n - j, K - n + j - 1:K + n - j + 2]
            if low.any() and high.any():
                total[K - n - 2:K + n + 3] += np.convolve(low, high)
        return total

    def drift(self, f: np.ndarray, n: int):
        """Sum of nu_j f'_(n-j) over the orders 0 < j < n, which are known."""
        return sum((self.nu[j] * self.derivative(f[n - j]) for j in range(1, n)), self.u[0] * 0)

    def derivative(self, f: np.ndarray):
        return f * (self.complex(0, 1) * self.m)

    def integral(self, f: np.ndarray):
        """Periodic integral of f that is 0 at s = 0; the mean of f vanishes by an integral of the motion."""
        out, K = f * 0, self.K
        self.note(f[K], f)
        for k, m in enumerate(self.m):
            if m:
                out[k] = f[k] / self.complex(0, int(m))
        out[K] = -out.sum()
        return out

    def note(self, number: complex, beside: np.ndarray):
        size = float(np.abs(beside).sum())
        self.defect = max(self.defect, float(abs(number)) / size if size else 0.0)

    def step(self, n: int) -> bool:
        """Order n from all lower ones; False where a resonance forbids it."""
        P, u, v, g1, g2, g3 = self.product, self.u, self.v, self.g1, self.g2, self.g3
        (y1, y2), (F1, F2, F3), k = self.y, self.F, self.k
        torque = 0 if n < 2 else (self.product(u, v, n - 2) * -self.C1 + y1 * v[n - 2] - y2 * u[n - 2]
                                  + F1 * g2[n - 2] - F2 * g1[n - 2] + k * self.C1 * P(g1, g2, n - 2))
        self.w[n] = self.integral(torque - self.drift(self.w, n))
        if not self.precession(n, -self.drift(u, n) - self.A1 * P(self.w, v, n, 1) + self.w[n] * (y2 / self.a)
                               + (F2 * g3[n - 1] - F3 * g2[n - 1]) / self.a + k * self.A1 * P(g2, g3, n - 1),
                               -self.drift(v, n) - self.B1 * P(self.w, u, n, 1) - self.w[n] * (y1 / self.b)
                               + (F3 * g1[n - 1] - F1 * g3[n - 1]) / self.b + k * self.B1 * P(g1, g3, n - 1)):
            return False
        self.g3[n] = self.integral(P(v, g1, n - 1) - P(u, g2, n - 1) - self.drift(g3, n))
        self.weight(n)
        return True

    def precession(self, n: int, Ru: np.ndarray, Rv: np.ndarray) -> bool:
        """u, v of order n: u' + alpha v = Ru, v' + beta u = Rv, harmonic by harmonic."""
        K, i = self.K, self.complex(0, 1)
        floor = self.rounding * max(np.abs(Ru).max(), np.abs(Rv).max())
        silent = (np.abs(Ru) <= floor) & (np.abs(Rv) <= floor)
        if not (self.at_rest(self.v[n], Ru[K], self.exact.alpha, floor, self.alpha)
                and self.at_rest(self.u[n], Rv[K], self.exact.beta, floor, self.beta)):
            self.stopped = 0
            return False
        for k, m in enumerate(self.m):
            if m == 0 or silent[k]:
                continue
            exact = self.exact.Omega2 - int(m)**2
            if exact == 0:
                self.stopped = abs(int(m))
                return False
            divisor, im = self.number(exact), i * int(m)
            self.u[n, k] = (im * Ru[k] - self.alpha * Rv[k]) / divisor
            self.v[n, k] = (im * Rv[k] - self.beta * Ru[k]) / divisor
        return True

    def at_rest(self, out: np.ndarray, forcing: complex, exact: Fraction, floor: float,
                number: float) -> bool:
        """The mean: forcing over alpha or beta, which are 0 for C* = B and C* = A."""
        if exact:
            out[self.K] = forcing / number
        return bool(exact) or abs(forcing) <= floor

    def weight(self, n: int):
        """G and nu of order n: G' + iG = R + i nu_n G_0; the harmonic exp(-is) of the right side must vanish.
        """
        K, i = self.K, self.complex(0, 1)
        turned = self.product(self.u, self.g3, n - 1) + i * self.product(self.v, self.g3, n - 1)
        R = i * turned - i * self.product(self.w, self.G, n, 1) - self.drift(self.G, n)
        amplitude = self.G[0, K - 1]
        if amplitude:
            nu = i * R[K - 1] / amplitude
            self.nu[n] = nu.real
            self.note(nu.imag * abs(amplitude), R)
        out = {k: R[k] / (i * (int(m) + 1)) for k, m in enumerate(self.m) if m != -1}
        out[K - 1] = -sum(out.values(), self.complex(0))
        self.set_G(n, out)
