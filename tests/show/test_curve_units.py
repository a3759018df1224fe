"""What is said of curves of equilibria in degrees a second: read as arithmetic, it names the points of the
curve."""
from __future__ import annotations

import math
import re

import pytest

from stabilab import equilibria
from stabilab.equilibrium.description import RATE
from stabilab.show.terminal import plain
from stabilab.show.text.classification import rates_of
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
        told = curve.description
        if told.unit != RATE:  # the curve of momentum along rotation: symbols alone, in SI
            assert "s = D" in curve.parametrisation and rates_of(told, DEG) == SI.rates
            continue
        equation, run = (plain(DEG.said(one)) for one in (told.equation, told.parametrisation))
        assert rates_of(told, DEG) == DEG.rates
        for t in (0.375, -2.75, 1.9):
            x = {f"omega{n}": v * TURN for n, v in enumerate(curve.point(t), 1)}
            if "alpha" in equation:  # oblique: alpha counts in units of N = e x M
                normal = eval(re.search(r"N = e x M = (\([^)]*\))", equation)[1])
                x["alpha"] = sum(n * v for n, v in zip(normal, x.values())) / sum(n * n for n in normal)
            if " turns about " not in run:
                told_of = said(run, t * TURN)
                # told to six digits
                assert told_of and {name: x[name] for name in told_of} == pytest.approx(told_of, rel=1e-4,
                                                                                      abs=1e-4)
            for name, number in said(equation, t * TURN).items():
                left = re.sub(r"([\w)]) ([(\w])", r"\1 * \2", name.replace(" + ", "+").replace(" - ", "-"))
                assert eval(left, dict(x)) == pytest.approx(number, rel=1e-4, abs=1e-2)


def test_in_radians_every_word_stays():
    scene, _ = physical((4, 3, 2), (1, 5, 0), (0, 0, 7))
    (curve,) = equilibria(scene).curves
    told = curve.description
    assert [plain(SI.said(one)) for one in (told.name, told.equation, told.parametrisation)] == [
        curve.name, curve.equation, curve.parametrisation]
