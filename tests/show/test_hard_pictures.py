"""Pictures where numbers are extreme, words many and curves steep: nothing is cut off, hidden or piled up."""
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from stabilab.case.read import load_any
from stabilab.show import labels, style
from stabilab.show.plot import in_space, surfaces
from stabilab.show.plot.subject import subject
from stabilab.show.space import reach
from stabilab.show.turns.band import outside
from tests.shared import CASES

ASTEROID = """
[body]
inertia = ["3.1e19", "3.0e19", "1.1e19"]
[effects.constant_torque]
torque = [0, 0, "2e2"]
[motion]
angular_velocity = ["1e-8", "2e-8", "3e-9"]
"""
ROTOR = """
[body]
inertia = ["1e-9", "1.3e-9", "1.7e-9"]
[effects.gyrostat]
momentum = [0, 0, "2e-6"]
[effects.constant_torque]
torque = ["1e-6", 0, 0]
[motion]
angular_velocity = [20000, 90000, 1000]
"""


@pytest.fixture(autouse=True)
def style_of_pictures():
    with style.drawing():
        yield


def curves(ax):
    return [np.array(line.get_data()) for line in ax.get_lines() if len(line.get_xdata()) > 20]


def test_a_curve_of_equilibria_goes_on_to_the_frame_beside_its_asymptote():
    """By hand: 2.5 w2 w3 + 4 w3 = -0.02 of this case, a hyperbola whose branch right of w2 = -1.6 goes down
    without end; and each place that is drawn lies on it."""
    ax = stabilab.plot.equilibria(CASES / "thruster-stuck-major-axis.toml")
    bottom, top = ax.get_ylim()
    drawn = np.radians(np.concatenate(curves(ax), axis=1))
    residue = 2.5 * drawn[0] * drawn[1] + 4 * drawn[1] + 0.02
    assert np.abs(residue).max() < 1e-9 * max(1.0, np.abs(drawn).max() ** 2)
    right = drawn[:, drawn[0] > -1.6]
    assert np.degrees(right[1].min()) <= bottom and np.degrees(drawn[1].max()) >= top
    inside = right[:, np.degrees(right[1]) > bottom]
    steps = np.abs(np.diff(inside[1][np.argsort(inside[0])]))
    assert np.degrees(steps.max()) <= 1.01 * reach.CHORD * (top - bottom) / 2


@pytest.mark.parametrize("size", [1e-8, 1e-4, 1.0, 1e6])
def test_curves_of_equilibria_do_not_depend_on_the_unit_of_time(size):
    """By hand: D3 w3' = (D1 - D2) w1 w2 + M = 0 on the plane w3 = 0. A torque of size^2 has rates of this size."""
    text = f"[body]\ninertia = [3, 2, 1]\n[effects.constant_torque]\ntorque = [0, 0, {size**2!r}]\n"
    text += f"[motion]\nangular_velocity = [{size!r}, 0, {size!r}]\n"
    ax = stabilab.plot.equilibria(text, units="si")
    high = ax.get_xlim()[1]
    assert 1.4 * size < high < 20 * size
    drawn = np.concatenate(curves(ax), axis=1) / size
    assert np.abs(drawn[0] * drawn[1] + 1).max() < 1e-6
    across = np.hypot(*drawn)
    assert across.min() == pytest.approx(math.sqrt(2), rel=0.02)  # its nearest point, where w1 = -w2


def test_equilibria_of_an_asteroid_are_drawn_at_its_own_rates():
    ax = stabilab.plot.equilibria(ASTEROID, units="si")
    assert ax.get_xlim()[1] < 1e-6 and min(np.hypot(*line).min() for line in curves(ax)) < 1e-7


def test_a_torque_that_hardly_lifts_the_energy_has_few_other_energies():
    """It lifts the energy by 3e-6 of it a turn: a line for each such step would be a third of a million."""
    drawn = surfaces.cylinder(subject(ROTOR), None)
    assert 10 < len(drawn.lines) < 200


@pytest.mark.parametrize("name", ["thruster-stuck-major-axis", "liquid-sensible", "geostationary-22n"])
def test_no_words_of_a_body_stand_on_others(name):
    placed = labels.boxes(stabilab.plot.body(CASES / f"{name}.toml"))
    assert len(placed) > 4
    for n, one in enumerate(placed):
        assert not any(one.overlaps(other) for other in placed[:n]), name


def test_words_of_attitudes_stand_apart_and_below_the_title():
    figure = stabilab.plot.equilibria(CASES / "orbits/spinning.toml").figure
    placed = [box for ax in figure.axes for box in labels.boxes(ax)]
    for n, one in enumerate(placed):
        assert not any(one.overlaps(other) for other in placed[:n])
    title = figure.texts[0].get_window_extent()
    assert all(ax.title.get_window_extent().y1 < title.y0 for ax in figure.axes)
    assert figure.get_suptitle().count("\n") == 1


def test_the_eye_looks_along_no_axis_and_no_floor():
    rng = np.random.default_rng(4)
    for direction in (*rng.normal(size=(200, 3)), *np.eye(3), *-np.eye(3)):
        up, round_ = in_space.facing(direction)
        assert in_space.LOW <= abs(up) <= in_space.STEEP
        assert abs((round_ + 45) % 90 - 45) >= in_space.OBLIQUE - 1e-9
        assert np.degrees(np.arccos(in_space.sight((up, round_)) @ direction / np.linalg.norm(direction))) < 70


def test_a_title_has_the_width_of_the_figure_beside_a_window_of_it():
    ax = stabilab.plot.phase(CASES / "two-wheels-minor-axis.toml")
    assert len(ax.figure.axes) > 1
    assert ax.get_title().splitlines()[0] == load_any(CASES / "two-wheels-minor-axis.toml").heading


def test_moments_of_a_stage_are_whole_numbers():
    """21400 and 21750 kg m^2, as the file has them."""
    ax = stabilab.plot.body(CASES / "burns/stage.toml")
    words = "; ".join(text.get_text() for text in ax.figure.legends[0].get_texts())
    assert "D = (3850, 21400, 21750) kg m²" in words, words
    assert "12 kg of 4100 kg" in ax.figure.legends[0].get_title().get_text()


def test_no_line_of_notes_parts_a_number_from_its_unit():
    words = "no rigid body has this tensor: the largest principal moment, 100 kg m², exceeds the others"
    for inches in np.linspace(2.0, 9.0, 40):
        assert not any(line.endswith(("100", "kg")) for line in style.clauses(words, inches, 9).split("\n"))


@pytest.mark.parametrize("name", ["middle-axis-double-well", "minor-axis-300", "uncertain-separatrix"])
def test_words_at_a_barrier_stand_inside_and_off_its_arrow(name):
    ax = stabilab.plot.potential(CASES / f"{name}.toml")
    ax.figure.draw_without_rendering()
    (words,) = [text for text in ax.texts if text.get_text()]
    box = words.get_window_extent()
    assert ax.bbox.x0 <= box.x0 and box.x1 <= ax.bbox.x1 and box.y1 <= ax.bbox.y1


def test_ends_of_draws_that_are_not_finite_are_not_named():
    ax = stabilab.plot.histogram(CASES / "uncertain-separatrix.toml", samples=60)
    names = [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert "5 %" in names and not any("and 95 %" in name for name in names)


def test_what_does_not_go_round_is_drawn_between_bands():
    assert outside([True, False, False, True, False]) == [(1, 3), (4, 5)]
    assert outside([False, True]) == [(0, 1)] and outside([True, True]) == []


def test_the_turn_of_a_body_into_its_wheel_is_drawn_before_the_nutation_that_is_left():
    """By DOP853 from D w' = -w x (D w + h e_y) - u e_y, h' = u, with the numbers of the file; deg/s."""
    D, u = np.array([118.0, 96, 152]), 0.02
    law = lambda t, y: [*((-np.cross(y[:3], D * y[:3] + [0, y[3], 0]) - [0, u, 0]) / D), u]
    run = solve_ivp(law, (0, 900), [0, 0, 3.15 * math.tau / 60, 0], "DOP853", rtol=1e-10, atol=1e-12,
                    dense_output=True)
    ax = stabilab.plot.space(CASES / "dual-spin-turn.toml")
    drawn = np.concatenate([np.array(line.get_data_3d()) for line in ax.get_lines()
                            if line.get_color() == style.VIOLET], axis=1)
    for t in (60, 300, 600, 840):
        at = np.degrees(run.sol(t)[:3])
        assert np.nanmin(np.linalg.norm(drawn.T - at, axis=1)) < 0.3, t
    place = next(text for text in ax.texts if text.get_text().strip() == "start, 0 min").get_position_3d()
    assert np.linalg.norm(np.array(place) - [0, 0, 18.9]) < 1


def test_many_turns_that_lose_energy_fill_one_side_of_the_sphere_and_leave_the_other():
    """The body spins about its axis of symmetry and ends across it: over the upper half alone, though the lower one
    has the same energies. By hand: that half has half of the area 4 pi |H|^2; what is drawn faces the eye."""
    result = surfaces.losing_sphere(subject(CASES / "explorer-1-damped.toml"))
    size = float(np.linalg.norm(result.swept[0, 0]))
    assert result.swept[..., 2].min() > -0.02 * size and result.swept[..., 2].max() > 0.99 * size
    assert not any(len(points) > 10_000 for points, *_ in result.lines)


def test_beyond_a_saddle_a_route_fills_the_side_on_which_it_goes_on():
    """Moments 1, 2, 3: above the saddle's energy 1/4 about +1, below it about +3, by (x^2 + y^2/2 + z^2/3)/2."""
    ball, *_ = surfaces._ball(1.0)
    energy = lambda H: (H**2 / (2 * np.array([1, 2, 3]))).sum(axis=-1)
    route = np.array([[0.98, 0.1, 0.17], [0.7, 0.65, 0.3], [0.3, 0.9, 0.3], [0.1, 0.6, 0.79], [0.05, 0.1, 0.99]])
    route /= np.linalg.norm(route, axis=1, keepdims=True)
    middles = surfaces._swept(ball, energy(ball), route, energy(route), [0.25]).mean(axis=1)
    assert energy(middles).max() < 0.5 and energy(middles).min() > 1 / 6
    above = energy(middles) > 0.26
    assert middles[above, 0].min() > 0 and middles[~above & (energy(middles) < 0.24), 2].min() > 0
    assert above.any() and (energy(middles) < 0.2).any()
