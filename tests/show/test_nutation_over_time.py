"""The picture and the column of the nutation, against SciPy's DOP853 on equations written in tests/oracles, with the
attitude where the angle is to a direction in space."""
from __future__ import annotations

import json
import math
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab as package
from stabilab.errors import InputError
from stabilab.show import style
from stabilab.show.plot import nutation
from tests.oracles.rigid import damped, euler, in_space, with_a_direction
from tests.shared import CASES

pytest.importorskip("matplotlib")


def angle(vectors, axis):
    """(n,) deg between vectors (n, 3) and an axis, by the half-angle, which is exact for small ones and for all."""
    u, v = np.array(vectors) / np.linalg.norm(vectors, axis=1)[:, None], np.array(axis, float)
    return np.degrees(2 * np.arctan2(np.linalg.norm(u - v, axis=1), np.linalg.norm(u + v, axis=1)))


def curve(ax, colour=style.VIOLET):
    """(t, values) of the curve of a colour; lines across the axes have two places."""
    line, = (line for line in ax.lines if line.get_color() == colour and len(line.get_xdata()) > 2)
    return line.get_xdata(), line.get_ydata()


def across(ax, look):
    """Heights of the horizontal lines of a look."""
    return [line.get_ydata()[0] for line in ax.lines if len(line.get_xdata()) == 2
            and line.get_color() == look and line.get_ydata()[0] == line.get_ydata()[1]]


def scipy(rates, start, t):
    return solve_ivp(rates, (0, t[-1]), start, method="DOP853", rtol=1e-10, atol=1e-12, t_eval=t).y


def words(ax):
    return [text.get_text() for text in ax.figure.legends[0].get_texts()]


def test_of_a_free_body_it_goes_between_the_bounds_of_its_polhode():
    """By hand: on the polhode of H^2 and T cos^2 of the minor axis' angle is greatest where w2 = 0 and least where w1 =
    0, H3^2 = D3 (D_i 2T - H^2)/(D_i - D3), i the axis that is left."""
    D, w = np.array([3.0, 2.5, 1.0]), np.array([0.03, 0.01, 0.1])
    text = {"body": {"inertia": [3, "2.5", 1]}, "motion": {"angular_velocity": ["0.03", "0.01", "0.1"], "span": [0, 300]}}
    with style.drawing():
        ax = nutation(text, units="si")
        t, found = curve(ax)
        H2, T2 = (D * D * w * w).sum(), (D * w * w).sum()
        bounds = sorted(math.acos(math.sqrt(D[2] * (D[i] * T2 - H2) / (D[i] - D[2]) / H2)) for i in (0, 1))
        assert across(ax, style.VIOLET) == pytest.approx(bounds, rel=1e-9)
        assert found.min() == pytest.approx(bounds[0], rel=1e-5) and found.max() == pytest.approx(bounds[1], rel=1e-5)
        some = np.linspace(0, len(t) - 1, 40).astype(int)
        H = scipy(euler(D), w, t[some]).T * D
        np.testing.assert_allclose(np.degrees(found[some]), angle(H, (0, 0, 1)), atol=1e-6)  # SciPy
        assert words(ax)[0] == "this motion: z to the angular momentum"


def test_of_a_flat_spin_it_grows_from_the_minor_axis_and_ends_across_it():
    """The page's case of Rahn and Barba 1991; SciPy with the sphere and its fluid; the end is by hand a quarter turn."""
    D, k, c = np.array([2000.0, 1500, 1000]), 18.0, 30.0
    with style.drawing():
        ax = nutation(CASES / "rahn-barba.toml", span=480, units="deg")
        t, found = curve(ax)
        some = np.linspace(0, len(t) - 1, 60).astype(int)
        y = scipy(damped(D, k, c), [0.1224, 0, 2.99, 0, 0, 0], 60 * t[some])
        H = y[:3].T * D + k * y[3:].T
        np.testing.assert_allclose(found[some], angle(H, (0, 0, 1)), atol=1e-4)
        assert across(ax, style.BLUE) == [pytest.approx(90)]
        assert any("separatrix crossed after 7.84 min" in text for text in words(ax))  # of flat-spin, the paper's 7.8
        folds = [line for line in ax.lines if line.get_color() == style.GREY and len(line.get_xdata()) > 2]
        growth, = folds  # the decay is later
        grown = np.diff(np.log(growth.get_ydata())) / np.diff(60 * growth.get_xdata())
        w, outer, matrix = 2.99, D - k, np.zeros((4, 4))  # of w1, w2, s1, s2 about (0, 0, w): tests/oracles by hand
        matrix[0] = [0, (outer[1] - outer[2]) * w / outer[0], c / outer[0], 0]
        matrix[1] = [(outer[2] - outer[0]) * w / outer[1], 0, 0, c / outer[1]]
        matrix[2] = [-matrix[0, 0], -matrix[0, 1], -c / k - c / outer[0], w]
        matrix[3] = [-matrix[1, 0], -matrix[1, 1], -w, -c / k - c / outer[1]]
        wanted = np.linalg.eigvals(matrix).real.max()  # of |H| = 2990 N m s, 0.3 % above that
        assert grown == pytest.approx(wanted, rel=5e-2)


def test_under_a_torque_it_shows_how_far_the_axis_turns_from_its_start():
    D, M, w = np.array([70.0, 60.0, 100.0]), np.array([1.5, 0, 2.0]), np.array([0.02, 0.03, 0.4])
    text = {"body": {"inertia": D.tolist()}, "effects": {"constant_torque": {"torque": ["1.5", 0, 2]}},
            "motion": {"angular_velocity": ["0.02", "0.03", "0.4"], "span": [0, 40]}}
    with style.drawing():
        ax = nutation(text, span=40, units="deg")
        (t, lean), (_, apart) = curve(ax), curve(ax, style.BLACK)
        some = np.linspace(0, len(t) - 1, 40).astype(int)
        y = scipy(in_space(euler(D, torque=M)), [*w, *np.eye(3).ravel()], t[some])
        np.testing.assert_allclose(lean[some], angle(y[:3].T * D, (0, 0, 1)), atol=1e-6)  # SciPy
        np.testing.assert_allclose(apart[some], angle(y[3:].reshape(3, 3, -1)[:, 2].T, (0, 0, 1)), atol=1e-5)
        assert "z to its direction at the start" in words(ax)


def test_of_a_top_it_is_the_lean_between_the_roots_of_its_cubic():
    with style.drawing():
        ax = nutation(CASES / "toy-top.toml", span=0.5, units="deg")
        t, found = curve(ax)
        gamma = np.array([0.0871557, 0, -0.9961947])
        some = np.linspace(0, len(t) - 1, 40).astype(int)
        y = scipy(with_a_direction([1.74e-4, 1.74e-4, 4.8e-5], arm=(0, 0, 0.981 * 0.0375)),
                  [0, 0, 50 * math.pi, *gamma], t[some])
        np.testing.assert_allclose(found[some], angle(-y[3:].T, (0, 0, 1)), atol=1e-5)  # SciPy
        low, high = across(ax, style.VIOLET)
        assert found.min() == pytest.approx(low, abs=1e-5) and found.max() == pytest.approx(high, abs=1e-5)
        assert ax.get_ylabel() == "lean (deg)"


def test_its_bounds_have_the_digits_that_tell_them_apart():
    """By hand: of a body with D1 = D2 (1 - 1e-4) the bounds are close to each other; of D1 = D2 both are
    atan2(D1 w1, D3 w3)."""
    for first, least in (("2.5", 1), ("2.49975", 2)):
        text = {"body": {"inertia": [first, "2.5", 1]}, "motion": {"angular_velocity": ["0.03", "0.01", "0.1"], "span": [0, 300]}}
        with style.drawing():
            ax = nutation(text, units="deg", axis="z")
            ends = across(ax, style.VIOLET)
            printed = [float(n) for n in re.findall(r"[\d.]+", words(ax)[1])]
        assert len(set(printed)) == len(printed) == least
        if least == 2:
            assert printed == pytest.approx(sorted(ends), abs=0.5 * (max(ends) - min(ends)))
        else:
            angle = math.degrees(math.atan2(2.5 * math.hypot(0.03, 0.01), 0.1))
            assert words(ax)[1].startswith("for ever: ") and printed[0] == pytest.approx(angle, rel=1e-4)


def test_two_curves_are_angles():
    with style.drawing():
        assert nutation(CASES / "thruster-stuck-major-axis.toml", units="deg").get_ylabel() == "angle (deg)"
        assert nutation(CASES / "toutatis.toml", units="deg").get_ylabel() == "nutation (deg)"


def test_a_long_motion_is_the_band_between_its_least_and_greatest():
    """Against the bounds for ever, which the first test has by hand."""
    text = {"body": {"inertia": [3, "2.5", 1]}, "motion": {"angular_velocity": ["0.3", "0.1", 1], "span": [0, 9000]}}
    with style.drawing():
        ax = nutation(text, span=9000, units="deg")
        low, high = across(ax, style.VIOLET)
        band, = ax.collections
        heights = band.get_paths()[0].vertices[:, 1]
        assert low - 1e-6 <= heights.min() < low + 0.05 * (high - low)
        assert high - 0.05 * (high - low) < heights.max() <= high + 1e-6


@pytest.mark.parametrize("text, why", [
    (CASES / "minor-axis-100.toml", "scaled variables have no body"),
    ({"body": {"inertia": [3, 2, 1]}, "motion": {"angular_velocity": [1, 0, 0]}}, "each axis keeps its angle"),
    ({"body": {"inertia": [3, 2, 1]}, "effects": {"constant_torque": {"torque": [0, 1, 1]}},
      "motion": {"angular_velocity": [0, 0, 0], "span": [0, 9]}}, "the angular momentum is zero")])
def test_what_has_no_such_angle_is_refused(text, why):
    with pytest.raises(InputError, match=why):
        nutation(text)


def test_the_axis_is_that_of_the_file_the_nearest_one_or_the_one_that_is_given():
    body = {"body": {"inertia": [3, "2.5", 1]}}
    spun = body | {"motion": {"spin": "1 rad/s", "axis": [1, 1, 0], "nutation": "20 deg", "span": [0, 9]}}
    back = body | {"motion": {"angular_velocity": ["0.01", 0, -1], "span": [0, 9]}}
    with style.drawing():
        ax = nutation(spun)
        assert words(ax)[0] == "this motion: the axis of the spin to the angular momentum"
        assert curve(ax)[1][0] == pytest.approx(20, abs=1e-9)  # deg, as the file says
        ax = nutation(back)
        assert words(ax)[0].startswith("this motion: −z to") and curve(ax)[1][0] < 2
        assert words(nutation(back, axis="x"))[0].startswith("this motion: x to")
    with pytest.raises(InputError, match="axis: expected x, y, z"):
        nutation(back, axis="w")
    with pytest.raises(InputError, match="a nutation alone"):
        package.plot.write(back, "none.png", "time", axis="z")


@pytest.mark.parametrize("name", ["dual-spin-damper", "toutatis"])
def test_a_run_has_it_as_a_column_in_every_view(name, stabilab):
    """By hand: H = D omega + wheel + k sigma of the same run's columns."""
    case = package.load(CASES / f"{name}.toml")
    run = case.simulate([0, 10, 50], nutation="y")
    H = np.array(case.scene.body.inertia) * run.state["omega"]
    H = H + (np.array([float(v) for v in case.scene.vector("gyrostat")]) if name.startswith("dual") else 0)
    if "damper" in run.state:
        H = H + float(case.scene.effect("viscous_damper").exact[0]) * run.state["damper"]
    np.testing.assert_allclose(np.degrees(run.state["nutation"]), angle(H, (0, 1, 0)), rtol=1e-12)
    assert run.nutation_axis == "y" and 0 <= run.error["nutation"] < 1e-8
    data = run.to_xarray()
    assert data["nutation"].attrs["units"] == "rad"
    printed = json.loads(stabilab("simulate", str(CASES / f"{name}.toml"), "--at", "0,10,50", "--nutation", "y", "--json")[1])
    assert printed["nutation_axis"] == "y"
    np.testing.assert_allclose(printed["state"]["nutation"], run.state["nutation"], rtol=1e-9)


def test_a_damper_that_turns_in_a_body_at_rest_is_no_equilibrium():
    """By hand: H = 0.1 (1, 2, 3) kg m^2/s at the start, nearest to z."""
    with style.drawing():
        ax = nutation({"body": {"inertia": [3, 2, 1]}, "effects": {"viscous_damper": {"inertia": "0.1", "coefficient": "0.1"}},
                       "motion": {"angular_velocity": [0, 0, 0], "damper": [1, 2, 3], "span": [0, 9]}})
        assert curve(ax)[1][0] == pytest.approx(np.degrees(np.arccos(3 / 14**0.5)), rel=1e-9)
