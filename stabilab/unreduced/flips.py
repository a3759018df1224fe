"""How often a motion that repeats turns over: when its angular momentum passes, in the body, from one side of
it to the other.

Take an axis of the body along which the momentum H = D omega + lambda lies within 45 degrees at one time, and
against which it lies within 45 degrees at another: the body turns over at each zero of that component between
them (without a torque H is fixed in space, so it is the body that does; under one it may be H). A wobble
about an axis has none; of two, the one along which H gets larger counts; an axis in a plane round which
everything is alike turns there evenly and is none. Of a body without wheels and torque it is the intermediate
axis, whose component is a multiple of sn (Landau & Lifshitz, Mechanics, section 37) with zeros half a period
apart. Other motions are followed over one period by their power series.
"""
from __future__ import annotations

import math
from collections.abc import Sequence

from ..integrate.quadratic_series import coefficients, length, summed
from ..orbit.result import Fate, Flips, Motion
from ..physics.scene import AnyScene, Scene

ORDER, SHARE = 20, 1e-12  # of the series; of the size of the state: the last term of a step
STEPS, INSIDE = 2000, 12  # at most; parts of a step at whose ends signs are looked at
HALVINGS = 60
BACK = 1e-6  # of the size of the state: a motion that ends so near its start was followed well
ALIKE = 1e-6  # relative: times that differ by less are one


def flips_of(scene: AnyScene, result: Motion) -> Flips | None:
    """How often the motion turns over; None where it does not, or where that is not known: of a motion that
    does not repeat, in scaled variables, under other effects than wheels and a constant torque, and so near a
    separatrix that doubles do not follow it round."""
    pairs, period = result.extremes, result.period
    if (result.fate != Fate.BOUNDED or period is None or pairs is None or not result.for_all_time
            or scene.variables == "scaled" or not scene.plain):
        return None
    inertia, wheel = scene.body.inertia, [float(v) for v in scene.vector("gyrostat")]
    swings = [tuple(d * value + l for value in pair) for d, l, pair in zip(inertia, wheel, pairs)]
    both = [i for i, (low, high) in enumerate(swings) if low < 0 < high and not _round(scene, i)]
    if not both:
        return None
    axis = max(both, key=lambda i: min(map(abs, swings[i])))
    free = not any(scene.vector("constant_torque"))
    if free and not any(wheel):
        momentum = sum((d * w) ** 2 for d, w in zip(inertia, result.at))
        return Flips(axis + 1, (period / 2,), True) if 2 * swings[axis][1] ** 2 > momentum else None
    times = _zeros(scene, result.at[:3], period, axis)
    return Flips(axis + 1, _shortest(_apart(times, period)), free) if times else None


def _round(scene: Scene, i: int) -> bool:
    """Whether another axis is just like this one: of the same moment, with no wheel and no torque in the
    plane of the two."""
    D, vectors = scene.body.exact, (scene.vector("gyrostat"), scene.vector("constant_torque"))
    return any(D[i] == D[j] and not any(v[i] or v[j] for v in vectors) for j in range(3) if j != i)


def _zeros(scene: Scene, start: Sequence[float], period: float, axis: int) -> list[float] | None:
    """The times in [0, period), rising, at which the component of the momentum passes through zero; None
    where H is not within 45 degrees of both its directions, or the motion was not followed round."""
    form = scene.quadratic()
    D, wheel = scene.body.inertia, [float(v) for v in scene.vector("gyrostat")]
    x, t, result = tuple(map(float, start)), 0.0, []
    before, first, along = 0.0, 0.0, set()  # signs yet, and those for which H lies along the axis
    largest = max(map(abs, x))
    for _ in range(STEPS):
        series = coefficients(form, x, ORDER)
        if not all(math.isfinite(c) for term in series for c in term):
            return None
        h = min(length(series, SHARE * (max(map(abs, x)) or largest)), period - t)
        last = 0.0
        for n in range(INSIDE + 1):
            location = h * n / INSIDE
            H = [d * summed(term, location) + l for d, term, l in zip(D, series, wheel)]
            value = H[axis]
            if 2 * value * value > sum(v * v for v in H):
                along.add(value > 0)
            if value * before < 0:
                result.append(t + _between(series[axis], -wheel[axis] / D[axis], last, location))
            if value:
                before, last, first = value, location, first or value
        t, x = t + h, tuple(summed(term, h) for term in series)
        largest = max(largest, *map(abs, x))
        if t >= period:
            break
    if t < period or len(along) < 2 or any(abs(a - b) > BACK * largest for a, b in zip(x, start)):
        return None
    if first * before < 0:  # it starts at a zero, which is that of the end
        result.insert(0, 0.0)
    return result if len(result) % 2 == 0 else None


def _between(series: list[float], level: float, low: float, high: float) -> float:
    """Where a series passes a level between two places on different sides of it."""
    above = summed(series, high) > level
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        if (summed(series, middle) > level) == above:
            high = middle
        else:
            low = middle
    return (low + high) / 2


def _apart(times: Sequence[float], period: float) -> list[float]:
    """The times from each zero to the next, the last to the first of the next period."""
    return [b - a for a, b in zip(times, [*times[1:], times[0] + period])]


def _shortest(times: Sequence[float]) -> tuple[float, ...]:
    """The shortest row of times whose repetition they are."""
    for size in range(1, len(times) + 1):
        if len(times) % size == 0 and all(abs(t - times[n % size]) <= ALIKE * t for n, t in enumerate(times)):
            return tuple(sum(times[n::size]) * size / len(times) for n in range(size))
    return tuple(times)
