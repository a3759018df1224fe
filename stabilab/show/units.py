"""The units that people read: deg/s, deg/day, rpm or rev/s and minutes, or SI: for text and pictures."""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal, localcontext
from functools import partial
from typing import TYPE_CHECKING, Any

from ..errors import InputError, printable
from ..reasons import Axis, Moment, Quantity, Reason, Span, Symbolic, listed, outward
from .axes import PLAIN, Axes, axes_of
from .terminal import lettered

if TYPE_CHECKING:
    from ..case.read import Case
    from ..numbers.vectors import Float3

DIGITS = 6  # of a number in a table
SHORT = 4  # of a number within a sentence
WHOLE = 1e6  # below it no power of ten: 15904 and not 1.59e+04
OWN = ("rad", "rad/s", "rad/s^2", "s", "tau")  # units of quantities that have others for people
Unit = tuple[str, float]  # its name, and how many of it make one in SI
TURN = 180 / math.pi


@dataclass(frozen=True)
class Units:
    """A system of units: `name` is a key of `SYSTEMS`, or "scaled" for dimensionless variables.

    `rates` and `angles` are units; `ladder` has the units of time, each with the number of seconds from which
    it is used; `axes` names the axes of the case.
    The methods turn a value in SI (or in the variables of a scaled case) into text with its unit.
    """

    name: str
    rates: Unit
    angles: Unit
    ladder: tuple[tuple[float, Unit], ...]
    axes: Axes = PLAIN

    @property
    def scaled(self) -> bool:
        """Whether the numbers have no dimension."""
        return self.name == "scaled"

    def rate(self, value: float, digits: int = DIGITS, side: int = 0) -> str:
        """An angular velocity, given in rad/s. side: as of `told`, here and below."""
        return self.told(value, self.rates, digits, side)

    def angle(self, value: float, digits: int = DIGITS, side: int = 0) -> str:
        """An angle, given in rad."""
        return self.told(value, self.angles, digits, side)

    def time(self, value: float, digits: int = DIGITS, side: int = 0) -> str:
        """A time, given in s, in the unit that suits its size."""
        return self.told(value, self.times(value), digits, side)

    def clock(self, low: float, high: float) -> str:
        """A time between two bounds, given in s, in the unit that suits its size."""
        unit = self.times(high)
        return f"{' to '.join(bracket(low, high, unit[1]))} {unit[0]}"

    def moment(self, value: float, digits: int = DIGITS, side: int = 0) -> str:
        """A point in time: "t = 2.5 s", or "τ = 2.5" of a scaled case."""
        if self.scaled:
            return f"τ = {number(as_bound(value, 1.0, digits, side), digits)}"
        return f"t = {self.time(value, digits, side)}"

    def torque(self, value: float, digits: int = DIGITS) -> str:
        """A torque, given in N m."""
        return self.told(value, self.of("N m"), digits)

    def energy(self, value: float, digits: int = DIGITS) -> str:
        """An energy, given in J."""
        return self.told(value, self.of("J"), digits)

    def times(self, longest: float) -> Unit:
        """The unit of time that suits times up to `longest` seconds."""
        size = abs(longest)
        # the last also of NaN
        return next((unit for smallest, unit in self.ladder if size >= smallest), self.ladder[-1][1])

    def told(self, value: float, unit: Unit, digits: int = DIGITS, side: int = 0) -> str:
        """The number in the unit, with the unit's name. side: +1 of an upper bound, which is never printed
        below itself; -1 of a lower one."""
        name, item = unit
        return f"{number(as_bound(value, item, digits, side), digits)} {name}".rstrip()

    def said(self, reason: Reason, digits: int = DIGITS - 1, whole: bool | None = False) -> str:
        """A sentence in these units, with letters. digits: of angles, rates and times. whole: whether axes
        have their long names; None: letters alone where they have them."""
        fill = partial(self.filled, digits=digits, whole=whole)
        return "".join(joint + (item.text(fill, letters=True) if item.code
                                else lettered(self.axes.sentence(printable(item.text()))))
                       for joint, item in reason.clauses())

    def filled(self, value: Any, digits: int = SHORT, whole: bool | None = False) -> str:
        """What fills a hole of a sentence, as text. digits, whole: as of `said`."""
        if isinstance(value, Axis):
            name = self.axes.brief if whole is None else self.axes.whole if whole else self.axes.short
            return name(value.number)
        if isinstance(value, Reason):
            return self.said(value, digits, whole)
        if isinstance(value, Symbolic):
            return value.text(self.of, True)
        if isinstance(value, tuple):
            return listed(tuple(self.filled(item, digits, whole) for item in value))
        if isinstance(value, Moment):
            return self.moment(value.value, value.digits or digits, value.side)
        if isinstance(value, Span):
            return self.span(value.unit, value.start, value.end)
        if not isinstance(value, Quantity):
            return f"{value:,}" if type(value) is int else printable(str(value))
        digits = value.digits or (digits if value.unit in OWN else DIGITS)
        if isinstance(value.value, tuple):
            return self.vector(value.value, self.of(value.unit), digits)
        unit = self.times(value.value) if value.unit in ("s", "tau") else self.of(value.unit)
        return self.told(value.value, unit, digits, value.side)

    def span(self, unit: str, start: float, end: float) -> str:
        """A span of time, given in s, or in tau of a scaled case."""
        name, item = ("τ", 1.0) if unit == "tau" else self.times(max(abs(start), abs(end)))
        digits = SHORT if max(abs(start), abs(end)) * item < 10**SHORT else DIGITS
        return f"{number(start * item, digits)} to {number(end * item, digits)} {name}"

    def of(self, unit: str) -> Unit:
        """The unit in which numbers of this SI unit are printed; those of a scaled case have none."""
        name, item = self.rates
        turns = {"rad/s": self.rates, "rad": self.angles,
                 "(rad/s)^2": (f"({name})²" if name else "", item * item),
                 "rad/s^2": ("" if self.scaled else f"{self.angles[0]}/s²", self.angles[1])}
        return turns.get(unit, ("" if self.scaled and unit != "1" else lettered(unit), 1.0))

    def vector(self, values: Float3 | list[str], unit: Unit, digits: int = DIGITS) -> str:
        """Several numbers in one unit: "(1, 2, 3) deg/s"."""
        name, item = unit
        return f"{vector((float(v) * item for v in values), digits)} {name}".rstrip()


CLOCK = ((172800.0, ("day", 1 / 86400)), (7200.0, ("h", 1 / 3600)), (120.0, ("min", 1 / 60)),
         (0.0, ("s", 1.0)))
DEG = Units("deg", ("deg/s", TURN), ("deg", TURN), CLOCK)
SI = Units("si", ("rad/s", 1.0), ("rad", 1.0), ((0.0, ("s", 1.0)),))
SCALED = Units("scaled", ("", 1.0), ("rad", 1.0), ((0.0, ("τ", 1.0)),))
SYSTEMS = {"deg": DEG, "deg/day": replace(DEG, name="deg/day", rates=("deg/day", 86400 * TURN)),
           "rpm": replace(DEG, name="rpm", rates=("rpm", 30 / math.pi)),
           "rev/s": replace(DEG, name="rev/s", rates=("rev/s", 0.5 / math.pi)), "si": SI}
SLOW = math.radians(0.01)  # rad/s: below it a rate in deg/s begins with zeros


def units_of(case: Case, request: str | None = None) -> Units:
    """The units for a case: those asked for, else those of its [output], else those that suit. A scaled case
    has none."""
    named = request.lower() if isinstance(request, str) else request
    if named is not None and named not in SYSTEMS:
        raise InputError(f"--units: expected {', '.join(SYSTEMS)}, got {request!r:.40}")
    system = SCALED if case.variables == "scaled" else SYSTEMS[named or case.units or suited(case)]
    return replace(system, axes=axes_of(case))


def suited(case: Case) -> str:
    """deg/day for a body that turns slowly and freely, such as an asteroid; else degrees per second."""
    slow = case.state is not None and 0 < math.hypot(*case.state[:3]) < SLOW
    free = all(effect.name == "gyrostat" for effect in case.scene.effects)
    return "deg/day" if slow and free else "deg"


PARAMETERS = (("lambda", "N m s"), ("D", "kg m²"), ("M", "N m"), ("mass", "kg"), ("f", "N"), ("k", "N m s"),
              ("eHl2", "N m s"),
              ("kappa", "N m s³"), ("zeta", "1/s"), ("Mgx", "N m"), ("Mgy", "N m"), ("Mgz", "N m"),
              ("N", "1/s²"))


def parameter_unit(name: str) -> str:
    """The SI unit of a parameter of the equations by its name (lambda1, D3, mass); "" of unknown names."""
    return next((unit for stem, unit in PARAMETERS if name == stem or name.removeprefix(stem).isdigit()), "")


def number(value: float, digits: int = SHORT) -> str:
    """So many significant digits at most, below a million whole where these do not reach the point; a word
    where it has none."""
    if math.isinf(value):
        return "unbounded" if value > 0 else "-unbounded"
    printed = f"{value + 0.0:.{digits}g}"
    return f"{value:.0f}" if "e+" in printed and abs(value) < WHOLE else printed


def as_bound(value: float, item: float, digits: int, side: int) -> float:
    """The value in a unit of which `item` make one in SI, rounded outward: read back in SI it is no less than
    an upper bound (side +1) and no more than a lower one (-1); side 0: the product. With all digits before
    the point that `number` prints."""
    result = value * item
    if not side or not math.isfinite(result):
        return result
    full = len(str(int(abs(result)))) if abs(result) < WHOLE else 0
    nearby = float(f"{result:.{(digits := max(digits, full))}g}")
    if side * (nearby / item - value) >= 0:
        return nearby
    result = outward(result, digits, side)
    while math.isfinite(result) and side * (result / item - value) < 0:
        result = outward(math.nextafter(result, side * math.inf), digits, side)
    return result


def but_for_rounding(pairs: Sequence[tuple[float, float]] | None, tolerance: float | None):
    """Least and greatest of each component, 0 for what is within the tolerance of the largest of them."""
    if pairs is None:
        return None
    resolved = (tolerance or 0.0) * max((abs(v) for pair in pairs for v in pair if v is not None
                                      and math.isfinite(v)), default=0.0)
    return tuple(tuple(0.0 if v is not None and abs(v) <= resolved else v for v in pair) for pair in pairs)


def bracket(low: float, high: float, item: float = 1.0) -> tuple[str, str]:
    """Both ends with the decimals that tell them apart, six digits at most, rounded down and up, in a unit of
    which `item` make one in SI: read back in SI they are no nearer to each other than the ends."""
    width, top = (high - low) * item, high * item
    largest = max(0, 5 - math.floor(math.log10(top)))
    decimals = largest if not width > 0 else min(largest, max(0, 1 - math.floor(math.log10(width))))
    step = Decimal(1).scaleb(-decimals)
    with localcontext() as context:
        context.prec = 800  # of any double
        smallest = Decimal(low * item).quantize(step, ROUND_FLOOR)
        greatest = Decimal(top).quantize(step, ROUND_CEILING)
        while float(smallest) / item > low:
            smallest -= step
        while float(greatest) / item < high:
            greatest += step
    return str(smallest), str(greatest)


def vector(values: Iterable[float], digits: int = DIGITS) -> str:
    """Numbers in parentheses: "(1, 2, 3)"."""
    return f"({', '.join(number(float(v), digits) for v in values)})"


def with_unit(text: str, unit: str) -> str:
    """A name with its unit behind it; "" and "1" are none."""
    return text if unit in ("", "1") else f"{text} ({unit})"
