"""Extremes by the printed formulas, against grids of the printed equations as they stand."""
import numpy as np
import pytest

from stabilab.papers.printed_integrals import printed_extremes
from stabilab.papers.table import extremes_table, latex_escape, torque_signs


def piece(square, start):
    """The indices of the stretch of a grid around `start` on which a square is not negative."""
    wrong = np.flatnonzero(square < 0)
    return slice(wrong[wrong < start].max() + 1, wrong[wrong > start].min())


@pytest.mark.parametrize("lam", (100, 300, 500))
def test_the_minor_axis_by_18_and_30(lam):
    x, b = (2.5, 4, 0.1), lam / 250
    F = np.hypot(x[0], x[1])
    psi = np.arctan2(x[0], x[1]) + np.linspace(-4, 4, 800_001)
    x1, x2 = F * np.sin(psi), F * np.cos(psi)  # (18); the artan of (30) counts on as the angle
    G1 = 2 * x[2] ** 2 + x[1] ** 2 - x[0] ** 2 - 4 * b * x[0] - 4 * np.arctan2(x[0], x[1])
    square = (G1 - x2**2 + x1**2 + 4 * b * x1 + 4 * psi) / 2  # of x3
    on = piece(square, 400_000)
    found = printed_extremes("minor-axis", x, lam / 500, b)
    x3 = np.sqrt(square[on].max())
    for pair, values in zip(found, (x1[on], x2[on], np.array([-x3, x3]))):
        assert pair == pytest.approx((values.min(), values.max()), abs=1e-4)
    assert found[0][1] == pytest.approx(4.717, abs=5e-4)  # F, for every wheel


@pytest.mark.parametrize("lam", (100, 300, 500))
def test_the_middle_axis_by_79(lam):
    x, ab = (2.5, 1.3, 2.5), lam / 500 + lam / 250
    x1 = np.geomspace(1e-6, 10, 2_000_001)
    G3 = x[0] ** 2 / 2 + x[1] ** 2 / 2 + ab * x[0] - np.log(x[0])
    square = 2 * (G3 - x1**2 / 2 - ab * x1 + np.log(x1))  # of x2
    on = piece(square, int(np.searchsorted(x1, x[0])))
    found = printed_extremes("middle-axis-equal", x, lam / 500, lam / 250)
    assert found[0] == found[2] == pytest.approx((x1[on].min(), x1[on].max()), rel=1e-4)
    assert found[1][1] == pytest.approx(np.sqrt(square[on].max()), rel=1e-6)


def test_the_artanh_of_71_ends_before_x2_returns_to_zero():
    x, a, b = (1.7, 1.1, -0.2), 0.2, 0.4
    root = np.sqrt(x[0] ** 2 - x[2] ** 2)
    s = np.linspace(-2, 2, 400_001)
    size, product = root**2 * np.cosh(2 * s), (root**2 * np.sinh(2 * s) / 2) ** 2
    with np.errstate(all="ignore"):
        by_71 = size * (1 + 2 * (a + b) / root) - 2 * np.arctanh(2 * product / size)
    G2 = 2 * x[1] ** 2 + by_71[np.abs(s - np.arctanh(x[2] / x[0])).argmin()]
    defined = 2 * product / size < 1
    assert ((G2 - by_71)[defined] > 0).all()
    assert printed_extremes("middle-axis", x, a, b) is None


def test_tables_set_the_printed_numbers_beside_the_true_ones():
    rows = {n: extremes_table(n).rows for n in (2, 3, 4)}
    assert [row[0] for row in rows[2]][:3] == ["minor-axis-100", "as printed", "difference"]
    for true, printed, apart in zip(rows[2][::3], rows[2][1::3], rows[2][2::3]):
        assert apart[9:] == pytest.approx([p - t for p, t in zip(printed[9:], true[9:])])
    assert [row[9:15] for row in rows[3] if row[0] == "as printed"] == [(None,) * 6] * 3
    assert sum(row[0] == "as printed" for row in rows[4]) == 3
    assert len(torque_signs().rows) == 18  # of 27 signs with and without b = a, those that differ


def test_indices_are_set_as_indices():
    assert latex_escape("x1 max, λ1 & 2") == r"$x_1$ max, $\lambda_1$ \& 2"
