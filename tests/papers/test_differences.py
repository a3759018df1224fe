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
