"""How a small change of a start grows, by other derivations, other integrators and what theory says of tori.
"""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
from stabilab import Body, Gravity, Scene
from stabilab.physics.to_numpy import equations_of, form
from stabilab.unreduced import chaos
from stabilab.unreduced.chaos import growth, turn_of, varied
from tests.oracles.rigid import with_a_direction
from tests.shared import case

D, ARM = np.array([1.0, 1.6, 2.2]), np.array([0.3, 0.2, 0.6])
TOP = Scene(Body((1, "1.6", "2.2")), Gravity("1", ("0.3", "0.2", "0.6")))
WILD, TAME = (0.2, 0.9, -0.4, 0.6, 0.0, -0.8), (0.05, 0.02, 0.03, *(ARM / np.linalg.norm(ARM)))


def megno(scene, state, turns=400):
    states = np.atleast_2d(np.array(state, float))
    turn = turn_of(scene, states)
    return growth(scene, states, turns * turn, turn)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name",
                         ["torque-free-body", "torque-free-gyrostat", "minor-axis-100", "middle-axis-100"])
def test_a_motion_of_one_degree_of_freedom_tends_to_two(name):
    """Neighbours on the orbits of an integrable motion part in proportion to time, and then MEGNO -> 2
    (Cincotta, Giordano, Simo 2003)."""
    one = case(name)
    history = megno(one.scene, one.state, 1500).megno[0]
    away = np.abs(history - 2)
    assert away[-1] < 0.1 and away[-1] < away[-2] < away[-3]


@pytest.mark.slow
def test_the_equations_of_a_change_are_those_that_heyoka_derives_by_itself():
    heyoka = pytest.importorskip("heyoka")
    from stabilab.integrate.to_heyoka import heyoka_form, to_taylor
    one = case("off-axis-two")
    plain, start = equations_of(one.scene), (0.3, -0.2, 0.5)
    ours = to_taylor(varied(plain))
    change = np.array([1.0, -2, 3])
    ours.state[:] = [*start, *change]
    forms = form(plain, plain.rhs)
    variables, rates = heyoka_form(forms.state, forms.symbols, forms.expressions)
    system = heyoka.var_ode_sys(list(zip(variables, rates)), heyoka.var_args.vars, order=1)
    theirs = heyoka.taylor_adaptive(system, [*start, *np.eye(3).ravel()], pars=forms.numbers)
    ours.propagate_until(20.0)
    theirs.propagate_until(20.0)
    assert ours.state[3:] == pytest.approx(np.reshape(theirs.state[3:], (3, 3)) @ change, rel=1e-9)


def test_without_heyoka_scipy_gives_the_same(monkeypatch):
    one = case("minor-axis-100")
    expected = megno(one.scene, one.state, 6).megno
    monkeypatch.setattr(chaos, "heyoka_available", lambda: False)
    assert megno(one.scene, one.state, 6).megno == pytest.approx(expected, abs=1e-6)


@pytest.mark.slow
def test_a_heavy_top_is_chaotic_at_the_rate_at_which_two_of_its_motions_part():
    """Two runs of DOP853 of Euler's and Poisson's equations by hand, brought near again each 5 units of time
    (Benettin's method). Rates of single runs of 2,000 scatter by a fifth, as rounding has it: those of four
    starts, on the mean."""
    from scipy.integrate import solve_ivp

    rate, near = with_a_direction(D, arm=ARM), 1e-7
    starts = [np.array(WILD) + [shift, 0, 0, 0, 0, 0] for shift in (0, 1e-3, 2e-3, 3e-3)]
    total = []
    for a in starts:
        b = a + near * np.array([1, -1, 1, 0, 0, 0]) / 3**0.5
        for _ in range(400):
            a, b = (solve_ivp(rate, (0, 5), x, "DOP853", rtol=1e-9, atol=1e-10).y[:, -1] for x in (a, b))
            apart = np.linalg.norm(b - a)
            total.append(np.log(apart / near))
            b = a + (b - a) * near / apart
    found = megno(TOP, starts, 1000)
    rates = 2 * found.megno[:, -1] / found.times[-1]
    assert rates.mean() == pytest.approx(np.mean(total) / 5, rel=0.25)
    assert (found.megno[:, -1] > 1.6 * found.megno[:, -2]).all() and (found.megno[:, -2] > 10).all()


def test_the_same_top_near_its_rest_is_regular():
    """Small swings about the stable rest are two coupled oscillators of different frequencies and a
    precession: tori."""
    assert (megno(TOP, TAME).megno[0, -3:] < 2.3).all()


@pytest.mark.slow
def test_neighbours_that_come_together_have_ever_lower_numbers():
    one = case("liquid-base")
    history = megno(one.scene, one.state, 200).megno[0]
    assert (np.diff(history[1:]) < 0).all() and history[-1] == pytest.approx(2 * history[-2], rel=0.1)


def test_a_motion_has_the_same_numbers_whatever_its_company():
    one = case("minor-axis-100")
    states = np.array([one.state, (2.6, 4, 0.1), (2.4, 4, 0.2)])
    turn = turn_of(one.scene, states)
    together, alone = growth(one.scene, states, 50 * turn,
                             turn), growth(one.scene, states[1:2], 50 * turn, turn)
    assert (together.megno[1] == alone.megno[0]).all()


def test_slow_motions_are_followed_in_a_unit_of_their_own():
    """omega/u over t u obeys the same equations without a torque."""
    body = Scene(Body((3, 2, 1)))
    fast, slow = megno(body, (0.5, 1, 0.3), 60), megno(body, np.array([0.5, 1, 0.3]) * 2.0**-30, 60)
    assert slow.megno == pytest.approx(fast.megno,
                                       rel=1e-6) and slow.times == pytest.approx(fast.times * 2.0**30)


def test_a_force_moves_the_body_and_leaves_chaos_as_it_is():
    """The place of a body is no part of its rotation; the case gives none."""
    body = {"body": {"inertia": [3, 2, 1], "mass": 1}, "motion": {"angular_velocity": [1, 2, 3]}}
    forced = body | {"effects": {"body_force": {"force": [0, 1, 0]}}}
    one, other = (stabilab.load(given).scene for given in (body, forced))
    assert stabilab.chaos(forced, until=20.0).megno == stabilab.chaos(body, until=20.0).megno and one != other
