"""What accuracy costs: every way to follow one motion, over a ladder of settings, against a reference that
knows its error.

Error: the largest relative error over the asked-for times (each block of the state against its largest size),
or of the derived answer. Cost: steps, evaluations and processor time; the fastest of several runs, warmed up;
what is done once for all runs (compiling) apart.
"""
from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from ..errors import InputError
from ..integrate.reference import WORK, Recursion, Reference, one_run, pairs, reference, relative_errors
from ..integrate.to_heyoka import compiled_anew
from ..integrate.trajectory import SCIPY_METHODS
from ..physics.coefficients import limits_of
from .loading import loading
from .many_digits import Digits, with_many_digits
from .methods import Answer, Method, Problem, answer_methods, fate_methods, known_period, methods, problem

TIMES = 16  # states over the span
QUESTIONS = {"span": "states over the span", "end": "state at the end", "extremes": "extremes",
             "period": "period"}
PRICED = 2.0  # digits: over less, a price of one says nothing
EPS = 2.0**-53
WANTED = (3, 6, 9, 12, 15, 30)  # digits whose price is told


@dataclass(frozen=True)
class Effort:
    """How much is measured. work: of the reference, multiplications; evaluations: a rung that would need
    more, by the growth from rung to rung, is left out; every: rungs of a ladder; repeats: runs of a rung, and
    seconds after which fewer do; digits: seconds that a run in very many digits may take; ends: whether the
    state at the end is asked for besides those over the span; without: methods that are left out.
    """

    work: int
    evaluations: int
    every: int
    repeats: tuple[int, float]
    digits: float
    ends: bool = True
    without: tuple[str, ...] = ()


EFFORTS = {"full": Effort(WORK, 60_000, 1, (7, 0.2), 90.0),
           "quick": Effort(WORK // 4, 12_000, 3, (3, 0.05), 2.0),
           "brief": Effort(WORK // 12, 4_000, 3, (2, 0.01), 0.3, False),
           "glance": Effort(WORK // 24, 2_000, 3, (2, 0.005), 0.1, False,
                            ("taylor-batch", "RK45", "RK23", "Radau", "BDF"))}


@dataclass(frozen=True)
class Point:
    """One setting of one method on one question.

    error: relative; seconds: fastest run (for one of `lanes` motions followed at once), slowest: the slowest
    of `repeats`; compile: seconds of what is done once a setting, loading: once a process, the integrator's
    import and the start of its compiler; opening: of the run that comes first. setting: what `value` is
    (rtol, nodes, order; formula: nothing). parts: the blocks of the state that the method knows; "" for all.
    """

    question: str
    method: str
    setting: str
    value: float
    error: float
    steps: int | None
    evaluations: int | None
    seconds: float
    slowest: float
    repeats: int
    compile: float
    lanes: int = 1
    parts: str = ""
    loading: float = 0.0
    opening: float = 0.0

    @property
    def first(self) -> float:
        """Seconds of a first run in a process: import, compiling and the run."""
        return self.loading + self.compile + max(self.opening, self.seconds)

    @property
    def digits(self) -> float:
        """Correct digits; 0 where nothing is right or no answer came."""
        return max(0.0, -math.log10(self.error)) if 0 < self.error < 1 else 0.0 if self.error else math.inf


@dataclass(frozen=True)
class FateAnswer:
    """One way to the fate: its word and the seconds it takes."""

    method: str
    word: str
    seconds: float
    slowest: float
    repeats: int


@dataclass(frozen=True)
class Precision:
    """All that was measured of a case.

    times (n,): where states are compared, as far as the reference agrees with itself; reference: without its
    states in outputs; reference_seconds: of both its runs; sensitivity: relative change of the state over
    the span per relative change of the start, as one random (seeded) change in the last place shows it, None
    where not known. left_out: (method, value, why). many: what digits
    beyond doubles cost where formulas give them.
    """

    case: Any
    task: Problem = field(repr=False)
    times: np.ndarray
    reference: Reference = field(repr=False)
    points: tuple[Point, ...]
    fates: tuple[FateAnswer, ...]
    sensitivity: float | None
    left_out: tuple[tuple, ...]
    effort: str
    reference_seconds: float = math.nan
    many: tuple[Digits, ...] = ()

    @property
    def quick(self) -> bool:
        return self.effort != "full"

    @property
    def validity(self):
        """Of the scene's approximate laws at the times compared; None where all are exact."""
        limits = limits_of(self.case.scene)
        if limits is None or not len(self.reference.t):
            return None
        return limits.along(self.case.scene, {name: self.reference.states[:, part] for name,
                                              part in self.task.slices.items()}, "at the times compared")

    def of(self, question: str, method: Method | str | None = None) -> list[Point]:
        """The points of a question (and a method), coarse to fine."""
        return [p for p in self.points if p.question == question and method in (None, p.method)]

    @property
    def questions(self) -> list[str]:
        return [q for q in QUESTIONS if self.of(q)]

    def front(self, question: str = "end") -> list[Point]:
        """The points that no other beats in both error and time, cheapest first. The batch stands apart: it
        needs several motions at once."""
        return pareto(p for p in self.of(question) if p.lanes == 1 and not p.parts)

    def cheapest(self, digits: float, question: str = "span", once: bool = False) -> list[Point]:
        """Of each method that has so many digits its cheapest point, cheapest first; without the batch and
        what knows a part of the state only. once: of a first run, else of one that is repeated."""
        best: dict[str, Point] = {}
        for p in sorted(self.of(question), key=lambda p: p.first if once else p.seconds):
            if p.digits >= digits and p.lanes == 1 and not p.parts:
                best.setdefault(p.method, p)
        return list(best.values())


def pareto(points) -> list[Point]:
    """Points that no other beats in both error and seconds, cheapest first."""
    best, result = math.inf, []
    for p in sorted(points, key=lambda p: (p.seconds, p.error)):
        if p.error < best and p.error < 1:
            result.append(p)
            best = p.error
    return result


def digit_price(points) -> float | None:
    """Factor in time for one more digit, by least squares of log time on digits over points where digits
    still grow."""
    rows, top = [], 0.0
    for p in points:
        if p.digits > top + 0.2:
            rows.append((p.digits, math.log(p.seconds)))
            top = p.digits
    if len(rows) < 2 or rows[-1][0] - rows[0][0] < PRICED:
        return None
    digits, logs = np.array(rows).T
    return float(math.exp(np.polyfit(digits, logs, 1)[0]))


def precision(case, effort: str = "full", until: float | None = None, progress=None) -> Precision:
    """Measure a case. effort: "full" (a minute), "quick" (few settings, small limits), "brief" (seconds) or
    "glance" (a second, the methods that are likely to be best). until: end of the span in place of the case's
    own. progress(words) is called before each method.

    Raises InputError for a case without a motion and a span, for an end that is not above zero, and for rates
    that are no polynomials.
    """
    tell = progress or (lambda text: None)
    if until is not None and not 0 < until < math.inf:
        raise InputError(f"until: expected a time above zero, got {until!r}")
    case = case if until is None else replace(case, span=(0.0, float(until)))
    task, largest = problem(case, TIMES), EFFORTS[effort]
    tell("reference")
    period = known_period(task)
    began = time.process_time()
    exact = reference(case.scene, task.start, task.times, task.equations.blocks, period is not None,
                      largest.work)
    took = time.process_time() - began
    points: list[Point] = []
    left_out: list[Any] = []
    spans = [exact.t, exact.t[-1:]][:2 if largest.ends else 1]
    for method in methods(task, largest.every) if len(exact.t) else ():
        if method.name not in largest.without:
            tell(method.name)
            _measured(task, method, exact, largest, spans, points, left_out)
    for method in answer_methods(task, period, largest.every) if exact.period else ():
        tell(f"{method.name}, period and extremes")
        _measured(task, method, exact, largest, [None], points, left_out)
    fates = tuple(FateAnswer(name, word, *timing) for name, call in fate_methods(task) for word,
                  *timing, _ in [_timed(call, largest)])
    if exact.period:
        tell("formulas in many digits")
    many = with_many_digits(task, largest.digits) if exact.period else ()
    return Precision(case, task, exact.t, exact, tuple(points), fates, _sensitivity(task, exact),
                     tuple(left_out), effort, took, many)


def _timed(call: Callable[..., Any], effort: Effort):
    """(answer of the first run, fastest, slowest, repeats of the runs after it, seconds of the first)."""
    start = time.process_time()
    answer = call()
    opening = time.process_time() - start
    seconds: list[float] = []
    largest, enough = effort.repeats
    while len(seconds) < largest and (not seconds or sum(seconds) < enough):
        start = time.process_time()
        call()
        seconds.append(time.process_time() - start)
    return answer, min(seconds), max(seconds), len(seconds), opening


def _measured(task: Problem, method: Method, exact: Reference, effort: Effort, spans: Sequence[np.ndarray],
              points: list[Point], left_out: list[tuple[str, float, str]]):
    """Put what every rung of a method's ladder reaches into `points`, or into `left_out`. spans: times of its
    runs, rising to the end; None of a run that answers with period and extremes."""
    last, growth, loaded = 0, 1.0, loading(method.name)
    for value in method.ladder:
        if method.name in SCIPY_METHODS and last * growth > effort.evaluations:
            left_out.append((method.name, value,
                             f"more than the {effort.evaluations} evaluations allowed, by the growth so far"))
            continue
        with compiled_anew() if method.name.startswith("taylor") else nullcontext():
            start = time.process_time()
            run = method.prepare(task, value)
            compiled = time.process_time() - start
        for question, times in zip(("span", "end"), spans):
            answer, fast, slow, repeats, opening = _timed(partial(run, times), effort)
            info = "" if times is None or set(answer.parts) == set(task.slices) else ", ".join(answer.parts)
            errors = (_answer_errors(answer, exact) if times is None
                      else {question: _state_error(task, answer, exact, len(times))})
            if errors.get("span") == math.inf or errors.get("end") == math.inf:
                left_out.append((method.name, value, "no answer over the whole span"))
                break
            points += [Point(name, method.name, method.setting, value, error, answer.steps,
                             answer.evaluations, fast / method.lanes, slow / method.lanes, repeats, compiled,
                             method.lanes, info, loaded, opening) for name, error in errors.items()]
        used = answer.evaluations or 0
        growth, last = max(1.0, used / last) if last and used else 1.0, used


def _state_error(task: Problem, answer: Answer, exact: Reference, count: int) -> float:
    """Largest relative error over the last `count` times, inf where an answer is missing; never below the
    reference's own."""
    worst = float(exact.error[-count:].max())
    for name, values in answer.parts.items():
        part = task.slices[name]
        if name == "attitude":  # q and -q are one attitude; angles do not say which
            values = (values * np.where((values * exact.states[-count:, part]).sum(axis=1) < 0, -1.0,
                                        1.0)[:, None])
        size = np.abs(exact.states[:, part]).max(initial=0.0) or 1.0
        gap = np.abs((values - exact.states[-count:, part]) - exact.rest[-count:, part]).max() / size
        worst = max(worst, float(gap)) if np.isfinite(gap) else math.inf
    return worst


def _answer_errors(answer: Answer, exact: Reference) -> dict[str, float]:
    """Of the period and of the extremes, never below the reference's own; inf where an answer is missing."""
    high, low, own = exact.period
    period = abs((answer.parts["period"][0] - high) - low) / high
    high, low = exact.extremes[..., 0], exact.extremes[..., 1]
    extremes = np.abs((answer.parts["extremes"] - high) - low).max() / (np.abs(high).max() or 1.0)
    return {name: max(float(error), lower) if np.isfinite(error) else math.inf
            for name, error, lower in (("period", period, own), ("extremes", extremes, exact.extremes_error))}


def _sensitivity(task: Problem, exact: Reference) -> float | None:
    """Largest relative change of the state over the span per relative change of the start, for one change of
    every component by about a unit in its last place."""
    if not len(exact.t):
        return None
    signs = np.random.default_rng(1).choice([-1.0, 1.0], task.start.size)
    nudged = np.where(task.start == 0, EPS * signs * np.abs(task.start).max(),
                      task.start * (1 + 2 * EPS * signs))
    moved = np.abs(nudged - task.start).max() / (np.abs(task.start).max() or 1.0)
    if not moved:
        return None
    result, _ = one_run(Recursion(task.equations), nudged, exact.t, 30, [WORK], exact.period is not None)
    n = len(result)
    states, rest = pairs(result)
    shift = relative_errors(states, exact.states[:n], exact.rest[:n] - rest, task.slices)
    return float(shift.max() / moved)
