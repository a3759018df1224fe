"""One position of a moving hand on the page of `stabilab explore`: the verdict, and all that is drawn,
against what a hand notices."""
from __future__ import annotations

import statistics
import time
from functools import partial
from pathlib import Path

from stabilab import load
from stabilab.show.explore.pictures import unframed
from stabilab.show.explore.session import Session

from .rows import Row, allowed

CASES = Path(__file__).parents[1] / "cases"
NAMES = ("thruster-stuck-major-axis", "minor-axis-100", "middle-axis-double-well", "cubesat-3u")
FOLLOWED = ("liquid-sensible", "top-fast")  # bodies of other effects
UPDATE, ANALYSIS = 0.1, 0.01  # s: of all, and of the outcome
WHAT = ("processor time; beside the outcome: equilibria with proofs, separatrix of 18 x 33 places a "
        "branch, motion, phase plane")


def measurements(small=False):
    return [partial(_moved, name, 3 if small else 25) for name in NAMES[::len(NAMES) - 1 if small else 1]] + [
        partial(_followed, name) for name in FOLLOWED if not small]


def _followed(name, rounds=25) -> Row:
    """The start of a body moves whose motion has to be followed in time."""
    session, times = Session(load(CASES / f"{name}.toml")), []
    own = float(session.about()["groups"][2]["controls"][0]["value"])
    box = unframed(session.answer({}))[0]["space"]["box"]
    for n in range(rounds + 2):
        begun = time.process_time()
        session.answer({"start": [repr(own * (1 + 0.003 * n)), None, None], "box": box, "moving": True})
        times.append(time.process_time() - begun)
    return allowed(f"explorer-{name}", f"explorer, the start of {name} moves", times[2:], UPDATE,
                   "processor time; 1200 places of the motion by Taylor series")


def _moved(name, rounds) -> list[Row]:
    """The torque is dragged; then the pointer rests. Processor time, which other work changes little."""
    session = Session(load(CASES / f"{name}.toml"))
    torque = session.about()["groups"][0]
    values = [one["value"] for one in torque["controls"]]  # off the axes: components along those of the file
    box = unframed(session.answer({}))[0]["space"]["box"]
    whole, verdict, rest = [], [], []
    for n in range(rounds + 2):
        grown = 1 + 0.003 * n
        moved = ({"axis": torque["axis"], "size": repr(values[0] * grown), "tilt": repr(values[1]),
                  "azimuth": repr(values[2])} if torque["axis"] else
                 {"file": [repr(value * grown) for value in values]})
        asked = {"torque": moved, "box": box, "moving": True}
        begun = time.process_time()
        told = unframed(session.answer(asked))[0]
        whole.append(time.process_time() - begun)
        verdict.append(told["analysis"] / 1e3)
        if n % 5 == 0:
            begun = time.process_time()
            session.answer({"torque": moved, "box": box})
            rest.append(time.process_time() - begun)
    what = f"explorer, the torque of {name} "
    return [allowed(f"explorer-{name}", what + "moves", whole[2:], UPDATE, WHAT),
            allowed(f"explorer-{name}-outcome", what + "moves: the outcome", verdict[2:], ANALYSIS,
                    "processor time; case read anew, fate, margin in energy, extremes"),
            Row(f"explorer-{name}-rest", what + "rests", statistics.median(rest), "s")]
