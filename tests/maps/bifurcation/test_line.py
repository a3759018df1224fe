"""A diagram over one number: every event by hand or by a way of its own, and the right number of equilibria
on both sides of each."""
from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab.errors import InputError
from stabilab.maps.bifurcation.diagram import branches
from stabilab.maps.bifurcation.equations import ENDLESS
from stabilab.show.maps import bifurcation as diagram_words
from tests.oracles import elimination as by_hand
from tests.shared import CASES

NEAR = Fraction(1, 10**9)  # of the range: on either side of an event


def case_text(D, lam, M, omega=None):
    row = lambda v: "[" + ", ".join(f'"{Fraction(c)}"' for c in v) + "]"
    motion = f"[motion]\nangular_velocity = {row(omega)}\n" if omega is not None else ""
    return (
        f"[body]\ninertia = {row(D)}\n[effects.gyrostat]\nmomentum = "
        f"{row(lam)}\n[effects.constant_torque]\ntorque = {row(M)}\n{motion}")


def written(tmp_path, *numbers):
    path = tmp_path / "case.toml"
    path.write_text(case_text(*numbers))
    return path


def counts(found):
    return [piece.count for piece in found.pieces]


def test_folds_on_a_circle_stand_where_the_product_of_two_rates_is_greatest(tmp_path):
    # by hand, without a wheel: (D1 - D2) w1 w2 = -M3 on the ellipse D1 (D1 - D3) w1^2 + D2 (D2 - D3) w2^2 = W
    # has four roots while
    # |M3| < (D1 - D2) W / (2 sqrt(D1 (D1 - D3) D2 (D2 - D3))), none beyond
    D, start = (12, 9, 5), (Fraction(1, 10), Fraction(1, 20), Fraction(1, 50))
    found = stabilab.bifurcation(written(tmp_path, D, (0, 0, 0), (0, 0, "0.02"), start),
                                 {"torque[3]": "0:0.5"})
    W = 12 * 7 * 0.1**2 + 9 * 4 * 0.05**2
    assert counts(found) == [4, 0]
    (fold,) = found.events
    assert fold.value == pytest.approx(3 * W / (2 * math.sqrt(12 * 7 * 9 * 4)), rel=1e-14)
    assert fold.kinds == ("fold",) and [state.times for state in fold.states] == [2, 2]
    assert {state.verdict for state in fold.states} == {"unstable"}
    assert sorted(state.verdict
                  for state in found.pieces[0].states) == ["stable", "stable", "unstable", "unstable"]


def test_the_saddle_of_the_middle_axis_appears_at_the_papers_cusp():
    # |c| = 4 * 3^(-3/4), where g^4 + c g + 1 has a double root (docs/mathematics): c = b with a = 0
    found = stabilab.bifurcation(CASES / "middle-axis-double-well.toml", {"b": (0, 4)}, curve=True)
    assert counts(found) == [0, 2] and found.events[0].value == pytest.approx(4 * 3**-0.75, rel=1e-15)


def test_a_wheel_along_the_torque_leaves_equilibria_at_one_value_alone():
    # by hand: dotted with M the balance reads M.(D w + lambda) = 0 and M.w = 0, for M an eigenvector of D so
    # lambda.M = 0
    found = stabilab.bifurcation(CASES / "wheel-and-thruster.toml", {"momentum[3]": "-300:300"})
    assert counts(found) == [0, 0]
    assert [(event.value, event.kinds, event.count) for event in found.events] == [(0.0, ("axis",), ENDLESS)]


def test_a_critical_value_at_an_end_of_the_range_is_told():
    found = stabilab.bifurcation(CASES / "off-axis-two.toml", {"torque[3]": "0:1"})
    assert counts(found) == [2] and [event.value for event in found.events] == [0.0]


def test_a_pitchfork_is_told_from_a_fold():
    # by hand: no wheel, D = (12, 9, 5) on the hyperbola w1 w2 = -M3/3 the sign of m = 36 w1^2... changes in
    # pairs that meet at the origin for M3 = 0 alone,
    # and there the torque vanishes; without a torque every principal axis is a line of equilibria
    found = stabilab.bifurcation(CASES / "wheel-and-thruster.toml", {"torque[3]": "-100:100"}, curve=True)
    assert counts(found) == [2, 2] and found.events[0].kinds == ("axis",) and found.events[0].count == ENDLESS


def exactly(D, lam, M):
    """How many isolated equilibria, by exact elimination that shares no code with the package."""
    return len(by_hand.of_body(D, lam, M)[1].roots)


def random_numbers(rng):
    D = sorted((Fraction(int(v), 16) for v in rng.integers(16, 31, 3)), reverse=True)
    lam = [Fraction(int(v), 8) if rng.random() < 0.7 else Fraction(0) for v in rng.integers(-8, 9, 3)]
    M = [Fraction(int(v), 8) for v in rng.integers(-8, 9, 3)]
    return D, lam, M


@pytest.fixture
def check_isolated(tmp_path):
    def check(seed):
        """Events met and values checked of one random scene."""
        rng = np.random.default_rng(seed)
        D, lam, M = random_numbers(rng)
        i, name = int(rng.integers(3)), ("torque", "momentum")[int(rng.integers(2))]
        row = M if name == "torque" else lam
        if sum(m != 0 for n, m in enumerate(M) if name == "momentum" or n != i) < 2 or len(set(D)) < 3:
            return 0
        low, high = row[i] - 2, row[i] + 2
        found = stabilab.bifurcation(written(tmp_path, D, lam, M), {f"{name}[{i + 1}]": (low, high)})
        events = [event.value for event in found.events]
        for piece in found.pieces:
            for share in (NEAR, Fraction(1, 3), 1 - NEAR):
                value = Fraction(piece.low) + (Fraction(piece.high) - Fraction(piece.low)) * share
                row[i] = value
                assert exactly(D, lam, M) == piece.count, (seed, float(value), events)
        for event in found.events:
            if event.exact is not None and "axis" not in event.kinds:
                row[i] = event.exact
                assert exactly(D, lam, M) == event.count, (seed, event)
        return len(found.events)
    return check


@pytest.mark.parametrize("seeds", [range(30), pytest.param(range(100, 300), marks=pytest.mark.slow),
                                   pytest.param(range(300, 1100), marks=[pytest.mark.slow, pytest.mark.long])])
def test_random_scenes_off_the_axes_have_the_counted_equilibria_on_both_sides_of_every_event(check_isolated, seeds):
    # exact elimination of tests/oracles, nothing of the package
    assert sum(map(check_isolated, seeds)) > len(seeds) / 2


@pytest.mark.slow
def test_values_that_agree_in_ten_digits_are_told_apart(tmp_path):
    """The range ends 1e-12 above a fold: both were printed as 0.2253344315."""
    path = written(tmp_path, (12, 9, 5), ("0.8", 0, 0), (0, 0, "0.02"), ("0.1", "0.05", "0.02"))
    found = stabilab.bifurcation(path, {"torque[3]": "0:0.225334431522"})
    told = diagram_words.text(found)
    assert "0.225334431521 to 0.225334431522" in told
    assert "none above; folds at 0.0185085734791 and 0.225334431521" in told
    # ten digits where they are enough
    assert "0.2253344315; none above" in diagram_words.text(stabilab.bifurcation(path, {"torque[3]": "0:0.5"}))


def test_a_fold_where_all_eigenvalues_are_zero_is_told(tmp_path):
    """At D3 = 1/2 of D1 = 1, D2 = 3/2 the two meet where m and n vanish at once: by the Jacobian written out
    here."""
    D, lam, M = np.array([1, 1.5, 0.5]), np.array([0, -2, 0]), np.array([2, -1, -0.5])
    found = stabilab.bifurcation(written(tmp_path, (1, "3/2", 1), lam.tolist(), M.tolist()),
                                 {"inertia[3]": (Fraction(1, 2), Fraction(3, 2))})
    (state,) = found.events[0].states
    x = np.array(state.at)
    across = lambda v: np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    jacobian = (across(D * x + lam) - across(x) @ np.diag(D)) / D[:, None]  # of (D x + lam) x x + M
    assert np.abs(np.cross(D * x + lam, x) + M).max() < 1e-12
    assert found.events[0].exact == Fraction(1, 2)
    assert np.abs(np.linalg.matrix_power(jacobian, 3)).max() < 1e-12 and state.verdict == "unstable"


def test_what_cannot_be_eliminated_is_refused_with_the_way_out(tmp_path):
    own = written(tmp_path, (3, 2, "1.5"), (0, 0, 0), ("0.1", "0.2", "0.1"))
    for vary, words in (({"torque[3]": "0:1:5"}, "no number of steps"),
                        ({"torque[3]": "1:0"}, "the lower end first"), ({"torqe[3]": "0:1"}, "did you mean"),
                        ({"inertia[1]": "-1:9"}, "leaves what a case may be"), ({}, "nothing varies"),
                        ({"torque[3]": "0:1 kg"}, "expected torque"),
                        ({"torque[3]": 3}, "two numbers"), (3, "expected names and ranges"),
                        ({"torque[1]": "0:1", "torque[2]": "0:1", "torque[3]": "0:1"}, "one or two")):
        with pytest.raises(InputError, match=words):
            stabilab.bifurcation(own, vary)
    with pytest.raises(InputError, match="sweep --answer equilibria"):
        stabilab.bifurcation(CASES / "liquid-base.toml", {"inertia[1]": "8:9"})


def test_a_symmetric_body_with_the_torque_along_its_axis_has_a_line_where_stability_changes_once(tmp_path):
    # by hand, D = (9, 9, 5), lambda = (l, 0, 0): the conic is the line w2 = -M3/l, and m is linear along it
    found = stabilab.bifurcation(written(tmp_path, (9, 9, 5), ("0.8", 0, 0), (0, 0, "0.02")),
                                 {"torque[3]": "-0.5:0.5"}, curve=True)
    assert counts(found) == [1, 1] and [event.value for event in found.events] == [0.0]
    (border,), sample = found.pieces[1].states, float(found.pieces[1].sample)
    assert border.at[1] == pytest.approx(-sample / 0.8, rel=1e-14)
    growth = [largest_growth((9, 9, 5), (0.8, 0, 0), (border.at[0] + off, border.at[1], 0.0))
              for off in (-1e-3, 1e-3)]
    assert min(growth) < 1e-9 < 1e-3 < max(growth)  # eigenvalues by NumPy


def test_a_sphere_within_the_range_keeps_one_equilibrium_on_the_curve_of_the_motion(tmp_path):
    # by hand: of three equal moments the motion keeps w1, and (0, 0, M3) = -(l, 0, 0) x w at (w1, -M3/l, 0)
    # alone
    found = stabilab.bifurcation(written(tmp_path, (9, 9, 9), ("0.8", 0, 0), (0, 0, "0.01"),
                                         ("0.1", "0.05", "0.02")), {"inertia[3]": "8:10"})
    (event,) = found.events
    assert (event.value, event.kinds, event.count) == (9.0, ("infinity",), 1)
    assert event.states[0].at == pytest.approx((0.1, -0.0125, 0.0), abs=1e-15)


def largest_growth(D, lam, omega):
    """The largest real part of the eigenvalues of D w' = (D w + lambda) x w + M at a state, by NumPy."""
    turn = lambda v: np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    D, lam, omega = (np.array(v, dtype=float) for v in (D, lam, omega))
    return np.linalg.eigvals((turn(D * omega + lam) - turn(omega) @ np.diag(D)) / D[:, None]).real.max()


# at torque -l1 l2/(D1 - D2) the conic is two lines: two equilibria of different stability have one w1 there
@pytest.mark.one_in(3)
@pytest.mark.parametrize("lam, omega", [(("-0.75", "-0.75"), ("0.05", "-0.25", "-0.05")),
                                        (("0.875", "1"), ("-0.05", "0.35", "0.15")),
                                        (("0.375", "-1"), ("-0.15", "0.3", "0"))])
def test_branches_that_pass_one_above_another_keep_their_stability(tmp_path, lam, omega):
    D, torque = (12, 9, 5), -Fraction(lam[0]) * Fraction(lam[1]) / 3
    found = stabilab.bifurcation(written(tmp_path, D, (*lam, 0), (0, 0, torque), omega),
                                 {"torque[3]": (torque - Fraction(1, 5), torque + Fraction(1, 4))})
    looked = 0
    for branch in branches(found, 24):
        for state in branch.states:
            growth = largest_growth(D, (*map(float, lam), 0), state)
            if growth > 1e-4 or growth < 1e-7:  # between, rounding decides
                looked += 1
                assert branch.verdict == ("unstable" if growth > 1e-4 else "stable")
    assert looked > 40
