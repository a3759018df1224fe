"""What `compare` prints. Expected numbers: of its own JSON, which has every digit in SI."""
import json
import math
import re

import pytest

from tests.shared import CASES


def rows(text):
    """(model, part) -> (largest error, of, what follows)."""
    found = re.findall(r"^  (\w+) +(\S+) +([\d.e+-]+) +([\d.e+-]+)  (.*)$", text, re.M)
    return {(model, part): (float(largest), float(of), rest) for model, part, largest, of, rest in found}


@pytest.mark.parametrize("units, angle", [("deg", "deg"), ("si", "rad")])
def test_errors_have_the_units_of_the_other_answers(stabilab, units, angle):
    path, one = CASES / "charged-body-small-torque.toml", math.degrees(1) if units == "deg" else 1.0
    text, found = stabilab("compare", path, "--units",
                           units)[1], json.loads(stabilab("compare", path, "--json")[1])["departures"]
    expected = {"omega": ("ω", one, f"{angle}/s"), "angles": ("angles", one, angle),
                "momentum": ("momentum", 1, "kg m²/s"), "velocity": ("velocity", 1, "m/s"),
                "position": ("position", 1, "m")}
    shown = rows(text)
    assert len(shown) == len(found) == 15
    for row in found:
        name, factor, unit = expected[row["part"]]
        largest, of, in_unit = shown[row["model"], name]
        assert (largest, of) == pytest.approx((row["largest"] * factor, row["scale"] * factor),
                                              rel=1e-3) and in_unit.startswith(f"{unit} ")


def test_rounding_is_not_drawn_as_motion():
    """A component within 1e-17 of 0 beside one of 2 rad/s."""
    import numpy as np

    from stabilab.answers.simulate import Simulation
    from stabilab.show import style
    from stabilab.show.text import cost
    from tests.shared import case
    t = np.linspace(0, 1, 50)
    run = Simulation(t, {"omega": np.stack([1e-17 * np.sin(40 * t), 0.1 * np.sin(t), 2 + 0 * t], -1)},
                     "exact", "taylor", None)
    with style.drawing() as plt:
        noise, motion, _ = cost.picture(plt, case("top-fast"), {"exact": run}).axes
        assert np.ptp(noise.get_ylim()) > 1 and np.ptp(motion.get_ylim()) < 10  # deg/s
