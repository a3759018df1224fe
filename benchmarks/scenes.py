"""Every question on a sample of random scenes of every kind, each scene beside what a careful user of the
general tools would write, and beside single states in balls.

python -m benchmarks.scenes [SCENES [FIRST]]: prints the rows on so many scenes of the sample, from the number
FIRST on; one line a scene goes to stderr, and Ctrl-C ends the sample. Times are processor times of one
thread, each contestant warmed up, in turn on the same states; compiled loops are loaded before.
"""
from __future__ import annotations

import math
import statistics
import sys
import time
from dataclasses import dataclass
from functools import partial

import numpy as np

from stabilab import Fate, extremes, fate, period, separatrix
from stabilab.answers.motions.compiling import rows as load_compiled_loops
from stabilab.orbit.extremes import precise_extremes
from stabilab.orbit.extremes_arrays import extremes_and_periods
from stabilab.orbit.fate import fate_of
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.period import precise_period
from stabilab.orbit.reduction import reduce
from stabilab.show.surface import triangulate

from .contestants import BatchFate, SceneEvents, TurningTimes
from .pages import amount
from .random_scenes import EVERY, Drawn, of_every_kind
from .rows import Row

STATES = 20_000     # of ours; theirs are asked of `SAMPLE` of them
SAMPLE = 24
# bounded motions at least: where a scene has few, of as many states as it takes, for a call has costs of its
# own
HELD = 1000
DRAWS = 500         # times that states are drawn for that
# of the kinetic energy: nearer to the separatrix heyoka's run may pass it by rounding, and never ends
CLEAR = 1e-6
ROUNDS = 3
# of heyoka's batch of all states, and of a single run: where a turn takes longer, as with moments that are
# equal to 1e-13, the run is given up, and the ratio is one that is exceeded
BATCH_STEPS, RUN_STEPS = 8_000, 1_000
PATIENCE = 1.5      # s for a call: of slower questions fewer states are asked
LONG = 0.05         # s
CELLS = 256         # of Flying Edges along each side
IN_BALLS = 12       # states of each scene, half of them beside the separatrix, and as many bounded ones
KEYS = {"first call of fate less the next": "first", "fate": "fate", "extremes": "extremes",
        "period": "period", "separatrix surfaces": "surface", "fate of one state in balls": "fate-balls",
        "extremes of one state in balls": "extremes-balls", "period of one state in balls": "period-balls"}
WANTED = {"fate": 100, "extremes": 5, "period": 2,
          "separatrix surfaces": 5}
# what arrays may be off by, relative: a margin to the kinetic energy about the axis and the barrier
DIGITS = {"fate of one state in balls": 1e-12, "extremes of one state in balls": 1e-12,
          "period of one state in balls": 1e-11}


@dataclass(frozen=True)
class Measured:
    """One question on one scene: seconds a piece of ours and of theirs, or in balls, what answers of arrays
    are off by there, and how many of them are undecided or differ in their label."""

    question: str
    scene: str
    ours: float
    theirs: float = float("nan")
    off: float = 0.0
    wrong: int = 0

    @property
    def ratio(self) -> float:
        """How much faster ours is; NaN where the other gave none."""
        return self.theirs / self.ours


def measurements(small=False):
    return [partial(rows, small)]


def rows(small=False, scenes=EVERY, first=0, told=None) -> list[Row]:
    """One row a question, one for a scene's first call, and one for each question in balls."""
    load_compiled_loops()
    measured, failed = [], []
    try:
        for one in of_every_kind(3 if small else scenes, first):
            try:
                measured += _scene(one, small, told)
            except Exception as error:  # the other scenes are measured all the same
                failed.append(f"number {one.number} failed: {type(error).__name__}: {error}")
                print(failed[-1], file=sys.stderr)
    except KeyboardInterrupt:
        if told is None:
            raise
        print("ended by Ctrl-C", file=told)
    return [(_row_in_balls if question in DIGITS else _row)(question, rows, failed)
            for question in KEYS if (rows := [m for m in measured if m.question == question])]


def _row(question, found, failed) -> Row:
    ours = sorted(found, key=lambda m: m.ours)
    known = sorted((m for m in found if m.theirs == m.theirs), key=lambda m: m.ratio)
    ninety = ours[min(len(ours) - 1, int(0.9 * len(ours)))]
    median = statistics.median(m.ours for m in ours)
    key, what = f"scenes-{KEYS[question]}", f"{len(found)} random scenes, {question}, median"
    note = "; ".join([f"processor time; 90 % within {amount(ninety.ours, 's')}, the slowest in "
                      f"{amount(ours[-1].ours, 's')}: {ours[-1].scene}", *failed])
    undecided = f"{sum(m.wrong for m in found)} undecided" if question == "fate" else ""
    if not known:
        return Row(key, what, median, error=undecided, note=note)
    reached = sum(m.ratio >= WANTED[question] for m in known)
    return Row(key, what, median, "each", statistics.median(m.theirs for m in known),
               f"{OTHERS[question]}, median", statistics.median(m.ratio for m in known), known[0].ratio,
               known[-1].ratio, undecided, WANTED[question],
               f"{note}; wanted on every scene, reached on {reached} of the {len(known)} where the other "
               f"answers{GIVEN_UP.get(question, '')}; least ratio: {known[0].scene}")


def _row_in_balls(question, found, failed) -> Row:
    worst, limit = max(found, key=lambda m: m.off), DIGITS[question]
    reached = sum(m.off <= limit for m in found)
    wrong = f"; {sum(m.wrong for m in found)} labels differ" if question.startswith("fate") else ""
    note = "; ".join([f"arrays wanted within {limit:g} of it on every scene, reached on {reached} of "
                      f"{len(found)}; farthest off: {worst.scene}", *failed])
    return Row(f"scenes-{KEYS[question]}", f"{len(found)} random scenes, {question}, median",
               statistics.median(m.ours for m in found), note=note,
               error=f"arrays are off by {worst.off:.2g} of it at most{wrong}")


GIVEN_UP = {"fate": f" (given up after {BATCH_STEPS} steps of its batch)",
            **dict.fromkeys(("extremes", "period"), f" (given up after {RUN_STEPS} steps of a state)")}
OTHERS = {"fate": "heyoka batch with compaction", "extremes": "heyoka with events",
          "period": "heyoka with events at the turns only",
          "separatrix surfaces": f"Flying Edges at {CELLS}^3, field and contour"}


def _scene(one: Drawn, small, told):
    """What is measured of one scene."""
    found, rounds = [], 1 if small else ROUNDS
    scene, states = one.scene, one.states(600 if small else STATES)
    name = f"number {one.number}, {one.name}"
    at = time.process_time()
    decided = fate(scene, states)
    first = time.process_time() - at
    clear = np.abs(decided.margins) > CLEAR * (states**2).sum(axis=1)
    part = states[clear][:8 if small else SAMPLE]
    batch = BatchFate(scene, steps=BATCH_STEPS)
    # along a straight line there is no turn to count, and its runs decide nothing
    theirs = _pace(batch, part, rounds) if (batch(part) >= 0).any() else math.nan
    ours = _pace(lambda x: fate(scene, x), states, rounds)
    found.append(Measured("first call of fate less the next", name, max(first - ours * len(states), 1e-6)))
    found.append(Measured("fate", name, ours, theirs, wrong=int((decided.labels == Fate.UNDECIDED).sum())))
    bounded = decided.labels == Fate.BOUNDED
    held, part = states[bounded], states[bounded & clear][:8 if small else SAMPLE]
    if not small:
        held = _enough(one, held)
    if len(part) > 3:
        for question, ask, other in (("extremes", extremes, SceneEvents(scene, steps=RUN_STEPS)),
                                     ("period", period, TurningTimes(scene, steps=RUN_STEPS))):
            theirs = _pace(other, part, rounds)
            ours = _patient(lambda x, ask=ask: ask(scene, x), held, rounds)
            found.append(Measured(question, name, ours, theirs))
    found += _surface(scene, name, rounds, 24 if small else CELLS)
    found += _in_balls(scene, name, np.concatenate([one.beside(states[:IN_BALLS]), held[-IN_BALLS:]]))
    if told:
        print(one.number, one.kind, ", ".join(
            f"{m.question} {amount(m.ours, 's')} ({m.off if m.question in DIGITS else m.ratio:.3g})"
            for m in found), file=told, flush=True)
    return found


def _in_balls(scene, name, states) -> list[Measured]:
    """Each state alone in balls, and what arrays are off by."""
    r, many, (boxes, periods) = reduce(scene), fate(scene, states), extremes_and_periods(scene, states)
    times, off, wrong = np.zeros(3), np.zeros(3), 0
    for n, state in enumerate(states.tolist()):
        orbit = Orbit(r, state)
        at = [time.process_time()]
        alone = fate_of(scene, orbit)
        at.append(time.process_time())
        box = precise_extremes(orbit, alone.label)
        at.append(time.process_time())
        once = precise_period(orbit, alone.label)
        at.append(time.process_time())
        times += np.diff(at)
        wrong += alone.label != many.labels[n]
        kinetic = 0.5 * float(r.weight) * (state[r.axis] + float(r.s)) ** 2
        off = np.maximum(off, [_apart(many.margins[n], alone.margin, kinetic + abs(kinetic + alone.margin)),
                               max(_apart(*pair, np.abs(both[np.isfinite(both)]).max(initial=0.0))
                                   for ends, both in zip(boxes[n], box) for pair in zip(ends, both)),
                               _apart(periods[n], once)])
    return [Measured(question, name, times[n] / len(states), off=off[n], wrong=wrong)
            for n, question in enumerate(DIGITS)]


def _apart(value, exact, size=0.0) -> float:
    """By how much of the exact number, or of a size, a value is off; infinite where one alone is no number.
    """
    if not (math.isfinite(value) and math.isfinite(exact)):
        return 0.0 if value == exact or (math.isnan(value) and math.isnan(exact)) else math.inf
    return abs(value - exact) / (size or abs(exact)) if value != exact else 0.0


def _enough(one, held):
    """At least `HELD` bounded states of the scene's own sort, beginning with these."""
    found = [held]
    for again in range(1, DRAWS):
        if not sum(map(len, found)) or sum(map(len, found)) >= HELD:
            break
        more = one.states(STATES, again)
        found.append(more[fate(one.scene, more).labels == Fate.BOUNDED])
    return np.concatenate(found)


def _patient(call, states, rounds) -> float:
    """`_pace` over so many of the states that a call lasts no longer than `PATIENCE`."""
    for count in (2000, len(states)):
        part = states[:count]
        each = _pace(call, part, 1 if count < len(states) else rounds)
        if each * min(10 * count, len(states)) > PATIENCE:
            break
    return each


def _pace(call, states, rounds) -> float:
    """Processor time a state, s, the median of the rounds after one to warm up; one round where a call is
    long."""
    call(states[:6000])  # more than from where on tables and compiled loops serve
    times = [_time_of(lambda: call(states))]
    times += [_time_of(lambda: call(states)) for _ in range(rounds - 1) if times[0] < LONG]
    return statistics.median(times) / len(states)


def _time_of(call) -> float:
    at = time.process_time()
    call()
    return time.process_time() - at


def _surface(scene, name, rounds, cells):
    """The mesh of the separatrix at the error of Flying Edges on a grid of margins in the box that its
    branches fill."""
    whole = separatrix(scene, accuracy=None, shape=(12, 17))
    if not whole.branches:
        return []
    points = np.concatenate([branch.points.reshape(-1, 3) for branch in whole.branches])
    axes = [np.linspace(low, high, cells) for low, high in zip(points.min(axis=0), points.max(axis=0))]
    at = time.process_time()
    theirs = _contour(scene, axes)
    their_time = time.process_time() - at
    error = _error(scene, theirs, max(axis[1] - axis[0] for axis in axes))
    ours = statistics.median(_time_of(partial(_mesh, scene, error)) for _ in range(rounds + 1))
    return [Measured("separatrix surfaces", name, ours, their_time)]


def _mesh(scene, accuracy):
    return [triangulate(branch) for branch in separatrix(scene, accuracy=accuracy).branches]


def _contour(scene, axes):
    """Flying Edges on margins: as the margin falls by the energy along the torque's axis, one plane of fates
    fills the box."""
    import pyvista
    i = next(k for k in range(3) if scene.vector("constant_torque")[k])
    plane = np.zeros([1 if k == i else len(axis) for k, axis in enumerate(axes)] + [3])
    for k, axis in enumerate(axes):
        plane[..., k] = 0.0 if k == i else axis.reshape([-1 if m == k else 1 for m in range(3)])
    gap = fate(scene, plane).margins
    gap = np.where(np.isfinite(gap), gap,
                   -1e3 * np.abs(gap[np.isfinite(gap)]).max(initial=1.0)).astype(np.float32)
    energy = 0.5 * float(scene.body.exact[i]) * axes[i].reshape([-1 if m == i else 1 for m in range(3)]) ** 2
    grid = pyvista.ImageData(dimensions=[len(axis) for axis in axes],
                             spacing=[axis[1] - axis[0] for axis in axes], origin=[axis[0] for axis in axes])
    grid["margin"] = (gap - energy.astype(np.float32)).ravel(order="F")
    return grid.contour([0.0], scalars="margin", method="flying_edges")


def _error(scene, contour, cell, sample=400) -> float:
    """Largest distance of a contour's points from the surface, to first order, at a sample; a cell at most,
    which is the error at a fold."""
    points = np.random.default_rng(1).permutation(np.asarray(contour.points, float))[:sample]
    if not len(points):
        return cell
    step = 1e-4 * cell
    with np.errstate(all="ignore"):
        gradient = np.stack([(fate(scene, points + d).margins - fate(scene, points - d).margins) / (2 * step)
                             for d in step * np.eye(3)], axis=-1)
        off = np.abs(fate(scene, points).margins) / np.linalg.norm(gradient, axis=-1)
    off = off[np.isfinite(off)]
    return float(min(off.max(initial=0.0) or cell, cell))


if __name__ == "__main__":
    for row in rows(scenes=int(sys.argv[1]) if sys.argv[1:] else EVERY,
                    first=int(sys.argv[2]) if sys.argv[2:] else 0, told=sys.stderr):
        print(f"{row.what}: {amount(row.ours, 's')}, ratio {row.ratio} "
              f"({row.low} to {row.high}); {row.note}")
