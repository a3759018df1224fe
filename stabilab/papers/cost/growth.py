"""How cost grows: with the number of states, with the digits, and with closeness to the separatrix.

Times are the fastest of a few runs, warmed up; errors, nodes and bits are counted and do not depend on the
machine.
"""
from __future__ import annotations

import math
import time
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...answers.extremes import extremes, period
from ...answers.fate import fate
from ...cost.accuracy import precision
from ...integrate.reference import WORK, Recursion, one_run, pairs, relative_errors
from ...numbers.balls import Unclear, sign, working
from ...numbers.numba_door import installed
from ...orbit.extremes.one_state import extreme_balls, turning_points
from ...orbit.fate.one_state import precise_margin
from ...orbit.landscape import landscape
from ...orbit.one_orbit import Orbit, ball_orbit
from ...orbit.period import period_ball, precise_period
from ...orbit.result import Fate

SEED = 4
STATES = {"fate": (2, 7), "extremes": (2, 5), "period": (2, 5)}  # decades of the number of states
REPORT_DECADE = 6  # the report's quick form stops here
SPREAD = 1.5  # of random states about the case's own
# digits of ball arithmetic; of Taylor series those beyond doubles
MANY = (3, 6, 9, 12, 16, 18, 21, 24, 27, 30)
DOUBLES = 15
DISTANCES = tuple(range(1, 16))  # decades of relative distance in energy to the separatrix
NODE_DIGITS, MOST_NODES = 8, 1 << 15
BITS = range(16, 129, 4)
SLOW, ENOUGH = 1.0, 0.1  # seconds of the first run after which only one follows; seconds of all runs together


@dataclass(frozen=True)
class Growth:
    """One measurement. about: "states", "digits" or "separatrix"; x: how many, how many digits were reached,
    or the relative distance; seconds: of one answer, all states together; count of count_name (nodes, bits,
    states in balls), None where there is none."""

    about: str
    question: str
    method: str
    x: float
    seconds: float
    repeats: int
    count: int | None = None
    count_name: str = ""


def _timed(call, most=30):
    """(answer, fastest, repeats) after one run that warms up; what takes long is run once more only."""
    start = time.perf_counter()
    answer = call()
    first, seconds = time.perf_counter() - start, []
    while len(seconds) < (1 if first > SLOW else most) and (len(seconds) < 2 or sum(seconds) < ENOUGH):
        start = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - start)
    return answer, min(seconds), len(seconds)


# -- with the number of states


def with_states(case, full: bool = False, tell=lambda words: None) -> list[Growth]:
    """Fate, extremes and period of random states (seeded) about the case's own: 1e2 to 1e7 for the fate (1e6
    unless full), to 1e5 for the others (1e4 unless full); fates by NumPy, and by numba where it is
    installed."""
    found = []
    for question, (first, last) in STATES.items():
        for decade in range(first, (last if full else min(last - 1, REPORT_DECADE)) + 1):
            tell(f"{question} of 1e{decade} states")
            states = (np.random.default_rng(SEED).normal(size=(10**decade, 3)) * SPREAD
                      + np.asarray(case.state))
            for engine, options in engines(question):
                answer, seconds, repeats = _timed(partial(_FUNCTIONS[question](), case.scene, states,
                                                          **options))
                precise = (int(answer.precise), "states in balls") if question == "fate" else (None, "")
                found.append(Growth("states", question, engine, len(states), seconds, repeats, *precise))
    return found


def engines(question) -> list[tuple[str, dict]]:
    """(name, keywords) of the ways in which a question about many states is answered here."""
    if question != "fate":
        return [("row by row", {})]
    return [("NumPy", {"fast": False})] + ([("numba", {"fast": True})] if installed() else [])


def _fate():
    return fate


def _extremes():
    return extremes


def _period():
    return period


_FUNCTIONS = {"fate": _fate, "extremes": _extremes, "period": _period}


# -- with the digits


def with_digits(case, effort: str = "brief", tell=lambda words: None) -> list[Growth]:
    """The states over the span by every method, at the digits that it reached; from 16 digits on by Taylor
    series in many digits; and extremes, period and margin by formulas in doubles and by balls. For motions
    that repeat."""
    tell("cost of digits: doubles")
    found = precision(case, effort)
    rows = [Growth("digits", "states over the span", p.method, p.digits, p.seconds, p.repeats, p.evaluations,
                   "evaluations")
            for p in found.of("span") if p.method in ("taylor", "DOP853", "reduced") and 0 < p.digits < 16]
    rows += [Growth("digits", q, "formulas", p.digits, p.seconds, p.repeats) for q in ("extremes", "period")
             for p in found.of(q, "reduced")]
    for digits in MANY:
        tell(f"cost of {digits} digits")
        rows += _many(found.task, found.reference, digits)
    return rows


def _many(task, exact, digits):
    reduction, bits = landscape(task.scene).reduction, math.ceil(digits * math.log2(10))
    if digits > DOUBLES:
        yield _series(task, exact, digits)
    for question, call in (("extremes",
                            lambda: extreme_balls(Orbit(reduction, task.start), Fate.BOUNDED, bits)),
                           ("period", lambda: period_ball(Orbit(reduction, task.start), digits)),
                           ("margin", lambda: precise_margin(Orbit(reduction, task.start), digits))):
        _, seconds, repeats = _timed(call)
        yield Growth("digits", question, "balls", digits, seconds, repeats)


def _series(task, exact, digits) -> Growth:
    spent = []

    def series():
        budget = [WORK]
        run = one_run(Recursion(task.equations), task.start, task.times, digits + 2, budget)
        spent.append(WORK - budget[0])
        return run
    (states, _), seconds, repeats = _timed(series)
    return Growth("digits", "states over the span", "Taylor in many digits",
                  min(_reached(states, exact), digits), seconds, repeats,
                  spent[0], "multiplications")


def _reached(states, exact) -> float:
    """Digits on which a run agrees with the reference, whose own error is the limit."""
    high, low = pairs(states)
    error = relative_errors(high, exact.states, exact.rest - low, exact.slices).max()
    return -math.log10(max(float(error), float(exact.error.max())))


# -- with closeness to the separatrix


def near(case, decade: int) -> tuple[np.ndarray, float]:
    """(state, distance): the case's state with its rate about the torque's axis changed so that its energy
    lies below the barrier by 10^-decade of the barrier's height above a rate of zero, up to the rounding of
    the state; and the distance it then has. For a torque on an axis, no wheel momentum along it."""
    axis = landscape(case.scene).reduction.axis
    state = np.array(case.state, float)
    state[axis] = 0.0
    height = float(fate(case.scene, state).margins)
    weight = 1.0 if case.scene.variables == "scaled" else float(case.scene.body.inertia[axis])
    state[axis] = math.sqrt(2 * height * (1 - 10.0**-decade) / weight)
    return state, float(fate(case.scene, state).margins) / height


def with_closeness(case, tell=lambda words: None) -> list[Growth]:
    """Fate, extremes and period of single states 1e-1 to 1e-15 (relative, in energy) below the separatrix:
    the time, the bits that the fate takes in balls, and the nodes of the plain midpoint rule that the period
    takes for NODE_DIGITS digits."""
    found = []
    for decade in DISTANCES:
        tell(f"1e-{decade} from the separatrix")
        state, distance = near(case, decade)
        for question, function in _FUNCTIONS.items():
            _, seconds, repeats = _timed(partial(function(), case.scene, state))
            count = {"fate": (bits_needed(case.scene, state), "bits"),
                     "period": (nodes_needed(case.scene, state), "nodes")}.get(question, (None, ""))
            found.append(Growth("separatrix", question, "as called", distance, seconds, repeats, *count))
    return found


def bits_needed(scene, state) -> int | None:
    """The least working precision at which the balls of every barrier part from the energy's."""
    for bits in BITS:
        try:
            with working(bits) as numbers:
                for margin in ball_orbit(landscape(scene).reduction, state, numbers).margins():
                    sign(margin)
            return bits
        except Unclear:
            continue
    return None


def nodes_needed(scene, state) -> int | None:
    """Nodes of the midpoint rule, doubled until the period has NODE_DIGITS digits of that in balls; None
    where rounding forbids it."""
    land = landscape(scene)
    orbit, nodes = Orbit(land.reduction, state), 4
    exact = precise_period(orbit, Fate.BOUNDED)

    def ends(one):
        found = turning_points(one)
        return 0.5 * float(found[1] - found[0]), *(one.doubles_at(y) for y in found)
    half, *places = orbit.settled(ends)
    forces = [land.potential.force(place) for place in places]
    while nodes <= MOST_NODES:
        phi = (np.arange(nodes // 2) + 0.5) * (np.pi / nodes)
        way, total = 2 * half * np.sin(0.5 * phi) ** 2, 0.0
        for place, force, y in zip(places, forces, (way, -way)):  # E - V is told from the nearer end
            twice = -2 * land.potential.rise(y, place, force)
            with np.errstate(invalid="ignore"):
                total += 2 * float((half * np.sin(phi) / np.sqrt(twice)).sum()) * np.pi / nodes
        if abs(total - exact) <= 10.0**-NODE_DIGITS * exact:
            return nodes
        nodes *= 2
    return None
