"""The reduced potential of one state in ball arithmetic: where doubles cannot decide, or would lose digits.

Inputs (the state's doubles or fractions, the scene's rationals) are exact; every number is a ball that surely holds the true
value (`balls`). The mechanics is the same for any number of digits; what it is on a circle, a hyperbola and a
parabola, `ball_geometry` says.
"""
from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

from ..numbers.balls import Unclear, sign
from ..numbers.vectors import Number


class Spot(NamedTuple):
    """An equilibrium on the orbit at offset y. kind: +1 a maximum of V (barrier), -1 a minimum (well), 0 neither."""

    y: Number
    kind: int


class BallOrbit:
    """The orbit of one state in balls: V along it as a function of the offset y = theta - theta_0, and its equilibria.

    numbers: the kind of ball that it computes in; to be used where that came from, inside `settled`. What a geometry has to say
    besides: its `place`, `components`, `height`, `force` and `slope` at an offset, its equilibria (`_found`), `tops`
    and `swept`.
    """

    place: Callable[..., Any]
    components: Callable[..., Any]
    height: Callable[..., Any]
    force: Callable[..., Any]
    slope: Callable[..., Any]
    on_plane: bool = False  # on an invariant plane of a hyperbola
    closed = False  # whether it comes to the same place again
    spins_purely = False  # whether nothing but the rate about the axis changes as it spins up

    def __init__(self, reduction, state, numbers):
        self.r, self.numbers = reduction, numbers
        r = reduction
        self.state = tuple(v if isinstance(v, Fraction) else float(v) for v in state)  # exact either way
        self.u, self.v = (Fraction(self.state[a]) for a in (r.j, r.k))
        self.force_here = r.kappa * self.u * self.v + r.rho * self.v + r.sigma * self.u + r.m  # exact
        self._set_up(Fraction(self.state[r.axis]) + r.s)
        self.energy = self.w * self.w / 2  # E - V(theta_0)

    def _set_up(self, speed):
        """flip, n, w, mu and the constants of the geometry; speed: omega_i + s, exactly."""
        raise NotImplementedError

    def component_i(self, w):
        """omega_i where theta' = w."""
        return w * self.flip / self.n - self.numbers.ball(self.r.s)

    def doubles_at(self, y) -> tuple[float, ...]:
        """The place at offset y as floats, in the form that `potential` takes."""
        return tuple(map(float, self.place(y)))

    # --- its equilibria
    @cached_property
    def spots(self) -> list[Spot]:
        """All equilibria on the orbit, ascending; on a circle those with offsets in (0, 2 pi]."""
        found = self._found()
        if any(0 in y and not y.is_zero() for y, _ in found):
            raise Unclear  # on which side of the state it stands is not known, and no side may pass it over
        found.sort(key=lambda one: one[0].mid())  # as doubles two that nearly meet may be one number
        for (a, _), (b, _) in zip(found, found[1:]):
            if not a < b:
                raise Unclear
        return [Spot(y, self._kind(y, m, [o for o, _ in found])) for y, m in found]

    def _found(self) -> list:
        """[(offset, multiplicity)] of the equilibria, in any order."""
        raise NotImplementedError

    def _kind(self, y, multiplicity, others) -> int:
        if multiplicity == 1:
            return sign(self.slope(y))
        if multiplicity % 2 == 0:
            return 0
        gap = min([abs(float((o - y).mid())) for o in others if o is not y] + [0.1])
        return sign(self.force(y + gap / 4))

    @property
    def all_spots(self) -> list[Spot]:
        """The equilibria, on a circle also those of the turn behind, ascending."""
        return self.spots

    # --- what a geometry may say otherwise
    def fall(self):
        """What the potential falls by over a turn of a circle; nothing on the others."""
        return self.w * 0

    def barriers(self) -> list[Spot]:
        """The barriers that the fate depends on: on a circle those ahead within one turn, on an invariant plane those ahead,
        else all."""
        return [s for s in self.spots if s.kind > 0]

    def margins(self) -> list:
        """Height minus energy of each of the `barriers`."""
        return [self.height(s.y) - self.energy for s in self.barriers()]

    def margin(self):
        """The margin that decides the fate: of the highest barrier on a circle, else of the one nearest in height; None without a barrier."""
        return min(self.margins(), key=lambda v: abs(v.mid()), default=None)

    def margins_to_tie(self, margin) -> list:
        """The margins of the barriers that a motion of their energy would tend to, given that which decides the fate."""
        return [margin]

    def wall(self, inner, side):
        """An offset on one side of all equilibria, from `inner` on, where the potential is higher than the energy; None on a circle."""
        step, outer = 1, inner + side
        while not sign(self.height(outer) - self.energy) > 0:
            step *= 2
            outer = inner + side * step
        return outer

    def end_of_plane(self, side):
        """(offset, W^2/2 there) of the end of an invariant plane that the motion would tend to on that side, or None."""
        return None

    def invariants(self) -> dict[str, float]:
        """Q and the energy, as `invariants_of` tells them; nothing on a parabola."""
        return {}
