"""A scene in numbers: coefficients of its rates, one state checked without NumPy, the dimensionless
variables of the papers, and whether laws are approximate.

The coefficients, in exact numbers:

    D omega' = (D omega + Lambda + h) x omega + M - u - c D omega - C omega + kappa (omega'' + omega x omega')
               + s x gamma + N gamma x D gamma + E gamma3 omega x e3 + eddy (omega x gamma) x gamma,
    gamma' = gamma x omega,  h' = u

Lambda = lambda - k e3 (gyrostat; a charge of constant angle turns the body as a wheel of moment -k e3
would; k is no part of the angular momentum, yet the rates are the same), s = M g times the centre of mass,
E = e H l^2 of a charge whose angle follows the attitude. A force at the centre of mass does not turn the
body.

The dimensionless variables of Amer et al. 2024, eqs (2)-(4), both ways.

With k1 = (D2-D3)/D1, k2 = (D1-D3)/D2, k3 = (D1-D2)/D3, k = k1 k2 k3 and a torque measure u:

    omega_j = sqrt(u k_j) x_j,   t = tau / sqrt(u k),   M_j = D_j u sqrt(k k_j) mu_j,
    a = lambda1 / ((D1-D3) sqrt(u k1)),   b = lambda1 / ((D1-D2) sqrt(u k1)).

The paper forgets the root of u in a and b, which is harmless only for its u = 1."""
from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from types import ModuleType, SimpleNamespace
from typing import TYPE_CHECKING, Any, ClassVar

from ..errors import InputError
from ..numbers.exact import Rounded, exact_vector, sqrt_fraction
from ..numbers.vectors import Exact3, Float3, Number, Triple, cross, cross_matrix, dot
from ..reasons import Axis, Reason, Sentence
from ..validation import checked_scene, real
from .body import Body
from .effects import effect_class
from .effects.base import Effect
from .scene import INSIDE, NO_MOTION, ZERO3, AnyScene, ScaledGyrostat, Scene

if TYPE_CHECKING:
    import numpy as np

LOSS_UNPROVED = Sentence(
    "liquid-loss-unproved",
    "undecided: the liquid takes energy for the moments of a rigid body alone, and no rigid body has these")()
CHARGE_AS_WHEEL = Sentence(
    "charge-as-wheel", "the charge turns the body as a gyrostatic moment -k e3 would: Λ = λ - k e3, as long "
    "as the angle of {axis} to the field is the constant one, which is judged where an attitude is given")
FORCE_ASIDE = Sentence(
    "force-aside", "the force at the centre of mass does not turn the body: the rotation is judged as if it "
    "were absent")()
ZERO = Fraction(0)


def loses(scene: AnyScene) -> bool:
    """Whether something in a scene takes energy."""
    return any(effect.takes for effect in scene.effects)


@dataclass(frozen=True)
class Content:
    """The coefficients of the equations above, exact. printed: the liquid's torque is the printed one;
    inside, friction: of a damper, the moment of inertia of its sphere, which turns relative to the body, and
    the coefficient of its fluid. C: rows of a linear damper; eddy: k B^2 of eddy currents, N m s; u: torque
    of a motor on its wheel, for so long as duration says, s (None: for ever). movers: the effects that bring
    a damper with another state of its own, a wheel or a mass."""

    D: Exact3
    Lambda: Exact3
    M: Exact3
    c: Fraction = ZERO
    kappa: Fraction = ZERO
    printed: bool = False
    s: Exact3 = ZERO3
    N: Fraction = ZERO
    E: Fraction = ZERO
    inside: Fraction = ZERO
    friction: Fraction = ZERO
    C: tuple[Exact3, ...] = (ZERO3,) * 3
    eddy: Fraction = ZERO
    u: Exact3 = ZERO3
    duration: Fraction | None = None
    movers: tuple[Any, ...] = ()
    charged: bool = False
    forced: bool = False

    @property
    def directed(self) -> bool:
        """Whether the torque depends on where a direction of space lies in the body."""
        return bool(any(self.s) or self.E or self.eddy or (self.N and len(set(self.D)) > 1))

    @property
    def damped(self) -> bool:
        """Whether a linear damper acts."""
        return any(map(any, self.C))

    @property
    def drag(self) -> tuple[Exact3, ...]:
        """C + c D: what medium and linear damper take is omega . drag omega, W."""
        return tuple(tuple(v + (i == j) * self.c * self.D[i] for j, v in enumerate(row))
                     for i, row in enumerate(self.C))

    @property
    def dissipative(self) -> bool:
        """Whether a liquid, a medium, a damper or eddy currents take energy."""
        return bool(self.c or self.damper_inside or self.damped or self.eddy
                    or (self.kappa and len(set(self.D)) + any(self.Lambda) + self.directed > 1))

    @property
    def damper_inside(self) -> bool:
        """Whether a damper moves inside the body."""
        return bool(self.inside or self.movers)

    @property
    def rest_of_moments(self) -> Fraction:
        """T >= this |omega|^2/2: the least moment of what moves with the body, at least; not positive where
        none is proved. A wheel of moment J leaves omega . (D - J a a^T) omega >= (1 - J a . D^-1 a) omega . D
        omega."""
        part = 1 - sum((item.share(self.D) for item in self.movers), Fraction(0))
        return min(self.D) * part - self.inside

    @property
    def all_is_damped(self) -> bool:
        """Whether some damper moves at every rotation that is not permanent."""
        return bool(self.inside) or any(not item.never_turns(self.D, self.Lambda) for item in self.movers)

    @property
    def displaced(self) -> bool:
        """Whether permanent rotations displace a damper, so that they are not those of the body alone."""
        return any(item.displaced for item in self.movers)

    @property
    def unproved_loss(self) -> Reason | None:
        """Why the liquid may give energy: T' = -kappa/(D1 D2 D3) sum (Di - Dj)^2 (Di + Dj - Dk) wi^2 wj^2
        falls for the moments of a mass distribution alone. None where it only takes energy, as far as this
        sum goes, or there is no liquid."""
        return LOSS_UNPROVED if self.kappa and 2 * max(self.D) > sum(self.D) else None

    @property
    def kind(self) -> str:
        """"gyrostat" (Lambda and M alone), "dissipative", "directed", "directed and dissipative", or "wheel
        motor" or "eddy currents", whatever acts besides."""
        if any(self.u):
            return "wheel motor"
        if self.eddy:
            return "eddy currents"
        phrases = [word for word, there in (("directed", self.directed), ("dissipative", self.dissipative))
                 if there]
        return " and ".join(phrases) or "gyrostat"

    @property
    def without_motor(self) -> Content:
        """The same without the motor of the wheel, which has its momentum for the whole duration."""
        taken = tuple(l + u * (self.duration or 0) for l, u in zip(self.Lambda, self.u))
        return replace(self, Lambda=taken, u=ZERO3, duration=None)

    @property
    def note(self) -> Reason | None:
        """What was put aside or taken together, for the reader; None where nothing was."""
        forced = FORCE_ASIDE if self.forced else None
        return CHARGE_AS_WHEEL(axis=Axis(3)).then(forced) if self.charged else forced


def content(scene: AnyScene) -> Content | None:
    """The coefficients of a scene; None where it has an effect that is not in the equations above."""
    if scene.variables == "scaled":
        return None
    numbers: dict[str, Any] = {"Lambda": ZERO3, "M": ZERO3}
    for effect in scene.effects:
        terms = effect.terms()
        if terms is None:
            return None
        numbers |= {name: _joined(name, numbers[name], value) if name in numbers else value
                    for name, value in terms.items()}
    return Content(scene.body.exact, **numbers)


def _joined(name: str, item: Any, other: Any) -> Any:
    return item + other if name == "movers" else _sum(item, other)


def _sum(item: Any, other: Any) -> Any:
    """Of numbers, or of rows of them."""
    return tuple(map(_sum, item, other)) if isinstance(item, tuple) else item + other


@dataclass(frozen=True)
class Together(Effect):
    """What turns the body as a wheel of moment Lambda would: wheel and charge of constant angle in one."""

    name: ClassVar[str] = "gyrostat"
    works: ClassVar[bool] = False

    exact: Exact3
    symbols: ClassVar[tuple[str, ...]] = ("lambda1", "lambda2", "lambda3")

    def terms(self) -> dict[str, Any]:
        return {"Lambda": self.exact}

    def momentum(self, p: Mapping[str, Number]) -> Triple:
        return tuple(p[name] for name in self.symbols)


def gyrostat_scene(parts: Content) -> Scene:
    """The scene of a gyrostat and a constant torque that has the same rates (kind "gyrostat")."""
    # a scene loads no effect that it does not have
    torque = [effect_class("constant_torque")(parts.M)] if any(parts.M) else []
    return Scene(Body(parts.D), Together(parts.Lambda), *torque)


def linear_rates(D: Sequence[Number], omega: Sequence[Number], H: Sequence[Number]) -> list[list[Number]]:
    """Rows of the derivative by omega of D^-1 (D omega + Lambda) x omega, where H = D omega + Lambda (any
    scalar type)."""
    turn, spin = cross_matrix(H), cross_matrix(omega)  # D a = H x omega
    return [[(turn[i][j] - spin[i][j] * D[j]) * (1 / D[i]) for j in range(3)] for i in range(3)]


def rates(parts: Content, omega: Sequence[Number], gamma: Sequence[Number] | None) -> tuple[Exact3, Exact3]:
    """(omega', gamma') in exact fractions; with a liquid only where nothing depends on gamma."""
    w = tuple(map(Fraction, omega))
    g = tuple(map(Fraction, gamma)) if gamma else (Fraction(0),) * 3
    D = parts.D
    H = tuple(d * x + l for d, x, l in zip(D, w, parts.Lambda))
    total = list(cross(H, w))
    total = [t + m - dot(row, w) for t, m, row in zip(total, parts.M, parts.drag)]
    if parts.kappa:
        total = [t + parts.kappa * v for t, v in zip(total, liquid_torque(parts, w))]
    if gamma:
        field = (cross(parts.s, g), cross(g, tuple(parts.N * d * x for d, x in zip(D, g))),
                 cross(w, (0, 0, parts.E * g[2])), cross(cross(w, tuple(parts.eddy * v for v in g)), g))
        total = [t + sum(part[i] for part in field) for i, t in enumerate(total)]
    return tuple(t / d for t, d in zip(total, D)), cross(g, w) if gamma else ()


def liquid_torque(parts: Content, w: Sequence[Number]) -> Triple:
    """omega'' + omega x omega' along the motion without small effects (any scalar type)."""
    D = parts.D
    moment = (0, 0, 0) if parts.printed else parts.Lambda
    H = tuple(d * x + l for d, x, l in zip(D, w, moment))
    first = tuple(t * (1 / d) for t, d in zip(cross(H, w), D))
    turned = tuple(p + q for p, q in zip(cross(tuple(d * a for d, a in zip(D, first)), w), cross(H, first)))
    return tuple(t * (1 / d) + v for t, d, v in zip(turned, D, cross(w, first)))


def at_rest(parts: Content, omega: Sequence[Number], gamma: Sequence[Number] | None) -> bool:
    """Whether every rate vanishes exactly (not asked with a liquid in a field), a damper at rest in the body.
    """
    return not (parts.kappa and gamma) and not any(v for block in rates(parts, omega, gamma) for v in block)


def effective(scene: AnyScene) -> AnyScene:
    """The scene itself, or, where charges of constant angle and forces are all it has besides, its twin with
    the gyrostatic moment lambda - k e3. Other scenes come back as they are."""
    if checked_scene(scene).plain:
        return scene
    parts = content(scene)
    return gyrostat_scene(parts) if parts is not None and parts.kind == "gyrostat" else scene


# --- One state, checked and split into plain floats; no NumPy
def split(parts: Content, state: Any) -> tuple[Float3, Float3 | None]:
    """(omega, gamma or None) as plain floats."""
    if isinstance(state, dict):
        rows = [state.get("omega", ()), state.get("gamma", ())]
    else:
        row = _row(state)
        own = 3 + 3 * parts.directed
        row = row[:own] if (parts.damper_inside or any(parts.u)) and len(row) > own else row
        rows = [row[:3], row[3:]]
    omega, gamma = (_row(row) if len(row) else () for row in rows)
    if len(omega) != 3 or len(gamma) not in (0, 3):
        raise InputError("state: expected three numbers (omega), or six (omega, gamma), or a dict of blocks")
    if not parts.directed:
        return omega, None
    if not gamma:
        raise InputError(
            "state: an effect of this scene needs the vertical: give gamma too (six numbers, or a "
            "dict of blocks)")
    return omega, gamma


def relative(parts: Content, state: Any) -> Float3:
    """The rates of a damper relative to the body, rad/s: those of the state, zero where it has none."""
    first = 3 + 3 * parts.directed
    return _inside(state, "damper", first) if parts.inside else (0.0,) * 3


def taken_up(parts: Content, state: Any) -> Float3:
    """The momentum that a motor has given its wheel, N m s, likewise."""
    first = 3 + 3 * parts.directed + 3 * bool(parts.inside)
    return _inside(state, "wheel", first) if any(parts.u) else (0.0,) * 3


def moved(parts: Content, state: Any) -> dict[str, tuple[float, ...]]:
    """The blocks of dampers with another state of their own, likewise."""
    first, result = 3 + 3 * (parts.directed + bool(parts.inside) + any(parts.u)), {}
    for name in (name for name in INSIDE for item in parts.movers if name in item.needs):
        size = len(NO_MOTION[name])
        rows = state.get(name, ()) if isinstance(state, dict) else _row(state)[first:first + size]
        result[name] = _row(rows) if len(rows) else NO_MOTION[name]
        first += size
    return result


def added_inside(effects: Iterable[Any], omega: Sequence[Number], blocks: Mapping[str, Sequence[Number]],
                 number: Callable[[Fraction], Any] = Fraction) -> tuple[Triple, Number]:
    """(momentum, energy) that the motion of parts inside adds to those of the body with them at rest, in the
    arithmetic of the state; omega and blocks of the state by name; number: what the numbers of the effects
    become."""
    momentum, energy = (omega[0] * 0,) * 3, omega[0] * 0
    for effect in effects:
        numbers = {name: number(value) for name, value in effect.parameters().items()}
        if (part := effect.part(SimpleNamespace(omega=omega, **blocks), numbers)) is not None:
            momentum = tuple(h + p for h, p in zip(momentum, part.momentum))
            energy = energy + part.energy
    return momentum, energy


def _inside(state: Any, block: str, first: int) -> Float3:
    """A block of what turns inside the body, which a row of the state has from `first` on; zero where it has
    none."""
    rows = state.get(block, ()) if isinstance(state, dict) else _row(state)[first:first + 3]
    return _row(rows) if len(rows) else (0.0,) * 3


def _row(values: Any) -> tuple[float, ...]:
    """Finite floats in one row; InputError otherwise."""
    if isinstance(values,
                  (tuple, list)) and values and all(type(v) is float and math.isfinite(v) for v in values):
        return tuple(values)
    from .states import numbers_in_a_row  # other kinds of numbers, and the words for what is none
    return tuple(map(float, numbers_in_a_row(values, "state")))


def three_floats(state: np.ndarray | Sequence[float | Fraction | str]) -> Float3:
    """Three finite floats; InputError otherwise."""
    try:
        values = tuple(map(float, real(state, "states")))
        if len(values) == 3 and all(map(math.isfinite, values)):
            return values
    except (TypeError, ValueError, OverflowError):
        pass
    from .states import checked_states  # other shapes that hold one state, and the words for what is none
    array = checked_states(state)
    if array.size != 3:
        raise InputError(f"state: expected one state, three numbers, got the shape {array.shape}")
    return tuple(array.reshape(3).tolist())


# --- Dimensionless variables
@dataclass(frozen=True, repr=False)
class Scaling(Rounded):
    """omega_j = rate[j] x_j and t = time tau; exact up to square roots kept to 240 bits."""

    rate: Exact3
    time: Fraction
    u: Fraction

    def to_scaled(self, omega: Iterable[float]) -> Float3:
        """omega (rad/s), a sequence of three floats -> x."""
        return tuple(float(Fraction(w) / r) for w, r in zip(map(float, omega), self.rate))


def shape_factors(body: Body) -> tuple[Fraction, Fraction, Fraction]:
    """k1, k2, k3 of eq. (2). Raises InputError where the scaling is undefined: it needs D1 > D2 > D3."""
    d1, d2, d3 = body.exact
    if not d1 > d2 > d3:
        raise InputError("the scaled variables need D1 > D2 > D3, three different moments in falling order; "
                         f"here D = ({float(d1):g}, {float(d2):g}, {float(d3):g}): use physical variables")
    return (d2 - d3) / d1, (d1 - d3) / d2, (d1 - d2) / d3


def torque_measure(body: Body, torque: Sequence[Fraction]) -> Fraction:
    """u of eq. (4): sqrt(k2 k3 u1^2 + k3 k1 u2^2 + k1 k2 u3^2)/k with u_j = M_j/D_j; 0 for no torque."""
    k1, k2, k3 = shape_factors(body)
    u1, u2, u3 = (m / d for m, d in zip(torque, body.exact))
    return sqrt_fraction(k2 * k3 * u1 * u1 + k3 * k1 * u2 * u2 + k1 * k2 * u3 * u3) / (k1 * k2 * k3)


def scaling(body: Body, u: Fraction) -> Scaling:
    """The change of variables for torque measure u > 0."""
    if u <= 0:
        raise InputError("the scaled variables are undefined without a torque (u = 0): use physical "
                         "variables, "
                         "or give the torque as mu (then u = 1)")
    k1, k2, k3 = shape_factors(body)
    return Scaling(tuple(sqrt_fraction(u * k) for k in (k1, k2, k3)), 1 / sqrt_fraction(u * k1 * k2 * k3), u)


def torque_from_mu(body: Body, mu: Sequence[Number]) -> Exact3:
    """M (N m), exact to 240 bits, from the dimensionless torque for u = 1, the paper's choice."""
    ks = shape_factors(body)
    k = ks[0] * ks[1] * ks[2]
    return tuple(d * sqrt_fraction(k * kj) * m for d, kj, m in zip(body.exact, ks, exact_vector(mu, "mu")))


def to_scaled(scene: Scene, mu: Sequence[Number] | None = None) -> tuple[ScaledGyrostat, Scaling]:
    """The scaled twin of a physical scene and the change of variables.

    mu: the dimensionless torque where the case gave it (u = 1, no rounding through M); otherwise u from the
    torque and mu of unit length. Raises InputError where undefined (equal or unordered moments, no torque, a
    gyrostatic moment off axis 1).
    """
    lam = scene.vector("gyrostat")
    if lam[1] or lam[2]:
        raise InputError(
            "the scaled variables need the gyrostatic moment along axis 1; use physical variables")
    d1, d2, d3 = scene.body.exact
    torque = scene.vector("constant_torque")
    u = Fraction(1) if mu is not None else torque_measure(scene.body, torque)
    change = scaling(scene.body, u)
    k1, k2, k3 = shape_factors(scene.body)
    if mu is None:
        k = k1 * k2 * k3
        mu = tuple(m / (d * u * sqrt_fraction(k * kj)) for m, d,
                   kj in zip(torque, scene.body.exact, (k1, k2, k3)))
    root = sqrt_fraction(u * k1)
    return ScaledGyrostat(lam[0] / ((d1 - d3) * root), lam[0] / ((d1 - d2) * root), tuple(mu)), change


# --- Approximate laws of a scene: how far they hold is asked through here, so that a scene of exact laws
# loads nothing of it
def limits_of(scene: AnyScene) -> ModuleType | None:
    """What tells how far the approximate laws of a scene hold, `law_limits`; None where all its laws are
    exact."""
    if not scene.approximate:
        return None
    from . import law_limits
    return law_limits
