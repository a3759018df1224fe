"""Wild scenes: moments equal to the last digit, needles and discs, wheels and torques over sixteen decades,
states at rest, at equilibria, beside separatrices and on invariant planes; tidy ones of the small numbers
that people write, where much is met exactly; and how far the ways to one answer part, in units of what they
promise.
"""
from __future__ import annotations

import math

import numpy as np

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene
from stabilab.answers.digits import ask
from stabilab.answers.motion import Needs
from stabilab.answers.motion import motion as motion_of
from stabilab.orbit.extremes_arrays import extremes_and_periods
from stabilab.orbit.fate import REASONS, Basis
from stabilab.orbit.landscape import landscape
from tests.hunt.disagreements import between

MARGIN, DIGITS = 1e-12, 1e-11  # promised of a margin (of its terms), and of extremes and periods
TIDY = ((2, 2, 3), (2, 2, 2), (2, 3, 4), (3, 4, 5), (2, 2, 1), (1, 1, 2), (1, 2, 3), (2, 1.5, 1), (4, 4, 3))
SHAPES = ("any", "any", "near", "twins", "equal", "sphere", "needle", "disc")
STATES = ("any", "any", "wide", "few", "still", "equilibrium", "brink", "brink", "plane")


def size(rng, decades=8.0):
    """A number of either sign over twice so many decades."""
    return float(rng.choice([-1, 1]) * 10.0 ** rng.uniform(-decades, decades))


def wild_scene(rng):
    """A scene whose motions have a reduction, or no torque."""
    decades = float(rng.choice([0.5, 2.0, 8.0]))
    pace = 10.0 ** rng.uniform(-3, 3) if rng.random() < 0.3 else 1.0
    if rng.random() < 0.15:
        a = size(rng, decades)
        mu = np.zeros(3)
        mu[rng.integers(1, 3)] = size(rng, decades) * (rng.random() < 0.9)
        return ScaledGyrostat(a, a + size(rng, min(decades, 4.0)) * rng.integers(0, 2), tuple(mu.tolist()))
    D, axis, momentum, torque = _moments(rng), int(rng.integers(3)), np.zeros(3), np.zeros(3)
    acting = rng.random() < 0.75
    for i in range(3):
        if rng.random() < 0.6 and not (acting and i == axis):
            momentum[i] = size(rng, decades) * pace
    torque[axis] = size(rng, decades) * pace * pace * acting
    return Scene(Body(D.tolist()), Gyrostat(momentum.tolist()), ConstantTorque(torque.tolist()))


def _moments(rng):
    shape, (a, b, c) = rng.choice(SHAPES), rng.uniform(1, 2, 3)
    D = {"any": (a, b, c), "near": (a, a * (1 + 10.0 ** rng.uniform(-9, -7)), c),
         "twins": (a, a * (1 + 2.0**-50), c), "equal": (a, a, c),
         "sphere": (a, a, a),
         "needle": (a, a * (1 + 1e-9 * rng.integers(0, 2)), a * 10.0 ** rng.uniform(-8, -2)),
         "disc": (a, b, (a + b) * (1 - 10.0 ** rng.uniform(-15, -2)))}[shape]
    return rng.permutation(D) * (10.0 ** rng.uniform(-6, 6) if rng.random() < 0.2 else 1.0)


def tidy_scene(rng):
    """A scene of halves, quarters and small integers whose motions have a reduction, or no torque."""
    if rng.random() < 0.2:
        a, b, mu = _small(rng), _small(rng), np.zeros(3)
        mu[rng.integers(1, 3)] = _small(rng)
        return ScaledGyrostat(a, b, tuple(mu.tolist()))
    D, axis, momentum, torque = rng.permutation(TIDY[rng.integers(len(TIDY))]), int(
        rng.integers(3)), np.zeros(3), np.zeros(3)
    torque[axis] = _small(rng) * (rng.random() < 0.75)
    for i in range(3):
        if rng.random() < 0.5 and not (torque[axis] and i == axis):
            momentum[i] = _small(rng)
    return Scene(Body(D.tolist()), Gyrostat(momentum.tolist()), ConstantTorque(torque.tolist()))


def _small(rng):
    return float(rng.integers(-3, 4)) / float(rng.choice([1, 1, 2, 4]))


def tidy_state(rng, scene):
    """Three floats of that kind, zeros among them; of any scene."""
    return (rng.integers(-4, 5, 3) / rng.choice([1, 1, 2, 4]) * (rng.random(3) < 0.75)).tolist()


def wild_state(rng, scene):
    """A state of one of the kinds of `STATES`, three floats."""
    kind, land = rng.choice(STATES), landscape(scene)
    unit = 10.0 ** rng.uniform(-8, 8) if kind == "wide" else 10.0 ** rng.uniform(-1, 1)
    state = rng.normal(size=3) * unit
    if kind == "few":
        state = state * rng.integers(0, 2, 3)
    elif kind == "still":
        state = np.zeros(3)
    elif kind == "equilibrium":
        state = _equilibrium(rng, scene, state)
    elif land is not None and kind == "brink":
        state = _brink(rng, scene, land.reduction.axis, state)
    elif land is not None and kind == "plane" and land.e > 0:
        g, r = land.reduction.constants, land.reduction
        state[r.j], state[r.k] = (float(rng.choice([-1, 1])) * g["rx"] * unit - g["sj"],
                                  g["rz"] * unit - g["sk"])
    return state.tolist()


def _equilibrium(rng, scene, otherwise):
    found = stabilab.equilibria(scene)
    places = [p.at for p in found.points] + [s.at for c in found.curves for s in c.samples]
    return np.array(places[rng.integers(len(places))]) if places else otherwise


def _brink(rng, scene, axis, state):
    """The rate about the axis with which the motion just reaches its barrier, off by 1e-3 to 1e-15."""
    still = np.array(state)
    still[axis] = 0.0
    margin = float(stabilab.fate(scene, still).margins)
    if not 0 < margin < math.inf or not landscape(scene).sense:
        return state
    weight = 1.0 if scene.variables == "scaled" else float(scene.body.inertia[axis])
    still[axis] = (rng.choice([-1, 1]) * math.sqrt(2 * margin / weight)
                   * (1 + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-15, -3)))
    return still


# -- comparisons: each gives what is wrong, in words


def energies(scene, state, margin):
    """What a margin's digits are promised of: the kinetic energy (of the torque's axis, or the whole) and the
    barrier's height over it."""
    acting = [i for i, m in enumerate(scene.quadratic().m) if m]
    if scene.variables == "scaled":
        own = 0.5 * state[acting[0] if acting else 2] ** 2
    else:
        own = (0.5 * sum(float(d) * v * v for i,
                         (d, v) in enumerate(zip(scene.body.exact, state)) if not acting or i in acting))
    return own + abs(own + margin)


def margins_part(scene, state, one, other, promise=2 * MARGIN) -> bool:
    one, other = (math.inf if m is None else float(m) for m in (one, other))
    if math.isfinite(one) and math.isfinite(other):
        return not abs(one - other) <= promise * energies(scene, state, one)
    return math.isfinite(one) != math.isfinite(other)


def pairs_part(one, other, promise=2 * DIGITS) -> bool:
    return any(between(a, b, "", promise)[0] > 1 for a, b in zip(one, other))


def times_part(one, other, promise=2 * DIGITS) -> bool:
    one, other = (math.inf if t is None or t == 0 else float(t) for t in (one, other))
    return not (one == other or abs(one - other) <= promise * abs(one))


def disagreements(scene, states, fast, with_digits):
    """In words, with the state: what arrays (NumPy and compiled) and many digits say otherwise than one state.
    """
    free = landscape(scene) is None  # its extremes come from a run
    array = np.array(states)
    many, times = stabilab.fate(scene, array), None
    if not free:
        times = {way: extremes_and_periods(scene, array, by_numba=way) for way in fast}
    ones = [motion_of(scene, state, needs=Needs.QUICK) for state in states]
    for n, (state, one) in enumerate(zip(states, ones)):
        for wrong in [*_against_arrays(scene, state, one, many, n),
                      *(_against_boxes(one, times, n) if times else ())]:
            yield [v.hex() for v in state], wrong
    if with_digits:
        n = int(with_digits) % len(states)
        if times:
            yield from _periods_apart(scene, states, times[fast[0]][1])
        yield from (([v.hex() for v in states[n]], wrong)
                    for wrong in _against_digits(scene, states[n], ones[n], free))


def _against_arrays(scene, state, one, many, n):
    label, words = Fate(int(many.labels[n])), str(REASONS[Basis(int(many.reasons[n]))])
    if (one.fate, one.axis, one.sense) != (label, many.axis[n],
                                           many.sense[n]) or not one.because.startswith(words):
        yield (
            f"one state: {one.fate.word} {one.axis} {one.sense}, {one.because}; arrays: {label.word} "
            f"{many.axis[n]} {many.sense[n]}, {words}")
    if margins_part(scene, state, many.margins[n], one.margin_energy):
        yield f"margin {one.margin_energy!r}, arrays {float(many.margins[n])!r}"


def _against_boxes(one, times, n):
    for way, (boxes, periods) in times.items():
        if pairs_part(one.extremes, boxes[n]):
            yield f"extremes {one.extremes}, arrays (fast={way}) {boxes[n].tolist()}"
        if one.fate == Fate.BOUNDED and not periods[n] > 0 or one.fate != Fate.BOUNDED and 0 < periods[
            n] < math.inf:
            yield f"period of arrays (fast={way}) {periods[n]!r}, {one.fate.word}"
    first, *rest = (periods[n] for _, periods in times.values())
    if any(times_part(first, other) for other in rest):
        yield f"periods by the two ways: {first!r}, {rest}"


def _periods_apart(scene, states, periods):
    for state, many in zip(states, periods):
        one = stabilab.motion(scene, state).period
        if one is not None and times_part(one, many):
            yield [v.hex() for v in state], f"period of one state {one!r}, of arrays {float(many)!r}"


def _against_digits(scene, state, one, free):
    told = ask("fate", scene, state, 30)
    if told.values is not None and margins_part(scene, state, told.values, one.margin_energy, MARGIN):
        yield f"margin {one.margin_energy!r}, 30 digits {told.decimals}"
    if told.digits is not None and told.digits < 30:
        yield f"margin: {told.digits} digits of 30, {told.because}"
    if free or one.fate == Fate.SEPARATRIX:
        return
    told = ask("extremes", scene, state, 30)
    if told.digits < 30 or pairs_part(told.values, one.extremes, DIGITS):
        yield f"extremes {one.extremes}, 30 digits {told.decimals}, {told.because}"
    if one.fate == Fate.BOUNDED:
        told, period = ask("period", scene, state, 30), float(stabilab.period(scene, np.array(state)))
        if told.digits is not None and (told.digits < 30 or times_part(told.values, period, DIGITS)):
            yield f"period {period!r}, 30 digits {told.decimals}, {told.because}"
