"""The state at late times by quadrature against heyoka: stepping there, folding by the period it finds by
events, its grid."""
from __future__ import annotations

import math
from functools import partial

import numpy as np

from stabilab.integrate.reference import reference, relative_errors
from stabilab.orbit.flow import reduced_motion

from .contestants import scaled_minor_system
from .rows import SCENE, A, B, Row, against
from .timing import side_by_side

HELD, SPINNING = (2.75, 1.125, 1.0), (1.375, 4.625, 3.375)  # well inside, and spinning up (exact doubles)
LATE = 1000.0


def measurements(small=False):
    late, rounds = (20.0, 1) if small else (LATE, 7)
    contest = Stepping()
    return [partial(bounded, contest, late, rounds),
            partial(spin_up, contest, 5.0 if small else late, rounds),
            partial(many_times, contest, late, rounds)]



class Stepping:
    """heyoka's Taylor series at half an ulp, from the state to the time; or from the state to the time's rest
    of the period, which it finds as the time between two events x3 = 0 of one kind."""

    def __init__(self, tolerance=1e-16):
        import heyoka
        variables, system = scaled_minor_system(A, B, heyoka)
        self.plain = heyoka.taylor_adaptive(system[:3], [0.0] * 3, tol=tolerance)
        self.passed = []

        def note(ta, time, sign):
            self.passed.append(time)
        upwards = heyoka.nt_event(variables[2], note, direction=heyoka.event_direction.positive)
        self.events = heyoka.taylor_adaptive(system[:3], [0.0] * 3, tol=tolerance, nt_events=[upwards])

    def at(self, state, time):
        self.plain.time, self.plain.state[:] = 0.0, state
        self.plain.propagate_until(time)
        return self.plain.state

    def period(self, state):
        ta, self.passed = self.events, []
        ta.time, ta.state[:] = 0.0, state
        while len(self.passed) < 2:
            ta.step()
        return self.passed[1] - self.passed[0]

    def grid(self, state, times):
        self.plain.time, self.plain.state[:] = 0.0, state
        return self.plain.propagate_grid(times)[-1]


def errors(state, time, *answers, orbit=False):
    """Relative errors of answers at one time against Taylor series in many digits."""
    exact = reference(SCENE, state, np.array([time]), orbit=orbit)
    return [float(relative_errors(np.array([a]), exact.states, exact.rest, exact.slices)[0]) for a in answers]


def bounded(contest, late, rounds) -> list[Row]:
    """One late state of a bounded motion."""
    motion, period = reduced_motion(SCENE, HELD), contest.period(HELD)
    whole = lambda: reduced_motion(SCENE, HELD).at(late)
    theirs = contest.at(HELD, late).copy(), contest.at(HELD, math.fmod(late, period)).copy()
    ready, first, plain, folded = errors(HELD, late, motion.at(late), whole(), *theirs, orbit=True)
    # the rest of the period that counts is half of it on average: a late time that leaves as much
    fair = late - math.fmod(late, period) + 0.5 * period
    step = repeated(lambda: contest.at(HELD, late), FEW)
    rest = repeated(lambda: contest.at(HELD, math.fmod(fair, period)), MANY)
    found = repeated(lambda: contest.at(HELD, math.fmod(fair, contest.period(HELD))), MANY)
    name, kept = f"bounded motion at t = {late:g}", "after its preparation"
    said = "relative error: ours {:.1e}, theirs {:.1e}".format
    return [
        against("late", f"{name}, {kept}",
             side_by_side(repeated(lambda: motion.at(late), MANY), step, MANY, FEW, rounds), "heyoka",
             said(ready, plain)),
        against("late-period-known", f"{name}, {kept}",
             side_by_side(repeated(lambda: motion.at(fair), MANY), rest, MANY, MANY, rounds),
             "heyoka that knows the period", said(ready, folded),
             note="the fair control: its period is known to it, half of it is left to integrate"),
        against("late-first", f"{name}, preparation included",
                side_by_side(repeated(whole, MANY), step, MANY, FEW, rounds), "heyoka", said(first, plain)),
        against("late-first-period-found", f"{name}, preparation included",
                side_by_side(repeated(whole, MANY), found, MANY, MANY, rounds),
             "heyoka that finds the period by events", said(first, folded),
             note="one state asked once is cheaper by events, if its compiled code is at hand")]


MANY, FEW = 100, 4  # calls that take about as long on a busy machine: waiting for it is shared out fairly


def repeated(call, times):
    """The call so many times over."""
    def run():
        for _ in range(times):
            call()
    return run


def spin_up(contest, late, rounds) -> list[Row]:
    """One late state of a spin-up."""
    motion = reduced_motion(SCENE, SPINNING)
    early = min(late, 20.0)
    ours, theirs = errors(SPINNING, early, motion.at(early), contest.at(SPINNING, early).copy())
    gap = float(np.abs(np.array(motion.at(late)) - contest.at(SPINNING, late)).max() / late)
    said = (
        f"relative error at t = {early:g}: ours {ours:.1e}, theirs {theirs:.1e}; at {late:g} they differ by "
        f"{gap:.1e}")
    ready, whole = (lambda: motion.at(late)), (lambda: reduced_motion(SCENE, SPINNING).at(late))
    theirs = lambda: contest.at(SPINNING, late)
    name = f"spin-up at t = {late:g}"
    late_one = side_by_side(repeated(ready, MANY), theirs, MANY, 1, rounds)
    first = side_by_side(repeated(whole, MANY // 2), theirs, MANY // 2, 1, rounds)
    return [against("late-spin-up", f"{name}, after its preparation", late_one, "heyoka", said),
            against("late-spin-up-first", f"{name}, preparation included", first, "heyoka", said)]


def many_times(contest, late, rounds, count=10_000) -> list[Row]:
    """Many states of a bounded motion."""
    times = np.linspace(0.0, late, count)
    ready = lambda: reduced_motion(SCENE, HELD).states(times)
    ours, theirs = ready(), contest.grid(HELD, times)
    errs = errors(HELD, late, ours[-1], theirs[-1], orbit=True)
    motion, grid = reduced_motion(SCENE, HELD), lambda: contest.grid(HELD, times)
    name = f"{count} times up to {late:g} of a bounded motion"
    said = f"relative error of the last: ours {errs[0]:.1e}, theirs {errs[1]:.1e}"
    asked, grid, whole = repeated(lambda: motion.states(times),
                                  6), repeated(grid, 3), repeated(ready, 6)
    asked, whole = side_by_side(asked, grid, 6, 3, rounds), side_by_side(whole, grid, 6, 3, rounds)
    return [against("late-many", f"{name}, after its preparation", asked, "heyoka's grid", said),
            against("late-many-first", f"{name}, preparation included", whole, "heyoka's grid", said)]
