"""What is printed of a motion, from its enclosure: rates, modified Rodrigues parameters, angles. Balls in,
balls out."""
from __future__ import annotations

from .enclose import At, cross

DEGREES = "deg/s"


def omega(motion, at: At, numbers) -> list:
    """Rates in the unit that the motion is given in."""
    return [w * 180 / numbers.pi() if motion.unit == DEGREES else w for w in at.omega]


def sigma(motion, at: At, numbers) -> list:
    """Modified Rodrigues parameters of the attitude, of the rotation by less than half a turn."""
    start = _start(motion, numbers)
    c = [[sum(row[m] * start[m][k] for m in range(3)) for k in range(3)] for row in at.turned]
    twice = (1 + c[0][0] + c[1][1] + c[2][2]).sqrt()  # 2 cos(half the angle)
    return [(c[j][k] - c[k][j]) / (2 * twice) / (1 + twice / 2) for j, k in ((1, 2), (2, 0), (0, 1))]


def _start(motion, numbers):
    """Rows (3, 3) of the matrix that takes components in space to those in the body at the start."""
    if motion.against_momentum:
        return _against_momentum(motion, numbers)
    s = [numbers.ball(v) for v in motion.sigma]
    square = s[0] * s[0] + s[1] * s[1] + s[2] * s[2]
    columns = []
    for k in range(3):
        e = [numbers.ball(int(i == k)) for i in range(3)]
        once = cross(s, e)
        twice = cross(s, once)
        columns.append([a + (8 * c - 4 * (1 - square) * b) / (1 + square) ** 2 for a, b,
                        c in zip(e, once, twice)])
    return [[column[i] for column in columns] for i in range(3)]


def _against_momentum(motion, numbers):
    third = _unit([-numbers.ball(m * w) for m, w in zip(motion.inertia, motion.omega)])
    second = _unit([-third[1] / third[0], numbers.ball(1), numbers.ball(0)])
    first = _unit(cross(second, third))
    return [[column[i] for column in (first, second, third)] for i in range(3)]


def _unit(vector):
    length = sum(v * v for v in vector).sqrt()
    return [v / length for v in vector]


def rate3(motion, at: At, numbers) -> list:
    """The rate about axis 3."""
    return [at.omega[2]]


def angle3(motion, at: At, numbers) -> list:
    """The angle about axis 3, turned at a constant rate until the motion begins, and by less than half a turn
    from then on."""
    return [numbers.ball(motion.omega[2] * motion.begins) + numbers.angle(-at.turned[1][0], at.turned[0][0])]


def off_linear(motion, at: At, numbers, time) -> list:
    """The angle between the attitude and that of a rotation at the initial rate."""
    w = [numbers.ball(v) for v in motion.omega]
    size = sum(v * v for v in w).sqrt()
    axis, turn = [v / size for v in w], -size * numbers.ball(time)
    trace = numbers.ball(0)
    for k in range(3):
        e = [numbers.ball(int(i == k)) for i in range(3)]
        linear = [a * turn.cos() + b * turn.sin() + n * axis[k] * (1 - turn.cos()) for a, b,
                  n in zip(e, cross(axis, e), axis)]
        trace += sum(a * row[k] for a, row in zip(linear, at.turned))
    return [2 * ((3 - trace) / 4).sqrt().asin()]


def momentum_turn(motion, at: At, numbers) -> list:
    """The angle between the angular momentum in space and that of the start; zero by theory, and here at most
    the width of the enclosure."""
    start = [numbers.ball(m * w) for m, w in zip(motion.inertia, motion.omega)]
    body = [numbers.ball(m) * w for m, w in zip(motion.inertia, at.omega)]
    space = [sum(at.turned[i][k] * body[i] for i in range(3)) for k in range(3)]
    across = sum(v * v for v in cross(start, space))
    return [numbers.around(numbers.ball(0),
                           (numbers.upper(across).sqrt() / sum(v * v for v in start)).asin())]
