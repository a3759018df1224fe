"""Zeros and extremes of the rates along an enclosed motion, each proved to be one and none passed over.

On an interval where a function's enclosure leaves out zero it has none; where its derivative's does, it has one at most, and the signs at the ends tell.
Any other interval is divided. The rates' own equations give the derivatives, so that no error is differentiated.
"""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from ...numbers.vectors import CYCLE
from ...physics.quadratic import QuadraticForm
from ...physics.scene import AnyScene
from .result import Event

MOST_BOXES = 500  # of a piece and a function
UNEVEN = Fraction(4871, 10000)  # where intervals are divided, lest a symmetric motion's root be met
NOTHING = 25  # digits below the motion's own size: a rate, or its derivative, that stays so small over a piece counts as zero there
ROUNDS = 60  # of Newton's method


def events_of(scene: AnyScene, pieces: Sequence[Any], until: Fraction) -> tuple[tuple[Event, ...], str]:
    """(events after the start in order of time, words on how they were found). To be called with more than enough bits at work."""
    found, open_at, form = [], [], scene.quadratic()
    names = scene.components
    for number, piece in enumerate(pieces):
        curve = _Curve(piece, form)
        for i in range(3):
            for kind, order in (("zero", 0), ("extreme", 1)):
                roots, clear = _roots(curve, i, order, number == 0)
                if not clear:
                    open_at.append(f"{names[i]}, {'zero' if order == 0 else 'extreme'}, about {float(piece.start):.4g}")
                found += [_event(curve, i, kind, s) for s in roots]
    found = [one for one in found if one.t <= _ball(until)]
    words = f"zeros and extremes of each rate after the start, by roots along the enclosed motion: none is passed over (below 1e-{NOTHING} counts as zero)"
    if open_at:
        words += f", but where the digits leave open whether there is one ({'; '.join(open_at[:3])}{' and so on' * (len(open_at) > 3)})"
    return tuple(sorted(found, key=lambda one: one.t.mid())), words


def _event(curve: _Curve, i: int, kind: str, s: Any) -> Event:
    from flint import arb
    value, bend = curve.derivative(i, 0, s), curve.derivative(i, 2, s)
    if kind == "extreme":
        kind = "least" if bend > 0 else "greatest" if bend < 0 else "extreme"
    return Event(kind, i, _ball(curve.piece.start) + s * _ball(curve.piece.length), arb(0) if kind == "zero" else value)


def _ball(value: Any) -> Any:
    from flint import arb, fmpq
    return arb(fmpq(value.numerator, value.denominator))


class _Curve:
    """Rates over a piece and their derivatives in time, from the equations x_i' = kappa x_j x_k + rho x_k + sigma x_j + m."""

    def __init__(self, piece: Any, form: QuadraticForm) -> None:
        self.piece, self.size = piece, _ball(Fraction(piece.unit))
        self.kappa, self.rho, self.sigma, self.m = ([_ball(Fraction(v)) for v in row] for row in (form.kappa, form.rho, form.sigma, form.m))

    def derivative(self, i: int, order: int, s: Any) -> Any:
        """The `order`-th derivative (0 to 2) of component i at s, a ball."""
        x = self.piece.at(s)
        if order == 0:
            return x[i]
        rate = [self.kappa[n] * x[j] * x[k] + self.rho[n] * x[k] + self.sigma[n] * x[j] + self.m[n] for n, (j, k) in enumerate(CYCLE)]
        if order == 1:
            return rate[i]
        j, k = CYCLE[i]
        return self.kappa[i] * (rate[j] * x[k] + x[j] * rate[k]) + self.rho[i] * rate[k] + self.sigma[i] * rate[j]


def _roots(curve: _Curve, i: int, order: int, first: bool) -> tuple[list[Any], bool]:
    """(balls of s, whether all of the piece is clear) of the zeros of a derivative. first: the piece begins at the start, whose own zero does not count."""
    from flint import arb
    whole = lambda n: curve.derivative(i, n, arb(0.5, 0.5))
    if whole(order).abs_upper() < curve.size ** (order + 1) * arb(10) ** -NOTHING:
        return [], True  # a rate that is zero, or constant, throughout
    left, boxes = [(Fraction(0), Fraction(1))], 0
    found: list[Any] = []
    while left:
        a, b = left.pop()
        boxes += 1
        box = _ball(a).union(_ball(b))
        if 0 not in curve.derivative(i, order, box):
            continue
        if 0 not in curve.derivative(i, order + 1, box):
            low, high = (curve.derivative(i, order, _ball(end)) for end in (a, b))
            if first and a == 0 and 0 in low:
                continue
            if 0 in low or 0 in high:
                return found, False
            if (low > 0) != (high > 0):
                found.append(_closer(curve, i, order, box))
        elif boxes > MOST_BOXES:
            return found, False
        else:
            middle = a + (b - a) * UNEVEN
            left += [(a, middle), (middle, b)]
    return found, True


def _closer(curve: _Curve, i: int, order: int, box: Any) -> Any:
    """The root in a box on which the slope has a sign, by interval Newton as long as it narrows."""
    from flint import arb
    scale = _ball(curve.piece.length)
    for _ in range(ROUNDS):
        middle = arb(box.mid())
        new = middle - curve.derivative(i, order, middle) / (curve.derivative(i, order + 1, box) * scale)
        if not new.overlaps(box):
            break
        narrower = new.intersection(box)
        if not narrower.rad() < box.rad() * 0.9:
            break
        box = narrower
    return box
