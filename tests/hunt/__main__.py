"""`make hunt`: turn the knobs of a problem so that two ways to its answer disagree as much as they can.

python -m tests.hunt [SECONDS] [FOLDER] [SEED] [NAME...]: differential evolution and hypothesis' target, half
of the time each, for each of the disagreements (or those named). What parts by more than promised is kept in
FOLDER (default .hunt) as NAME-*.json, and the exit code is 1. A hunt that is ended (SIGTERM, as `timeout`
sends it) says what it found until then; a crash of compiled code says where.
"""
import faulthandler
import json
import signal
import sys
import traceback
from pathlib import Path
from time import monotonic

import numpy as np

from stabilab.errors import InputError
from tests.hunt import parabolas, unreduced
from tests.hunt.disagreements import DISAGREEMENTS, WRONG
from tests.hunt.problems import KNOBS, problem_of
from tests.hunt.returns import returns
from tests.hunt.threads import threads

KEPT = 8  # of each disagreement, the worst
SEARCHES = {name: (function, problem_of) for name,
            function in {**DISAGREEMENTS, "returns": returns, "threads": threads}.items()} | {
    "unreduced": (unreduced.unreduced, unreduced.problem_of),
    "parabolas": (parabolas.parabolas, parabolas.problem_of)}
CEILING = 30.0  # of the logarithm: what an optimiser sees of a wrong label


class Ended(BaseException):
    """The hunt is ended from outside."""


class TimeUp(BaseException):
    """Ends an optimiser from within; no Exception, so that nothing on the way takes it for a failure."""


class Hunt:
    """One disagreement under search: counts, and the worst findings."""

    def __init__(self, name, function, folder=None, make=problem_of):
        self.name, self.function, self.folder, self.make = name, function, folder, make
        self.asked, self.worst, self.kept = 0, 0.0, []
        self.end = self.most = np.inf

    def go(self, how, seconds, seed, questions=np.inf):
        """how: `evolve` or `aim`, begun anew with the next seed until the time is up or so many questions are
        asked."""
        self.end, self.most = monotonic() + seconds, self.asked + questions
        try:
            while True:
                how(self, seed)
                seed += 1
        except TimeUp:
            pass

    def size(self, knobs) -> float:
        """log10 of the disagreement at a point of the cube; what exceeds 1 is kept."""
        if monotonic() >= self.end or self.asked >= self.most:
            raise TimeUp
        try:
            scene, problem, state = self.make(knobs)
        except (InputError, OverflowError):
            return -CEILING
        if not np.isfinite(state).all():
            return -CEILING
        self.asked += 1
        try:
            size, words = self.function(scene, problem, state)
        except InputError as error:  # an answer that is refused in words; the other way may not say more
            size, words = 0.0, str(error)
        except Exception:
            size, words = WRONG, traceback.format_exc(limit=-4)
        self.worst = max(self.worst, size)
        if size > 1:
            self._keep(size, words, scene, state)
        return float(np.clip(np.log10(size), -CEILING, CEILING)) if size > 0 else -CEILING

    def _keep(self, size, words, scene, state):
        row = {"disagreement": self.name, "size": size, "scene": repr(scene),
               "state": [v.hex() for v in map(float, state)], "words": words}
        self.kept = sorted([*self.kept, row], key=lambda r: -r["size"])[:KEPT]
        if self.folder:
            for n, one in enumerate(self.kept):
                (self.folder / f"{self.name}-{n}.json").write_text(json.dumps(one, indent=1))


def evolve(hunt, seed):
    """Differential evolution over the cube."""
    from scipy.optimize import differential_evolution
    differential_evolution(lambda v: -hunt.size(v), [(0, 1)] * KNOBS, maxiter=60, popsize=4, init="sobol",
                           polish=False, tol=0,
                           mutation=(0.4, 1.0), rng=np.random.default_rng(seed))


def aim(hunt, seed):
    """Hypothesis, told to make the disagreement large."""
    from hypothesis import HealthCheck, Phase, given, settings, target
    from hypothesis import seed as seeded
    from hypothesis import strategies as st

    @seeded(seed)
    @settings(max_examples=200, database=None, deadline=None, phases=(Phase.generate, Phase.target),
              suppress_health_check=list(HealthCheck))
    @given(st.lists(st.floats(0, 1), min_size=KNOBS, max_size=KNOBS))
    def test(knobs):
        target(hunt.size(knobs))
    test()


def main(seconds=600, folder=".hunt", seed=1, *names):
    folder, seed = Path(folder), int(seed)
    folder.mkdir(parents=True, exist_ok=True)
    names = names or tuple(SEARCHES)
    share = float(seconds) / len(names) / 2
    found, ended = 0, False
    signal.signal(signal.SIGTERM, _end)
    for name in names:
        function, make = SEARCHES[name]
        hunt = Hunt(name, function, folder, make)
        try:
            hunt.go(evolve, share, seed)
            hunt.go(aim, share, seed)
        except Ended:
            ended = True
        found += len(hunt.kept)
        print(f"{name}: {hunt.asked} questions, largest disagreement {hunt.worst:.3g} of what is promised",
              flush=True)
        for row in hunt.kept:
            print(f"  {row['size']:.3g}: {row['scene']}\n    from {row['state']}: {row['words']}", flush=True)
        if ended:
            break
    print(("ended early: " if ended else "") + ("nothing found" if not found else f"found: see {folder}"))
    sys.exit(1 if found or ended else 0)


def _end(*_):
    raise Ended


if __name__ == "__main__":
    faulthandler.enable()
    main(*sys.argv[1:])
