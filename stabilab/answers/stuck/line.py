"""Along a line of starts or of wheel momenta, numbered by s: every s at which the fate may change, by roots,
and those at which it does.

On a circle (torque on the major or minor axis, `orbit.reduction`) the motion is bounded exactly if the
potential somewhere within one turn ahead rises over the start by more than its energy, R(y, s) > E(s). The
fate can change only where the highest barrier is as high as the energy:

    R(y, s) = E(s)  and  dR/dy = -F(y, s) = 0   for a y in (0, 2 pi],   or, where E = 0, where the start
    itself is an equilibrium, F(0, s) = 0.

Along a line the place x, z of the start, its speed v about the torque's axis, E = v^2/2, and c and d of the
reduction are linear in s, so both are quadratics in s whose coefficients are functions of y. Their resultant
in s is a function of y alone; its zeros are isolated by balls of it and of its derivative: a cell of y is
left out where they exclude a zero, holds one where the derivative has a sign and Newton's step contracts, and
is halved otherwise. With h = y/2, S = sin h, K = cos h, and at the start w = z K - x S, u = x K + z S,

    R = -mu y - 2 S [w (G (x + S w) + c) + d u].

As the wheel changes the terms in s^2 of R and of F vanish at S = 0 like S^2 and S, because the rate at the
start is linear in s. So sigma = S s is the unknown: both quadratics are regular on the whole turn, and no
zero stands for an infinite s.

A zero may be double. From rest, or from a spin about the torque's axis alone, R and F are even in s and share
two roots at once, s and -s; along a change of that spin alone F does not depend on s. A cell with such a zero
is halved until it is `NARROW`, and every real root of f there is a candidate: one too many changes no fate.
Without energy (no rate about the torque's axis) y = 0 is a zero for every s. There, and as near to it as
`NARROW`, only an equilibrium at the start itself changes the fate.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias

from ...numbers.balls import working
from ...numbers.bracket import Bracket, Judge, narrowed, side
from ...numbers.vectors import CYCLE, Exact3, Number, Triple
from ...orbit.fate import fate_of
from ...orbit.one_orbit import Orbit
from ...orbit.reduction import Reduction, reduce
from ...orbit.result import Fate
from ...physics.body import Body
from ...physics.effects import effect_class
from ...physics.scene import Scene, Turn, aligned
from ..caveats import STEADY

BITS = 128
CELLS = 16  # the turn at first
ORDER = 12  # of Taylor's polynomial: the balls' overestimate is less by the cell's reach to this power
NARROW = 1e-13  # a cell of h as narrow holds a zero as far as anybody can see
MAX_CELLS = 2_000  # cells that are looked at
INF = math.inf
# of the unit: how near to a candidate its change of fate is looked for first
CANDIDATE_WIDTH = Fraction(1, 10**9)
# half a turn h -> the two quadratics, highest coefficient first
Pair: TypeAlias = Callable[[Any], tuple[Triple, Triple]]
Intervals: TypeAlias = tuple[tuple[float, float], ...]
EVERY = ((-INF, INF),)


@dataclass(frozen=True)
class Family:
    """A torque along principal axis `axis` (0-based) of a body, and a start; exact, along the axes of the
    body or, where the torque lies between two equal moments, of the body turned so that it does.
    back(vector): along the scene's own axes; turned(vector): from them."""

    body: Body
    axis: int
    torque: Fraction
    wheel: Exact3
    state: Exact3
    turn: Turn | None = None

    def scene(self, wheel: Sequence[Fraction] | None = None, torque: Fraction | None = None) -> Scene:
        """With this wheel momentum, and this torque about the axis."""
        size = self.torque if torque is None else torque
        return Scene(self.body, effect_class("gyrostat")(tuple(self.wheel if wheel is None else wheel)),
                     effect_class("constant_torque")(tuple(size * (n == self.axis) for n in range(3))))

    def fate(self, wheel: Sequence[Fraction] | None = None, torque: Fraction | None = None) -> Fate:
        """The fate of the start, decided exactly; SPIN_UP where a wheel along the torque lets no motion be
        bounded."""
        return self._decided(wheel, torque)[0]

    def _decided(self, wheel: Sequence[Fraction] | None, torque: Fraction | None) -> tuple[Fate, float]:
        """(fate, margin in energy)."""
        scene = self.scene(wheel, torque)
        reduction = reduce(scene)
        if reduction is None:
            return Fate.SPIN_UP, math.nan
        result = fate_of(scene, Orbit(reduction, self.state))
        return result.label, result.margin

    def clearly(self, wheel: Sequence[Fraction] | None = None, torque: Fraction | None = None) -> float:
        """How clearly the start stays bounded: the margin in energy, positive where it does, infinite where
        no more is known than that (a `bracket.Judge`)."""
        label, margin = self._decided(wheel, torque)
        steady = label in STEADY
        resolved = math.isfinite(margin) and margin and (margin > 0) == steady and label != Fate.EQUILIBRIUM
        return margin if resolved else side(steady)

    def steady(self, wheel: Sequence[Fraction] | None = None, torque: Fraction | None = None) -> bool:
        """Whether the start stays bounded."""
        return self.fate(wheel, torque) in STEADY

    def reduction(self, wheel: Sequence[Fraction]) -> Reduction | None:
        """About the torque's axis; None where the wheel has momentum along it, about an axis of symmetry too,
        whose uniform growth has a reduction of its own."""
        return None if wheel[self.axis] else reduce(self.scene(wheel))

    def along(self, start: Sequence[Fraction], step: Sequence[Fraction], s: Fraction) -> Exact3:
        """start + s step."""
        return tuple(a + s * b for a, b in zip(start, step))

    @property
    def across(self) -> tuple[int, int]:
        """The two other axes."""
        return CYCLE[self.axis]

    @property
    def momentum_unit(self) -> float:
        """A size that wheel momenta of this motion are measured by."""
        return own_momentum(self.body, self.state, abs(float(self.torque)))

    def turned(self, vector: Sequence[Fraction]) -> Exact3:
        """A vector along the scene's axes, along those of the family."""
        return tuple(vector) if self.turn is None else self.turn(vector)

    def back(self, vector: Sequence[Fraction]) -> Exact3:
        """The inverse of `turned`."""
        if self.turn is None:
            return tuple(vector)
        return tuple(sum((self.turn.rotation[i][j] * Fraction(vector[i]) for i in range(3)), Fraction(0))
                     for j in range(3))


def own_momentum(body: Body, state: Sequence[Number], torque: float) -> float:
    """The size of a body's own momentum, N m s, and of what a torque of this size, N m, makes of it."""
    weight = max(body.inertia)
    return weight * max(math.hypot(*map(float, state)), math.sqrt(torque / weight))


def family_of(scene: Scene, state: Sequence[Fraction]) -> Family | None:
    """The family of a scene and an exact state; None where the torque is off the axes, or there is none."""
    turn, torque = None, scene.vector("constant_torque")
    if sum(m != 0 for m in torque) > 1:
        turn = aligned(scene)
        if turn is None:
            return None
        scene, state = turn.twin, turn(state)
        torque = scene.vector("constant_torque")
    acting = [n for n in range(3) if torque[n]]
    if len(acting) != 1:
        return None
    return Family(scene.body, acting[0], torque[acting[0]], scene.vector("gyrostat"),
                  tuple(map(Fraction, state)), turn)


class Line:
    """The reductions at s = 0 and s = 1, one and the same where the wheel stays, and the exact starts there.
    """

    def __init__(self, at_0: Reduction, at_1: Reduction, start: Sequence[Fraction],
                 end: Sequence[Fraction]) -> None:
        self.wheel = at_0 is not at_1
        (x0, z0, c0, d0, v0), (x1, z1, c1, d1, v1) = _place(at_0, start), _place(at_1, end)
        g, dv = at_0.exact_constants, Fraction(0) if self.wheel else v1 - v0
        self.fixed = g["G"], g["mu"], dv * dv / 2, v0 * dv, v0 * v0 / 2
        self.at = x0, z0, c0, d0
        self.change = x1 - x0, z1 - z0, c1 - c0, d1 - d0
        self.rest = [float(-v0 / dv)] if dv else []

    def pair(self, ball: Callable[[Any], Any]) -> Pair:
        """The two quadratics with its numbers as balls."""
        fixed, at, change = (tuple(map(ball, numbers)) for numbers in (self.fixed, self.at, self.change))

        def quadratics(h: Any) -> tuple[Triple, Triple]:
            S, K = h.sin_cos()
            return (rise(fixed, at, change, h, S, K, self.wheel), force(fixed, at, change, S, K, self.wheel))
        return quadratics

    def unit(self, h: float) -> float:
        """What s is multiplied by in the unknown of the quadratics."""
        return math.sin(h) if self.wheel else 1.0

    def others(self) -> list[float]:
        """The s at which the start may be an equilibrium: no energy, or the torque is balanced, F(0, s) = 0.
        """
        bend, slope, level = force(self.fixed, self.at, self.change, 0, 1, False)
        if self.wheel or not bend:
            return [*self.rest, *([float(-level / slope)] if slope else [])]
        return [*self.rest, *real_roots([float(v) for v in (bend, slope, level)])]


def _place(reduction: Reduction, state: Sequence[Fraction]) -> tuple[Fraction, ...]:
    """x, z, c, d, and the speed about the torque's axis."""
    g = reduction.exact_constants
    return (g["flip"] * (state[reduction.j] + g["sj"]) / g["rx"], (state[reduction.k] + g["sk"]) / g["rz"],
            g["c"], g["d"], g["n"] * (state[reduction.axis] + reduction.s))


def rise(fixed: Any, at: Any, change: Any, h: Number, S: Number, K: Number, wheel: bool) -> Triple:
    """(f2, f1, f0) of f = R - E at half the turn h, of sine S and cosine K: in s, or in sigma where the wheel
    changes."""
    (G, mu, e2, e1, e0), (x0, z0, c0, d0), (x1, z1, c1, d1) = fixed, at, change
    w0, w1, u0, u1 = z0 * K - x0 * S, z1 * K - x1 * S, x0 * K + z0 * S, x1 * K + z1 * S
    i0, i1 = G * (x0 + S * w0) + c0, G * (x1 + S * w1) + c1
    first = -2 * (w0 * i1 + w1 * i0 + d0 * u1 + d1 * u0)
    level = -2 * S * (w0 * i0 + d0 * u0) - 2 * mu * h - e0
    if wheel:
        return 2 * _bend(G, change, w1), first, level
    return -2 * S * (w1 * i1 + d1 * u1) - e2, S * first - e1, level


def force(fixed: Any, at: Any, change: Any, S: Number, K: Number, wheel: bool) -> Triple:
    """(F2, F1, F0) likewise; where the wheel changes of S F in sigma."""
    (G, mu, *_), (x0, z0, c0, d0), (x1, z1, c1, d1) = fixed, at, change
    sine, cosine = 2 * S * K, 1 - 2 * S * S
    X0, Z0 = x0 * cosine + z0 * sine, z0 * cosine - x0 * sine
    X1, Z1 = x1 * cosine + z1 * sine, z1 * cosine - x1 * sine
    F0 = mu + G * X0 * Z0 + c0 * Z0 + d0 * X0
    F1 = G * (X0 * Z1 + X1 * Z0) + c0 * Z1 + c1 * Z0 + d0 * X1 + d1 * X0
    if wheel:
        w1, u1 = z1 * K - x1 * S, x1 * K + z1 * S
        return -2 * (K * _bend(G, change, w1) + S * (G * w1 * u1)), F1, S * F0
    return G * X1 * Z1 + c1 * Z1 + d1 * X1, F1, F0


def _bend(G: Number, change: Sequence[Number], w1: Number) -> Number:
    """Half the term in sigma^2 of R."""
    x1, z1, c1, d1 = change
    return (x1 * (G * x1 + c1) - d1 * z1) - G * w1 * w1


def resultant(f: Sequence[Number], g: Sequence[Number]) -> Number:
    """Of two quadratics (highest coefficient first): zero where they share a root."""
    (f2, f1, f0), (g2, g1, g0) = f, g
    cross = f2 * g0 - g2 * f0
    return cross * cross - (f2 * g1 - g2 * f1) * (f1 * g0 - g1 * f0)


def candidates(line: Line) -> list[float] | None:
    """Every s at which the start may lie on a separatrix, ascending, in doubles; None where `MAX_CELLS` cells
    do not tell."""
    result = line.others()
    with working(BITS, ORDER + 1) as numbers:
        pair = line.pair(numbers.ball)
        zeros = _isolated(pair)
        if zeros is None:
            return None
        for h in zeros:  # the start may lie on a separatrix at real roots of f, one or both shared by g
            if h >= NARROW and (unit := line.unit(h)):
                f, _ = pair(numbers.ball(h))
                result += [s / unit for s in real_roots([float(v.mid()) for v in f])]
    return sorted(result)


def _isolated(pair: Pair) -> list[float] | None:
    """The h in [0, pi] at which the resultant may vanish."""
    step = math.pi * (1 + 1e-15) / CELLS
    cells = [(n * step, (n + 1) * step) for n in range(CELLS)]
    result: list[float] = []
    for _ in range(MAX_CELLS):
        if not cells:
            return result
        low, high = cells.pop()
        left = _narrowed(pair, low, high)
        if left is None:
            continue
        if left[1] - left[0] < NARROW:
            result.append((left[0] + left[1]) / 2)
        elif left[1] - left[0] < 0.5 * (high - low):
            cells.append(left)
        else:
            middle = (left[0] + left[1]) / 2
            cells += [(left[0], middle), (middle, left[1])]
    return None


def expansion(pair: Pair, middle: Number, half: Number) -> list[Number]:
    """Coefficients of the resultant in the distance from the middle of a cell of h: Taylor's at the middle,
    and in front of the power `ORDER` a ball that holds the rest over the whole cell. The balls of a whole
    cell alone do not see what cancels, which is nearly all where two moments are nearly equal."""
    from flint import arb, arb_series
    rest = resultant(*pair(arb_series([arb(middle, half), 1], ORDER + 1)))
    here = resultant(*pair(arb_series([arb(middle), 1], ORDER)))
    return [*(here[n] for n in range(ORDER)), rest[ORDER]]


def _narrowed(pair: Pair, low: Number, high: Number) -> tuple[Number, Number] | None:
    """The part of a cell of h that may hold a zero; None where it holds none."""
    from flint import arb
    middle, half = (low + high) / 2, (high - low) / 2 * (1 + 1e-12)
    value, slope, *bend = expansion(pair, middle, half)
    reach, about = arb(half), lambda size: arb(0, size.abs_upper())
    if 0 not in value + about(sum((abs(c) * reach**n for n, c in enumerate((slope, *bend), 1)), arb(0))):
        return None
    slope += about(sum((n * abs(c) * reach**(n - 1) for n, c in enumerate(bend, 2)), arb(0)))
    if 0 in slope:
        return low, high
    step = value / slope  # Newton's: the zero is within middle - step
    smallest = middle - float((step.mid() + step.rad()).upper())
    largest = middle - float((step.mid() - step.rad()).lower())
    low, high = max(low, smallest - 1e-15), min(high, largest + 1e-15)
    return (low, high) if low <= high else None


def real_roots(quadratic: Sequence[float]) -> list[float]:
    """Its finite real roots (highest coefficient first), a double one twice, also where rounding hides it."""
    a, b, c = quadratic
    q = -0.5 * (b + math.copysign(math.sqrt(max(b * b - 4 * a * c, 0.0)), b))
    return [s for top, bottom in ((q, a), (c, q)) if bottom for s in [top / bottom] if math.isfinite(s)]


def pieces(clearly: Judge, unit: Fraction, cuts: Sequence[float]) -> Intervals:
    """The intervals of s in which a motion stays bounded, among the cuts: the fate is one and the same
    between two of them.

    clearly(s): how clearly it does (`Family.clearly`); unit: a size of s.
    """
    at = [Fraction(s) for s in cuts]
    if not at:
        return EVERY if clearly(Fraction(0)) > 0 else ()
    samples = [at[0] - unit, *((a + b) / 2 for a, b in zip(at, at[1:])), at[-1] + unit]
    margins = [clearly(s) for s in samples]
    steady = [margin > 0 for margin in margins]
    out: list[tuple[float, float]] = []
    low = -INF if steady[0] else math.nan
    for n, cut in enumerate(at):
        if steady[n] == steady[n + 1]:
            continue
        inside, outside = (n, n + 1) if steady[n] else (n + 1, n)
        around = Bracket(samples[inside], samples[outside], (margins[inside], margins[outside]))
        step = (1 if around.same > cut else -1) * CANDIDATE_WIDTH * unit
        nearby = clearly(cut + step), clearly(cut - step)
        if nearby[0] > 0 > nearby[1]:
            around = Bracket(cut + step, cut - step, nearby)
        end = float(narrowed(clearly, around, scale=unit).same)
        if steady[n]:
            out.append((low, end))
            low = math.nan
        else:
            low = end
    return tuple([*out, (low, INF)] if steady[-1] else out)


def nearest_change(retained: Intervals, steady: bool) -> tuple[float, float]:
    """(the least s > 0 at which the fate changes, the next one, from which on it is again what it was; inf
    where there is none).

    retained: the intervals of s in which the motion is bounded; steady: whether it is at s = 0.
    """
    # True: bounded up to there
    ends = [(end, side) for pair in retained for side, end in zip((False, True), pair) if 0 < end < INF]
    first = min((end for end, side in ends if side == steady), default=INF)
    return first, min((end for end, side in ends if side != steady and end > first), default=INF)
