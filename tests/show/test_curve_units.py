"""What is said of curves of equilibria in degrees a second: read as arithmetic, it names the points of the
curve."""
from __future__ import annotations

import math
import re

import pytest

from stabilab import equilibria
from stabilab.show.text.classification import in_units
from stabilab.show.units import DEG, SI
from tests.equilibrium.test_curve_text import ON_EVERY_AXIS, said
from tests.equilibrium.test_gyrostat import CURVED
from tests.oracles.pairs import physical

TURN = 180 / math.pi


@pytest.mark.parametrize("D, lam, M", CURVED + ON_EVERY_AXIS)
def test_equation_parametrisation_and_parameter_name_points_of_the_curve_in_degrees(D, lam, M):
    """Every clause at three points of the curve, whose rates in degrees are those of the curve itself times
    180/pi."""
    scene, _ = physical(D, lam, M)
    for curve in equilibria(scene).curves:
        told = in_units(curve, DEG)
        if told.unit == "rad/s":
            # symbols of its own, in SI
            assert re.search(r"alpha|s = D", curve.equation + curve.parametrisation)
            continue
        for t in (0.375, -2.75, 1.9):
            x = {f"omega{n}": v * TURN for n, v in enumerate(curve.point(t), 1)}
            if " turns about " not in told.parametrisation:
                run = said(told.parametrisation, t * told.one)
                # told to six digits
                assert run and {name: x[name] for name in run} == pytest.approx(run, rel=1e-4, abs=1e-4)
            for name, number in said(told.equation, t * told.one).items():
                left = re.sub(r"([\w)]) ([(\w])", r"\1 * \2", name.replace(" + ", "+").replace(" - ", "-"))
                assert eval(left, dict(x)) == pytest.approx(number, rel=1e-4, abs=1e-2)


def test_in_radians_every_word_stays():
    scene, _ = physical((4, 3, 2), (1, 5, 0), (0, 0, 7))
    (curve,) = equilibria(scene).curves
    assert in_units(curve, SI)[:4] == (curve.name, curve.equation, curve.parametrisation, "rad/s")
