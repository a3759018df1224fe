"""One position of a moving hand on the page of `stabilab explore`: the verdict, and all that is drawn,
against what a hand notices."""
from __future__ import annotations

import time
from pathlib import Path
from statistics import median

from stabilab import load
from stabilab.show.explore.pictures import unframed
from stabilab.show.explore.session import Session

from .rows import Row

CASES = Path(__file__).parents[1] / "cases"
NAMES = ("thruster-stuck-major-axis", "minor-axis-100", "middle-axis-double-well", "cubesat-3u")
FOLLOWED = ("liquid-sensible", "top-fast")  # bodies of other effects
UPDATE, ANALYSIS = 100.0, 10.0  # ms: of all, and of the verdict
WHAT = "the rest: equilibria with proofs, separatrix of 18 x 33 places a branch, motion, phase plane"


def rows(small=False) -> list[Row]:
    """CPU time of one process, as other work on the machine does not change it. theirs: what is allowed."""
    made = [row for name in NAMES[:1 if small else None] for row in _rows(name, 3 if small else 25)]
    return made if small else [*made, *(_followed(name) for name in FOLLOWED)]


def _followed(name, rounds=25) -> Row:
    """The start of a body moves whose motion has to be followed in time."""
    session, times = Session(load(CASES / f"{name}.toml")), []
    own = float(session.about()["groups"][2]["controls"][0]["value"])
    box = unframed(session.answer({}))[0]["space"]["box"]
    for n in range(rounds + 2):
        begun = time.process_time()
        session.answer({"start": [repr(own * (1 + 0.003 * n)), None, None], "box": box, "moving": True})
        times.append(1e3 * (time.process_time() - begun))
    return _row(f"explorer, the start of {name} moves", times[2:], UPDATE,
                "1200 places of the motion by Taylor series")


def _rows(name, rounds) -> list[Row]:
    session = Session(load(CASES / f"{name}.toml"))
    torque = session.about()["groups"][0]
    size, tilt, azimuth = (one["value"] for one in torque["controls"])
    box = unframed(session.answer({}))[0]["space"]["box"]
    whole, verdict = [], []
    for n in range(rounds + 2):
        moved = {"axis": torque["axis"], "size": repr(size * (1 + 0.003 * n)), "tilt": repr(tilt),
                 "azimuth": repr(azimuth)}
        asked = {"torque": moved, "box": box, "moving": True}
        begun = time.process_time()
        told = unframed(session.answer(asked))[0]
        whole.append(1e3 * (time.process_time() - begun))
        verdict.append(told["analysis"])
    return [_row(f"explorer, the torque of {name} moves", whole[2:], UPDATE, WHAT),
            _row(f"explorer, the torque of {name} moves: the verdict", verdict[2:], ANALYSIS,
                 "case read anew, fate, margin in energy, extremes")]


def _row(name, times, allowed, note) -> Row:
    ratios = sorted(allowed / t for t in times)
    return Row(name, f"{median(times):.1f} ms of CPU", f"{allowed:.0f} ms allowed", median(ratios),
               (ratios[0], ratios[-1]), "none: as exact as the questions",
               1.0, note)
