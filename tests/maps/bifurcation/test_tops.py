"""A top over its spin: minima of its effective potential counted on a grid that is written here, and Lagrange's critical
spin."""
import json
import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import InputError, bifurcation, load
from tests.oracles.rigid import with_a_direction
from tests.shared import CASES

TOY = CASES / "toy-top.toml"


def _top(weight=1.0, N=0.0, wheel=0.0, E=0.0, A=1.0, C=1.8, axis=2, motion="angular_velocity = {spin}\nvertical = {v}"):
    e = [int(i == axis) for i in range(3)]
    D = [C if i == axis else A for i in range(3)]
    fields = (f"[effects.gravity]\nweight = 1\ncentre_of_mass = {[weight * v for v in e]}\n" * bool(weight)
              + f"[effects.newtonian_field]\nlambda = {N / 3}\nR = 1\n" * bool(N)
              + f"[effects.gyrostat]\nmomentum = {[wheel * v for v in e]}\n" * bool(wheel)
              + f"[effects.charge]\ncharge = {E}\nfield = 1\narm = 1\nangle = \"attitude\"\n" * bool(E))
    motion = motion.format(spin=[4 * v for v in e], v=e)
    return load(f"[body]\ninertia = {D}\n{fields}[motion]\n{motion}\n")


def _extremes(A, L, weight, field, E, family):
    """(minima, maxima) of the effective potential over the lean inside (0, 180 deg), and whether the vertical is a
    minimum: heights on a grid of H . up = its value there, written out here."""
    side = 1 if family == "upright" else -1
    t = np.linspace(1e-4, math.pi - 1e-4, 200001)
    u = np.cos(t)
    p = L * side + E / 2  # area integral: A W sin^2 + L u + E u^2/2
    U = (p - L * u - E * u * u / 2) ** 2 / (2 * A * np.sin(t) ** 2) + weight * u + field * u * u / 2
    U = U if side > 0 else U[::-1]
    inner = U[1:-1]
    minima = int(((inner < U[:-2]) & (inner < U[2:])).sum())
    maxima = int(((inner > U[:-2]) & (inner > U[2:])).sum())
    return minima, maxima, bool(U[0] < U[1])


@pytest.mark.first(3, 12)
@pytest.mark.parametrize("n", range(150))
def test_between_the_changes_the_states_are_the_extremes_of_the_potential_on_a_grid(n):
    """A little inside both ends of each piece, and in its middle."""
    rng = np.random.default_rng([19, n])
    A, C = map(float, rng.uniform(0.7, 1.3, 2))
    weight, N = float(rng.uniform(-1, 1)), rng.uniform(-3, 3) * (n % 3 > 0) / (C - A if n % 3 == 2 else 1)
    wheel, E, N = map(float, (rng.normal() * (n % 2), rng.normal() * (n % 4 == 3), N))
    case = _top(weight, N, wheel, E, A, C, 2 if E else n % 3)
    found = bifurcation(case, {f"angular_velocity[{3 if E else n % 3 + 1}]": "-4:4"})
    side = -1 if weight < 0 else 1
    for piece in found.pieces:
        width = piece.high - piece.low
        for value in (piece.value, piece.low + 0.02 * width, piece.high - 0.02 * width):
            L = side * (C * value + wheel)
            if abs(L) < 0.05:
                continue  # the states are next to the poles of the potential
            for family in ("upright", "hanging"):
                minima, maxima, vertical = _extremes(A, L, abs(weight), N * (C - A), E, family)
                states = [state for state in found.states(Fraction(value)) if state.family == family]
                leaning = [state.stable for state in states if state.leaning]
                assert (leaning.count(True), leaning.count(False)) == (minima, maxima), (value, family)
                assert next(state.stable for state in states if not state.leaning) == vertical
            assert [s[::3] for s in found.states(Fraction(value))] == [s[::3] for s in piece.states]


def test_the_critical_spin_is_that_of_lagrange():
    found = bifurcation(load(TOY), {"angular_velocity[3]": "0:30 rev/s"})
    A, C, moment = 1.74e-4, 4.8e-5, 0.981 * 0.0375
    assert [float(v) for v in found.changes] == pytest.approx([2 * math.sqrt(A * moment) / C / (2 * math.pi)], rel=1e-14)
    assert [piece.stable("upright") for piece in found.pieces] == [False, True]
    # below it, by hand: 1 + u = L/(A M g l)^(1/2), at the rate (M g l/A)^(1/2)
    state, = (s for s in found.pieces[0].states if s.leaning)
    spin = found.pieces[0].value * 2 * math.pi
    assert math.cos(state.lean) == pytest.approx(C * spin / math.sqrt(A * moment) - 1, rel=1e-12)
    assert state.rate == pytest.approx(math.sqrt(moment / A), rel=1e-12) and state.stable


def test_a_wheel_and_a_newtonian_centre_move_the_critical_spin_as_by_hand():
    """(C s + lambda)^2 = 4 A (|s| + N (C - A)); over the wheel's momentum at one spin likewise."""
    case = _top(0.5, 0.6, 0.7)
    expected = [(sign * 2 * math.sqrt(0.5 + 0.6 * 0.8) - 0.7) / 1.8 for sign in (-1, 1)]
    found = bifurcation(case, {"angular_velocity[3]": "-4:4"})
    upright = [float(v) for v, one, two in zip(found.changes, found.pieces, found.pieces[1:])
               if one.stable("upright") != two.stable("upright")]
    assert upright == pytest.approx(expected, rel=1e-12)
    over = bifurcation(case, {"gyrostat.momentum[3]": "-20:20"})
    upright = [float(v) for v, one, two in zip(over.changes, over.pieces, over.pieces[1:])
               if one.stable("upright") != two.stable("upright")]
    assert upright == pytest.approx([sign * 2 * math.sqrt(0.5 + 0.6 * 0.8) - 7.2 for sign in (-1, 1)], rel=1e-12)


def test_over_the_weight_a_top_falls_where_lagrange_says():
    """L^2 = 4 A M g l: 7.2^2/4 = 12.96."""
    found = bifurcation(_top(1.0), {"gravity.weight": "1:20"})
    assert found.changes == (pytest.approx(12.96, rel=1e-12),)


def test_disturbed_on_either_side_of_the_critical_spin_it_stays_or_falls():
    """SciPy: the lean of a top let go at 0.01 rad, a hundredth beside the critical spin."""
    critical = 2 / 1.8
    for times, stays in ((1.02, True), (0.98, False)):
        run = solve_ivp(with_a_direction([1, 1, 1.8], arm=[0, 0, 1]), (0, 60), [0, 0, times * critical, math.sin(0.01), 0, -math.cos(0.01)],
                        rtol=1e-9, atol=1e-11)
        assert (np.arccos(-run.y[5]).max() < 0.1) == stays
        found = bifurcation(_top(), {"angular_velocity[3]": "0:4"})
        assert next(p for p in found.pieces if p.low < times * critical < p.high).stable("upright") == stays


def test_a_start_in_steady_precession_varies_its_spin_below_what_has_one():
    case = _top(motion='spin = 4\nlean = "40 deg"\nprecession = "slow"')
    assert bifurcation(case, {"spin": "0:4"}).changes == bifurcation(_top(), {"angular_velocity[3]": "0:4"}).changes


@pytest.mark.parametrize(("vary", "options", "words"), [
    ({"angular_velocity[1]": "0:4"}, {}, "neither the momentum about the axis"),
    ({"inertia[1]": "0.5:2"}, {}, "no symmetric top about one axis all over the range"),
    ({"centre_of_mass[3]": "-1:1"}, {}, "no symmetric top about one axis all over"),
    ({"angular_velocity[3]": "0:4", "weight": "1:2"}, {}, "one number may vary"),
    ({"angular_velocity[3]": "0:4"}, {"curve": True}, "take curve away")])
def test_what_cannot_be_varied_of_a_top_is_one_error(vary, options, words):
    with pytest.raises(InputError, match=words):
        bifurcation(_top(), vary, **options)


def test_the_command_prints_draws_and_writes_it(stabilab, tmp_path):
    options = ("bifurcation", TOY, "--vary", "angular_velocity[3]=0:30 rev/s")
    code, printed, _ = stabilab(*options, "--out", tmp_path / "a.png")
    assert code == 0 and (tmp_path / "a.png").stat().st_size > 5000
    assert printed.startswith("toy-top: upright stable for angular_velocity[3] from 16.777747 to 30 rev/s")
    data = json.loads(stabilab(*options, "--json")[1])
    assert [piece["upright"] for piece in data["pieces"]] == ["unstable", "stable"]
    rows = stabilab(*options, "--csv")[1].splitlines()
    assert rows[0].startswith("value,family,verdict,lean") and len(rows) > 300
    assert stabilab(*options, "--certify", tmp_path / "a.json")[0] == 2
