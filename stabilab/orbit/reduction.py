"""Reduction to one degree of freedom: a torque along principal axis i with no gyrostatic component along it.

With alpha' = omega_i + s the two other components obey linear equations in alpha,

    d omega_j/d alpha = p (omega_k + s_k),   d omega_k/d alpha = q (omega_j + s_j),

so they move on a circle (p q < 0), a hyperbola (p q > 0) or a parabola (p q = 0), and alpha is the coordinate
of a particle in a potential. In the canonical variables

    X = (omega_j + s_j)/sqrt|p|,  Z = sgn(p) (omega_k + s_k)/sqrt|q|,  theta = n alpha,  W = theta',  n =
    sqrt|p q|,
    dX/dtheta = Z,  dZ/dtheta = e X  (e = sgn(p q)),   Q = Z^2 - e X^2 = const,
    theta'' = F = mu + G X Z + c Z + d X,   V = -mu theta - G X^2/2 - c X - e d Z,   E = W^2/2 + V = const.

Proof, and what the geometries mean for fates: docs/mathematics/reduction.md.
(Amer et al. 2024 have the special cases lambda along axis 1 with a torque on axis 3 or 2: eqs (13)-(25),
(44)-(66).) A reflection of theta makes mu >= 0. Coefficients are formed exactly from the rationals of the
scene and rounded once.

The energy integrals G1, G2, G3 of Amer et al. 2024, eqs (25), (66), (79), in their corrected form.

Each is the energy of the reduced motion in the paper's scaled variables. With c = b - a, and with the unit
torque along the minor axis, or along the intermediate axis off and on its invariant planes,

    G1 = 2 x3^2 + x2^2 - (x1 + a)^2 - 4 c (x1 + a) - 4 theta,  theta = atan2(x1 + a, x2)
    G2 = 2 x2^2 + (x1 + b)^2 + x3^2 - 4 c (x1 + b) - 4 theta,  theta = atanh(x3/(x1 + b)), or of the inverse
    G3 = (x2^2 + x3^2)/2 - c x3 - ln|x3|  where x1 + b = x3,
         (x2^2 + x3^2)/2 + c x3 + ln|x3|  where x1 + b = -x3

so that G1 = 4 E + Q and G2 = 4 E + Q with the energy E and the invariant Q of `orbit.one_state.motion`.
Derivation, and what the paper prints instead: docs/mathematics/reduction.md.

The same integrals exist for any wheel across the torque and any order of the moments (`_canonical`): on a
circle G1, on a hyperbola G2, on an invariant plane G3. A torque of negative sign is that of the motion turned
half round axis 1, (x1, -x2, -x3)."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from ..numbers.exact import sqrt_fraction
from ..numbers.vectors import CYCLE, Exact3, Number, Triple
from ..physics.scene import AnyScene, QuadraticForm
from .potential import GEOMETRIES, Geometry

if TYPE_CHECKING:
    import numpy as np


def _sign(value: Fraction) -> int:
    return (value > 0) - (value < 0)


class Constants(NamedTuple):
    """Of the canonical variables, in any kind of number."""

    G: Any
    c: Any
    d: Any
    mu: Any
    n: Any
    rx: Any
    rz: Any
    flip: int


@dataclass(frozen=True)
class Reduction:
    """A scene seen as a particle in a potential (see the module text).

    axis i (0-based); j, k the cyclic others; shift s of omega_i; p, p0, q, q0 of the linear pair
    (d omega_j/d alpha = p omega_k + p0, d omega_k/d alpha = q omega_j + q0); kappa, rho, sigma, m of the rate
    of omega_i = kappa omega_j omega_k + rho omega_k + sigma omega_j + m. All exact. weight: twice the kinetic
    energy of omega_i per omega_i^2 (D_i, or 1 for scaled variables).
    """

    axis: int
    s: Fraction
    p: Fraction
    p0: Fraction
    q: Fraction
    q0: Fraction
    kappa: Fraction
    rho: Fraction
    sigma: Fraction
    m: Fraction
    weight: Fraction

    @property
    def j(self) -> int:
        return CYCLE[self.axis][0]

    @property
    def k(self) -> int:
        return CYCLE[self.axis][1]

    @cached_property
    def e(self) -> int:
        """-1 elliptic, +1 hyperbolic, 0 parabolic."""
        return _sign(self.p * self.q)

    @property
    def geometry(self) -> Geometry:
        """Circle, hyperbola or parabola: a class of `potential`."""
        return GEOMETRIES[self.e]

    @property
    def kind(self) -> str:
        """elliptic, hyperbolic or parabolic."""
        return self.geometry.kind

    @cached_property
    def centre(self) -> tuple[Fraction, Fraction]:
        """(sj, sk): the conic is centred at (omega_j, omega_k) = (-sj, -sk); elliptic and hyperbolic only."""
        return self.q0 / self.q, self.p0 / self.p

    @cached_property
    def across(self) -> tuple[Fraction, Fraction]:
        """rho and sigma of the rate of omega_i in components measured from the centre."""
        sj, sk = self.centre
        return self.rho - self.kappa * sj, self.sigma - self.kappa * sk

    @cached_property
    def torque(self) -> Fraction:
        """m of that rate (the last three terms cancel for a body); on a parabola m itself."""
        if not self.geometry.centred:
            return self.m
        sj, sk = self.centre
        return self.m + self.kappa * sj * sk - self.rho * sk - self.sigma * sj

    @cached_property
    def exact_constants(self) -> dict[str, Fraction]:
        """G, c, d, mu, n, sj, sk, rx = sqrt|p|, rz = sgn(p) sqrt|q|, flip; after the reflection that makes mu
        >= 0.

        Elliptic and hyperbolic only. Roots are kept to 240 bits, so these are "exact" for every later
        rounding.
        """
        ap, aq = abs(self.p), abs(self.q)
        result = self.constants_in(Fraction, sqrt_fraction(ap), sqrt_fraction(aq), sqrt_fraction(ap * aq))
        sj, sk = self.centre
        return {**result._asdict(), "sj": sj, "sk": sk, "flip": Fraction(result.flip)}

    def constants_in(self, number: Callable[[Fraction], Number], rp: Number, rq: Number,
                     n: Number) -> Constants:
        """The constants in a kind of number: number makes one of a Fraction; rp, rq, n: the roots of |p|, |q|
        and |p q| in it."""
        (across_j, across_k), torque = self.across, self.torque
        ap, aq, sp, flip = abs(self.p), abs(self.q), _sign(self.p), -1 if self.torque < 0 else 1
        return Constants(number(self.kappa * sp * ap * aq), flip * sp * number(across_j * aq) * rp,
                         number(across_k * ap) * rq,
                         flip * n * number(torque), n, rp, sp * rq, flip)

    @cached_property
    def constants(self) -> dict[str, float]:
        """The exact constants, each rounded once."""
        return {name: float(value) for name, value in self.exact_constants.items()}

    @cached_property
    def sense(self) -> int:
        """Sign of the constant torque about the axis (0 without one): the direction of any spin-up."""
        return _sign(self.torque)

    @property
    def exact_energy_unit(self) -> Fraction:
        """Energy of the scene (J, or the scaled x_i^2/2 + U) per unit of W^2/2 + V."""
        return self.weight / (abs(self.p * self.q) or 1)  # along a parabola theta is alpha

    @cached_property
    def energy_unit(self) -> float:
        """The same, rounded."""
        return float(self.exact_energy_unit)

    def canonical(self, states: Number) -> Triple:
        """(X, Z, W) of states (..., 3), each an array (...,); elliptic and hyperbolic."""
        g, low = self.constants, self.shift_remainders
        x = g["flip"] * (shifted(states[..., self.j], g["sj"], low[0]) / g["rx"])
        z = shifted(states[..., self.k], g["sk"], low[1]) / g["rz"]
        w = (g["flip"] * (g["n"] * shifted(states[..., self.axis], float(self.s),
                                           float(self.s - Fraction(float(self.s))))))
        return x, z, w

    @cached_property
    def shift_remainders(self) -> tuple[float, float]:
        """What the doubles of sj and sk leave of them."""
        j, k = (float(self.exact_constants[name] - Fraction(self.constants[name])) for name in ("sj", "sk"))
        return j, k

    def canonical_exact(self, state: Sequence[float | Fraction]) -> Exact3:
        """(X, Z, W) of one state, taken exactly, with the 240-bit constants: no cancellation in the shifts.
        """
        g = self.exact_constants
        u, v, w = (Fraction(state[a]) for a in (self.j, self.k, self.axis))
        return (g["flip"] * (u + g["sj"]) / g["rx"], (v + g["sk"]) / g["rz"],
                g["flip"] * g["n"] * (w + self.s))

    def component_j(self, x: Number) -> Number:
        """omega_j of canonical X (floats, arrays)."""
        g = self.constants
        return g["flip"] * g["rx"] * x - g["sj"]

    def component_k(self, z: Number) -> Number:
        """omega_k of canonical Z."""
        g = self.constants
        return g["rz"] * z - g["sk"]

    def component_i(self, w: Number) -> Number:
        """omega_i of canonical W."""
        g = self.constants
        return g["flip"] * w / g["n"] - float(self.s)

    def exact_invariant_sign(self, state: Sequence[float | Fraction]) -> int:
        """Sign of Q = Z^2 - e X^2 at a state, exactly (rational arithmetic)."""
        u, v = Fraction(state[self.j]), Fraction(state[self.k])
        sj, sk = self.centre
        x2, z2 = (u + sj) ** 2 / abs(self.p), (v + sk) ** 2 / abs(self.q)
        return _sign(z2 - self.e * x2)

    @property
    def parabolic_shift_size(self) -> float:
        """How far the centre of the conic is from the origin, in units of the components: large for nearly
        equal moments, where the canonical variables cancel and the precise path takes over."""
        if not self.geometry.centred:
            return 0.0
        return max(abs(self.constants["sj"]), abs(self.constants["sk"]))


def reduction_about(form: QuadraticForm, axis: int, weight: Fraction = Fraction(1)) -> Reduction | None:
    """The reduction about principal axis `axis`, or None where the scene has none.

    It exists iff the torque has no component along the other axes and both their rates share a factor
    (omega_i + s).
    """
    j, k = CYCLE[axis]
    if form.m[j] or form.m[k]:
        return None
    # omega_j' = (kappa_j omega_k + rho_j) omega_i + sigma_j omega_k; omega_k' = (kappa_k omega_j + sigma_k)
    # omega_i + rho_k omega_j
    s = _common_shift(form, j, k)
    if s is None:
        return None
    return Reduction(axis=axis, s=s, p=form.kappa[j], p0=form.rho[j], q=form.kappa[k], q0=form.sigma[k],
                     kappa=form.kappa[axis], rho=form.rho[axis], sigma=form.sigma[axis], m=form.m[axis],
                     weight=weight)


def _common_shift(form: QuadraticForm, j: int, k: int) -> Fraction | None:
    """s with sigma_j = s kappa_j, s rho_j = 0, rho_k = s kappa_k, s sigma_k = 0; None if there is no such s.
    """
    s = Fraction(0)
    if form.sigma[j] or form.rho[k]:
        if not form.kappa[j] or not form.kappa[k]:
            return None
        s = form.sigma[j] / form.kappa[j]
        if form.rho[k] != s * form.kappa[k] or form.rho[j] or form.sigma[k]:
            return None
    return s


@lru_cache(
    maxsize=64)  # every question asks for it several times, and its rationals cost more than a few states
def reduce(scene: AnyScene) -> Reduction | None:
    """The reduction that serves `scene` (cached): about the torque's axis, or, without torque, about any axis
    that allows one (elliptic preferred: its circle is compact). None where there is none."""
    form = scene.quadratic()
    weights = scene.body.exact if scene.variables == "physical" else (Fraction(1),) * 3
    axes = [i for i in range(3) if form.m[i]]
    if len(axes) > 1:
        return None
    rows = [r for i in (axes or range(3)) if (r := reduction_about(form, i, weights[i]))]
    if not rows:
        return None
    return min(rows, key=lambda r: (r.geometry.rank, math.hypot(float(r.s), r.parabolic_shift_size)))


def shifted(value: np.ndarray, shift: float, low: float) -> Any:
    """value + (shift + low) to a rounding of the sum, however much of it cancels (Knuth's two-sum); numbers
    or arrays."""
    full = value + shift
    part = full - value
    return full + ((value - (full - part)) + (shift - part) + low)


@dataclass(frozen=True)
class EnergyIntegral:
    """One of the paper's energy integrals along a motion, dimensionless (scaled variables).

    name: "G1" (torque on the minor or the major axis), "G2" (on the intermediate axis) or "G3" (there, on
    an invariant plane). on_separatrix: G1s, G2s or G3s, its value at the saddle that decides the fate, None
    where no saddle stands ahead at this value of the other invariant. difference: on_separatrix - value,
    exact however near the two are; positive below the separatrix. turned_about: the formulas are those of a
    torque in the positive direction of its axis; under one in the negative direction the number of the axis
    (1, 2, 3, of the scene) about which state, wheel and torque are turned by half before they are applied;
    else None.
    """

    name: str
    value: float
    on_separatrix: float | None = None
    difference: float | None = None
    turned_about: int | None = None


def energy_integral(scene: AnyScene, state: Sequence[float | Fraction],
                    margin: float | None) -> EnergyIntegral | None:
    """The energy integral of the motion from `state` (three rates of the scene, each taken exactly).

    margin: the motion's margin in energy, in the scene's unit. None where the scene has no such integral:
    no torque along a principal axis, a wheel along the torque, two equal moments (no scaled variables), or a
    pure spin in the centre of the conic, where the angle is undefined; and where it is no double.
    """
    r = reduce(scene)
    if r is None or not r.sense or not r.geometry.centred:
        return None
    try:
        result = _canonical(r, [Fraction(v) for v in state])
        if result is None:
            return None
        name, value = result
        # the half turn that keeps the sine of G1, and of G2 and G3 the component about axis k
        turned = None if r.torque > 0 else 1 + (r.j if name == "G1" and r.exact_constants["G"] > 0 else r.k)
        if margin is None:
            return EnergyIntegral(name, value, turned_about=turned)
        times = 1 if name == "G3" else 4
        difference = float(times * Fraction(margin) / (r.exact_energy_unit * r.exact_constants["mu"]))
    except OverflowError:  # squares of rates that are no doubles
        return None
    return EnergyIntegral(name, value, value + difference, difference, turned)


def _canonical(r: Reduction, state: list[Fraction]) -> tuple[str, float] | None:
    """(name, value) from the canonical variables of `reduction`; None where the angle is undefined.

    Dividing energies by mu makes the torque 1, and X, Z times sqrt(|G|/mu) the paper's scaled components.
    """
    g = r.exact_constants
    x, z, w = r.canonical_exact(state)
    energy = 4 * (w * w / 2 - g["G"] * x * x / 2 - g["c"] * x - r.e * g["d"] * z) / g["mu"]
    if x == z == 0:
        return None
    if r.exact_invariant_sign(state) == 0:  # a plane X = Z or X = -Z: theta = ln|x|, or -ln|x|
        scaled = x * sqrt_fraction(abs(g["G"]) / g["mu"])
        return "G3", float(energy / 4) - math.copysign(1, x * z) * _log(abs(scaled))
    invariant = z * z - r.e * x * x
    quadratic = float(energy - r.e * g["G"] * invariant / g["mu"])
    if r.e > 0:
        quotient = abs((z + x) / (z - x))
        return "G2", quadratic - 2 * _log(quotient)
    # the sine is the component about the larger of the two other moments, x1 + a, with its own sign
    sine, cosine, sign = (x, z, g["flip"]) if g["G"] > 0 else (z, -x, math.copysign(1, g["rz"]))
    size = sign * max(abs(sine), abs(cosine))
    return "G1", quadratic - 4 * math.atan2(sine / size, cosine / size)


def _log(value: Fraction) -> float:
    """ln of a positive fraction of any size."""
    if 1e-3 < value < 1e3:
        return math.log(value)
    return math.log(value.numerator) - math.log(value.denominator)
