"""How cost grows with the number of states, with the digits, and with closeness to the separatrix, measured,
and its page.

Times are the fastest of a few runs, warmed up; errors, nodes and bits are counted and do not depend on the
machine.
"""
from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import astuple, dataclass, fields
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..answers.motion import motion
from ..answers.motions.rows import extremes, fates, periods
from ..case.read import load
from ..cost.accuracy import precision
from ..integrate.reference import WORK, Recursion, one_run, pairs, relative_errors
from ..numbers.balls import Unclear, sign, working
from ..numbers.numba_door import installed
from ..orbit.extremes import extreme_balls, turning_points
from ..orbit.fate import precise_margin
from ..orbit.landscape import landscape
from ..orbit.one_orbit import Orbit, ball_orbit
from ..orbit.period import period_ball, precise_period
from ..orbit.result import Fate
from ..show import narrow, style
from ..show.data import csv_lines
from ..show.report import html
from ..show.text.cost import caption, duration

if TYPE_CHECKING:
    from ..numbers.vectors import Float3
    from ..physics.scene import Scene

SEED = 4
STATES = {"fate": (2, 7), "extremes": (2, 5), "period": (2, 5)}  # decades of the number of states
REPORT_DECADE = 6  # the report's quick form stops here
SPREAD = 1.5  # of random states about the case's own
# digits of ball arithmetic; of Taylor series those beyond doubles
MANY = (3, 6, 9, 12, 16, 18, 21, 24, 27, 30)
VERY_MANY = (100, 1000, 10_000)  # of formulas alone, each proved; the last where all is measured
DOUBLES = 15
DISTANCES = tuple(range(1, 16))  # decades of relative distance in energy to the separatrix
NODE_DIGITS, MOST_NODES = 8, 1 << 15
TESTED_BITS = range(16, 129, 4)
QUESTIONS: dict[str, Callable[..., Any]] = {"fate": fates, "extremes": extremes, "period": periods}
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


def _timed(call, largest=30):
    """(answer, fastest, repeats) after one run that warms up; what takes long is run once more only."""
    start = time.perf_counter()
    answer = call()
    first, seconds = time.perf_counter() - start, []
    while len(seconds) < (1 if first > SLOW else largest) and (len(seconds) < 2 or sum(seconds) < ENOUGH):
        start = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - start)
    return answer, min(seconds), len(seconds)


# -- with the number of states


def with_states(case, full: bool = False, tell=lambda text: None) -> list[Growth]:
    """Fate, extremes and period of random states (seeded) about the case's own: 1e2 to 1e7 for the fate (1e6
    unless full), to 1e5 for the others (1e4 unless full); fates by NumPy, and by numba where it is
    installed."""
    rows = []
    for question, (first, last) in STATES.items():
        for decade in range(first, (last if full else min(last - 1, REPORT_DECADE)) + 1):
            tell(f"{question} of 1e{decade} states")
            states = (np.random.default_rng(SEED).normal(size=(10**decade, 3)) * SPREAD
                      + np.asarray(case.state))
            for engine, options in engines(question):
                answer, seconds, repeats = _timed(partial(QUESTIONS[question], case.scene, states, **options))
                precise = (int(answer.precise), "states in balls") if question == "fate" else (None, "")
                rows.append(Growth("states", question, engine, len(states), seconds, repeats, *precise))
    return rows


def engines(question) -> list[tuple[str, dict]]:
    """(name, keywords) of the ways in which a question about many states is answered here."""
    if question != "fate":
        return [("row by row", {})]
    return [("NumPy", {"fast": False})] + ([("numba", {"fast": True})] if installed() else [])


# -- with the digits


def with_digits(case, effort: str = "brief", tell=lambda text: None) -> list[Growth]:
    """The states over the span by every method, at the digits that it reached; from 16 digits on by Taylor
    series in many digits; and extremes, period and margin by formulas in doubles and by balls. For motions
    that repeat."""
    tell("cost of digits: doubles")
    result = precision(case, effort)
    rows = [Growth("digits", "states over the span", p.method, p.digits, p.seconds, p.repeats, p.evaluations,
                   "evaluations")
            for p in result.of("span") if p.method in ("taylor", "DOP853", "reduced") and 0 < p.digits < 16]
    rows += [Growth("digits", q, "formulas", p.digits, p.seconds, p.repeats) for q in ("extremes", "period")
             for p in result.of(q, "reduced")]
    for digits in (*MANY, *(VERY_MANY if effort == "full" else VERY_MANY[:-1])):
        tell(f"cost of {digits} digits")
        rows += _many(result.task, result.reference, digits)
    return rows


def _many(task, exact, digits):
    reduction, bits = landscape(task.scene).reduction, math.ceil(digits * math.log2(10))
    if DOUBLES < digits < VERY_MANY[0]:
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
    height = motion(case.scene, state).margin_energy  # by balls: of many states margins have 12 digits
    weight = 1.0 if case.scene.variables == "scaled" else float(case.scene.body.inertia[axis])
    state[axis] = math.sqrt(2 * height * (1 - 10.0**-decade) / weight)
    return state, motion(case.scene, state).margin_energy / height


def with_closeness(case, tell=lambda text: None) -> list[Growth]:
    """Fate, extremes and period of single states 1e-1 to 1e-15 (relative, in energy) below the separatrix:
    the time, the bits that the fate takes in balls, and the nodes of the plain midpoint rule that the period
    takes for NODE_DIGITS digits."""
    rows = []
    for decade in DISTANCES:
        tell(f"1e-{decade} from the separatrix")
        state, distance = near(case, decade)
        for question, function in QUESTIONS.items():
            _, seconds, repeats = _timed(partial(function, case.scene, state))
            count = {"fate": (bits_needed(case.scene, state), "bits"),
                     "period": (nodes_needed(case.scene, state), "nodes")}.get(question, (None, ""))
            rows.append(Growth("separatrix", question, "as called", distance, seconds, repeats, *count))
    return rows


def bits_needed(scene: Scene, state: Float3 | np.ndarray) -> int | None:
    """The least working precision at which the balls of every barrier part from the energy's."""
    for bits in TESTED_BITS:
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

    def ends(item):
        result = turning_points(item)
        return 0.5 * float(result[1] - result[0]), *(item.doubles_at(y) for y in result)
    half, *places = orbit.settled(ends)
    forces = [land.potential.force(location) for location in places]
    while nodes <= MOST_NODES:
        phi = (np.arange(nodes // 2) + 0.5) * (np.pi / nodes)
        route, total = 2 * half * np.sin(0.5 * phi) ** 2, 0.0
        for index, force, y in zip(places, forces, (route, -route)):  # E - V is measured from the nearer end
            twice = -2 * land.potential.rise(y, index, force)
            with np.errstate(invalid="ignore"):
                total += 2 * float((half * np.sin(phi) / np.sqrt(twice)).sum()) * np.pi / nodes
        if abs(total - exact) <= 10.0**-NODE_DIGITS * exact:
            return nodes
        nodes *= 2
    return None


# --- How cost grows, drawn: time against the number of states, the digits, and closeness to the separatrix
LOOKS = {("fate", "NumPy"): {"color": style.BLUE, "marker": "o"},
         ("fate", "numba"): {"color": style.BLUE, "marker": "s", "linestyle": "--"},
         ("extremes", "row by row"): {"color": style.GREEN, "marker": "o"},
         ("period", "row by row"): {"color": style.VERMILION, "marker": "o"},
         ("states over the span", "taylor"): {"color": style.BLUE, "marker": "o"},
         ("states over the span", "DOP853"): {"color": style.VERMILION, "marker": "D"},
         ("states over the span", "reduced"): {"color": style.GREEN, "marker": "P"},
         ("states over the span",
          "Taylor in many digits"): {"color": style.BLUE, "marker": "s", "linestyle": "--"},
         ("extremes", "formulas"): {"color": style.GREEN, "marker": "*", "linestyle": "none", "zorder": 5},
         ("period", "formulas"): {"color": style.ORANGE, "marker": "*", "linestyle": "none", "zorder": 5},
         ("extremes", "balls"): {"color": style.GREEN, "marker": "^", "linestyle": ":"},
         ("period", "balls"): {"color": style.ORANGE, "marker": "v", "linestyle": ":"},
         ("margin", "balls"): {"color": style.PURPLE, "marker": "<", "linestyle": ":"},
         ("fate", "as called"): {"color": style.BLUE, "marker": "o"},
         ("extremes", "as called"): {"color": style.GREEN, "marker": "^"},
         ("period", "as called"): {"color": style.ORANGE, "marker": "v"}}
TITLES = {"states": "Time against the number of states", "digits": "Time against digits",
          "separatrix": "Time against closeness to the separatrix"}
AXES = {"states": "states", "digits": "digits reached",
        "separatrix": "relative distance from the separatrix, in energy"}


def page(case, folder, tell=None, full: bool = False, **around) -> Path:
    """Measure how cost grows about a case (torque on an axis, bounded, no wheel momentum along the torque)
    and write growth.html, growth.csv and three pictures (in growth/) into the folder; returns the page's
    path. full: every decade of states; around: of the pages beside it (`html.render`)."""
    folder, tell = Path(folder), tell or (lambda text: None)
    rows = [*with_states(case, full, tell), *with_digits(case, "full" if full else "brief", tell),
            *with_closeness(case, tell)]
    with style.whole_file(folder / "growth.csv") as waiting:
        waiting.write_text(csv(rows), encoding="utf-8")
    pictures = []
    for about in TITLES:
        with style.drawing() as plt:
            paths = narrow.save_both(picture(plt, [r for r in rows if r.about == about], about),
                                     folder / "growth" / f"{about}.png")
        pictures.append(html.picture(*paths, "growth/", title=TITLES[about], words=words(rows, about)))
    return html.write(folder / "growth.html", "growth.html", pictures=pictures, machine=caption(),
                      case=case.name, full=full, **around)


def csv(rows) -> str:
    """One line per measurement; empty where there is no count."""
    return csv_lines([[f.name for f in fields(Growth)], *map(astuple, rows)])


def picture(plt, rows, about):
    """Seconds against x, a line per question and method; for closeness a second panel with bits and nodes."""
    panels = 2 if about == "separatrix" else 1
    figure, axes = plt.subplots(1, panels, figsize=(5.6 * panels + 1.6, 5.0), layout="constrained",
                                squeeze=False)
    groups = {}
    for row in rows:
        groups.setdefault((row.question, row.method), []).append(row)
    ax = axes[0][0]
    ax.set(yscale="log", xlabel=AXES[about], ylabel="time (s)", title=TITLES[about],
           xscale="log")
    for key, points in groups.items():
        points = sorted(points, key=lambda r: r.x)
        ax.plot([r.x for r in points], [r.seconds for r in points], markersize=5, linewidth=1.3, **LOOKS[key])
    if about == "digits":
        ax.axvspan(15.95, max(r.x for r in rows) * 1.1, color="#EEEEEE", zorder=0)
        ax.annotate("more than a double holds", (16.2, 0.985), xycoords=("data", "axes fraction"), va="top",
                    fontsize=8, color=style.GREY)
    if panels == 2:
        _counts(axes[0][1], groups)
    if about == "separatrix":
        for item in axes[0]:
            item.invert_xaxis()
    style.legend(figure, [(", ".join(dict.fromkeys((q, m) if m != "as called" else (q,))), LOOKS[q, m])
                          for q, m in groups], columns=3)
    return figure


def _counts(ax, groups):
    ax.set(xscale="log", yscale="log", xlabel=AXES["separatrix"], ylabel="bits, nodes",
           title=f"Bits for the fate, nodes for {NODE_DIGITS} digits of the period")
    for (question, method), points in groups.items():
        resolved = [r for r in points if r.count is not None]
        if resolved:
            ax.plot([r.x for r in resolved], [r.count for r in resolved], markersize=5, linewidth=1.3,
                    **LOOKS[question, method])


def words(rows, about) -> str:
    """What the picture shows, with its numbers."""
    mine = [r for r in rows if r.about == about]
    pick = lambda question, method=None: sorted((r for r in mine if r.question == question
                                                 and method in (None, r.method)), key=lambda r: r.x)
    if about == "states":
        ends = [(q, m, pick(q, m)) for q, m in dict.fromkeys((r.question, r.method) for r in mine)]
        return ("Random states (seeded). "
                + "; ".join(f"{q}, {m}: {duration(p[0].seconds / p[0].x)} a state at {p[0].x:,.0f}, "
                f"{duration(p[-1].seconds / p[-1].x)} at {p[-1].x:,.0f}" for q, m, p in ends) + ".")
    if about == "digits":
        many, periods = pick("states over the span", "Taylor in many digits"), pick("period", "balls")
        return (f"A Taylor series in many digits takes {duration(many[0].seconds)} for {many[0].x:.0f} "
                f"digits and {duration(many[-1].seconds)} for {many[-1].x:.0f}: the order grows with the "
                "digits, a product of two series with its square. A formula in balls takes for the period "
                f"{duration(periods[0].seconds)} for {periods[0].x:,.0f} digits and "
                f"{duration(periods[-1].seconds)} for {periods[-1].x:,.0f}.")
    fates, periods = pick("fate"), pick("period")
    nodes = [r for r in reversed(periods) if r.count is not None]
    lost = ("" if len(nodes) == len(periods)
            else (
                f"; nearer than {nodes[-1].x:.0e} the rule in doubles does not get there at all, and balls "
                f"answer"))
    return (f"From 1e-1 to 1e-15 the fate's time goes from {duration(fates[-1].seconds)} to "
            f"{duration(fates[0].seconds)}, and its bits in balls from {fates[-1].count} to "
            f"{fates[0].count}: a state is as hard as its margin is small. The period itself grows like the "
            f"logarithm of the distance; the midpoint rule takes {nodes[0].count} nodes at 1e-1 and "
            f"{nodes[-1].count} at {nodes[-1].x:.0e}{lost}.")


def main(case, folder) -> None:
    """The whole measurement, every decade of states and every setting: minutes."""
    print(page(load(case), folder, full=True))


if __name__ == "__main__":
    import sys
    main(*sys.argv[1:3])
