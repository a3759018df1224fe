"""The equations of motion of a scene, written once in symbols, torque by torque, and the balance laws that
hold along them.

    D omega' = (D omega + h) x omega + tau,     h, tau: momenta and torques of the effects, each once
    T' = omega . tau  (effects that do work),   (|H|^2 / 2)' = H . tau,   H = D omega + h

A part that turns inside the body (`effects.base.Part`) has its moment taken off D on the left, its friction's
torque on the right, and its own share of T and of H. Where that moment is not the same about all axes (a
wheel, a mass on a line) the three equations are solved for omega' by the adjugate, which divides once.

Everything here is a SymPy value; numbers enter at `to_numpy`."""
from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache, reduce
from typing import Any, TypeAlias

from ..errors import InputError
from ..numbers.exact import exact
from ..numbers.vectors import Number, Triple, cross, dot
from ..reasons import Axis, Reason, Reasoned, Sentence
from ..validation import checked_scene
from .scene import BLOCKS, AnyScene, ScaledGyrostat, Scene, ordered

Symbolic: TypeAlias = Any  # an expression or a symbol of SymPy, which is loaded by none who only reads
Symbols: TypeAlias = dict[str, Symbolic]

WORK = Sentence("law-energy", "work and energy: T' = ω . (torques that do work)")()
WORK_AND_POTENTIAL = Sentence(
    "law-energy-with-potential",
    "work and energy: (T + potential)' = ω . (other torques that do work)")()
TURNING = Sentence("law-momentum", "angular momentum: (|H|²/2)' = H . (outer torques)")()
AREA = Sentence(
    "law-area",
    "angular momentum along γ: (H . γ - shares of the torques)' = γ . (other torques)")()
VERTICAL = Sentence("law-gamma", "γ is a unit vector fixed in space: |γ|² is constant")()
LENGTH = Sentence("law-quaternion", "the quaternion keeps its length")()
CIRCLE = Sentence("law-circle", "((x1+a)² + x2²)' = 2 μ1 (x1+a) + 2 μ2 x2")()
HYPERBOLA = Sentence("law-hyperbola", "((x1+b)² - x3²)' = 2 μ1 (x1+b) - 2 μ3 x3")()
SCALED_WORK = Sentence(
    "law-scaled-energy",
    "work and energy, (b circle - a hyperbola)/2: T' = (b-a) μ1 x1 + b μ2 x2 + a μ3 x3")()
ENERGY_KEPT = Sentence("law-energy-constant", "no torque does work: kinetic energy is constant")()
POTENTIAL_KEPT = Sentence(
    "law-total-energy-constant",
    "all torques that do work have a potential: kinetic plus potential energy is constant")()
MOMENTUM_KEPT = Sentence(
    "law-momentum-constant",
    "no outer torque: the size of the angular momentum is constant")()
AREA_KEPT = Sentence(
    "law-area-constant",
    "no torque along γ but the part accounted for: this area integral is constant")()
VERTICAL_KEPT = Sentence("law-gamma-fixed", "γ is a unit vector fixed in space")()
LENGTH_KEPT = Sentence("law-quaternion-constant", "the quaternion of the attitude has length one")()
NO_TORQUE_IN_IT = Sentence("law-constant", "no torque acts in it: the {name} is constant")
ENERGY_WITH_TURNS = Sentence(
    "law-energy-with-turn-angles",
    "constant torque: T - M . (turn angles) is constant, αᵢ' = ωᵢ")()
QUADRATIC_KEPT = Sentence(
    "law-quadratic-constant",
    "torque along a principal axis (or in a plane of equal moments), no gyrostatic component along it: "
    "the quadratic invariant C is constant")()
QUADRATIC_GROWS = Sentence(
    "law-quadratic-grows",
    "torque along a principal axis: |H|²/2 - D_M T grows by λ . M each second, so there is no equilibrium "
    "and no bounded motion")()
MOMENTUM_WITH_TURNS = Sentence(
    "law-momentum-with-turn-angles",
    "constant torque: |H|²/2 - (D M) . (turn angles) changes by λ . M each second")()
SPIN = Sentence("law-spin", "symmetric body: the spin about {axis} changes by its torque alone")
CIRCLE_WITH_TURNS = Sentence(
    "law-circle-with-turn-angles",
    "((x1+a)² + x2²)/2 - μ1 α1 - μ2 α2 changes by μ1 a per unit of τ, αᵢ' = xᵢ")()
HYPERBOLA_WITH_TURNS = Sentence(
    "law-hyperbola-with-turn-angles",
    "((x1+b)² - x3²)/2 - μ1 α1 + μ3 α3 changes by μ1 b per unit of τ, αᵢ' = xᵢ")()
ACROSS_KEPT = Sentence("law-j-constant", "a = b, torque on {axis}: x2² + x3² is constant")
J_CHANGES = Sentence(
    "law-j-changes",
    "torque on {axis}: J = x2² + x3² - 2(b-a) x1 changes by -2(b-a) μ1 per unit of τ, so there is no "
    "equilibrium and no bounded motion")
PLANE_OF_SUM = Sentence("law-plane", "μ1 = μ3: the plane x1 + b = x3 is invariant")()
PLANE_OF_DIFFERENCE = Sentence("law-opposite-plane", "μ1 = -μ3: the plane x1 + b = -x3 is invariant")()


@dataclass(frozen=True)
class Balance(Reasoned):
    """A law grad(quantity) . rhs == rate, identically in state and parameters; `name` says which, `reason`
    what, because: the same in words."""

    name: str
    quantity: Symbolic
    rate: Symbolic


@dataclass(frozen=True, eq=False,
           repr=False)  # one and the same object per scene: what is made of it is kept by identity
class Equations:
    """Equations of motion as SymPy values.

    blocks: the parts of the state (see `blocks`); state: symbols of the state; parameters: symbol name ->
    exact value, in order of declaration, but for those that are zero, which are nowhere in the equations;
    symbols: name -> symbol, same order; rhs: rates of the state, 1/s of it (1/tau when scaled); torques: name
    -> triple, the parts of inertia * rhs (body frame, N m); inertia: the factors of the rates on the left;
    energy: kinetic energy; balances: the laws.
    """

    variables: str
    state: tuple[Symbolic, ...]
    parameters: dict[str, Fraction]
    symbols: Symbols
    inertia: tuple[Symbolic, ...]
    torques: dict[str, Triple]
    rhs: tuple[Symbolic, ...]
    energy: Symbolic
    balances: tuple[Balance, ...]
    blocks: tuple[str, ...] = ("omega",)

    def __repr__(self) -> str:
        parts = (("", map(str, self.state)), ("torques: ", self.torques),
                 ("first integrals and balances: ", (balance.name for balance in self.balances)))
        return f"Equations({'; '.join(head + ', '.join(names) for head, names in parts)})"

    @cached_property
    def jacobian(self) -> Symbolic:
        """Immutable matrix d rhs_i / d state_j; formed for those who ask, for a liquid's takes as long as all
        the rest."""
        from sympy import ImmutableMatrix
        return ImmutableMatrix([[rate.diff(x) for x in self.state] for rate in self.rhs])

    def numeric(self, expression: Symbolic) -> Symbolic:
        """The expression with the exact parameter values put in (rationals; no rounding)."""
        return expression.subs(values(self))

    def derivative(self, quantity: Symbolic) -> Symbolic:
        """Rate of a quantity along the motion; turn angles alpha_i (alpha_i' = state_i) may stand in it."""
        motion = list(zip(self.state, self.rhs)) + list(zip(turn_angles(), self.state[:3]))
        return sum(quantity.diff(variable) * rate for variable, rate in motion)


def derive(scene: AnyScene, also: Iterable[str] = ()) -> Equations:
    """Equations of motion of a Scene (omega, rad/s, body frame) or of a ScaledGyrostat (x).

    The state has the blocks that the scene's effects need, and those named in `also` (physical scenes only).
    Right-hand sides, energy, Jacobian and balance laws are SymPy expressions. Raises InputError for what is
    no scene, and for velocity or position of a body without a mass.
    """
    return (_scaled(scene) if checked_scene(scene).variables == "scaled"
            else _derived(scene, ordered((*scene.blocks, *also)) if also else scene.blocks))


def values(equations: Equations) -> dict[Symbolic, Symbolic]:
    """Symbol -> SymPy rational of every parameter."""
    from sympy import Rational
    return {equations.symbols[name]: Rational(v.numerator, v.denominator) for name,
            v in equations.parameters.items()}


def turn_angles() -> tuple[Symbolic, ...]:
    """Symbols alpha1, alpha2, alpha3: the integrals of the state's components over time."""
    from sympy import symbols
    return symbols("alpha1:4", real=True)


def _symbols(names: Iterable[str], **assumptions: bool) -> Symbols:
    from sympy import Symbol
    return {name: Symbol(name, real=True, **assumptions) for name in names}


def _present(parameters: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """Those that are not zero."""
    return {name: value for name, value in parameters.items() if value}


def with_zeros(names: Iterable[str], symbols: Symbols) -> Symbols:
    """Name -> symbol, 0 for a parameter that is zero."""
    from sympy import Integer
    return {name: symbols.get(name, Integer(0)) for name in names}


def strengths(scene: Scene, symbols: Symbols) -> Symbols:
    """What the formulas of the scene's effects are called with: a symbol for every parameter that is not
    zero."""
    return symbols | with_zeros([name for effect in scene.effects for name in effect.parameters()], symbols)


def add_terms(u: Iterable[Number], v: Iterable[Number]) -> Triple:
    return tuple(p + q for p, q in zip(u, v))


@lru_cache(maxsize=32)  # one answer asks for the same equations several times
def _derived(scene: Scene, names: tuple[str, ...]) -> Equations:
    from sympy import Integer
    blocks = {name: tuple(_symbols(BLOCKS[name].components).values()) for name in names}
    parameters = dict(zip(("D1", "D2", "D3"), scene.body.exact))
    symbols = _symbols(parameters, positive=True)
    for effect in scene.effects:
        parameters |= _present(effect.parameters())
        symbols |= _symbols(_present(effect.parameters()))
    D, p = tuple(symbols[name] for name in ("D1", "D2", "D3")), strengths(scene, symbols)
    motion = MotionView(scene, blocks, D, p)
    zero = (Integer(0),) * 3

    torques, carried, outer, working, potential = {"inertia": motion.inertial}, zero, zero, zero, Integer(0)
    inside, loss, moments = Integer(0), Integer(0), D
    relative = zero
    taken: dict[str, tuple[Triple, ...]] = {}
    for effect in scene.effects:
        momentum, torque = effect.momentum(p) or zero, effect.torque_along(motion, p) or zero
        torques[effect.name] = add_terms(cross(momentum, motion.omega), torque)
        if (part := effect.part(motion, p)) is not None:
            torques[effect.name] = add_terms(torques[effect.name], part.torque)
            moments = tuple(d - part.inertia for d in moments)
            relative = add_terms(relative, part.momentum)
            inside, loss = inside + part.energy, loss + part.loss
            taken |= {effect.name: part.taken} if part.taken is not None else {}
        carried, outer = add_terms(carried, momentum), add_terms(outer, torque)
        stored = effect.potential(motion, p)
        potential += stored or 0
        working = add_terms(working, torque) if effect.works and stored is None else working

    if "velocity" in blocks:
        if scene.body.mass is None:
            raise InputError("velocity and position need the mass of the body: give body.mass in kg")
        parameters["mass"] = exact(scene.body.mass)
        symbols |= _symbols(("mass",), positive=True)
    motion.change = _turning(moments, tuple(taken.values()), reduce(add_terms, torques.values()))
    for name, rows in taken.items():
        torques[name] = add_terms(torques[name], (dot(row, motion.change) for row in rows))
    rates = {"omega": motion.change}
    rates |= {name: rate(scene, motion, symbols | p) for name, rate in KINEMATICS.items() if name in blocks}
    state, rhs = (tuple(v for name in names for v in part[name]) for part in (blocks, rates))
    inertia = moments + (Integer(1),) * (len(state) - 3)
    energy = dot(motion.spin, motion.omega) / 2 + inside
    H = reduce(add_terms, (carried, relative), motion.spin)
    balances = [
        Balance("energy", energy + potential, dot(motion.omega, working) - loss,
                reason=WORK if potential == 0 else WORK_AND_POTENTIAL),
        Balance("momentum", dot(H, H) / 2, dot(H, outer), reason=TURNING)]
    if "gamma" in blocks:
        balances += _gamma_laws(scene, motion, p, H)
    if "attitude" in blocks:
        q = blocks["attitude"]
        balances.append(Balance("quaternion", sum(a**2 for a in q), Integer(0), reason=LENGTH))
    return Equations("physical", state, parameters, symbols, inertia, torques, rhs, energy, tuple(balances),
                     names)


def _turning(moments: Triple, taken: Iterable[Sequence[Triple]], total: Triple) -> Triple:
    """omega' of (diag(moments) - sum of taken) omega' = total."""
    if not taken:
        return tuple(t / d for t, d in zip(total, moments))
    rows = [[(moments[i] if i == j else 0) - sum(item[i][j] for item in taken) for j in range(3)]
            for i in range(3)]
    columns = [tuple(row[j] for row in rows) for j in range(3)]
    crossed = [cross(columns[j], columns[k]) for j, k in ((1, 2), (2, 0), (0, 1))]  # rows of the adjugate
    return tuple(dot(row, total) / dot(columns[0], crossed[0]) for row in crossed)


def _gamma_laws(scene: Scene, motion: MotionView, symbols: Symbols, H: Triple) -> Iterator[Balance]:
    """(H . gamma - area functions)' = gamma . (torques without one), and |gamma|."""
    from sympy import Integer
    zero, gamma = (Integer(0),) * 3, motion.gamma
    quantity, rest = dot(H, gamma), zero
    for effect in scene.effects:
        area = effect.area(motion, symbols)
        if area is None:
            rest = add_terms(rest, effect.torque_along(motion, symbols) or zero)
        else:
            quantity -= area
    yield Balance("area", quantity, dot(rest, gamma), reason=AREA)
    yield Balance("gamma", dot(gamma, gamma), Integer(0), reason=VERTICAL)


class MotionView:
    """What an effect may see of the motion: the blocks of the state by name, the principal moments D, and
    `undisturbed`."""

    omega: Triple
    gamma: Triple
    attitude: tuple[Symbolic, ...]
    velocity: Triple
    damper: Triple
    wheel: Triple
    damper_wheel: tuple[Symbolic, ...]
    sprung_wheel: tuple[Symbolic, ...]
    damper_mass: tuple[Symbolic, ...]
    change: Triple  # omega', once it is known

    def __init__(self, scene: Scene, blocks: Mapping[str, tuple[Symbolic, ...]], D: Triple,
                 symbols: Symbols) -> None:
        self._scene, self._blocks, self._symbols, self.D = scene, blocks, symbols, D
        self.__dict__ |= blocks
        self.spin = tuple(d * w for d, w in zip(D, self.omega))
        self.inertial = cross(self.spin, self.omega)

    def undisturbed(self, free: bool = False) -> tuple[Triple, Triple]:
        """(omega', omega'') along the motion without the small effects; free: of the body alone."""
        from sympy import expand
        total, inside = self.inertial, []
        for effect in () if free else self._scene.effects:
            if not effect.small:
                momentum = effect.momentum(self._symbols)
                total = add_terms(total, cross(momentum, self.omega)) if momentum else total
                total = add_terms(total, effect.torque_along(self, self._symbols) or (0, 0, 0))
                if (part := effect.part(self, self._symbols)) is not None:
                    total = add_terms(total, part.torque)
                    inside.append((self._blocks[effect.needs[0]], part))
        first = tuple(t / d for t, d in zip(total, self.D))
        change = list(zip(self.omega, first))
        for block, part in inside:
            change += zip(block, part.rate(first))
        if "gamma" in self._blocks:
            change += zip(self.gamma, cross(self.gamma, self.omega))
        second = tuple(expand(sum(rate.diff(x) * v for x, v in change)) for rate in first)
        return first, second


def rotation(q: Iterable[Number]) -> tuple[Triple, Triple, Triple]:
    """Rows of the matrix from body to space of a unit quaternion (q0, q1, q2, q3), any scalar type."""
    a, b, c, d = q
    return ((a*a + b*b - c*c - d*d, 2*(b*c - a*d), 2*(b*d + a*c)),
            (2*(b*c + a*d), a*a - b*b + c*c - d*d, 2*(c*d - a*b)),
            (2*(b*d - a*c), 2*(c*d + a*b), a*a - b*b - c*c + d*d))


def _quaternion_rate(scene: Scene, motion: MotionView, symbols: Symbols) -> tuple[Symbolic, ...]:
    """q' = q (0, omega)/2."""
    a, b, c, d = motion.attitude
    p, q, r = motion.omega
    return ((-b*p - c*q - d*r) / 2, (a*p + c*r - d*q) / 2, (a*q + d*p - b*r) / 2, (a*r + b*q - c*p) / 2)


def _acceleration(scene: Scene, motion: MotionView, symbols: Symbols) -> Triple:
    """m v' = R f."""
    zero = (motion.omega[0] * 0,) * 3
    total = reduce(add_terms, (e.force(motion, symbols) or zero for e in scene.effects), zero)
    return tuple(dot(row, total) / symbols["mass"] for row in rotation(motion.attitude))


def _inside(block: str, effect: str) -> Callable[..., Triple]:
    """The rates of a part that turns inside the body, by its block; effect: that brings it, in words."""
    def rate(scene: Scene, motion: MotionView, symbols: Symbols) -> Triple:
        part = next((item.part(motion, symbols) for item in scene.effects if block in item.needs), None)
        if part is None:
            raise InputError(f"state: {block} is a block of a scene with a {effect}, which this one has not")
        return part.rate(motion.change)
    return rate


KINEMATICS = {
    "gamma": lambda scene, motion, symbols: cross(motion.gamma, motion.omega),
    "attitude": _quaternion_rate,
    "velocity": _acceleration,
    "position": lambda scene, motion, symbols: motion.velocity,
    "damper": _inside("damper", "viscous damper"),
    "wheel": _inside("wheel", "wheel motor"),
    "damper_wheel": _inside("damper_wheel", "damper wheel"),
    "sprung_wheel": _inside("sprung_wheel", "damper wheel on a spring"),
    "damper_mass": _inside("damper_mass", "damper mass"),
}


SCALED = ("a", "b", "mu1", "mu2", "mu3")


@lru_cache(maxsize=32)
def _scaled(scene: ScaledGyrostat) -> Equations:
    from sympy import Integer
    x1, x2, x3 = x = tuple(_symbols(scene.components).values())
    parameters = _present(dict(zip(SCALED, scene.exact_ab + scene.exact_mu)))
    symbols = _symbols(parameters)
    a, b, *mu = with_zeros(SCALED, symbols).values()
    torques = {"inertia": (x2 * x3, -x1 * x3, x1 * x2), "gyrostat": (Integer(0), -a * x3, b * x2),
               "constant_torque": tuple(mu)}
    rhs = reduce(add_terms, torques.values())
    X, Y = x1 + a, x1 + b
    circle = Balance("circle", X**2 + x2**2, 2 * mu[0] * X + 2 * mu[1] * x2, reason=CIRCLE)
    hyperbola = Balance("hyperbola", Y**2 - x3**2, 2 * mu[0] * Y - 2 * mu[2] * x3, reason=HYPERBOLA)
    energy = ((b - a) * x1**2 + b * x2**2 + a * x3**2) / 2
    work = Balance("energy", energy, (b - a) * mu[0] * x1 + b * mu[1] * x2 + a * mu[2] * x3,
                   reason=SCALED_WORK)
    return Equations("scaled", x, parameters, symbols, (Integer(1),) * 3, torques, rhs, energy,
                     (circle, hyperbola, work))


# --- The laws of a scene in symbols: what is conserved, and how fast the rest changes
def invariants(scene: AnyScene) -> tuple[Balance, ...]:
    """The laws that hold for this very scene, its numbers put in.

    A Balance whose rate is 0 is a constant of the motion; a constant rate grows exactly in proportion to
    time; a quantity may hold turn angles alpha_i; a rate that is a multiple of its quantity makes quantity =
    0 an invariant plane. Derived from the assembled equations, so a new effect is judged without being named
    here.
    """
    equations = derive(scene)
    laws = [*conserved(equations)]
    laws += _scaled_laws(equations) if scene.variables == "scaled" else _physical_laws(scene, equations)
    return tuple(laws)

CONSERVED: dict[str, Reason] = {"energy": ENERGY_KEPT, "momentum": MOMENTUM_KEPT, "area": AREA_KEPT,
                                "gamma": VERTICAL_KEPT, "quaternion": LENGTH_KEPT}


def conserved(equations: Equations) -> Iterator[Balance]:
    """The laws whose quantity is constant and not zero throughout, with the reason."""
    for law in equations.balances:
        if equations.numeric(law.rate) == 0 and (quantity := equations.numeric(law.quantity)) != 0:
            reason = CONSERVED.get(law.name) or NO_TORQUE_IN_IT(name=law.name)
            if law.name == "energy" and law.quantity != equations.energy:
                reason = POTENTIAL_KEPT
            yield Balance(law.name, quantity, law.rate * 0, reason=reason)


def _outer(scene: Scene, equations: Equations) -> tuple[Triple, ...] | None:
    """(carried momentum, outer torque) of a physical scene as exact numbers, or None where they vary with the
    state."""
    from sympy import Integer, expand
    zero, p = (Integer(0),) * 3, strengths(scene, equations.symbols)
    momenta = [e.momentum(p) or zero for e in scene.effects]
    parts = [equations.torques[e.name] for e in scene.effects]
    torques = [tuple(a - b for a, b in zip(part, cross(h, equations.state[:3]))) for part,
               h in zip(parts, momenta)]
    sums = [reduce(add_terms, rows, zero) for rows in (momenta, torques)]
    if any(_varies(equations.numeric(Integer(0) + v)) for row in sums for v in row):
        return None
    pair = tuple(tuple(equations.numeric(expand(Integer(0) + v)) for v in row) for row in sums)
    return None if any(v.free_symbols for row in pair for v in row) else pair


def _varies(expression: Symbolic) -> bool:
    """Whether it has different values at two points: to expand a long fraction would take minutes."""
    from sympy import Rational
    symbols = sorted(expression.free_symbols, key=str)
    here, there = (expression.xreplace({x: Rational(n + 2, base + n) for n, x in enumerate(symbols)})
                   for base in (7, 11))
    return bool(symbols) and bool(here.is_Rational and there.is_Rational) and here != there


def _physical_laws(scene: Scene, equations: Equations) -> Iterator[Balance]:
    resolved = _outer(scene, equations)
    if resolved is None:
        return
    (lam, M), omega, alpha = resolved, equations.state, turn_angles()
    D = [equations.numeric(d) for d in equations.inertia]
    T, half_H2 = (equations.numeric(law.quantity) for law in equations.balances[:2])
    if any(M):
        yield Balance("energy with turn angles", T - dot(M, alpha), T * 0, reason=ENERGY_WITH_TURNS)
    moments = {D[i] for i in range(3) if M[i]}
    if len(moments) == 1:
        d, rate = moments.pop(), dot(M, lam)
        yield Balance("quadratic", half_H2 - d * T, rate,
                      reason=QUADRATIC_KEPT if rate == 0 else QUADRATIC_GROWS)
    elif moments:
        turned = dot(tuple(d * m for d, m in zip(D, M)), alpha)
        yield Balance("momentum with turn angles", half_H2 - turned, dot(M, lam), reason=MOMENTUM_WITH_TURNS)
    for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):
        if D[j] == D[k] and lam[j] == lam[k] == 0:
            yield Balance(f"spin {i + 1}", omega[i], M[i] / D[i], reason=SPIN(axis=Axis(i + 1)))


def _scaled_laws(equations: Equations) -> Iterator[Balance]:
    x1, x2, x3 = equations.state
    a, b, mu1, mu2, mu3 = (equations.numeric(s) for s in with_zeros(SCALED, equations.symbols).values())
    alpha = turn_angles()
    if mu1 != 0 or mu2 != 0:
        yield Balance("circle with turn angles",
                      ((x1 + a)**2 + x2**2) / 2 - mu1 * alpha[0] - mu2 * alpha[1], mu1 * a,
                      reason=CIRCLE_WITH_TURNS)
    if mu1 != 0 or mu3 != 0:
        yield Balance("hyperbola with turn angles",
                      ((x1 + b)**2 - x3**2) / 2 - mu1 * alpha[0] + mu3 * alpha[2], mu1 * b,
                      reason=HYPERBOLA_WITH_TURNS)
    if mu2 == 0 and mu3 == 0 and mu1 != 0:
        yield Balance("J", x2**2 + x3**2 - 2 * (b - a) * x1, -2 * (b - a) * mu1,
                      reason=(ACROSS_KEPT if a == b else J_CHANGES)(axis=Axis(1)))
    if mu1 == mu3:
        yield Balance("plane x1 + b = x3", x1 + b - x3, -x2 * (x1 + b - x3), reason=PLANE_OF_SUM)
    if mu1 == -mu3:
        yield Balance("plane x1 + b = -x3", x1 + b + x3, x2 * (x1 + b + x3), reason=PLANE_OF_DIFFERENCE)
