"""What a certificate (its form: docs/certificate.md) says of motions with a closed solution, and of spin-up
under a torque of any direction.

Closed solutions (`unreduced.spin_up.certificate.closed`) are those without a torque, of spheres, and of
bodies of revolution without a transverse wheel. It states the law, the exact direction along which the
rates grow, how fast they do at least, and how large what lies across that direction (or, bounded, the whole
rate) ever becomes at most.

Of a spin-up under a torque of any direction it has the motion up to a time, and an inequality at its end
that stays true: that about the fixed centre where it holds soon, else that about the moving centre, or
along the equator of a body of revolution. A checker can work out each from the rates alone."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from ..orbit.result import Fate
from ..physics.own_unit import natural
from ..physics.scene import AnyScene
from ..reasons import Moment, Reason, Sentence
from ..unreduced import enclosure_kernel
from ..unreduced.enclosure import Course, allowed
from ..unreduced.spin_up.certificate import Tests, closed, tests_of
from ..unreduced.spin_up.follow import spin_up

if TYPE_CHECKING:
    from ..unreduced.spin_up.result import SpinUp


NOT_CERTIFIED = Sentence("fate-not-certified", "{fate}: {why}")
NOT_ENCLOSED = Sentence(
    "way-not-enclosed", "{fate}: {why}; it was not enclosed up to {time} in {steps} validated steps")
NO_INEQUALITY = Sentence(
    "no-known-inequality", "{fate}: {why}; no inequality that a checker knows holds up to {time}")

# relative, of what is claimed of gain and size: another's rounding of the roots in them
ROOM = Fraction(1, 10**9)


def closed_motion(scene: AnyScene, state: Sequence[Fraction]) -> dict[str, Any] | None:
    """Fate, axis, sense and the claims of the closed solution from a state (three Fractions); None for scenes
    that have none."""
    result = closed(scene, state)
    if result is None:
        return None
    growth, (axis, sense) = result.direction, result.about
    claims = {"law": result.law, "direction": None if growth is None else [str(v) for v in growth],
              "gain": result.gain and str(result.gain * (1 - ROOM)), "most": str(result.most * (1 + ROOM))}
    return {"fate": (Fate.SPIN_UP if growth else Fate.BOUNDED).word, "axis": axis, "sense": sense,
            "closed": claims}


# of the run that finds the time, and validated ones: a checker takes a millisecond for each
BUDGET, STEPS = 60_000, 30_000
FIXED_ORDERS = ((0, 2), (4, 6), (12, 14), (16, 18))  # lowest first: the check of high ones takes longest
MOVING_ORDERS = ((2, 4), (4, 6), (8, 10))
# times, over that of the first certificate, at which the inequality is asked
LATER = (1.0, 1.0625, 1.25, 1.5, 2.0, 3.0, 5.0, 8.0)
CHECKPOINTS = 4
# of the checkpoints' brackets, relative to the greatest rate; wider where the enclosure is
BRACKET_DIGITS = 9
# what is claimed of the gain is less by this: the inequality's own rounding
SURE = Fraction(1 << 20, (1 << 20) + 1)


def certified_spin_up(scene: AnyScene,
                      state: Sequence[Any]) -> tuple[dict[str, Any], None] | tuple[None, Reason]:
    """(claims, None) of the spin-up from a state (three Fractions), or (None, why there are none)."""
    result = spin_up(scene, state, budget=BUDGET)
    if result.fate is not Fate.SPIN_UP or result.level == "exact":
        return None, NOT_CERTIFIED(fate=result.fate.word, why=result.reason)
    own, unit = natural(scene)
    ways = list(_inequalities(tests_of(own), result))
    times = [result.t * later for later in LATER] if result.t else [0.0]
    course = Course(scene, state, times[-1]) if result.t else None
    for later in times:
        box = _box(course, later, state)
        if box is None:
            return None, NOT_ENCLOSED(fate=result.fate.word, why=result.reason, time=Moment(later, side=1),
                                      steps=STEPS)
        inequality = _holding(tests_of(own), ways, box, unit)
        if inequality:
            t = Fraction(course.t) if course else Fraction(0)
            return {"axis": result.axis, "sense": result.sense, "t": str(t), **inequality,
                    "way": _checkpoints(scene, state, course, t)}, None
    return None, NO_INEQUALITY(fate=result.fate.word, why=result.reason, time=Moment(times[-1]).lower)


def _inequalities(tests: Tests, result: SpinUp) -> Iterator[tuple[str, Any, tuple[int, int]]]:
    """(what it is about, field, orders) of those that say what was found, in the order in which they are
    asked."""
    if not result.axis:
        yield from (("equator", field, orders) for field in tests.equatorial for orders in MOVING_ORDERS)
        return
    for about, fields, all_ in (("fixed centre", tests.fixed, FIXED_ORDERS),
                                ("moving centre", tests.moving, MOVING_ORDERS)):
        yield from ((about, field, orders) for field in fields
                    if (field.axis + 1, field.sense) == (result.axis, result.sense) for orders in all_)


def _box(course: Course | None, t: float, state: Sequence[Any]) -> Any:
    """(middle (3,), radius) of a ball that holds the motion at a time; None where the steps do not reach."""
    if course is None:
        middle = np.array([float(v) for v in state])
        off = sum(abs(v - Fraction(m)) for v, m in zip(state, middle.tolist()))
        return middle, float(off) * (1 + 2.0**-40)
    course.advance(t, min(STEPS, allowed()) - course.steps)
    now = course.now
    return (now.middle, float(np.abs(now.rest).sum() + now.radius.sum())
            * (1 + 2.0**-40)) if course.status == enclosure_kernel.DONE else None


def _holding(tests: Tests, ways: list[tuple[str, Any, tuple[int, int]]], box: tuple[np.ndarray, float],
             unit: float) -> dict[str, Any] | None:
    """The first inequality that holds for the ball, its orders and constants in the scene's units; None where
    none does."""
    middle, nearby = box
    for about, field, orders in ways:
        constants = tests.certifier(field, orders).constants(middle / unit, nearby / unit)
        if constants:
            A, z, eta, *_ = map(Fraction, constants)
            u = Fraction(unit)
            # the field's amplitude over that of a checker, who knows the rates and no moments: of U + i q V,
            # or of w u + i tau v/w
            scale = abs(field.form.scale[0]) if about == "fixed centre" else np.sqrt(np.prod(field.roots))
            cone, gain = A / Fraction(float(scale)) * u, eta / Fraction(field.D1) * u * u * SURE
            return {"about": about, "orders": list(orders),
                    "cone": str(cone), "least": str(z * u), "gain": _decimal(gain, 12)}
    return None


def _decimal(value: Fraction, digits: int) -> str:
    """Return a positive number after rounding it down to so many digits."""
    exponent = digits - 1 - int(f"{float(value):e}".partition("e")[2])
    return str(Fraction(int(value * Fraction(10) ** exponent)) / Fraction(10) ** exponent)


def _checkpoints(scene: AnyScene, state: Sequence[Any], course: Course | None,
                 t: Fraction) -> list[dict[str, Any]]:
    """Return brackets of the rates at some times up to t. A reader follows the motion by them, and a checker
    compares its own with them."""
    if not t:
        return []
    out, again = [], Course(scene, state, float(t))
    for n in range(1, CHECKPOINTS + 1):
        again.advance(float(t) * n / CHECKPOINTS)
        now = again.now
        size = Fraction(float(np.abs(now.middle).max())) / 10**BRACKET_DIGITS
        out.append({"t": str(Fraction(again.t)), "box": [_bracket(low, high, size) for low, high in now.box]})
    return out


def _bracket(low: Fraction, high: Fraction, room: Fraction) -> list[str]:
    """A bracket with ends of few digits round one, with some room: another's enclosure has its own width."""
    room = max(room, high - low)
    grain = Fraction(10) ** (int(f"{float(room):e}".partition("e")[2]) - 1)
    return [str((low - room) // grain * grain), str(-((-high - room) // grain) * grain)]
