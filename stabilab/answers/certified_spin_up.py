"""The part of a certificate that proves a spin-up under a torque of any direction: the way, and an inequality at its end that stays true.

The inequality is that of the normal form about its fixed centre, whatever form decided the fate first: it holds a little later, and a
checker can work it out from the rates alone. docs/certificate.md has the form.
"""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from ..orbit.result import Fate
from ..physics.scene import AnyScene
from ..unreduced.enclosure import kernel
from ..unreduced.enclosure.run import Course
from ..unreduced.spin_up.fields import natural, tests_of
from ..unreduced.spin_up.follow import spin_up

BUDGET, STEPS = 60_000, 2_500  # of the run that finds the time, and validated ones: a checker takes some seconds for so many
ORDERS = ((0, 2), (4, 6), (12, 14), (16, 18))  # lowest first: the check of high ones takes longest
LATER = (1.0, 1.0625, 1.25, 1.5, 2.0, 3.0, 5.0, 8.0)  # times, over that of the first certificate, at which the inequality is asked
CHECKPOINTS = 4
DIGITS = 22  # of the checkpoints' brackets, relative to the greatest rate; wider where the enclosure is
SURE = Fraction(1 << 20, (1 << 20) + 1)  # what is told of the gain is less by this: the inequality's own rounding


def certified_spin_up(scene: AnyScene, state: Sequence[Any]) -> tuple[dict[str, Any] | None, str]:
    """(claims, "") of the spin-up from a state (three Fractions), or (None, why there are none)."""
    found = spin_up(scene, state, budget=BUDGET)
    if found.fate is not Fate.SPIN_UP or found.level == "exact":
        return None, f"{found.fate.word}: {found.cause}" + (" (a closed solution, which has no certificate yet)" if found.level == "exact" else "")
    own, unit = natural(scene)
    field = next((field for field in tests_of(own).fixed if (field.axis + 1, field.sense) == (found.axis, found.sense)), None)
    if field is None:
        return None, f"{found.fate.word}: {found.cause}; there is a certificate for spin-up about the major and the minor axis alone"
    end = found.t * LATER[-1]
    times = [found.t * later for later in LATER] if found.t else [0.0]
    course = Course(scene, state, end) if end else None
    for later in times:
        box = _box(course, later, state)
        if box is None:
            return None, f"{found.fate.word}: {found.cause}; its way was not enclosed up to t = {later:.6g} in {STEPS} validated steps"
        inequality = _holding(tests_of(own), field, box, unit)
        if inequality:
            t = Fraction(course.t) if course else Fraction(0)
            return {"axis": found.axis, "sense": found.sense, "t": str(t), **inequality, "way": _checkpoints(scene, state, course, t)}, ""
    return None, f"{found.fate.word}: {found.cause}; the inequality about the fixed centre, which a checker knows, does not hold up to t = {times[-1]:.6g}"


def _box(course: Course | None, t: float, state: Sequence[Any]) -> Any:
    """(middle (3,), radius) of a ball that holds the motion at a time; None where the steps do not reach."""
    if course is None:
        middle = np.array([float(v) for v in state])
        return middle, float(sum(abs(v - Fraction(m)) for v, m in zip(state, middle.tolist()))) * (1 + 2.0**-40)
    course.advance(t, STEPS - course.steps)
    now = course.now
    return (now.middle, float(np.abs(now.rest).sum() + now.radius.sum()) * (1 + 2.0**-40)) if course.status == kernel.DONE else None


def _holding(tests: Any, field: Any, box: Any, unit: float) -> dict[str, Any] | None:
    """Orders and constants of the first inequality that holds for the ball, in the scene's units; None where none does."""
    middle, near = box
    for orders in ORDERS:
        found = tests.certifier(field, orders)(middle[None] / unit, np.array([near / unit]))
        if found.good[0]:
            u = Fraction(unit)
            cone = Fraction(float(found.A[0])) / abs(Fraction(field.form.scale[0])) * u
            gain = Fraction(float(found.eta[0])) / Fraction(field.D1) * u * u * SURE
            return {"orders": list(orders), "cone": str(cone), "least": str(Fraction(float(found.z[0])) * u), "gain": _decimal(gain, 12)}
    return None


def _decimal(value: Fraction, digits: int) -> str:
    """A positive number, rounded down to so many digits."""
    exponent = digits - 1 - int(f"{float(value):e}".partition("e")[2])
    return str(Fraction(int(value * Fraction(10) ** exponent)) / Fraction(10) ** exponent)


def _checkpoints(scene: AnyScene, state: Sequence[Any], course: Course | None, t: Fraction) -> list[dict[str, Any]]:
    """Brackets of the rates at some times up to t, for whoever reads and for whoever checks."""
    if not t:
        return []
    out, again = [], Course(scene, state, float(t))
    for n in range(1, CHECKPOINTS + 1):
        again.advance(float(t) * n / CHECKPOINTS)
        now = again.now
        size = Fraction(float(np.abs(now.middle).max())) / 10**DIGITS
        out.append({"t": str(Fraction(again.t)), "box": [_bracket(low, high, size) for low, high in now.box]})
    return out


def _bracket(low: Fraction, high: Fraction, room: Fraction) -> list[str]:
    """A bracket with ends of few digits round one, with some room: another's enclosure has its own width."""
    room = max(room, high - low)
    grain = Fraction(10) ** (int(f"{float(room):e}".partition("e")[2]) - 1)
    return [str((low - room) // grain * grain), str(-((-high - room) // grain) * grain)]
