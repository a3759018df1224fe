"""Figure 18: without a wheel the printed formulas lie on the exact curves. Both are evaluated here by hand: with
b = 0 (25) to (27) and (31) of the paper, and the equations (13), x1' = x2 x3, x2' = -x1 x3, x3' = 1 + x1 x2."""
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import load
from stabilab.papers import index
from stabilab.papers.audit import findings_of
from stabilab.papers.figures.catalogue import figure
from stabilab.papers.table import cases_folder
from stabilab.show import style

F2 = 2.5**2 + 4**2
SADDLES = {"left": -np.arcsin(2 / F2), "right": 2 * np.pi - np.arcsin(2 / F2)}


@pytest.fixture
def panels():
    with style.drawing() as plt:
        yield figure(18).draw(plt).axes


def lines(ax, dashed):
    return [np.array(line.get_data(), float) for line in ax.lines
            if (line.get_linestyle() == "--") == dashed and line.get_marker() in ("None", None, "")
            and line.get_color() in (style.SAGE, style.BLACK, style.GREY)]


def energy(alpha):
    return F2 * np.cos(alpha) - 2 * alpha


def test_solid_and_dashed_separatrices_are_the_level_of_their_saddle(panels):
    solid, dashed = lines(panels[0], False), lines(panels[0], True)
    assert len(solid) == 2 and len(dashed) == 4
    levels = [energy(SADDLES[side]) for side in ("left", "right")]
    for (alpha, x), level in zip([*solid, *dashed], [*levels, *np.repeat(levels, 2)]):
        assert np.abs(x**2 / 2 + energy(alpha) - level).max() < 1e-13 * F2 and np.ptp(alpha) > 7


def test_surfaces_from_above_meet_the_plane_where_31_does(panels):
    solid, dashed = lines(panels[1], False), lines(panels[1], True)
    assert len(solid) == 2 and len(dashed) == 3
    circle = dashed.pop()
    assert np.allclose(np.hypot(*circle), np.sqrt(2), atol=1e-15)
    for x1, x2 in [*solid, *dashed]:  # each from the line of saddles, x2 > 0 at the left surface
        square, turn = x1**2 + x2**2, np.arctan2(x1, x2) - (np.pi if x2[0] < 0 else 0)
        root = np.sqrt(np.maximum(square**2 - 4, 0))
        left = x2**2 - x1**2 - root - 2 * np.arcsin(np.minimum(2 / square, 1)) - 4 * turn  # (31), x3 = 0
        assert np.abs(left / square).max() < 1e-7 and np.hypot(x1, x2).max() > 5  # a far end, where x3 is a root


def test_the_caption_says_departures_of_the_size_of_rounding():
    words = figure(18).caption
    sizes = [float(v) for v in re.findall(r"(\d+e[-−]\d+)", words.replace("−", "-"))]
    assert len(sizes) == 3 and max(sizes) < 1e-13
    # the left surface, x1 < 0, begins at (-1, 1): 2 sqrt 2 from the (1, -1) of the text
    assert f"exchanged, {2 * np.sqrt(2):.2f} away" in words


def test_the_case_is_bounded_as_it_expects():
    """A run by SciPy over 300 units of tau: x3 stays within the loop."""
    case = load(cases_folder() / "minor-axis-without-wheel.toml")
    assert case.scene.a == case.scene.b == 0 and case.state == (2.5, 4, 0.1)
    run = solve_ivp(lambda t, x: (x[1] * x[2], -x[0] * x[2], 1 + x[0] * x[1]), (0, 300), case.state,
                    method="DOP853", rtol=1e-12, atol=1e-12)
    assert np.abs(run.y[2]).max() < 4.5 and case.expect["fate"] == "bounded"


@pytest.mark.slow
def test_the_figure_is_no_item_of_the_paper():
    (findings,) = [findings_of("constant-torque-gyrostat")]
    found = [item.item for item in index.items([findings])]
    assert "figure 17" in found and "figure 18" not in found
    assert "not in the paper" in figure(18).title
