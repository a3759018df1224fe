"""The state at late times by quadrature against heyoka: stepping there, folding by the period it finds by events, its grid."""
from __future__ import annotations

import math

import numpy as np

from stabilab.analysis.precision_reference import reference, relative_errors
from stabilab.analysis.reduced_motion import reduced_motion
from stabilab.analysis.tabulated_motion import tabulated

from .contestants import scaled_minor_system
from .rows import SCENE, A, B, Row, each
from .timing import side_by_side

HELD, SPINNING = (2.75, 1.125, 1.0), (1.375, 4.625, 3.375)  # well inside, and spinning up (exact doubles)
LATE = 1000.0


def rows(small=False) -> list[Row]:
    late, rounds = (20.0, 1) if small else (LATE, 7)
    contest = Stepping()
    return [*bounded(contest, late, rounds), *spin_up(contest, 5.0 if small else late, rounds), *many_times(contest, late, rounds)]


class Stepping:
    """heyoka's Taylor series at half an ulp, from the state to the time; or from the state to the time's rest of the period, which
    it finds as the time between two events x3 = 0 of one kind."""

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
    motion, period = tabulated(reduced_motion(SCENE, HELD)), contest.period(HELD)
    ours, plain, folded = errors(HELD, late, motion.at(late), contest.at(HELD, late).copy(), contest.at(HELD, math.fmod(late, period)).copy(),
                                 orbit=True)
    again = 200

    def repeated(call, times=again):
        def run():
            for _ in range(times):
                call()
        return run
    # the rest of the period that counts is half of it on average: a late time that leaves as much
    fair = late - math.fmod(late, period) + 0.5 * period
    alone = side_by_side(repeated(lambda: motion.at(late)), repeated(lambda: contest.at(HELD, late), 2), again, 2, rounds)
    control = side_by_side(repeated(lambda: motion.at(fair)), repeated(lambda: contest.at(HELD, math.fmod(fair, period))), again, again, rounds)
    whole = lambda: reduced_motion(SCENE, HELD).at(late)
    first = side_by_side(repeated(whole, 5), repeated(lambda: contest.at(HELD, late), 2), 5, 2, rounds)
    fair_first = side_by_side(repeated(whole, 5), repeated(lambda: contest.at(HELD, math.fmod(fair, contest.period(HELD))), 20), 5, 20, rounds)
    name, kept = f"bounded motion at t = {late:g}", "after its preparation"
    return [
        _row(f"{name}, {kept}", alone, "heyoka", f"relative error: ours {ours:.1e}, theirs {plain:.1e}", 300),
        _row(f"{name}, {kept}", control, "heyoka that knows the period", f"relative error: ours {ours:.1e}, theirs {folded:.1e}", 2,
             "the fair control: its period is known to it, half of it is left to integrate"),
        _row(f"{name}, preparation included", first, "heyoka", f"relative error: ours {ours:.1e}, theirs {plain:.1e}"),
        _row(f"{name}, preparation included", fair_first, "heyoka that finds the period by events", f"relative error: ours {ours:.1e}, "
             f"theirs {folded:.1e}", note="preparation: equilibria and energies in balls of 128 bits, so that no margin is too small; one state "
                                          "asked once is cheaper by events, if its compiled code is at hand")]


def spin_up(contest, late, rounds) -> list[Row]:
    """One late state of a spin-up."""
    motion = reduced_motion(SCENE, SPINNING)
    early = min(late, 20.0)
    ours, theirs = errors(SPINNING, early, motion.at(early), contest.at(SPINNING, early).copy())
    gap = float(np.abs(np.array(motion.at(late)) - contest.at(SPINNING, late)).max() / late)
    said = f"relative error at t = {early:g}: ours {ours:.1e}, theirs {theirs:.1e}; at {late:g} they differ by {gap:.1e}"
    many = 100

    def ready():
        for _ in range(many):
            motion.at(late)

    def whole():
        for _ in range(3):
            reduced_motion(SCENE, SPINNING).at(late)
    theirs = lambda: contest.at(SPINNING, late)
    return [_row(f"spin-up at t = {late:g}, after its preparation", side_by_side(ready, theirs, many, 1, rounds), "heyoka", said, 2000),
            _row(f"spin-up at t = {late:g}, preparation included", side_by_side(whole, theirs, 3, 1, rounds), "heyoka", said)]


def many_times(contest, late, rounds, count=10_000) -> list[Row]:
    """Many states of a bounded motion."""
    times = np.linspace(0.0, late, count)
    ready = lambda: tabulated(reduced_motion(SCENE, HELD)).states(times)
    ours, theirs = ready(), contest.grid(HELD, times)
    errs = errors(HELD, late, ours[-1], theirs[-1], orbit=True)
    motion, grid = reduced_motion(SCENE, HELD), lambda: contest.grid(HELD, times)
    name, said = f"{count} times up to {late:g} of a bounded motion", f"relative error of the last: ours {errs[0]:.1e}, theirs {errs[1]:.1e}"
    return [_row(f"{name}, its table included", side_by_side(lambda: tabulated(motion).states(times), grid, 1, 1, rounds), "heyoka's grid",
                 said, 2),
            _row(f"{name}, preparation included", side_by_side(ready, grid, 1, 1, rounds), "heyoka's grid", said,
                 note="the preparation in balls costs as much as some thousand states")]


def _row(name, timed, other, error, wanted=0.0, note=""):
    return Row(name, each(timed.ours), f"{each(timed.theirs)} {other}", timed.ratio, (timed.low, timed.high), error, wanted, note)
