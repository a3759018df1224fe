"""Values at which two saddles come to one height, against heights by quadrature-free NumPy along the motion's
ellipse."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab.maps.bifurcation import ask
from tests.maps.bifurcation.leaf import rises
from tests.maps.bifurcation.test_line import written
from tests.shared import later

GRID = 201


def dense(D, lam, M, omega, i, low, high):
    """Values between which a rise changes its sign, on a grid of the wheel's momentum about the next axis."""
    found, before, last = [], None, low
    for q in np.linspace(low, high, GRID):
        wheel = list(lam)
        wheel[(i + 1) % 3] = q
        now = rises(D, wheel, M, omega, i)
        if before is not None and now is not None:
            found += [(last, q) for u, v in zip(before, now) if u * v < 0]
        before, last = now, q
    return found


@pytest.mark.one_in(2)
@pytest.mark.parametrize("seed", [0, 1, *later(range(2, 12))])
def test_connections_are_those_that_a_grid_of_heights_brackets(tmp_path, seed):
    rng = np.random.default_rng(seed)
    i = int(rng.choice([0, 2]))  # of the greatest or the least moment: circles
    D = (Fraction(12), Fraction(9), Fraction(5))
    omega = [Fraction(int(v), 10) for v in rng.integers(-9, 10, 3)]
    lam, M = [Fraction(int(v), 4) for v in rng.integers(-6, 7, 3)], [Fraction(0)] * 3
    lam[i], M[i] = Fraction(0), Fraction(int(rng.integers(1, 9)), 10)
    low, high = -12, 12
    found = stabilab.bifurcation(written(tmp_path, D, lam, M, omega),
                                 {f"momentum[{(i + 1) % 3 + 1}]": (low, high)})
    values = [event.value for event in found.connections]
    assert all(any(a <= value <= b for value in values) for a, b in dense(D, lam, M, omega, i, low, high))
    for value in values:
        sides = []
        for q in (value - 1e-6, value + 1e-6):
            wheel = list(lam)
            wheel[(i + 1) % 3] = q
            sides.append(rises(D, wheel, M, omega, i))
        assert any(u * v < 0 for u, v in zip(*sides)), value


@pytest.mark.one_in(2)
@pytest.mark.parametrize("ends", [pytest.param(("-0.5", "0.5"), marks=pytest.mark.slow), ("-0.5", "0.4"),
                                  ("-0.01", "0.013")])
def test_mirrored_saddles_are_at_one_height_without_a_torque(tmp_path, ends):
    # by hand: with the wheel along axis 1 alone w2 -> -w2 maps the motion without a torque onto itself
    # backwards, and one saddle onto the other
    case = written(tmp_path, (12, 9, 5), ("0.8", 0, 0), (0, 0, "0.02"), ("0.1", "0.05", "0.02"))
    found = stabilab.bifurcation(case, {"torque[3]": tuple(map(Fraction, ends))})
    assert [event.value for event in found.connections] == [0.0] and not found.notes
    first, second = (state.at for state in found.connections[0].states if state.verdict == "unstable")
    assert first == pytest.approx((second[0], -second[1], 0.0), abs=1e-12)


def sign_changes(rises_at, low, high, count=201):
    """Pairs of neighbouring values between which a rise changes its sign."""
    rows = [(value, rises_at(value)) for value in np.linspace(low, high, count)]
    return [(p, q) for (p, before), (q, now) in zip(rows, rows[1:]) if before and now
            and any(u * v < 0 for u, v in zip(before, now))]


@pytest.mark.slow
@pytest.mark.parametrize("lam, omega", [(("-0.75", "-0.75"), ("0.05", "-0.25", "-0.05")),
                                        pytest.param(("0.5", "0.125"), ("0.2", "0.3", "0"),
                                                     marks=pytest.mark.slow)])
def test_connections_are_those_of_a_grid_where_equilibria_pass_one_above_another(tmp_path, lam, omega):
    D, torque = (12, 9, 5), -Fraction(lam[0]) * Fraction(lam[1]) / 3
    ends = (torque - Fraction(1, 5), torque + Fraction(1, 4))
    found = stabilab.bifurcation(written(tmp_path, D, (*lam, 0), (0, 0, torque), omega), {"torque[3]": ends})
    brackets = sign_changes(lambda value: rises(D, (*lam, 0), (0, 0, value), omega, 2), *map(float, ends))
    assert not found.notes and len(found.connections) == len(brackets)
    assert all(a <= event.value <= b for event, (a, b) in zip(found.connections, brackets))


@pytest.mark.slow
def test_connections_are_looked_for_up_to_the_moment_of_inertia_at_which_the_circle_opens(tmp_path):
    lam, M, omega = ("1.75", "-1.75", 0), (0, 0, "-1.25"), ("-1.5", "1.625", "-0.5")
    found = stabilab.bifurcation(written(tmp_path, (2, "3.25", 2), lam, M, omega), {"inertia[3]": "3:4"})
    brackets = sign_changes(lambda value: rises((2, 3.25, value), lam, M, omega, 2), 3.2501, 4.0)
    assert not found.notes and len(found.connections) == len(brackets)
    assert all(a <= event.value <= b for event, (a, b) in zip(found.connections, brackets))


# beyond D1 = D2 the circle opens, and two saddles go far away
CROSSING = ((7, 6, 3), (0, 0, "1/2"), ("1/50", 0, 0), (0, -1, 1)), {"inertia[1]": "25/8:9"}


@pytest.mark.slow
def test_saddles_that_go_far_away_where_the_circle_opens_take_a_bounded_number_of_enclosures(tmp_path,
                                                                                             monkeypatch):
    monkeypatch.setattr(ask, "MAX_ENCLOSURES", 2500)
    numbers, vary = CROSSING
    found = stabilab.bifurcation(written(tmp_path, *numbers), vary)
    assert not found.notes and not found.connections
    # NumPy along the ellipse
    heights = lambda value: rises((value, 6, 3), (0, 0, 0.5), (0.02, 0, 0), numbers[3], 0)
    assert not sign_changes(heights, 6.0001, 9.0, 101)


def test_connections_that_the_enclosures_do_not_reach_are_said_to_be_undecided(tmp_path, monkeypatch):
    monkeypatch.setattr(ask, "MAX_ENCLOSURES", 60)
    numbers, vary = CROSSING
    found = stabilab.bifurcation(written(tmp_path, *numbers), vary)
    assert not found.connections and any("undecided: whether two saddles come to one height" in note
                                         for note in found.notes)
    assert [piece.count for piece in found.pieces] == [2, 4]  # what the polynomials tell stays


def test_a_spent_budget_is_never_taken_for_a_zero(tmp_path, monkeypatch):
    # without a torque the mirrored saddles are at one height, at torque 0 by hand (above): a bisection that
    # is cut short tells nothing
    case = written(tmp_path, (12, 9, 5), ("0.8", 0, 0), (0, 0, "0.02"), ("0.1", "0.05", "0.02"))
    for most in (5, 20, 40, 60, 100):
        monkeypatch.setattr(ask, "MAX_ENCLOSURES", most)
        found = stabilab.bifurcation(case, {"torque[3]": ("-0.01", "0.013")})
        assert [event.value
                for event in found.connections] == [0.0] or (not found.connections and found.notes)
