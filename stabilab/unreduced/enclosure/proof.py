"""A certified spin-up proved: the way from an exact start to the inequality enclosed, and the inequality for
every state of the set there.

The theorem's inequality (`spin_up.certificate`) is tested for the ball that holds the enclosure at the time
when it fired. Its test is one in doubles, whose rounding is bounded beforehand: forms are exact before the
one root, each coefficient comes with a bound of its rounding (`spin_up.elimination`), the place of the ball
is taken at its worse ends, and every comparison leaves room for the rest. So nothing in the answer rests on a
run that was not enclosed.
"""
from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from ...asked import checked_scene
from ...numbers.exact import exact_vector
from ...physics.coefficients import effective
from ..spin_up.certificate import natural, tests_of
from ..spin_up.result import SpinUp, Trap
from . import kernel
from .run import Course, allowed

TRIED, HOPELESS = 512, 16  # steps after which a way that would take so many times what is allowed is given up
# times, over that of the certified run, at which the inequality is asked again
LATER = (1.0, 1.0625, 1.25, 1.5, 2.0)
WIDER = 1 + 2.0**-40


def proved(scene, state, found: SpinUp, steps: int | None = None, bits: int | None = None, fast: bool = False,
           plain: int = 0) -> SpinUp:
    """The answer of `spin_up` for the motion from a state (three exact numbers: floats at their word,
    Fractions, decimals in strings), with level "proved" where its way can be enclosed in so many validated
    steps and the inequality holds for the whole set there; else as it was found, its cause told what
    hindered. bits, plain: as of `enclosure.run.Course`. fast: ask the inequality by compiled loops, for which
    the first of an installation waits some seconds: where those that found it have loaded them."""
    if found.level != "certified":
        return found
    before: Any = found.trap  # of a motion off the axes of symmetry
    scene = effective(checked_scene(scene))
    own, unit = natural(scene)
    rates = "" if scene.variables == "scaled" else " rad/s"
    test = tests_of(own).certifier(before.field, before.orders, fast)
    way = _Way(scene, state, found.t * LATER[-1], bits, plain)
    for later in LATER:
        reached = way.to(found.t * later, steps)
        if reached is None:
            return replace(found,
                           cause=f"{found.cause}; not proved: after {way.steps} validated steps, at t = "
                                 f"{way.t:.6g}, the way is {way.why}")
        middle, near = reached
        constants = test.constants(middle / unit, near / unit * WIDER, fast)
        if constants:
            # six constants
            trap = Trap(before.field, before.form, before.orders, *constants, unit, way.t)  # type: ignore[call-arg]
            words = (found.cause.replace("is certified", "is proved")
                     + f"; the way there is enclosed, within {near:.2g}{rates} at t = {way.t:.6g}")
            return replace(found, level="proved", trap=trap, t=way.t, state=tuple(middle.tolist()),
                           cause=words)
        if not found.t:
            break
    return replace(found,
                   cause=f"{found.cause}; not proved: the inequality does not hold for the whole set that is "
                         f"known to hold the state")


class _Way:
    """The motion at rising times, as the centre and radius of a ball."""

    def __init__(self, scene, state, t_end, bits, plain):
        self.start = exact_vector(state, "state")
        self.course = Course(scene, state, t_end, bits, plain) if t_end else None
        self.t, self.steps, self.why = 0.0, 0, ""

    def to(self, t, steps):
        """(middle (3,), radius of a ball about it); None where the steps do not reach."""
        if self.course is None:
            middle = np.array([float(v) for v in self.start])
            return middle, _up([abs(v - Fraction(m)) for v, m in zip(self.start, middle.tolist())])
        steps = allowed(self.course.bits) if steps is None else steps
        if not self.course.steps:
            self.course.advance(t, min(steps, TRIED))
            if self.course.status == kernel.GOING and self.course.t * steps < t * self.course.steps / HOPELESS:
                self.t, self.steps, self.why = self.course.t, self.course.steps, "too long to enclose"
                return None
        self.course.advance(t, steps - self.course.steps)
        now = self.course.now
        self.t, self.steps, self.why = now.t, now.steps, now.reason
        return (now.middle, _up(now.radius + np.abs(now.rest))) if now.status == "enclosed" else None


def _up(reach) -> float:
    """A bound of the length of a vector with components of at most these sizes."""
    return math.hypot(*map(float, reach)) * WIDER  # squares of small reaches would vanish

