"""Certificates of random scenes, made and checked, and distances from the separatrix."""
from __future__ import annotations

import random
import statistics
import time
from functools import partial

from stabilab.answers.certificate import certificate
from stabilab.orbit.separatrix.distance import separatrix_distance
from stabilab.verify import verify

from .random_scenes import drawn
from .rows import Row
from .spin_up import random_scene


def measurements(small=False):
    return [partial(certificates, 3 if small else 100), partial(distances, 3 if small else 60)]


def certificates(scenes: int) -> list[Row]:
    """Processor time for the equilibria of a scene with a torque off the axes."""
    rng, made, checked, agreed = random.Random(11), [], [], 0
    for number in range(scenes + 1):
        scene = random_scene(rng)[0]
        at = time.process_time()
        found = certificate(scene)
        between = time.process_time()
        proved = verify(found).status == "proved"
        if number:
            agreed += proved
            made.append(between - at)
            checked.append(time.process_time() - between)
    what = f"certificates of the equilibria of {scenes} random scenes, torque off the axes"
    note = "the mean, scenes without an equilibrium included"
    return [Row("proofs-made", f"{what}, made", statistics.fmean(made), note=note,
                error=f"{agreed} of {scenes} proved by the checker"),
            Row("proofs-checked", f"{what}, checked", statistics.fmean(checked), note=note)]


def distances(scenes: int) -> Row:
    """Processor time of the proved distance from the separatrix, a state of each random scene."""
    times = []
    for one in drawn(scenes + 1):
        scene, state = one.scene, one.states(1)[0]
        at = time.process_time()
        separatrix_distance(scene, state)
        if one.number:
            times.append(time.process_time() - at)
    times.sort()
    return Row("proofs-distance", f"distance from the separatrix, {scenes} random scenes, median",
               statistics.median(times),
               note=f"the slowest of them takes {1e3 * times[-1]:.3g} ms, 90 % at most "
                    f"{1e3 * times[int(0.9 * len(times))]:.3g} ms")
