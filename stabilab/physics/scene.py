"""The scene: a body and the effects it is under, nothing more."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from fractions import Fraction
from functools import cached_property
from typing import Any, ClassVar, Literal, TypeAlias

from ..asked import Asked
from ..errors import InputError
from ..numbers.exact import exact, exact_vector, floats
from ..numbers.vectors import Exact3, Given
from ..record import record
from .blocks import ordered
from .body import Body
from .effects.base import Effect, effect_words
from .quadratic import QuadraticForm, euler_form, scaled_form

ZERO3 = (Fraction(0),) * 3


@record
class Scene(metaclass=Asked):
    """A body and its effects, each at most once. Effects not named here do not exist for any later step, and one of zero
    strength is not kept: it equals an absent one in every answer because it is absent.

    Scene(body, effect, effect ...): vectors are along the body's principal axes, in kg, m, s. States are the rates about these axes, (..., 3) in rad/s;
    effects that need more of the state add blocks to it. Raises InputError for anything but a Body and effects, and for an effect named twice.
    """

    body: Body
    effects: tuple[Effect, ...] = ()
    variables: ClassVar[Literal["physical"]] = "physical"
    components = ("omega1", "omega2", "omega3")
    time_unit = "s"

    def __init__(self, body: Body | None = None, *effects: Effect):
        flat = tuple(effects[0]) if len(effects) == 1 and isinstance(effects[0], (tuple, list)) else tuple(effects)
        if not isinstance(body, Body):
            raise InputError(f"scene: expected a Body first, such as Scene(Body((3, 2, 1)), ...), got {'nothing' if body is None else f'{body!r:.80}'}")
        for effect in flat:
            if not isinstance(effect, Effect):
                raise InputError(f"scene: expected effects after the body, such as Gyrostat or ConstantTorque, got {effect!r:.80}")
        names = [e.name for e in flat]
        for name in names:
            if names.count(name) > 1:
                raise InputError(f"effect {name!r} is named twice; a scene holds each effect once")
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
    def plain(self) -> bool:
        """Whether it has no effect beyond a gyrostat and a constant torque."""
        return not self._beyond()

    def _beyond(self) -> list[str]:
        return [e.name for e in self.effects if e.name not in ("gyrostat", "constant_torque")]

    def effect(self, name: str) -> Any:
        """The effect called `name`, with the fields that it alone has, or None."""
        return next((e for e in self.effects if e.name == name), None)

    def vector(self, name: str) -> Exact3:
        """Exact vector of the gyrostat, the constant torque or the weight (N m, along its arm); zero where the scene does not name it."""
        found = self.effect(name)
        return ZERO3 if found is None else found.exact

    def quadratic(self) -> QuadraticForm:
        """The rates with exact coefficients. Raises InputError for effects outside gyrostat and constant torque."""
        return self._form

    @cached_property
    def _form(self) -> QuadraticForm:
        """Kept, for every question asks for it several times."""
        other = self._beyond()
        if other:
            raise InputError(f"this analysis covers a gyrostat and a constant torque; the scene also has {', '.join(map(effect_words, other))}")
        return euler_form(self.body.exact, self.vector("gyrostat"), self.vector("constant_torque"))


@record
class ScaledGyrostat(metaclass=Asked):
    """The dimensionless system of Amer et al. 2024, eq. (5), for any real a, b, mu; accepted wherever a scene is.

    x1' = x2 x3 + mu1,  x2' = -x3 (x1 + a) + mu2,  x3' = x2 (x1 + b) + mu3, the dash for d/dtau

    a, b: two numbers for moments and wheel; mu: three for the torque; numbers or exact strings such as "1/5". States are x (..., 3), times tau.
    Raises InputError for what is no number.
    """

    a: Given
    b: Given
    mu: Sequence[Given]
    exact_ab: tuple[Fraction, Fraction] = field(init=False, repr=False)
    exact_mu: Exact3 = field(init=False, repr=False)
    variables: ClassVar[Literal["scaled"]] = "scaled"
    components = ("x1", "x2", "x3")
    time_unit = "tau"
    effects = approximate = ()
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
