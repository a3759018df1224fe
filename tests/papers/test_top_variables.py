"""Figures 2 to 5 of the paper on the top are in its variables (4): p = c sqrt(gamma0'') p1, r = r0 r1, gamma =
gamma0'' gamma1, c^2 = M g L/C. Numbers of its Table 1; the exact motion by SciPy from (2)."""
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab.papers.figures.catalogue import figure
from stabilab.show import style

CENTRE = np.array([0.7, 0.3, 0.1])
ACROSS = np.sqrt(300 * 9.81 * np.sqrt(0.49 + 0.09 + 0.01) / 11 * 0.001)  # c sqrt(gamma0''), rad/s
D = np.array([82.999082, 76.199174, 11.0])


def rates(t, state, momentum):
    w, g = state[:3], state[3:]
    field = 3 * 9.81e6 / 1000**3
    torque = 300 * 9.81 * np.cross(CENTRE, g) + field * np.cross(g, D * g)
    return np.concatenate([(np.cross(D * w + momentum, w) + torque) / D, np.cross(g, w)])


@pytest.mark.parametrize("number, values", [(2, [(30, 30), (60, 30), (90, 30)]),
                                            (3, [(30, 30), (30, 60), (30, 90)])])
def test_exact_curves_are_the_motion_in_the_papers_variables(number, values):
    with style.drawing() as plt:
        panels = np.reshape([part.axes for part in figure(number, "top").draw(plt)[:3]], (6, 3))
        exact = [[next(line.get_data() for line in ax.lines if line.get_color() == style.BLACK) for ax in row]
                 for row in panels]
        labels = [row[0].get_ylabel() for row in panels]
    assert [re.sub(r"[\\${}]|amma", "", label) for label in labels] == [
        "p_1", "q_1", "r_1", "g_1 (10^3)", "g_1' (10^3)", "g_1'' (10^3)"]
    for column, (lx, lz) in enumerate(values):
        curves = np.array([row[column][1] for row in exact])
        start = curves[:, 0] * [ACROSS, ACROSS, 5, 1, 1, 1]
        assert start[2:] == pytest.approx([5, 0.9999995, 0, 0.001], abs=1e-9)  # r0, gamma0 of Table 1
        t = exact[0][column][0]
        run = solve_ivp(rates, (0, t[-1]), start, t_eval=t, args=(np.array([lx, 0, lz]),), rtol=1e-10,
                        atol=1e-12)
        scaled = run.y / np.array([ACROSS, ACROSS, 5, 1, 1, 1])[:, None]
        assert np.abs(scaled - curves).max() < 1e-6


def test_phase_planes_have_rates_a_second_and_the_caption_says_all_factors():
    with style.drawing() as plt:
        panels = np.reshape([part.axes for part in figure(4, "top").draw(plt)[:3]], (6, 3))
        x, rate = next(line.get_data() for line in panels[2][0].lines if line.get_color() == style.BLACK)
    t = np.linspace(0, 1.3, len(x))
    assert x[0] == pytest.approx(1) and np.abs(np.gradient(x, t)[1:-1] - rate[1:-1]).max() < 1e-6
    words = figure(4, "top").caption
    assert f"= {ACROSS:.4g} rad/s, r1 of r0 = 5 rad/s" in words and "of γ0'' = 0.001" in words
    assert "is 0.2 s times these" in words
