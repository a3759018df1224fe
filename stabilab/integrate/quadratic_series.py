"""A motion with quadratic rates by its power series in plain floats.

They are for pictures that follow a slider, where neither NumPy nor a compiled step is loaded. The rates are
x_i' = kappa_i x_j x_k + rho_i x_k + sigma_i x_j + m_i, so the coefficients of the series follow from one
another by products of series. A picture needs no last digit: a step leaves TERM_TOLERANCE of the state's size
at most.
"""
from __future__ import annotations

import math
from functools import partial
from operator import mul

from ..errors import InputError
from ..numbers.polynomial import golden_section
from ..numbers.vectors import CYCLE
from ..physics.scene import QuadraticForm

ORDER = 14
TERM_TOLERANCE = 1e-8  # of the size of the state: the last term of a step
STEPS = 120    # of a motion at most; a revolution takes some five
INSIDE = 12     # points a step
SEEN = 1e-3    # of the largest rate: what is seen in a picture
# shares by which the components of a start are moved: it leaves every plane through two of them
APART = (1, 2, 3)
# of the largest value: what may still exceed it between two points; golden sections for that
NEAR, HALVED = 0.01, 12
BACK = 1e-5  # of the size of the state: a motion that ends so near its start was followed well
LARGEST = 1e100  # a rate beyond which a motion is not drawn on

Path = tuple[list[float], list[tuple[float, ...]]]


def followed(form: QuadraticForm, start: tuple[float, ...], until: float, steps: int = STEPS) -> Path:
    """(times, states) of the motion from t = 0 on, dense enough to be drawn as a line, to `until` or as far
    as so many steps go. Raises InputError where its numbers are so large that not even its first step can be
    formed in doubles."""
    t, x = 0.0, tuple(map(float, start))
    times, states = [t], [x]
    for _ in range(steps):
        series = coefficients(form, x)
        if not all(map(math.isfinite, (c for term in series for c in term))):
            if t:
                break
            raise InputError(f"this motion is too fast to be drawn: with a rate of {max(map(abs, x)):.3g} "
                             "and these torques and momenta the powers of its series exceed what a double "
                             "holds (1.8e308); expected numbers of a body that can be built, in SI units")
        size = max(abs(term[0]) for term in series) or max(map(abs, form.coefficients[3]))
        h = min(length(series, TERM_TOLERANCE * size), until - t)
        for n in range(1, INSIDE + 1):
            fraction = h * n / INSIDE
            times.append(t + fraction)
            states.append(tuple(summed(term, fraction) for term in series))
        t, x = times[-1], states[-1]
        if t >= until or not max(map(abs, x)) < LARGEST:
            break
    return times, states


def largest(form: QuadraticForm, start: tuple[float, ...], until: float) -> float | None:
    """The largest |x| of a motion that repeats after `until`, to some eight digits; None where 4 STEPS do not
    come back to its start."""
    t, x = 0.0, tuple(map(float, start))
    best, size = math.hypot(*x), max(map(abs, x)) or max(map(abs, form.coefficients[3]))
    for _ in range(4 * STEPS):
        series = coefficients(form, x)
        if not all(map(math.isfinite, (c for term in series for c in term))):
            return None
        h = min(length(series, TERM_TOLERANCE * (max(map(abs, x)) or size)), until - t)
        at = partial(_size, series)
        places = [h * n / INSIDE for n in range(INSIDE + 1)]
        sizes = [at(location) for location in places]
        top = max(range(INSIDE + 1), key=sizes.__getitem__)
        if sizes[top] > best * (1 - NEAR):
            ends = places[max(top - 1, 0)], places[min(top + 1, INSIDE)]
            best = max(best, *(-value for _,
                               value in golden_section(partial(_size, series, sign=-1.0), *ends, HALVED)))
        t, x = t + h, tuple(summed(term, h) for term in series)
        if t >= until:
            return best if all(abs(a - b) <= BACK * best for a, b in zip(x, start)) else None
    return None


def _size(series: list[list[float]], fraction: float, sign: float = 1.0) -> float:
    return sign * math.hypot(*(summed(term, fraction) for term in series))


def parting(form: QuadraticForm, path: Path) -> int:
    """How many of the first points of a path (of `followed`) lie where they are seen to lie, whatever its
    steps left: so many steps of the motion whose start is moved by TERM_TOLERANCE end within SEEN of the
    path's, of the largest rate. A zero stays: what holds a rate at zero holds it in floats too."""
    times, states = path
    width = SEEN * max(abs(v) for x in states for v in x)
    x = tuple(v * (1 + n * TERM_TOLERANCE) for v, n in zip(states[0], APART))
    for end in range(INSIDE, len(times), INSIDE):
        h = times[end] - times[end - INSIDE]
        x = tuple(summed(coefficient, h) for coefficient in coefficients(form, x))
        if not all(abs(a - b) <= width for a, b in zip(x, states[end])):
            return end - INSIDE + 1
    return len(times)


def coefficients(form: QuadraticForm, x: tuple[float, ...], order: int = ORDER) -> list[list[float]]:
    """Three lists: the coefficients of the powers of time from 0 to `order`."""
    kappa, rho, sigma, m = form.coefficients
    a = [[float(v)] for v in x]
    for n in range(order):
        products = [kappa[i] * sum(map(mul, a[j], reversed(a[k]))) + rho[i] * a[k][n] + sigma[i] * a[j][n]
                    + (m[i] if n == 0 else 0.0)
                    for i, (j, k) in enumerate(CYCLE)]
        for item, value in zip(a, products):
            item.append(value / (n + 1))
    return a


def length(series: list[list[float]], smallest: float) -> float:
    """A length over which the last two terms stay below `smallest`; inf where there are none."""
    lengths, order = [], len(series[0]) - 1
    for n in (order - 1, order):
        last = max(abs(term[n]) for term in series)
        if 0 < last < math.inf:
            lengths.append((smallest / last) ** (1 / n))
    return min(lengths, default=math.inf)


def summed(series: list[float], t: float) -> float:
    """The sum of a power series at a time."""
    total = 0.0
    for c in reversed(series):
        total = total * t + c
    return total
