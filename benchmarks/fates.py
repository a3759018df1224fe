"""The fate of many states: NumPy alone and numba, against integration until it is decided; and a grid of
them."""
from __future__ import annotations

import numpy as np

from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene, fate
from stabilab.answers.fate import fate_grid

from .contestants import BatchFate, SciPyFate
from .rows import SCENE, Row, each, numba_available, random_states
from .timing import side_by_side

SCENES = {
    "minor axis": SCENE,
    "middle axis with two wells": ScaledGyrostat(0.5, 3.1, (0, -0.8, 0)),
    "major axis, perpendicular gyrostat":
        Scene(Body((3.0, 2.0, 1.5)), Gyrostat((0.0, 0.8, 0.6)), ConstantTorque((0.2, 0.0, 0.0))),
}
BATCH = {False: 400, True: 4000}  # wanted ratios to heyoka's batch mode: NumPy, numba

LIMITS = {False: "; NumPy's limit: some 250 passes over arrays at half a nanosecond a state",
          True: "; numba's limit: two look-ups of eight coefficients a state"}


def rows(small=False) -> list[Row]:
    size, sample, rounds = (6000, 50, 2) if small else (1_000_000, 4000, 7)
    found = [against_batch(size, sample, rounds, name, fast) for name in SCENES for fast in ways()]
    found += [against_scipy(size, 4 if small else 24, rounds, name, fast)
              for name in list(SCENES)[:1 if small else 3]
              for fast in ways()]
    return found + [against_writing(48 if small else 512, rounds, fresh) for fresh in (True, False)]


def ways():
    return (False, True) if numba_available() else (False,)


def against_batch(size=1_000_000, sample=10_000, rounds=7, name="minor axis", fast=False) -> Row:
    """Labels of `size` states against heyoka's batch mode with compaction on `sample` of them."""
    return _against(BatchFate, "heyoka batch with compaction", BATCH[fast], size, sample, rounds, name, fast)


def against_scipy(size=1_000_000, sample=24, rounds=7, name="minor axis", fast=False) -> Row:
    """Labels of `size` states against SciPy's DOP853 with events at 1e-13 on `sample` of them."""
    return _against(SciPyFate, "SciPy DOP853 with events at 1e-13", 200_000, size, sample, rounds, name, fast)


def _against(contestant, words, wanted, size, sample, rounds, name, fast) -> Row:
    scene, states = SCENES[name], random_states(size)
    run, part = contestant(scene), states[:sample]
    timed = side_by_side(lambda: fate(scene, states, fast=fast), lambda: run(part), size, sample, rounds)
    answer, brute = fate(scene, states, fast=fast), run(part)
    clear = np.abs(answer.margins[:sample]) > 1e-9
    wrong = int(((answer.labels[:sample] == Fate.SPIN_UP) != (brute == 1))[clear].sum())
    return Row(f"fate of {size} states, {name}, {'numba' if fast else 'NumPy'}", each(timed.ours),
               f"{each(timed.theirs)} {words}", timed.ratio, (timed.low, timed.high),
               f"{wrong} of {int(clear.sum())} labels differ", wanted=wanted,
               note=f"one thread; {answer.precise} states in ball arithmetic{LIMITS[fast]}")


def against_writing(side=512, rounds=7, fresh=True) -> Row:
    """A grid of side^3 labels against writing its bytes ten times: into fresh memory, as the grid is, or into
    the same."""
    axes = [np.linspace(-5, 5, side), np.linspace(-5, 5, side), np.linspace(-6, 6, side)]
    out, cells = np.empty((side, side, side), np.int8), side**3

    def write():
        for byte in range(10):
            np.full(out.shape, byte, np.int8) if fresh else out.fill(byte)
    timed = side_by_side(lambda: fate_grid(SCENE, axes), write, cells, cells, rounds)
    states = np.stack(np.meshgrid(*[a[:: max(1, side // 16)] for a in axes], indexing="ij"), axis=-1)
    some = fate_grid(SCENE, [a[:: max(1, side // 16)] for a in axes])
    wrong = int((some != fate(SCENE, states, fast=False).labels).sum())
    return Row(f"fate grid {side}^3, minor axis, NumPy", each(timed.ours),
               f"{each(timed.theirs)} its bytes written ten times, "
               f"{'fresh memory' if fresh else 'the same memory'}", timed.ratio, (timed.low, timed.high),
               f"{wrong} of {some.size} labels differ", wanted=0.5 if fresh else 0.0,
               note="like with like" if fresh
               else "the grid itself is written to fresh memory: the control has the advantage")
