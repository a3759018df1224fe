"""Each printed value beside ours, the difference, and its cause where it is larger than the tolerance."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from ...numbers.balls import working
from . import quantities
from .enclose import BALL_BITS, at
from .integrators import WORDS, reproduced
from .record import Printed, Source

VERDICTS = ("agrees", "explained", "differs")
SHOWN = 20  # digits of ours that are written at most
COMPONENTS = {"omega": ("omega1", "omega2", "omega3"), "sigma": ("sigma1", "sigma2", "sigma3"),
              "rate3": ("omega3",), "angle3": ("angle about axis 3",),
              "off_linear": ("angle off a constant rate",),
              "momentum_turn": ("turn of the angular momentum",)}
UNITS = {"sigma": "", "angle3": "rad", "off_linear": "rad", "momentum_turn": "rad"}  # others: of the motion


@dataclass(frozen=True)
class Finding:
    """One value. ours: every digit written is right (to one unit of the last); bound: how far that is off at
    most; theirs: as printed. difference: ours from theirs, at most; tolerance: absolute. verdict: "agrees",
    "explained" (the method named in `cause`, run here, gives theirs within the tolerance: `left` is what
    remains), or "differs"."""

    printed: Printed
    time: str
    component: str
    unit: str
    ours: str
    bound: float
    theirs: str
    difference: float
    tolerance: float
    verdict: str
    cause: str
    left: float | None


def findings(source: Source, tell: Callable[[int, str], None] | None = None) -> tuple[Finding, ...]:
    """Every value of a source, in the order of its record; each motion is followed once. tell(how many are
    done, words): before each motion and value."""
    times: dict = {}
    for printed in source.printed:
        times.setdefault(printed.motion.id,
                         (printed.motion, set()))[1].update(Fraction(row[0]) for row in printed.values)
    followed = {}
    for name, (motion, wanted) in times.items():
        if tell:
            tell(0, f"{source.title}: following {name}")
        ordered = sorted(wanted)
        followed[name] = dict(zip(ordered, at(motion, ordered)))
    found = []
    for done, (printed, row) in enumerate((one, row) for one in source.printed for row in one.values):
        if tell:
            tell(done, source.title)
        found += _row(printed, row, followed[printed.motion.id])
    return tuple(found)


def _row(printed, row, followed):
    time, motion = Fraction(row[0]), printed.motion
    with working(BALL_BITS) as numbers:
        ask = getattr(quantities, printed.quantity)
        ask = partial(ask, time=time) if printed.quantity == "off_linear" else ask
        balls = ask(motion, followed[time], numbers)
        again = (reproduced(printed, float(time), [float(v.mid()) for v in balls]) if printed.cause
                 else [None] * len(balls))
        return [_judged(printed, row[0], *one, numbers)
                for one in zip(COMPONENTS[printed.quantity], balls, row[1:], again)]


def _judged(printed, time, component, ball, theirs, again, numbers):
    value = numbers.ball(Fraction(theirs))
    difference = float(numbers.upper(ball - value))
    tolerance = float(printed.tolerance * abs(Fraction(theirs)) if printed.relative else printed.tolerance)
    left = None if again is None else abs(again - float(theirs))
    verdict = ("agrees" if difference <= tolerance else "explained" if left is not None and left <= tolerance
               else "differs")
    cause = (f"{WORDS[printed.cause['method']].format(**printed.cause)} gives theirs to {left:.1e}"
             if verdict == "explained" else "")
    ours = "0" if 0 in ball else ball.str(SHOWN, radius=False)
    return Finding(printed, time, component, UNITS.get(printed.quantity, printed.motion.unit), ours,
                   float(numbers.upper(ball - numbers.ball(Fraction(ours)))), theirs, difference, tolerance,
                   verdict, cause, left if verdict == "explained" else None)
