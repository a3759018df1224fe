"""The picture of the reduced potential: what is drawn, against runs of Euler's equations."""
import numpy as np
import pytest
from matplotlib import pyplot as plt
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

import stabilab
from stabilab.errors import InputError
from stabilab.show import style
from tests.shared import CASES


def curve(ax, name):
    """The one line with the look of a meaning or marker."""
    wanted = style.MEANING.get(name) or style.MARKER[name]
    key = "marker" if name in style.MARKER else "linewidth"
    lines = [line for line in ax.get_lines() if line.get_color() == wanted.get("color", line.get_color())
             and getattr(line, f"get_{key}")() == wanted[key]]
    return lines[0].get_data()


@pytest.mark.parametrize("seed", range(12))
def test_the_potential_is_what_the_kinetic_energy_about_the_axis_leaves_of_the_energy(seed):
    """By SciPy's DOP853 on Euler's equations written out here: the turn is the integral of the rate about the
    axis of the torque, and D omega^2 / 2 of it and the potential are one constant."""
    rng = np.random.default_rng(seed)
    D, axis = np.sort(rng.uniform(1, 2, 3)), seed % 3
    D = rng.permutation(D * [0.8, 1, 1.1])
    wheel, torque, start = rng.normal(size=3), np.zeros(3), rng.normal(size=3)
    wheel[axis], torque[axis] = 0.0, rng.choice([-1, 1]) * rng.uniform(0.05, 0.3)
    scene = stabilab.Scene(stabilab.Body(tuple(map(float, D))),
                           [stabilab.Gyrostat(tuple(map(float, wheel))),
                            stabilab.ConstantTorque(tuple(map(float, torque)))])
    ax = stabilab.plot.potential(scene, start.tolist(), units="si")
    turn, height = curve(ax, "separatrix")
    order = np.argsort(turn)
    drawn = CubicSpline(turn[order], height[order])
    energy = ax.get_lines()[1].get_ydata()[0]
    run = solve_ivp(lambda t, s: [*((np.cross(D * s[:3] + wheel, s[:3]) + torque) / D), s[axis]], (0, 6),
                    [*start, 0], "DOP853", np.linspace(0, 6, 200), rtol=1e-12, atol=1e-13)
    there = (run.y[3] > turn.min()) & (run.y[3] < turn.max())
    rest = energy - D[axis] * run.y[axis] ** 2 / 2
    assert there.sum() > 20
    assert np.abs(drawn(run.y[3]) - rest)[there].max() < 1e-6 * (abs(energy) + np.ptp(height))


def test_every_motion_under_a_torque_that_has_a_margin_has_its_arrow():
    """Of 10 random bodies: the barrier ahead may stand a turn away. Lengths are the margins of `fate`."""
    rng = np.random.default_rng(5)
    seen = 0
    for k in range(10):
        D, axis = rng.permutation(rng.uniform(0.5, 3, 3)), k % 3
        wheel, torque = rng.normal(size=3) * 10.0 ** rng.uniform(-2, 1), np.zeros(3)
        wheel[axis], torque[axis] = 0.0, rng.normal()
        scene = stabilab.Scene(stabilab.Body(tuple(map(float, D))),
                               [stabilab.Gyrostat(tuple(map(float, wheel))),
                                stabilab.ConstantTorque(tuple(map(float, torque)))])
        start = (rng.normal(size=3) * 10.0 ** rng.uniform(-1, 1)).tolist()
        margin = stabilab.motion(scene, start).margin_energy
        ax = stabilab.plot.potential(scene, start)
        assert len(ax.texts) == (2 if margin else 0), k
        if margin:
            arrow, (left, right) = ax.texts[0], ax.get_xlim()
            assert arrow.xy[1] - arrow.xyann[1] == pytest.approx(margin, rel=1e-9)
            saddles = next(line.get_data() for line in ax.get_lines() if line.get_marker() == "o"
                           and line.get_markeredgecolor() == style.VERMILION)
            assert left < arrow.xy[0] < right and ax.texts[1].get_text().startswith("margin ") == (margin > 0)
            assert np.hypot(saddles[0] - arrow.xy[0], saddles[1] - arrow.xy[1]).min() < 1e-6 * max(1, abs(arrow.xy[1]))
            seen += 1
        plt.close(ax.figure)
    assert seen > 3


def test_a_motion_that_does_not_reduce_has_none_and_says_why():
    with pytest.raises(InputError, match="plot potential: the motion does not reduce to one degree of free"):
        stabilab.plot.potential(stabilab.load(f"{CASES}/off-axis-two.toml"))
