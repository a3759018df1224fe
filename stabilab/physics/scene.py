"""A scene: blocks of its state, effects, rates as quadratic forms, alignment of torque and axes, and the
ends of its effects.

The rates of a gyrostat under constant torque are quadratic, with exact coefficients:

    x_i' = kappa_i x_j x_k + rho_i x_k + sigma_i x_j + m_i        (i, j, k cyclic)

Physical and scaled variables both have this form, so one analysis serves both. Coefficients are exact
rationals: differences such as D1 - D2 or b - a are formed before the one rounding to double.

Where two moments are equal every axis in their plane is principal, and the body is turned so that its
torque lies along one. Of effects that stop acting it is known when, and which scene is left."""
from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, TypeAlias

from ..errors import InputError
from ..numbers.exact import exact, exact_vector, floats, sqrt_fraction
from ..numbers.principal import PrincipalAxes, without_trace
from ..numbers.vectors import CYCLE, Exact3, Float3, Given, Number, Triple, cross, dot
from ..validation import Asked
from .body import Body
from .effects.base import Effect, effect_words

if TYPE_CHECKING:
    import numpy as np


# --- The blocks a state may consist of, in their order: the angular velocity always, the others when
# something needs them
@dataclass(frozen=True)
class Block:
    """A part of the state: the names of its components, their unit, and what it is in words."""

    name: str
    components: tuple[str, ...]
    unit: str
    description: str


BLOCKS = {block.name: block for block in (
    Block("omega", ("omega1", "omega2", "omega3"), "rad/s", "angular velocity, body frame"),
    Block("gamma", ("gamma1", "gamma2", "gamma3"), "", "unit vector fixed in space, body frame"),
    Block("attitude", ("q0", "q1", "q2", "q3"), "", "quaternion from body to space"),
    Block("velocity", ("v1", "v2", "v3"), "m/s", "velocity, inertial frame"),
    Block("position", ("x1", "x2", "x3"), "m", "position, inertial frame"),
    Block("damper", ("sigma1", "sigma2", "sigma3"), "rad/s",
          "angular velocity of the damper's sphere relative to the body, body frame"),
    Block("wheel", ("h1", "h2", "h3"), "N m s", "momentum that a motor has given its wheel, body frame"),
    Block("damper_wheel", ("sigmaw",), "rad/s", "rate of the damper's wheel relative to the body"),
    Block("sprung_wheel", ("phis", "sigmas"), "rad, rad/s",
          "angle of the damper's wheel, from where its spring is relaxed, and its rate relative to the body"),
    Block("damper_mass", ("xm", "vm"), "m, m/s",
          "place of the damper's mass on its line, from where its spring is relaxed, and its speed in the "
          "body"))}
ORDER = tuple(BLOCKS)
# what moves inside the body: zero where nothing is said of it; the first are vectors
VECTORS_INSIDE = ("damper", "wheel")
INSIDE = (*VECTORS_INSIDE, "damper_wheel", "sprung_wheel", "damper_mass")
NO_MOTION = {name: (0.0,) * len(BLOCKS[name].components) for name in INSIDE}
# what a run may show: the blocks, and what is formed from them
PARTS = BLOCKS | {part.name: part for part in (
    Block("x", ("x1", "x2", "x3"), "", "angular velocity, body frame, scaled"),
    Block("angles", ("psi", "phi", "theta"), "rad", "psi, phi, theta of the 3-1-2 sequence, continuous"),
    Block("quaternion", ("qx", "qy", "qz", "qw"), "",
          "attitude as a unit quaternion, scalar last: turns components along the axes of the rates to "
          "inertial ones"),
    Block("matrix", tuple(f"R{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)), "",
          "attitude as a rotation matrix, row by row: turns components along the axes of the rates to "
          "inertial ones"),
    Block("euler", ("precession psi", "nutation theta", "rotation phi"), "rad",
          "classical Euler angles of the vertical, continuous"),
    Block("momentum", ("H1", "H2", "H3"), "kg m^2/s", "angular momentum, inertial frame"),
    Block("nutation", ("nutation",), "rad", "angle of a body axis to the angular momentum"),
    Block("amplitude", ("amplitude",), "rad/s", "amplitude of the transverse rate"),
    Block("spin", ("spin",), "rad/s", "averaged rate about axis 3"),
    Block("phase", ("phase",), "rad", "phase of the transverse rate"))}
ATTITUDES = ("quaternion", "matrix")  # forms in which a run may tell the attitude, besides angles
BRINGS = {"position": ("velocity", "attitude"), "velocity": ("attitude",)}  # what a block cannot do without


def ordered(names: Iterable[str]) -> tuple[str, ...]:
    """The blocks of these names with all they bring along, in order; omega is always there."""
    wanted = {"omega", *names}
    for name in tuple(wanted):
        wanted |= set(BRINGS.get(name, ()))
    return tuple(name for name in ORDER if name in wanted)


def slices(names: Iterable[str]) -> dict[str, slice]:
    """Where each block stands in the state."""
    out, start = {}, 0
    for name in names:
        size = len(BLOCKS[name].components)
        out[name] = slice(start, start + size)
        start += size
    return out


Rows: TypeAlias = tuple[Float3, ...]  # kappa, rho, sigma, m in doubles


@dataclass(frozen=True)
class QuadraticForm:
    """Coefficients of the rates; `symbol` is the letter of the state ("omega" or "x")."""

    kappa: Exact3
    rho: Exact3
    sigma: Exact3
    m: Exact3
    symbol: str = "omega"

    @cached_property
    def coefficients(self) -> Rows:
        """(kappa, rho, sigma, m), each rounded once to double."""
        return tuple(tuple(float(v) for v in row) for row in (self.kappa, self.rho, self.sigma, self.m))

    def rate(self, x: Sequence[Number]) -> list[Number]:
        """x' for one state: three numbers of any type (floats, fractions, balls) -> list of three."""
        rows: tuple[Triple, ...] = (self.kappa, self.rho, self.sigma, self.m)
        if isinstance(x[0], float):
            rows = self.coefficients
        return rates_of(rows, x)

    def jacobian(self, x: Sequence[Number], w: Number = 1) -> list[list[Number]]:
        """3 x 3 nested list: derivative of rate i by component at x/w, times w; entries of the type of x."""
        kappa, rho, sigma, _ = (self.coefficients if isinstance(x[0], float)
                                else (self.kappa, self.rho, self.sigma, 0))
        rows = []
        for i, (j, k) in enumerate(CYCLE):
            row = [x[0] * 0] * 3
            row[j] = kappa[i] * x[k] + sigma[i] * w
            row[k] = kappa[i] * x[j] + rho[i] * w
            rows.append(row)
        return rows


def rates_of(rows: Sequence[Triple], x: Sequence[Number]) -> list[Number]:
    """The rates of a quadratic form with these rows (kappa, rho, sigma, m) at three numbers."""
    kappa, rho, sigma, m = rows
    return [kappa[i] * x[j] * x[k] + rho[i] * x[k] + sigma[i] * x[j] + m[i] for i,
            (j, k) in enumerate(CYCLE)]


def euler_form(inertia: Exact3, momentum: Exact3, torque: Exact3) -> QuadraticForm:
    """D omega' = (D omega + lambda) x omega + M as rates of omega (theory: Euler's equations of a gyrostat).
    """
    D, lam = inertia, momentum
    return QuadraticForm(
        kappa=tuple((D[j] - D[k]) / D[i] for i, (j, k) in enumerate(CYCLE)),
        rho=tuple(lam[j] / D[i] for i, (j, k) in enumerate(CYCLE)),
        sigma=tuple(-lam[k] / D[i] for i, (j, k) in enumerate(CYCLE)),
        m=tuple(torque[i] / D[i] for i in range(3)), symbol="omega")


def euler_coefficients(inertia: Exact3, kappa: Float3, momentum: Float3, torque: Float3) -> Rows:
    """`coefficients` of `euler_form` of a momentum and a torque in doubles, to the same bits: no fraction is
    reduced, which for moments of many digits takes most of a short run. kappa: the form's, of the body alone.
    """
    sizes = [d.as_integer_ratio() for d in inertia]

    def over(value: float, i: int, sign: int = 1) -> float:
        n, d = value.as_integer_ratio()
        return sign * n * sizes[i][1] / (d * sizes[i][0])  # of whole numbers: rounded once
    return (kappa, tuple(over(momentum[j], i) for i, (j, k) in enumerate(CYCLE)),
            tuple(over(momentum[k], i, -1) for i, (j, k) in enumerate(CYCLE)),
            tuple(over(torque[i], i) for i in range(3)))


def scaled_form(a: Fraction, b: Fraction, mu: Exact3) -> QuadraticForm:
    """x1' = x2 x3 + mu1, x2' = -x3 (x1 + a) + mu2, x3' = x2 (x1 + b) + mu3 (Amer et al. 2024, eqs (3), (5)).
    """
    zero, item = Fraction(0), Fraction(1)
    return QuadraticForm(kappa=(item, -item, item), rho=(zero, zero, b), sigma=(zero, -a, zero), m=tuple(mu),
                         symbol="x")


def rests(form: QuadraticForm, state: Iterable[Number]) -> bool:
    """Whether every rate vanishes at the state (floats or Fractions, taken as exact), exactly."""
    return not any(form.rate([Fraction(v) for v in state]))


# --- The scene: a body and the effects it is under, nothing more
ZERO3 = (Fraction(0),) * 3


def along_principal_axes(effects: Sequence[Effect], frame: PrincipalAxes) -> list[Effect | None]:
    """The effects along the principal axes, from the frame of the tensor; None for one that is known along
    principal axes alone. Momentum across the torque in that frame is across it along irrational axes too:
    whether it is decides what becomes of a motion."""
    turned = list(effects) if frame.as_given else [effect.turned(frame) for effect in effects]
    torque: Any = next((effect for effect in turned if effect and effect.name == "constant_torque"), None)
    return [type(effect)(without_trace(effect.exact, torque.exact))  # type: ignore[attr-defined, call-arg]
            if effect and torque and effect.name == "gyrostat" else effect for effect in turned]


class HashedOnce:
    """A frozen dataclass that computes its hash once: what is made of a scene is looked up by it, and a hash
    of fractions or of expressions costs a tenth of a short run. It stays in this process: hashes of names
    differ in others."""

    __dict__: dict[str, Any]

    def __hash__(self) -> int:
        result = self.__dict__.get("_hash")
        if result is None:
            result = hash(tuple(getattr(self, item.name) for item in fields(self) if item.compare))  # type: ignore[arg-type]
            object.__setattr__(self, "_hash", result)
        return result

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_hash"}


@dataclass(frozen=True)
class Scene(HashedOnce, metaclass=Asked):
    """A body and its effects, each at most once. Effects not named here do not exist for any later step, and
    one of zero strength is not kept: it equals an absent one in every answer because it is absent.

    Scene(body, effect, effect ...): vectors are in the frame of the moments or the tensor that the body was
    given by, in kg, m, s; the scene holds them along the principal axes. States are the
    rates about these axes, (..., 3) in rad/s; effects that need more of the state add blocks to it. Raises
    InputError for anything but a Body and effects, and for an effect named twice.
    """

    body: Body
    effects: tuple[Effect, ...] = ()
    variables: ClassVar[Literal["physical"]] = "physical"
    components = ("omega1", "omega2", "omega3")
    time_unit = "s"
    # where these axes lie in the frame of the tensor; None where that is diagonal, or is not known
    frame: ClassVar[PrincipalAxes | None] = None

    __hash__ = HashedOnce.__hash__

    def __init__(self, body: Body | None = None, *effects: Effect):
        flat = (tuple(effects[0]) if len(effects) == 1 and isinstance(effects[0], (tuple, list))
                else tuple(effects))
        if not isinstance(body, Body):
            raise InputError(
                f"scene: expected a Body first, such as Scene(Body((3, 2, 1)), ...), got "
                f"{'nothing' if body is None else f'{body!r:.80}'}")
        for effect in flat:
            if not isinstance(effect, Effect):
                raise InputError(
                    f"scene: expected effects after the body, such as Gyrostat or ConstantTorque, got "
                    f"{effect!r:.80}")
        names = [e.name for e in flat]
        for name in names:
            if names.count(name) > 1:
                raise InputError(f"effect {name!r} is named twice; a scene holds each effect once")
        if body.axes is not None:  # from here on all is along the principal axes
            turned = along_principal_axes(flat, body.axes)
            for effect, result in zip(flat, turned):
                if result is None:
                    raise InputError(
                        f"scene: {effect_words(effect.name)} is known along principal axes alone: give the "
                        "body by its principal moments, and the rest along its axes")
            flat = tuple(effect for effect in turned if effect is not None)
            if not body.axes.as_given:
                object.__setattr__(self, "frame", body.axes)
            body = Body(body.exact, body.mass, body.slack)
        for effect in flat:
            if why := effect.refused_by(body):
                raise InputError(f"scene: {effect_words(effect.name)}: {why}")
        object.__setattr__(self, "body", body)
        object.__setattr__(self, "effects", tuple(e for e in flat if e.acts))

    @cached_property
    def blocks(self) -> tuple[str, ...]:
        """The blocks of the state that its effects need (see `blocks`)."""
        return ordered(name for effect in self.effects for name in effect.needs)

    @cached_property
    def approximate(self) -> tuple[Effect, ...]:
        """Its effects whose laws are approximations: see `stabilab.physics.law_limits`."""
        return tuple(effect for effect in self.effects if effect.approximate)

    @cached_property
    def ending(self) -> tuple[Effect, ...]:
        """Its effects that stop acting some time."""
        return tuple(effect for effect in self.effects if effect.stops_after() is not None)

    @cached_property
    def plain(self) -> bool:
        """Whether it has no effect beyond a gyrostat and a constant torque."""
        return not self.beyond

    @property
    def beyond(self) -> list[Effect]:
        """The effects beyond a gyrostat and a constant torque."""
        return [e for e in self.effects if e.name not in ("gyrostat", "constant_torque")]

    def effect(self, name: str) -> Any:
        """The effect called `name`, with the fields that it alone has, or None."""
        return next((e for e in self.effects if e.name == name), None)

    def vector(self, name: str) -> Exact3:
        """Exact vector of the gyrostat, the constant torque or the weight (N m, along its arm); zero where
        the scene does not name it."""
        result = self.effect(name)
        return ZERO3 if result is None else result.exact

    def quadratic(self) -> QuadraticForm:
        """The rates with exact coefficients. Raises InputError for effects outside gyrostat and constant
        torque."""
        return self._form

    @cached_property
    def _form(self) -> QuadraticForm:
        """Kept, for every question asks for it several times."""
        if self.beyond:
            others = ", ".join(item.with_article for item in self.beyond)
            raise InputError(f"this analysis covers a gyrostat and a constant torque; the scene also has "
                             f"{others}: `stabilab simulate` and `stabilab when` take it")
        return euler_form(self.body.exact, self.vector("gyrostat"), self.vector("constant_torque"))


@dataclass(frozen=True)
class ScaledGyrostat(metaclass=Asked):
    """The dimensionless system of Amer et al. 2024, eq. (5), for any real a, b, mu; accepted wherever a scene
    is.

    x1' = x2 x3 + mu1,  x2' = -x3 (x1 + a) + mu2,  x3' = x2 (x1 + b) + mu3, the dash for d/dtau

    a, b: two numbers for moments and wheel; mu: three for the torque; numbers or exact strings such as "1/5".
    States are x (..., 3), times tau. Raises InputError for what is no number.
    """

    a: Given
    b: Given
    mu: Sequence[Given]
    exact_ab: tuple[Fraction, Fraction] = field(init=False, repr=False)
    exact_mu: Exact3 = field(init=False, repr=False)
    variables: ClassVar[Literal["scaled"]] = "scaled"
    components = ("x1", "x2", "x3")
    time_unit = "tau"
    effects = approximate = beyond = ending = ()
    frame: ClassVar[PrincipalAxes | None] = None
    blocks = ("omega",)
    plain = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "exact_ab", (exact(self.a, "a"), exact(self.b, "b")))
        object.__setattr__(self, "exact_mu", exact_vector(self.mu, "mu"))
        object.__setattr__(self, "a", float(self.exact_ab[0]))
        object.__setattr__(self, "b", float(self.exact_ab[1]))
        object.__setattr__(self, "mu", floats(self.exact_mu))

    def quadratic(self) -> QuadraticForm:
        """The rates with exact coefficients."""
        return self._form

    @cached_property
    def _form(self) -> QuadraticForm:
        """Kept, as of `Scene`."""
        return scaled_form(*self.exact_ab, self.exact_mu)


AnyScene: TypeAlias = Scene | ScaledGyrostat


class Turn(NamedTuple):
    """twin: the scene with its torque along one axis. rotation: rows of Fractions, omega_twin = rotation @
    omega, good to 240 bits. exact: no row was rounded."""

    twin: Scene
    rotation: list[list[Fraction]]
    exact: bool

    def __call__(self, state: Sequence[Number]) -> tuple[Fraction, ...]:
        """The twin's state for a state of the scene, numbers exact."""
        return tuple(sum((r * Fraction(v) for r, v in zip(row, state)), Fraction(0)) for row in self.rotation)

    @property
    def matrix(self) -> np.ndarray:
        """(3, 3) array of the rotation's doubles."""
        import numpy as np
        return np.array([[float(v) for v in row] for row in self.rotation])


def aligned(scene: AnyScene) -> Turn | None:
    """The scene turned so that its torque lies along one axis, where its equal moments allow it.

    The twin has the same moments; its torque lies exactly along an axis, and its gyrostatic component along
    the torque is exactly zero where the scene's is.
    """
    if scene.variables != "physical":
        return None
    D, M, lam = scene.body.exact, scene.vector("constant_torque"), scene.vector("gyrostat")
    acting = [i for i in range(3) if M[i]]
    if len(acting) < 2 or len({D[i] for i in acting}) > 1:
        return None
    i = acting[0]
    length = sqrt_fraction(dot(M, M))
    unit = [m / length for m in M]
    # the second direction lies in the equal plane, across the torque
    j = acting[1]
    across = [Fraction(0)] * 3
    size = sqrt_fraction(unit[i] ** 2 + unit[j] ** 2)
    across[i], across[j] = -unit[j] / size, unit[i] / size
    third = cross(unit, across)
    even = (i, j, 3 - i - j) in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    rows = {i: unit, j: across, 3 - i - j: [*third] if even else [-v for v in third]}
    rotation = [rows[n] for n in range(3)]
    turned = [dot(row, lam) for row in rotation]
    if sum(m * v for m, v in zip(M, lam)) == 0:
        turned[i] = Fraction(0)
    torque = [length if n == i else Fraction(0) for n in range(3)]
    exact = length**2 == sum(m * m for m in M) and size**2 == unit[i] ** 2 + unit[j] ** 2
    return Turn(_turned(scene, {"gyrostat": turned, "constant_torque": torque}), rotation, exact)


def _turned(scene: Scene, vectors: Mapping[str, Sequence[Fraction]]) -> Scene:
    """The scene with these vectors in place of those of its wheel and torque."""
    kinds: dict[str, Any] = {effect.name: type(effect) for effect in scene.effects}
    return Scene(scene.body, *(kind(tuple(vectors[name])) for name, kind in kinds.items()))


def torque_axis(scene: AnyScene) -> int:
    """The principal axis, 1 to 3, that the whole torque of a scene is along; 0 where there is none, or other
    effects act."""
    acting = [n for n, m in enumerate(scene.quadratic().m, 1) if m] if scene.plain else []
    return acting[0] if len(acting) == 1 else 0


def time_left(scene: AnyScene) -> float | None:
    """For how long all effects of a scene act, s, from the start of a motion on; None where they do for
    ever."""
    rows = [effect.stops_after() for effect in getattr(scene, "ending", ())]  # equations may stand for it
    return min((max(left, 0.0) for left in rows if left is not None), default=None)


def hold_on(scene: AnyScene, end: float, question: str) -> None:
    """Raise InputError where an effect stops acting before `end`: the question takes one that acts all the
    time."""
    if (left := time_left(scene)) is not None and left < end:
        raise InputError(f"{question}: an effect stops acting after {left:.10g} s: ask up to then, and "
                         "beyond from the state there, of the scene that is left")


def stopped(scene: AnyScene, state: Mapping[str, Any]) -> tuple[Scene, dict[str, tuple[float, ...]]]:
    """(the scene without the effect that stops acting first, its blocks), from the state where it stops on.
    """
    ends = [(left, item) for item in scene.ending if (left := item.stops_after()) is not None]
    effect = min(ends, key=lambda end: end[0])[1]
    retained = {name: tuple(map(float, row)) for name, row in state.items() if name not in effect.needs}
    return effect.stopped(scene, state), retained


def later(scene: AnyScene, t: float) -> AnyScene:
    """The scene for a motion that is taken up at a time t, s, after its start: its effects stop so much
    sooner."""
    if not scene.ending:
        return scene
    return Scene(scene.body, *(effect.later(t) for effect in scene.effects))  # type: ignore[union-attr]


def judge_start(scene: AnyScene, state: Mapping[str, Any]) -> None:
    """Raise InputError where an effect cannot begin with these blocks."""
    for effect in getattr(scene, "effects", ()):
        if text := effect.refuses(state):
            raise InputError(f"state: {text}")


def judge_starts(scene: AnyScene, blocks: Sequence[str], rows: np.ndarray | Sequence[np.ndarray]) -> None:
    """The same of many motions from rows of these blocks."""
    if any(name in INSIDE for name in blocks):
        parts = slices(blocks)
        for row in rows:
            judge_start(scene, {name: row[part] for name, part in parts.items()})
