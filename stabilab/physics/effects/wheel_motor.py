"""A motor that spins a wheel up or brakes it: momentum goes from the body into the wheel, none is lost."""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar

from ...errors import Caveat, InputError, Kind
from ...numbers.exact import floats
from ...numbers.principal import PrincipalAxes
from ...numbers.units import TIME, TORQUE, in_si, vector_in_si
from ...numbers.vectors import Exact3, Given, Number, cross, dot
from ...reasons import Sentence
from .base import Effect, Part

if TYPE_CHECKING:
    from types import SimpleNamespace

    from ..equations import MotionView

ENDLESS = Caveat(Kind.MOTOR, Sentence(
    "motor-without-end", "the motor of the wheel runs without an end, and no wheel takes momentum for ever: "
    "give its duration in [effects.wheel_motor]")())
ACROSS = 1e-9  # the sine of an angle that is none: runs and turned frames round their vectors
MOVED = 2.0**-48  # of the state: a start that is moved in its last places is one all the same


@dataclass(frozen=True)
class WheelMotor(Effect):
    """Torque u on a wheel along the same line, N m, body frame, by a motor in the body, which has -u (as
    in Hall, J. Guidance 19(5), 1996).

    With h the momentum that the motor has given the wheel, N m s, lambda the wheel's own at the start and
    that of others (`gyrostat`), D the moments of the body without the wheel's own about its line, and M the
    outer torque

        D omega' = (D omega + lambda + h) x omega - u + M,    h' = u,    H = D omega + lambda + h,

    so that the motor keeps H in space, and T' = omega . (M - u), T of the body alone. lambda + h holds the
    wheel's whole momentum along its line, with its share in omega. duration: s, for which the motor runs from
    the start of a motion, whatever h is then; None: without an end. ran: s, for which it has run where the
    motion is taken up.
    """

    name: ClassVar[str] = "wheel_motor"
    article: ClassVar[str] = "a"
    keys: ClassVar[tuple[str, ...]] = ("torque", "duration")
    symbols: ClassVar[tuple[str, ...]] = ("u1", "u2", "u3")
    needs = ("wheel",)

    motor: Sequence[Given]
    duration: Given | None = None
    ran: float = field(default=0.0, repr=False)
    exact: Exact3 = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "exact", vector_in_si(self.motor, TORQUE, "torque"))
        object.__setattr__(self, "motor", floats(self.exact))
        if self.duration is not None:
            time = in_si(self.duration, TIME, "duration")
            if time <= 0:
                raise InputError(f"duration: expected a positive number, got {float(time):g}")
            object.__setattr__(self, "duration", time)
        ran = float(in_si(self.ran, TIME, "ran"))
        if ran < 0:
            raise InputError(f"ran: expected a time of at least 0, got {ran:g}")
        object.__setattr__(self, "ran", ran)

    @classmethod
    def from_case(cls, table: Any, context: Any) -> WheelMotor | None:
        complete = table.required("torque", torque="give torque = [u1, u2, u3] on the wheel, in N m")
        torque, duration = table.vector("torque"), table.positive("duration")
        if not complete or torque is None or ("duration" in table and duration is None):
            return None
        return cls(torque, duration)

    def terms(self) -> dict[str, Any]:
        return {"u": self.exact, "duration": self.duration}

    def written(self) -> dict[str, Any]:
        return {"torque": self.exact} | ({} if self.duration is None else {"duration": self.duration})

    @property
    def caveats(self) -> tuple[Caveat, ...]:
        return (ENDLESS,) if self.duration is None else ()

    def stops_after(self) -> float | None:
        return None if self.duration is None else float(self.duration) - self.ran

    def later(self, t: float) -> WheelMotor:
        return replace(self, ran=self.ran + t)

    def refuses(self, state: Mapping[str, Sequence[float]]) -> str:
        u, h = self.motor, tuple(map(float, state.get("wheel", (0.0,) * 3)))
        largest = max((abs(float(v)) for row in state.values() for v in row), default=0.0)
        if math.hypot(*cross(u, h)) <= math.hypot(*u) * (ACROSS * math.hypot(*h) + MOVED * largest):
            return ""
        return ("wheel: the momentum that the motor has given its wheel lies along the motor's line, and "
                "this one does not: give here the part along effects.wheel_motor.torque, and to "
                "effects.gyrostat.momentum what the wheel had before or other wheels have")

    def stopped(self, scene: Any, state: Mapping[str, Sequence[float]]) -> Any:
        """With the wheel's momentum as it is then."""
        from .gyrostat import Gyrostat
        momentum = tuple(a + Fraction(b) for a, b in zip(scene.vector("gyrostat"), state["wheel"]))
        return type(scene)(scene.body, Gyrostat(momentum),
                           *(item for item in scene.effects if item.name not in (self.name, "gyrostat")))

    def turned(self, frame: PrincipalAxes) -> WheelMotor:
        return WheelMotor(frame.turned(self.exact), self.duration, self.ran)

    def part(self, motion: SimpleNamespace | MotionView, p: Mapping[str, Number]) -> Part:
        u, h = tuple(p[name] for name in self.symbols), motion.wheel
        turning = tuple(t - v for t, v in zip(cross(h, motion.omega), u))
        return Part(0, h, 0, turning, dot(u, motion.omega), lambda change: u)
