"""Rates and attitude of a recorded motion, enclosed in balls: by the Taylor series in integers of
`integrate.integer_flow`."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from ...answers.passage.enclosed import own_unit
from ...integrate.integer_flow import IntegerFlow
from ...numbers.balls import working
from .wheels import wheels_at

# bits at first; that the enclosure is to keep; beyond what the error grew by
FIRST_BITS, KEPT, SPARE = 112, 60, 48
BALL_BITS = 400  # of what is formed from an enclosure
UNITS = ((1, 0, 0), (0, 1, 0))  # directions at rest in space, body frame; the third by their cross product


@dataclass(frozen=True)
class At:
    """The motion at a time: rates in rad/s (3 balls), and how space has turned, body frame: rows (3, 3) of
    balls, the columns being what the body's axes of the start have become."""

    omega: tuple
    turned: tuple


def at(motion, times) -> list[At]:
    """The motion at increasing times (rationals, s)."""
    if motion.wheels:
        return [At(*found) for found in wheels_at(motion, times)]
    runs = [_run(motion, times, axis) for axis in UNITS]
    with working(BALL_BITS):
        return [At(tuple(one[0]), _rows(one[1], two[1])) for one, two in zip(*runs)]


def _rows(first, second):
    columns = first, second, cross(first, second)
    return tuple(tuple(column[i] for column in columns) for i in range(3))


def cross(a, b) -> list:
    """The cross product of two vectors of any numbers."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _run(motion, times, axis):
    """[(rates, direction)] at the times, as many bits as it takes."""
    bits = FIRST_BITS
    while True:
        found, lost = _attempt(motion, times, axis, bits)
        if bits - lost >= KEPT:
            return found
        bits = lost + KEPT + SPARE


def _attempt(motion, times, axis, bits):
    scene = motion.scene
    unit = own_unit(scene, motion.omega)
    flow = IntegerFlow(scene.quadratic(), list(scene.body.exact), motion.omega, bits, unit,
                       tuple(map(Fraction, axis)))
    found, lost = [], 0
    with working(BALL_BITS) as numbers:
        # of a unit of omega; a free motion runs so much faster
        rate = numbers.pi() / 180 if motion.unit == "deg/s" else numbers.ball(1)
        waiting = [(numbers.ball(t) - numbers.ball(motion.begins)) * numbers.ball(unit) * rate for t in times]
        while len(found) < len(waiting):
            piece = flow.step()
            while len(found) < len(waiting) and waiting[len(found)] < numbers.ball(flow.now):
                values = values_of(piece, waiting[len(found)], numbers)
                found.append(([v * numbers.ball(unit) * rate for v in values[:3]], values[3:]))
                lost = max(lost, *(r.bit_length() for r in piece.radii))
            if flow.error.bit_length() > 900 - 64:
                return found, flow.error.bit_length()
    return found, lost


def values_of(piece, now, numbers) -> list:
    """The components of a piece at a time of the motion's own, a ball; balls, while `numbers` is the working
    kind."""
    from flint import arb
    s, scale, found = (now
                       - numbers.ball(piece.start)) / numbers.ball(piece.length), arb(2) ** -piece.bits, []
    for row, radius in zip(piece.rows, piece.radii):
        total = arb(0)
        for c in reversed(row):
            total = total * s + c
        found.append((total + arb(0, radius)) * scale)
    return found
