"""What is told of a stuck thruster: frozen rows that say how well they are known."""
from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from ...caveat import Caveat
from ...numbers.vectors import Float3
from ...representation import Shown
from ..tilt import Spread, Tilt


class Principal(NamedTuple):
    """Moments (kg m^2) of the principal axes 1, 2, 3 of the case; axes: rows, unit vectors in the frame of
    the file, right-handed."""

    moments: Float3
    axes: tuple[Float3, ...]


@dataclass(frozen=True)
class Margin:
    """The smallest change that changes the fate: its size, its direction (unit vector, frame of the file);
    None where none is known.

    because: why it is not known, or what it holds for. until: the greater change along the direction from
    which on the fate is again what it was: the size itself where it is another on the separatrix alone, inf
    where no greater change leads back, None where that is not known.
    """

    size: float | None = None
    direction: Float3 | None = None
    because: str = ""
    until: float | None = None

    @property
    def beyond(self) -> bool:
        """Whether a somewhat greater change along the direction changes the fate too."""
        return self.until is None or self.size is None or self.until > self.size


@dataclass(frozen=True)
class WheelAnswer:
    """Which momenta of one wheel keep the motion bounded.

    keeps_bounded: (least, greatest) momentum along its axis, N m s, of every interval, -inf and inf where it
    has no end. best: where there is no interval, the momentum within `searched` that delays the limit most;
    best_time: (low, high), s, None where the limit is not reached within the time followed; gain: by how much
    later, s (low end against low end). most: whether the runs that are compared came to the limit: else
    another momentum may delay it more. because: how this is known.
    """

    wheel: str
    axis: Float3
    now: float
    keeps_bounded: tuple[tuple[float, float], ...]
    because: str
    best: float | None = None
    best_time: tuple[float, float] | None = None
    gain: float | None = None
    searched: tuple[float, float] | None = None
    most: bool = True


@dataclass(frozen=True)
class Helper:
    """Other thrusters fired together with the stuck ones, each for a share of the time (`duty`, 0 to 1), as a
    mean torque.

    effect: "zero" (no torque is left), "bounded" (what is left keeps the motion bounded), "slower" (the limit
    comes later; without a limit: less torque is left), "none" (it is not known to come later: no help).
    torque_left: N m. fate: of the motion under what is left. time_to_limit: (low, high), s, or None.
    """

    thrusters: tuple[str, ...]
    duty: tuple[float, ...]
    effect: str
    torque_left: float
    fate: str
    time_to_limit: tuple[float, float] | None


@dataclass(frozen=True)
class Row:
    """What becomes of the body while some thrusters fire for ever.

    torque: N m, frame of the file; torque_principal: along `Stuck.principal`. fate: a word of `Fate`; level:
    "proved", "certified", "exact" or "run". axis: 1, 2 or 3 of `Stuck.principal`, sense along its unit
    vector; None where it spins up about none. direction: unit vector along which the rate grows, frame of the
    file, or None. limit: rad/s, of |omega|, or three numbers of its components in the frame of the file, or
    None. time_to_limit: (low, high), s, of the first time at the limit; None where it is never within what is
    known. never: whether it is known never to be reached. largest_rate: of |omega|, rad/s, up to that time or
    for ever. followed: s, up to where the limit is known not to be reached. tilt: what becomes of a bounded
    motion when the torque is a little off its axis (`answers.tilt`), where a limit or a misalignment is
    stated. caveats: all that limits the row.
    """

    thrusters: tuple[str, ...]
    torque: Float3
    torque_principal: Float3
    fate: str
    level: str
    axis: int | None
    sense: int | None
    direction: Float3 | None
    limit: float | Float3 | None
    time_to_limit: tuple[float, float] | None
    time_level: str
    never: bool
    largest_rate: float | None
    followed: float
    because: str
    margins: dict[str, Margin]
    wheels: tuple[WheelAnswer, ...] = ()
    helpers: tuple[Helper, ...] = ()
    tilt: Tilt | Spread | None = None
    caveats: tuple[Caveat, ...] = ()


@dataclass(frozen=True, repr=False)
class Stuck(Shown):
    """The answer for one case: a row a combination of thrusters (see `stuck`), in one set of principal axes.
    """

    case: str
    rows: tuple[Row, ...]
    principal: Principal
    ranked: bool = False
