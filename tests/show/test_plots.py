"""Plots of cases: what is drawn, of what there is no plot, and files that are what their names say."""
import json
import math
import re
from fractions import Fraction
from itertools import product
from types import SimpleNamespace

import matplotlib
import numpy as np
import pytest
from matplotlib import pyplot as plt
from scipy.integrate import solve_ivp

import stabilab
from stabilab import errors
from stabilab.case.read import read_text
from stabilab.show import style
from stabilab.show.plot import path, subject, surfaces, to_file
from stabilab.show.plot import subject as which
from stabilab.show.plot.over_time import limit_marks
from stabilab.show.space.box import Box
from stabilab.show.space.reach import curves_of
from stabilab.show.text import cost
from tests import shared
from tests.oracles.rigid import euler
from tests.shared import case as load

MOVING = f"{shared.MOVING}span = [0, 100]\n"


def lines(ax):
    return [line for line in ax.get_lines() if len(line.get_xdata()) > 100]


@pytest.mark.parametrize("name, kind", [("minor-axis-100", "phase"), ("liquid-base", "state"),
                                        ("vanguard-1", "state"), ("dual-spin-turn", "time"),
                                        ("cubesat-3u-detumbling", "time")])
def test_a_case_is_plotted_over_time_unless_a_picture_says_more(name, kind):
    """Theories come with a liquid, the vertical with a field; the other two have rates alone to be drawn."""
    assert which.default(which.subject(load(name))) == kind


@pytest.mark.one_in(3)
@pytest.mark.parametrize("title",
                         [r"thrust at $\\foo$, lambda1 = 100", "5 $ of 7 $", r"x_1 \\$ {y}^", "$x$ " * 40])
def test_a_dollar_in_a_title_is_drawn_as_a_dollar(title):
    """Matplotlib takes what stands between dollars for a formula, and stops at one that it cannot read."""
    case = stabilab.load(f'title = "{title}"\n' + MOVING)
    found = stabilab.basin(case, {"angular_velocity[1]": "-1:1:3", "angular_velocity[2]": "-1:1:3"}, depth=0)
    _, ax = plt.subplots()
    for axes in (stabilab.plot.time(case, ax=ax), stabilab.plot.basin(found)):
        axes.figure.draw_without_rendering()
        assert axes.title.get_text().replace(r"\$", "").count("$") == 0
        assert axes.title.get_text().count(r"\$") == title.count("$")


@pytest.mark.parametrize("size", [None, (3.6, 3.0)])
@pytest.mark.parametrize("name", ["cubesat-3u", "middle-axis-equal-100"])
def test_title_and_legend_lie_within_a_picture_and_leave_room_for_its_curves(name, size):
    """Oracle: Matplotlib's own boxes after the layout."""
    with style.drawing():
        figure = stabilab.plot.time(load(name), size=size).figure
        figure.draw_without_rendering()
        (ax,), (below,) = figure.axes, figure.legends
        assert ax.get_window_extent().height > figure.bbox.height / 3
        assert ax.title._get_wrapped_text() == ax.get_title()
        for box in (ax.title.get_window_extent(), below.get_window_extent()):
            assert 0 <= box.x0 and box.x1 <= figure.bbox.width


def test_an_axis_that_varies_by_little_counts_from_a_value_that_its_label_names():
    with style.drawing():
        # omega3 stays within 7e-6 deg/s of 16.2
        figure = stabilab.plot.state(load("charged-body-small-torque"))
        figure.draw_without_rendering()
        (ax,) = [one for one in figure.axes if one.get_ylabel().startswith(r"$\omega_3$")]
        found = re.fullmatch(r"\$\\omega_3\$ − ([\d.]+) \(\$10\^\{(-\d+)\}\$ deg/s\)", ax.get_ylabel())
        told = [float(text.get_text().replace("−", "-")) for text in ax.get_yticklabels()]
        assert float(found[1]) == 16.2 and not ax.yaxis.get_offset_text().get_text()
        assert [float(found[1]) + one * 10.0 ** int(found[2])
                for one in told] == pytest.approx(list(ax.get_yticks()), abs=1e-12)


def test_a_model_that_ends_early_says_so_and_words_on_cuts_tell_both_sides():
    t = np.linspace(0, 9, 50)
    runs = {"exact": SimpleNamespace(t=t, state={"omega": np.column_stack([np.sin(t)] * 3)}),
            "printed": SimpleNamespace(t=t[:40], state={"omega": np.column_stack([20 * np.cos(t[:40])] * 3)},
                                       status="left")}
    with style.drawing():
        figure = cost.picture(plt, load("minor-axis-100"), runs)
        words = [text.get_text() for text in figure.legends[0].get_texts()]
        told = {text.get_text() for ax in figure.axes for text in ax.texts}
        marks = [line.get_xdata() for line in figure.axes[0].get_lines() if line.get_marker() == "X"]
    # 39/49 of 9
    assert words[1].startswith("as printed, ends at 7.16") and [list(one) for one in marks] == [[t[39]]]
    low = (20 * np.cos(t[:40])).min()
    assert told == {f"cut: −{-low:.3g} to 20"}


def test_of_curves_on_each_other_the_later_ones_are_broken_so_that_all_are_seen():
    """Oracle: the pixels of the picture. At rest x2 = x3 = -1; of a spin about axis 3 |omega| = omega3 and
    omega1 = omega2 = 0."""
    rest = stabilab.plot.time(load("off-axis-fold"))
    spin = stabilab.plot.time(stabilab.load("[body]\ninertia = [12, 9, 5]\n[motion]\nangular_velocity = [0, 0, "
                                      "0.1]\nspan = [0, 9]\n"))
    moving = stabilab.plot.time(stabilab.load(MOVING))
    for ax, together in ((rest, 3), (spin, 4), (moving, 4)):
        ax.figure.canvas.draw()
        colours = {tuple(round(255 * c) for c in matplotlib.colors.to_rgb(line.get_color()))
                   for line in ax.get_lines()[:together]}
        box = ax.get_window_extent()
        drawn = np.asarray(ax.figure.canvas.buffer_rgba())[::-1][int(box.y0):int(box.y1),
                                                                 int(box.x0):int(box.x1), :3]
        seen = {colour: int((np.abs(drawn.astype(int) - colour).max(axis=2) < 12).sum())
                for colour in colours}
        assert len(colours) == together and min(seen.values()) > 100, seen
    assert all(line.get_linestyle() == "-" for line in moving.get_lines()[:4])


@pytest.mark.slow
def test_a_state_of_many_parts_is_written_to_several_pictures(tmp_path):
    """liquid-base has its rates alone, top-fast rates and vertical, charged-body five parts."""
    named = lambda name: [path.name for path in to_file.write_all(
        load(name), tmp_path / f"{name}.png", "state", size=(4, 3), dpi=30)]
    assert named("top-fast") == ["top-fast.png"]
    assert named("charged-body") == ["charged-body.png", "charged-body-2.png", "charged-body-3.png"]
    assert len(list(tmp_path.iterdir())) == 4
    for parts in ((), ("omega", "angles", "momentum"), ("gamma",)):
        with pytest.raises(errors.InputError, match="parts: expected one or two of omega, angles"):
            stabilab.plot.state(load("charged-body"), parts=parts)


@pytest.mark.parametrize("units, unit, one", [("deg", "deg", 180 / math.pi), ("si", "rad", 1.0)])
def test_every_part_of_a_state_is_drawn_in_the_units_of_the_other_plots(units, unit, one):
    """Oracle: the states of `simulate`, in rad and s, at the ends."""
    case = load("charged-body-small-torque")
    figure = stabilab.plot.state(case, units=units, span=case.span)
    found = stabilab.simulate(case.scene, case.state, case.span, case.blocks)
    assert len(figure.axes) == 6
    more = stabilab.plot.state(case, units=units, span=case.span, parts=("momentum",)).axes
    panels = {re.sub(r" [−+] [\d.]+ \(\$10\^\{-\d+\}\$ ", " (",
                     ax.get_ylabel()): ax.get_lines()[0].get_ydata()[-1] for ax in (*figure.axes, *more)}
    for n in range(3):
        assert panels[rf"$\omega_{n + 1}$ ({unit}/s)"] == pytest.approx(found.state["omega"][-1, n] * one)
        assert panels[f"$H_{n + 1}$ (kg m²/s)"] == pytest.approx(found.state["momentum"][-1, n])
    assert panels[rf"$\theta$ ({unit})"] == pytest.approx(found.state["angles"][-1, 2] * one, rel=1e-6)


def test_drawn_rates_are_those_of_the_motion():
    """Oracle: SciPy's DOP853 on Euler's equations written by hand."""
    from scipy.integrate import solve_ivp
    t, rates = path.path(subject.subject(stabilab.load(MOVING)), 0.0, 100.0)
    D, wheel, torque = np.array([12.0, 9.0, 5.0]), np.array([0.8, 0, 0]), np.array([0, 0, 0.02])
    run = solve_ivp(euler(D, wheel, torque), (0, 100), (0.1, 0.05, 0.02), method="DOP853", t_eval=t[::50], rtol=1e-11,
                    atol=1e-13)
    assert np.abs(run.y.T - rates[::50]).max() < 1e-8


def test_dotted_lines_stand_at_the_extremes_and_grey_ones_a_period_apart():
    case = stabilab.load(MOVING)
    ax = stabilab.plot.time(case)
    found = stabilab.motion(case.scene, case.state)
    level = {round(float(line.get_ydata()[0]), 9) for line in ax.get_lines() if len(line.get_xdata()) == 2
             and line.get_ydata()[0] == line.get_ydata()[1]}
    assert {round(math.degrees(v), 9) for pair in found.extremes for v in pair} <= level
    upright = [line.get_xdata()[0] for line in ax.get_lines() if len(line.get_xdata()) == 2
               and line.get_xdata()[0] == line.get_xdata()[1]]
    assert np.diff(upright) == pytest.approx(found.period) and len(upright) > 1


def test_the_limit_of_a_case_is_marked_where_the_size_of_the_rate_first_reaches_it():
    """cubesat-3u: 60 deg/s of |omega|; the crossing is judged by the drawn curve itself."""
    ax = stabilab.plot.time(load("cubesat-3u"))
    (when,), (level,) = next(line.get_data() for line in ax.get_lines() if line.get_marker() == "o")
    t, size = lines(ax)[0].get_data()
    assert level == pytest.approx(60, abs=1e-3) and when == pytest.approx(t[np.argmax(size >= 60)], abs=0.05)


def test_limits_about_axes_of_the_file_are_drawn_beside_the_rates_about_those():
    """geostationary-22n states its limits about axes that are not principal; at t = 0 the rates are as the
    file gives them."""
    case = load("geostationary-22n")
    ax = stabilab.plot.time(case)
    start = np.array([line.get_ydata()[0] for line in lines(ax)[1:4]])
    back = case.frame.back([Fraction(v) for v in case.state])
    assert start == pytest.approx([math.degrees(float(v)) for v in back],
                                  abs=1e-9) and "axes of the file" in ax.get_ylabel()
    assert "Spins up; 5 deg/s in a component after" in ax.get_title()  # no room for the axis in 60 letters
    assert "the tolerance of the force of R3" in " ".join(ax.figure.legends[0].get_title().get_text().split())


def test_a_curve_with_more_turns_than_columns_becomes_a_band_that_holds_it():
    t = np.linspace(0, 1000, 40001)
    values = np.sin(2 * np.pi * t)
    _, low, high = path.band(t, values)
    assert path.turning(values) == 2000 and low.max() < -0.99 and high.min() > 0.99


def test_a_scene_alone_is_drawn_on_its_unstable_plane_too():
    """By hand: (x1 + 1 + x3)' = x2 (x1 + 1 + x3), so the plane is kept; with x1 = x3 = -1/2 both components
    have the same last place."""
    one = subject.subject(stabilab.ScaledGyrostat(Fraction(1, 2), 1, (0, 1, 0)), state=(-0.5, 3.0, -0.5))
    t, x = path.path(one, 0.0, 6.0)
    assert t[-1] == 6 and abs(x[:, 0] + 1 + x[:, 2]).max() < 1e-15


def test_a_vertical_that_turns_often_is_shown_over_its_first_turns():
    """vanguard-1: the body turns at 972 deg/s, so the vertical turns back twice in 0.37 s."""
    figure = stabilab.plot.state(load("vanguard-1"))
    (line,) = figure.axes[3].get_lines()
    assert line.get_xdata()[-1] == pytest.approx(24 / 2 * 360 / 972, rel=0.1)


def test_a_motion_that_never_turns_has_one_branch_in_its_plane():
    """torque-free-body goes right round axis 1 (H^2 > 2 T D2), so omega1 keeps its sign; one in a well has
    both."""
    def signs(name):
        ax = stabilab.plot.phase(load(name))
        return sorted(float(np.sign(line.get_ydata()[len(line.get_ydata()) // 2])) for line in ax.get_lines()
                      if line.get_color() == MOTION)
    assert signs("torque-free-body") == [1.0] and signs("minor-axis-100") == [-1.0, 1.0]


def test_a_motion_all_but_at_rest_in_a_single_well_is_drawn_between_its_walls():
    """The bottom of the well lies 3e-4 from the start, between two points of the grid: the height of the
    picture was the root of a negative number."""
    ax = plt.figure().add_subplot()
    stabilab.plot.phase(load("charged-body-small-torque"), ax=ax)
    low, high = ax.get_ylim()
    assert math.isfinite(low) and math.isfinite(high) and high - low > 1e3 * abs(
        np.ptp(next(line for line in ax.get_lines() if line.get_color() == MOTION).get_ydata()))


@pytest.mark.parametrize("size", [1, 1e-2, 1e-4])
def test_a_motion_between_walls_fills_its_phase_plane_whatever_its_size_in_rad_a_second(size):
    """A slower body with a weaker torque moves alike (rates by a factor, torque by its square), and so does
    its picture."""
    case = read_text("slow.toml", f"""[body]
inertia = [8.7, 8.6, 11.1]
[effects.gyrostat]
momentum = [0, 0, {1.3 * size}]
[effects.constant_torque]
torque = [{4 * size**2}, 0, 0]
[motion]
angular_velocity = [0, 0, {0.28 * size}]
""")
    ax = stabilab.plot.phase(case)
    motion = next(line for line in lines(ax) if line.get_color() == style.MEANING["this motion"]["color"])
    low, high = ax.get_xlim()
    assert 0.5 < np.ptp(motion.get_xdata()) / (high - low) < 0.9


def test_a_bounded_motion_lies_in_its_phase_plane_whole():
    """That of uncertain-separatrix swings to 95 % of the way to a saddle on one side, and farther than a turn
    and a third from the middle on the other."""
    ax = stabilab.plot.phase(load("uncertain-separatrix"))
    (low, high), motion = ax.get_xlim(), [line for line in ax.get_lines() if line.get_color() == MOTION]
    turns = np.concatenate([line.get_xdata() for line in motion])
    ends = motion[0].get_ydata()[[0, -1]]
    assert low < turns.min() and turns.max() < high and np.abs(ends).max() < 1e-3 * np.abs(
        motion[0].get_ydata()).max()


def test_a_motion_of_a_ten_thousandth_of_the_picture_is_shown_enlarged():
    """Its turning points are known to 1e-14 of the picture, which leaves some 1e-6 of its rate there."""
    small = stabilab.plot.phase(load("charged-body-small-torque"))
    (plane, enlarged) = small.figure.axes
    assert len(stabilab.plot.phase(load("minor-axis-100")).figure.axes) == 1
    assert np.ptp(enlarged.get_ylim()) < 1e-3 * np.ptp(plane.get_ylim())


def test_a_band_of_uncertain_rates_holds_the_motions_at_its_corners():
    """Rates of uncertain-separatrix at the highest and the lowest of its numbers, by SciPy's DOP853 on
    Euler's equations written out here; 16 of the 32 corners are drawn, so a band is no bound."""
    ax = stabilab.plot.time(load("uncertain-separatrix"), span=5.0)
    names = [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert "between 16 uncertain samples" in names
    ends = []
    for sign in product((-1, 1), repeat=5):
        a, b, c, d, e = sign
        D, wheel = np.array([20 * (1 + 0.01 * a), 15 * (1 + 0.01 * b), 10]), np.array([3 + 0.05 * c, 2, 0])
        torque = np.array([0, 0, 0.1 * (1 + 0.05 * d)])
        run = solve_ivp(euler(D, wheel, torque), (0, 5),
                        [0.2, 0.15, 1.7 + 0.02 * e], "DOP853", rtol=1e-9, atol=1e-12)
        ends.append(np.degrees(run.y[:, -1]))
    ends = np.array(ends)
    bands = [band.get_paths()[0].vertices for band in ax.collections][:3]
    for n, band in enumerate(bands):
        last = band[np.isclose(band[:, 0], 5.0), 1]
        assert all(np.abs(ends[:, n] - value).min() < 1e-4 for value in (last.min(), last.max()))


EVERYWHERE = {"time", "space", "budget"}
KINDS = {"minor-axis-100": EVERYWHERE | {"phase", "potential", "sphere", "section", "equilibria"},
         "off-axis-two": EVERYWHERE | {"equilibria"},
         "major-axis-100": EVERYWHERE,
         "torque-free-gyrostat": EVERYWHERE | {"phase", "potential", "sphere", "section", "equilibria"},
         "liquid-base": EVERYWHERE | {"state", "equilibria"},
         "charged-body": EVERYWHERE | {"phase", "potential", "sphere", "section", "state", "equilibria"},
         "top-fast": EVERYWHERE | {"state", "equilibria"}}


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", KINDS)
def test_every_kind_of_scene_knows_its_kinds_of_plot(name):
    one = subject.subject(load(name))
    known = KINDS[name] | {"body"} | ({"attitude", "nutation"} if one.physical else set())  # a body to turn
    assert set(which.offered(one)) == known
    for kind in set(which.KINDS) - known:
        with pytest.raises(errors.InputError, match="this one has time"):
            which.check(kind, one)


def test_a_picture_has_the_size_and_the_dots_asked_for(tmp_path):
    from PIL import Image
    with Image.open(to_file.write(load("middle-axis-100"), tmp_path / "a.png", "phase", size=(5, 3),
                                  dpi=200)) as image:
        assert image.size == (1000, 600)


@pytest.mark.parametrize("options, words", [
    ({"kind": "nope"}, "expected one of time, phase"), ({"size": (0, 3)}, "1 to 60 inches"),
    ({"dpi": 3}, "10 to 1200 dots"),
    ({"kind": "time", "units": "knots"}, "expected one of deg, deg/day, rpm, rev/s, si")])
def test_what_cannot_be_drawn_is_refused_and_nothing_is_written(options, words, tmp_path):
    with pytest.raises(errors.InputError, match=words):
        to_file.write(load("middle-axis-100"), tmp_path / "a.png", **options)
    assert not list(tmp_path.iterdir())


def test_a_scene_is_drawn_with_a_state_on_the_axes_that_are_given():
    _, ax = plt.subplots()
    assert stabilab.plot.time(load("off-axis-two").scene, (0.1, 0.2, 0.3), span=20, ax=ax) is ax and lines(ax)
    assert stabilab.plot.phase(load("minor-axis-100"), ax=ax) is ax


@pytest.mark.parametrize("given, options, words", [
    (3, {}, "expected a case"), (None, {}, "expected a case"),
    (load("off-axis-two").scene, {}, "it needs a state"),
    (load("off-axis-two").scene, {"state": [[0.1, 0.2, 0.3]]}, "of one motion"),
    (load("middle-axis-100"), {"ax": plt.figure().add_subplot(projection="3d")}, "expected plane axes"),
    (load("middle-axis-100"), {"ax": 3}, "expected Matplotlib axes")])
def test_what_is_no_case_no_motion_or_no_axes_is_refused(given, options, words):
    with pytest.raises(errors.InputError, match=words):
        stabilab.plot.time(given, **options)


# -- in space --


def spatial(ax, colour):
    """The lines (n, 3) of a colour on three-dimensional axes."""
    return [np.array(line.get_data_3d()).T for line in ax.get_lines() if line.get_color() == colour]


MOTION, BLACK, BLUE, VERMILION = style.VIOLET, style.BLACK, style.BLUE, style.VERMILION


def of_free_body(H, D, wheel=(0, 0, 0)):
    return (((H - np.array(wheel)) ** 2) / (2 * np.array(D))).sum(axis=-1)


def test_a_motion_is_followed_once_for_all_pictures_of_its_span(monkeypatch):
    item, followed, along = subject.subject(load("charged-body")), [], path.along
    monkeypatch.setattr(path, "along", lambda *of: (followed.append(of), along(*of))[1])
    with style.drawing():
        stabilab.plot.time(item)
    t, omega = path.path(item, *item.seen)
    assert len(followed) == 1 and not omega.flags.writeable and len(t) == len(omega) == path.FINE


@pytest.mark.first(1, 3)
@pytest.mark.parametrize("scale", [2.0**-18, 2.0**40, 1.0, 2.0**-60])
def test_equilibria_are_found_at_rates_of_any_size(scale):
    """By hand: without torque and wheel they are the principal axes, H = +-|H| e_i, that of the middle moment
    unstable; nothing of it depends on the unit of the rates."""
    item = subject.subject(stabilab.Scene(stabilab.Body((3.25, 3.0, 1.0))), (0.375 * scale, 0.25 * scale, scale))
    size = math.hypot(3.25 * 0.375, 3.0 * 0.25, 1.0) * scale
    drawn = surfaces.momentum_sphere(item)
    points = np.array([point[0] for point, look in drawn.marks[:-1]]) / size  # the last is the start
    assert len(points) == 6 and np.abs(np.sort(np.abs(points), axis=1) - [0, 0, surfaces.LIFT]).max() < 1e-9
    assert {"stable equilibrium", "unstable equilibrium"} <= {text for text, _ in drawn.rows}
    curves = curves_of(stabilab.equilibria(item.scene), Box((0.0,) * 3, (2 * scale,) * 3))
    axes = sorted((int(np.abs(line[0]).argmax()), text.split()[0], np.abs(line).max() > 1.9 * scale)
                  for text, line in curves)
    assert axes == [(0, "stable", True)] * 2 + [(1, "unstable", True)] * 2 + [(2, "stable", True)] * 2
    assert stabilab.plot.equilibria(item).get_xlim()[1] < 10 * np.degrees(scale)


def test_on_the_momentum_sphere_the_motion_keeps_its_energy_and_the_separatrix_that_of_the_middle_axis():
    """Euler: T = H^2 / (2 D2) on the separatrix of a free body; 3, 2, 1 kg m^2."""
    ax = stabilab.plot.sphere(load("torque-free-body"))
    motion, separatrix = (np.concatenate([line[np.isfinite(line).all(axis=1)] for line in spatial(ax, colour)
                                          if len(line) > 2])
                          for colour in (MOTION, BLACK))
    size = np.linalg.norm(motion, axis=1)
    assert np.ptp(size) < 1e-9 * size[0]
    start = np.array([3, 2, 1]) * (0.2, 0.4, 0.3)
    drawn = size[0] / np.linalg.norm(start)
    assert drawn == pytest.approx(1.002)
    assert of_free_body(motion, (3, 2, 1)) == pytest.approx(drawn**2 * of_free_body(start, (3, 2, 1)))
    # of a grid of half a degree
    assert of_free_body(separatrix, (3, 2, 1)) == pytest.approx(size[0] ** 2 / 4, rel=2e-4)


def test_under_a_torque_on_the_minor_axis_all_lines_stay_on_the_circle_of_the_paper():
    """Amer et al. 2024: (x1 + a)^2 + x2^2 is constant for a torque on axis 3."""
    case = load("minor-axis-100")
    ax = stabilab.plot.sphere(case)
    radius = math.hypot(case.state[0] + case.scene.a, case.state[1])
    lines = [line for line in spatial(ax, MOTION) + spatial(ax, BLACK) if len(line) > 10]
    assert len(lines) >= 4
    for line in lines:
        assert np.hypot(line[:, 0] + case.scene.a,
                        line[:, 1])[np.isfinite(line[:, 0])] == pytest.approx(radius)


@pytest.mark.parametrize("name", ["off-axis-two", "torque-free-gyrostat", "cubesat-3u"])
def test_a_motion_in_space_has_its_shadows_on_the_walls_and_arrows_along_the_flow(name):
    """The flow by Euler's equations written out here, in the numbers of the case."""
    case = load(name)
    ax = stabilab.plot.space(case, units="si")
    path = np.array([line for line in ax.get_lines() if line.get_color() == MOTION][0].get_data_3d()).T
    shadows = [np.array(line.get_data_3d()).T for line in ax.get_lines() if line.get_color() == "#BDBDBD"]
    for axis, shadow in zip(range(3), shadows, strict=True):
        others = [n for n in range(3) if n != axis]
        assert np.array_equal(shadow[:, others], path[:, others]) and np.ptp(shadow[:, axis]) == 0
    inertia = np.array([float(v) for v in case.scene.body.inertia])
    wheel, torque = (np.array([float(v) for v in case.scene.vector(effect)])
                     for effect in ("gyrostat", "constant_torque"))
    arrows = [np.array(line.get_data_3d()).T for line in ax.get_lines()
              if line.get_color() == MOTION and len(line.get_data_3d()[0]) == 3]
    assert len(arrows) == 3
    for barb, head, other in arrows:
        tail = (barb + other) / 2
        middle = (tail + head) / 2
        flow = (np.cross(inertia * middle + wheel, middle) + torque) / inertia
        along = (head - tail) @ flow / np.linalg.norm(head - tail) / np.linalg.norm(flow)
        assert along > 0.98  # an arrow is a chord of the path's own length


def test_triangles_cut_by_a_box_keep_the_area_inside():
    """A square of side 4 in the plane z = 0 across a box of side 2 about the origin leaves 4 of its area."""
    from stabilab.show.plot.in_space import between, clipped
    corners = np.array([[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], float)
    inside = clipped(between(np.full(3, -1.0), np.full(3, 1.0)), corners[[[0, 1, 2], [0, 2, 3]]])
    area = (np.linalg.norm(np.cross(inside[:, 1] - inside[:, 0], inside[:, 2] - inside[:, 0]),
                           axis=1).sum() / 2)
    assert area == pytest.approx(4) and np.abs(inside).max() <= 1 + 1e-12


def test_stable_and_unstable_equilibria_differ_in_form_and_colour():
    """minor-axis-100: the hyperbola x3 = 0, x2 (x1 + b) = -1, two stable and two unstable pieces."""
    case = load("minor-axis-100")
    ax = stabilab.plot.equilibria(case)
    curves = [line for line in ax.get_lines() if len(line.get_xdata()) > 100]
    looks = {(line.get_color(), line.get_linestyle()) for line in curves}
    assert looks == {(BLUE, "-"), (VERMILION, "--")} and len(curves) == 4
    for line in curves:
        x, y = (v[np.isfinite(v)] for v in line.get_data())
        assert y * (x + case.scene.b) == pytest.approx(-1)


def test_equilibria_are_drawn_without_a_motion_and_refused_where_there_are_none():
    assert stabilab.plot.equilibria(stabilab.load(shared.SATELLITE)).get_lines()
    with pytest.raises(errors.InputError, match="there is nothing to draw: an equilibrium needs"):
        stabilab.plot.equilibria(load("major-axis-100"))


def test_given_axes_decide_whether_equilibria_are_drawn_in_space():
    _, ax = plt.subplots(subplot_kw={"projection": "3d"})
    assert stabilab.plot.equilibria(load("minor-axis-100"), ax=ax) is ax
    _, flat = plt.subplots()
    with pytest.raises(errors.InputError, match="three-dimensional"):
        stabilab.plot.equilibria(load("torque-free-gyrostat"), ax=flat)


# -- attitude --


def test_the_box_turns_as_a_body_that_keeps_its_momentum_in_space():
    """Without a torque R (D omega) is constant; the box of 3, 2, 1 kg m^2: edges as sqrt(2 + 1 - 3), sqrt(3 +
    1 - 2), sqrt(3 + 2 - 1)."""
    from stabilab.show.plot.turning import THINNEST, turn
    found = turn(subject.subject(load("torque-free-body")), 150)
    momentum = np.einsum("nij,nj->ni", found.rotations, found.omega * (3, 2, 1))
    assert np.abs(momentum - momentum[0]).max() < 1e-12 and found.whole
    assert found.edges == pytest.approx([THINNEST, math.sqrt(0.5), 1.0])


def test_a_film_has_the_momentum_that_stays_without_a_torque_and_the_share_of_the_limit():
    """Without a torque the momentum of body and wheel rests in space; cubesat-3u is at 60 deg/s, its limit,
    after 16.95 s (SciPy's DOP853 in test_to_limit)."""
    from stabilab.show.plot.turning import turn
    free = turn(subject.subject(load("torque-free-gyrostat")), 150)
    assert np.abs(free.momentum - free.momentum[0]).max() < 1e-11 * np.abs(free.momentum).max()
    assert [letter for letter, *_ in free.arrows] == ["H", "λ"] and free.share is None
    found = turn(subject.subject(load("cubesat-3u"), span=20.0), 400)
    assert float(np.interp(1.0, found.share, found.t)) == pytest.approx(16.95, abs=0.01)
    assert [letter for letter, *_ in found.arrows] == ["H", "M", "λ"]


def test_the_vertical_of_a_top_stands_upright_in_space_all_the_time():
    """R gamma is the third axis of space, with gamma of a run of its own equations (Poisson), which know no
    attitude."""
    from stabilab.answers.simulate import simulate
    from stabilab.show.plot.turning import turn
    case = load("top-lx30-lz30")
    found = turn(subject.subject(case), 20)
    gamma = simulate(case.scene, case.state, found.t, case.blocks).state["gamma"]
    assert gamma[0] == pytest.approx([1, 0, 0.001], abs=1e-6)
    # both runs are good to some 1e-12
    assert np.abs(np.einsum("nij,nj->ni", found.rotations, gamma) - (0, 0, 1)).max() < 1e-9


@pytest.mark.parametrize("frames", [40, 100])
def test_a_film_of_a_spin_up_goes_slow_at_its_start_its_limit_and_its_end_and_fast_between(frames):
    """cubesat-3u is at its limit after 16.95 s (SciPy's DOP853 in test_to_limit) and followed for four times that.
    Oracle of the angles: the trace of R^T R' of two pictures."""
    from stabilab.show.plot.turning import turn
    from stabilab.show.units import units_of
    case = load("cubesat-3u")
    found = turn(subject.subject(case), frames)
    assert len(found.t) == frames and (np.diff(found.t) > 0).all() and found.whole
    assert found.t[0] == 0 and found.t[-1] == pytest.approx(67.79, abs=0.01)
    angles = np.degrees(np.arccos(np.clip((np.einsum("nij,nij->n", found.rotations[1:], found.rotations[:-1]) - 1)
                                          / 2, -1, 1)))
    start, limit, end = found.even
    assert all(angles[a:b].max() < 15.5 for a, b in found.even)
    assert start[0] == 0 and end[1] == frames - 1 and found.t[limit[0]] < 16.95 < found.t[limit[1]]
    steps = np.diff(found.t)
    # fast: more time from picture to picture
    assert np.median(steps[limit[1]:end[0]]) > 5 * max(steps[end[0]:end[1]])
    notes = found.notes(units_of(case))
    assert (*limit, "limit: 16.95 s") in notes and [text for *_, text in notes].count("fast") == 2


def test_a_film_says_how_it_goes_and_when_the_limit_is_reached(tmp_path):
    """The body without a torque has no limit and is shown evenly."""
    for name, told in (("cubesat-3u", r"Slow at the start, at 16\.95 s \(limit\) and at the end, fast between\."),
                       ("torque-free-body", "")):
        moving = stabilab.plot.attitude(load(name), frames=100)
        moving._draw_was_started = True
        words = " ".join(text.get_text() for text in moving._fig.axes[0].texts)
        page = to_file.write(load(name), tmp_path / f"{name}.html", "attitude").read_text(encoding="utf-8")
        data = json.loads(re.search(r"const data = (.*?);\n", page)[1])
        assert re.search(told, words) and (told or "Slow" not in words)
        assert [text for *_, text in data["notes"]] == ["limit: 16.95 s"] * bool(told)
        assert ("SPINS UP" in page.upper()) == bool(told)  # the answer heads the page


def test_the_page_of_an_attitude_needs_nothing_else_and_its_title_is_as_written_and_ends_no_script(tmp_path):
    case = stabilab.load('title = "</script><b>lambda3 = 2 kg m^2/s"\n' + MOVING)
    one, two = (to_file.write(case, tmp_path / name).read_bytes() for name in ("a.html", "b.html"))
    page = one.decode()
    assert one == two and "http" not in page.replace("http-equiv", "") and "default-src 'none'" in page
    assert page.count("</script>") == 1 and page.count("lambda3 = 2 kg m^2/s") == 2
    assert '"names":["x","y","z"]' in page


def test_a_film_is_a_gif_and_what_cannot_be_written_names_what_is_missing(tmp_path, monkeypatch):
    from PIL import Image

    from stabilab.show.plot import turning as animation
    monkeypatch.setattr(animation, "PICTURES", 3)
    case = stabilab.load(MOVING)
    with Image.open(to_file.write(case, tmp_path / "a.gif", size=(2, 2), dpi=50)) as image:
        assert image.format == "GIF" and image.n_frames == 3 and image.size == (100, 100)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(errors.RenderingUnavailable, match="apt install ffmpeg"):
        to_file.write(case, tmp_path / "a.mp4")
    with pytest.raises(errors.InputError, match=r"ends in .html, .gif or .mp4, got .png"):
        to_file.write(case, tmp_path / "a.png", "attitude")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.gif"]


@pytest.mark.one_in(6)
@pytest.mark.parametrize("size", [None, (3.6, 3.0), (3.0, 3.0)])
@pytest.mark.parametrize("name", ["two-wheels-minor-axis", "torque-free-gyrostat", "middle-axis-double-well"])
def test_the_third_axis_is_named_upwards_and_an_axis_seen_from_its_end_has_fewer_ticks(name, size):
    """Oracle: the ticks' own boxes, of which no two lie on each other."""
    ax = stabilab.plot.sphere(load(name), size=size)
    ax.figure.draw_without_rendering()
    assert ax.zaxis.label.get_rotation() == (90 if " " in ax.get_zlabel() else 0)
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        low, high = sorted(axis.get_view_interval())
        boxes = [tick.label1.get_window_extent() for tick in axis.get_major_ticks()
                 if low <= tick.get_loc() <= high]
        assert len(boxes) >= 2
        assert not [1 for n, box in enumerate(boxes) for other in boxes[:n] if _deep(box, other)]


def _deep(box, other):
    """Whether two boxes share more than a fifth of the smaller one."""
    wide, high = min(box.x1, other.x1) - max(box.x0, other.x0), min(box.y1, other.y1) - max(box.y0, other.y0)
    return (wide > 0 and high > 0
            and wide * high > 0.2 * min(box.width * box.height, other.width * other.height))


@pytest.mark.parametrize("ends, words, marks", [
    ((4.0, 4.1), "reached after 4.05 s", 1), ((2.0, 8.0), "reached after 2.0 to 8.0 s", 0), ((20.0, 30.0), None, 0),
    (None, None, 0), ((float("inf"), float("inf")), None, 0), ((2.0, float("nan")), None, 0)])
def test_a_time_between_ends_far_apart_is_a_band(ends, words, marks):
    """A limit reached in 4.0 to 4.1 s is a point; 2 to 8 s, of which no middle is known, both ends of a band."""
    t = np.linspace(0, 10, 11)
    figure, ax = plt.subplots()
    rows = limit_marks(ax, 0.5, ends, t, np.outer(t, [0.1, 0, 0]), ("s", 1.0), ("rad/s", 1.0))
    assert [text for text, _ in rows[1:]] == ([words] if words else [])
    assert sum(line.get_marker() == "o" for line in ax.lines) == marks
    spans = [patch.get_extents().transformed(ax.transData.inverted()) for patch in ax.patches]
    assert [(round(box.x0, 9), round(box.x1, 9)) for box in spans] == ([(2, 8)] if words and not marks else [])
    plt.close(figure)


def test_a_reason_names_only_what_acts_in_the_scene():
    """As the files have it: [effects.gyrostat] and [effects.constant_torque], their components by hand."""
    why = lambda kind, name: which.why_not(kind, subject.subject(load(name)))
    for name, acting in (("minor-axis-100", "a wheel and a constant torque"), ("torque-free-gyrostat", "a wheel"),
                         ("minor-axis-without-wheel", "a constant torque"),
                         ("torque-free-body", "a body on which nothing acts")):
        assert why("state", name).startswith(f"no approximate theory comes with {acting}: "), name
    assert why("phase", "major-axis-100").endswith(": the gyrostatic moment has a component along the torque")
    assert why("phase", "off-axis-one").endswith(": the torque is off the principal axes")
    assert why("sphere", "off-axis-one").endswith("on which the motion stays: the torque is off the principal axes")
    scene = stabilab.Scene(stabilab.Body((3, 2, 1)), stabilab.Gyrostat((1, 2, 3)))
    assert which.why_not("phase", subject.subject(scene, (1, 2, 3))).endswith("components along all three axes")


@pytest.mark.parametrize("heading", ["A top", "A top " * 40])
@pytest.mark.parametrize("line", ["", "Bounded for ever", "clause of an answer; " * 12])
@pytest.mark.parametrize("inches", [3.4, 7.6, 13.0])
def test_a_title_has_two_lines_and_what_is_left_out_of_it_is_handed_on(heading, line, inches):
    """What is not the heading is the line, whole, or it comes back."""
    with style.drawing():
        text, _, rest, own = style.titled(heading, [line] if line else [], inches)
    assert text.count("\n") < style.TITLE_LINES and text.endswith(own)
    assert own.split() == ([] if rest else line.split()) and rest in ([], [line])
    assert text[:5] == heading[:5] or own.count("\n") == 1
