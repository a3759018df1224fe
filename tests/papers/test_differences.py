"""How far printed curves are from the exact motion, against differences taken by hand from the runs
themselves."""
import numpy as np
import pytest

from stabilab.papers.families import compared
from stabilab.papers.figures import cavity, top
from stabilab.papers.figures.catalogue import figure
from stabilab.papers.figures.figure import Difference, differences, plain, words


@pytest.mark.slow
def test_a_figure_tells_the_largest_difference_of_each_panel_at_equal_times():
    found = differences(figure(3, "cavity"))
    runs = compared("liquid-lambda3-15", "", cavity.SPAN)[0]
    true, wrong = (np.asarray(runs[name].state["omega"])[:, 0] for name in ("exact", "printed"))
    n = len(wrong)
    at = np.argmax(abs(wrong - true[:n]))
    assert len(found) == 6 and found[0].status == "compared"  # p and q for three values
    assert found[0].largest == abs(wrong
                                   - true[:n])[at] and found[0].at == runs["exact"].t[at] and found[
                                       0].reach == np.ptp(true)


def test_a_figure_without_printed_curves_has_no_differences():
    assert differences(figure(8)) == () and words(figure(8)) == []


@pytest.mark.parametrize("size, told", [(1444.0, "1444 m (140 times the exact motion's range) at t = 50 s"),
                                        (3.0, "3 m (0.3 of the exact motion's range) at t = 50 s")])
def test_a_difference_beyond_the_motions_range_is_so_many_times_it(size, told, monkeypatch):
    monkeypatch.setattr("stabilab.papers.figures.figure.differences",
                        lambda _: (Difference(r"$\eta_2$ (m)", "$M_1=4$ N m", size, 10.0, 50.0,
                                                         "compared"),))
    assert words(None) == [f"η2, M1=4 N m: {told}"]


def test_words_name_quantity_value_size_and_time():
    line = words(top.FIGURES[1])[0]
    assert line.startswith("p1, l") and "kg m²/s: " in line and "at t = " in line and not set("${}") & set(line)


@pytest.mark.parametrize("label, text", [
    (r"$\dot{p}$ (rad/s$^2$)", "dp/dt (rad/s²)"), (r"$\dot{\gamma}_1'$ (10$^3$/s)", "dγ1'/dt (10³/s)"),
    (r"$\dot{\gamma}''$ (1/s)", "dγ''/dt (1/s)"),
    ("$M_3=-3$ N m", "M3=−3 N m"),
    (r"$\lambda_3=15$ kg m$^2$/s", "λ3=15 kg m²/s"), (r"$\gamma\,''$", "γ''"),
    (r"$\omega_1/\omega_3$", "ω1/ω3")])
def test_labels_are_told_in_plain_text(label, text):
    assert plain(label) == text


def test_the_largest_distance_of_printed_separatrices_is_that_of_roots_not_of_samples():
    """By mpmath: the true x where the printed one ends in a vertical tangent, from heights written anew."""
    mp = pytest.importorskip("mpmath")
    from stabilab.papers.figures.minor_axis import departure

    a, b, x1, x2 = mp.mpf(1) / 5, mp.mpf(2) / 5, mp.mpf(5) / 2, 4
    def height(radius, wheel):
        return lambda alpha: radius**2 * mp.cos(alpha) - 4 * radius * wheel * mp.sin(alpha / 2) - 2 * alpha
    printed, true = height(mp.hypot(x1, x2), b), height(mp.hypot(x1 + a, x2), b - a)
    parts = []
    for near in (0, 2 * mp.pi):
        levels = [h(mp.findroot(lambda t, h=h: mp.diff(h, t), near))
                  for h in (printed, true)]
        for h, level, other, peak in ((printed, levels[0], true, levels[1]), (true, levels[1], printed, levels[0])):
            grid = [mp.mpf(n) / 50 - 7 for n in range(771)]
            ends = [mp.findroot(lambda t: level - h(t), pair, solver="anderson") for pair in zip(grid, grid[1:])
                    if (level - h(pair[0])) * (level - h(pair[1])) < 0 and pair[0] > near - 2 * mp.pi]
            parts += [(near, mp.sqrt(2 * (peak - other(t))), t) for t in ends if peak > other(t)]
    for near, name in ((0, "left"), (2 * mp.pi, "right")):
        size, at = max((size, t) for where, size, t in parts if where == near)
        assert f"{float(size):.2f} at α = {float(at):.2f} on the {name} one" in departure()
