"""What an effect is: a part of the physics that contributes nothing unless it says so.

A new effect is one file with a subclass, one row in `effects/__init__.py`, one law in the law test, one
case. The formulas use arithmetic only, so the same lines serve SymPy symbols, floats, arrays and exact
fractions.
"""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from fractions import Fraction
from typing import Any, ClassVar

from ...errors import Caveat, InputError
from ...numbers.principal import PrincipalAxes
from ...numbers.vectors import Number, Triple
from ...reasons import Reason
from ...validation import Asked


def effect_words(name: str) -> str:
    """The name of an effect as one says it: "liquid cavity", "Newtonian field"."""
    return name.replace("_", " ").replace("newtonian", "Newtonian")


@dataclass(frozen=True)
class Limit:
    """Up to where an approximate law may be used: a dimensionless number that must not exceed `limit`.

    number: its name and formula, a reason without quantities or words; value: {block of the state: its
    components} -> the number, for components of any shape alike, None where the state has no block that it
    asks for; follows: what follows beyond the limit, as number is given; source: of law and limit; needs: of
    the state, in words.
    """

    number: Reason | str
    limit: float
    value: Callable[[Mapping[str, tuple[Number, ...]]], Number | None]
    follows: Reason | str
    source: str
    needs: str = "a part of the state"


def of_a_damper(name: str, value: Fraction, zero: bool = False) -> float:
    """A number of a damper as a double. zero: whether it may be zero. Raises InputError for any other."""
    if value < 0 or not value and not zero:
        wanted = "no negative" if zero else "a positive"
        raise InputError(f"{name}: expected {wanted} number, got {float(value):g}; a body without a damper "
                         "is given without this effect")
    return float(value)


@dataclass(frozen=True)
class Part:
    """A part that turns inside the body, whose block of the state is the effect's own.

    inertia: its moment about any axis, kg m^2, held by the moments of the body; momentum: N m s, and energy:
    J, with that of its spring, what its motion adds to those of the body with the part at rest in it; torque:
    on the rest of the body, N m, body frame, at the rates of the block alone; loss: W, what friction or a
    motor takes from the body; rate: omega' -> rates of the block; taken: rows of what it takes off the tensor
    of the body in front of omega' where that is not the same about all axes, kg m^2.
    """

    inertia: Number
    momentum: Triple
    energy: Number
    torque: Triple
    loss: Number
    rate: Callable[[Triple], Triple]
    taken: tuple[Triple, ...] | None = None


@dataclass(frozen=True)
class Effect(metaclass=Asked):
    """Base of every effect. `name` is its table in a case file; `keys` its keys there."""

    name: ClassVar[str] = ""
    article: ClassVar[str] = ""  # of its name in a sentence; "" of what is not counted
    keys: ClassVar[tuple[str, ...]] = ()
    certain: ClassVar[tuple[str, ...]] = ()  # those whose numbers take no uncertainty: directions, words
    works: ClassVar[bool] = True  # False promises that the effect does no work; the law test holds it to that
    small: ClassVar[bool] = False  # True: left out of the undisturbed motion along which a liquid is carried
    keeps_volume: ClassVar[bool] = True  # False: the flow may shrink volumes
    # the state blocks it cannot do without, of `stabilab.physics.scene.ORDER`
    needs: ClassVar[tuple[str, ...]] = ()
    # True: its law holds up to its `limits`; an exact law is never asked for any
    approximate: ClassVar[bool] = False
    symbols: ClassVar[tuple[str, ...]] = ()  # of the numbers in `exact`, in order
    isotropic: ClassVar[bool] = False  # True: it is the same along all axes
    # energy: "inside", where the angular momentum stays as it is, or "outside"
    takes: ClassVar[str] = ""
    agent: ClassVar[str] = ""  # what acts, as the subject of a sentence: "the medium"

    @classmethod
    def from_case(cls, table: Any, context: Any) -> Effect | None:
        """The effect that its table in a case file states; None where the table is faulty (it keeps the
        faults).

        table: reads values by key (`vector`, `number`, `one_of`, `fault`); context: what the rest of the case
        knows (`body`, `torque_from_mu`). As it stands: three numbers under the only key.
        """
        vector = table.vector(cls.keys[0]) if table.required(*cls.keys) else None
        built: Any = cls  # an effect of other keys reads them itself
        return None if vector is None else built(vector)

    def written(self) -> dict[str, Any]:
        """Its table in a case file: key to value, exact where the effect holds it so."""
        values = [getattr(self, field.name) for field in fields(self) if field.init]
        exact = getattr(self, "exact", None)  # of the only number or vector; else of what several make
        return dict(zip(self.keys, values if exact is None or len(values) > 1 else [exact]))

    def parameters(self) -> dict[str, Fraction]:
        """Symbol name to exact value, in the order of declaration."""
        exact: Any = getattr(self, "exact", ())
        return dict(zip(self.symbols, exact if isinstance(exact, tuple) else (exact,)))

    def terms(self) -> dict[str, Any] | None:
        """What it adds to the equations of `physics.coefficients`, by the names of `Content`; None where it
        stands in none of them, so that the fate of no motion with it is known."""
        return None

    @property
    def with_article(self) -> str:
        """Its name behind "the scene has": "a liquid cavity", "resistance"."""
        return f"{self.article} {effect_words(self.name)}".lstrip()

    @property
    def acts(self) -> bool:
        """Whether its strength differs from zero: every formula of an effect is linear in its parameters."""
        return any(self.parameters().values())

    @property
    def caveats(self) -> tuple[Caveat, ...]:
        """What it takes for granted in every answer."""
        return ()

    def limits(self, scene: Any) -> tuple[Limit, ...]:
        """Up to where its law may be used in this scene."""
        return ()

    def refused_by(self, body: Any) -> str:
        """Why it cannot act on this body, and what to do; empty where it can."""
        return ""

    def stops_after(self) -> float | None:
        """For how long it acts from the start of a motion, s; None where it acts for ever."""
        return None

    def later(self, t: float) -> Effect:
        """The same for a motion that is taken up at a time t, s, after its start."""
        return self

    def refuses(self, state: Mapping[str, Sequence[float]]) -> str:
        """Why a state in blocks cannot be one with this effect, and what to do; empty where it can."""
        return ""

    def stopped(self, scene: Any, state: Mapping[str, Sequence[float]]) -> Any:
        """The scene from a state in blocks on, at which it has stopped."""
        return scene

    def turned(self, frame: PrincipalAxes) -> Effect | None:
        """The same effect along the principal axes of `frame` (numbers.principal), from the frame that a case
        gives it in; None where it cannot be turned."""
        return self if self.isotropic else None

    def momentum(self, p: Mapping[str, Number]) -> Triple | None:
        """Angular momentum carried inside the body, body frame, kg m^2/s, from the parameter symbols `p`."""
        return None

    def torque(self, omega: Triple, p: Mapping[str, Number]) -> Triple | None:
        """Torque on the body, body frame, N m."""
        return None

    def torque_along(self, motion: Any, p: Mapping[str, Number]) -> Triple | None:
        """The torque where it depends on more than omega; `motion` has the blocks of the state by name
        (`omega`, `gamma`), the principal moments `D`, and `undisturbed()`, the first and second rate of omega
        along the motion without the small effects."""
        return self.torque(motion.omega, p)

    def part(self, motion: Any, p: Mapping[str, Number]) -> Part | None:
        """What turns inside the body as a state of its own."""
        return None

    def potential(self, motion: Any, p: Mapping[str, Number]) -> Number | None:
        """Potential energy, J, whose fall is the work of the torque; None where it has none."""
        return None

    def area(self, motion: Any, p: Mapping[str, Number]) -> Number | None:
        """A function of the state whose rate is torque . gamma, N m; None where there is none in closed form.
        """
        return None

    def force(self, motion: Any, p: Mapping[str, Number]) -> Triple | None:
        """Force on the body, body frame, N; only a scene with translation asks."""
        return None
