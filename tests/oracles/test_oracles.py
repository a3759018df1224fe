"""The independent oracles agree with each other: Taylor series, SciPy's runs, reduced potential."""
from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.oracles import energy, model, taylor


def problems(seed, count):
    """Random models with the torque on a principal axis: elliptic, hyperbolic and parabolic, scaled and
    physical."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        size = rng.choice([-1, 1]) * 10 ** rng.uniform(-1, 1)
        if n % 4 == 0:
            yield model.scaled(*rng.normal(size=2) * 1.5, (0, 0, size)), tuple(rng.normal(size=3) * 2)
        elif n % 4 == 1:
            yield model.scaled(*rng.normal(size=2) * 3, (0, size, 0)), tuple(rng.normal(size=3) * 2)
        else:
            parts = rng.uniform(0.2, 1, 3)
            inertia = parts.sum() - parts
            if n % 4 == 3:
                inertia[1] = inertia[0]
            axis, lam, torque = rng.integers(3), rng.normal(size=3), np.zeros(3)
            lam[axis], torque[axis] = 0, size
            yield model.physical(inertia.tolist(), lam.tolist(),
                                 torque.tolist()), tuple(rng.normal(size=3) * 2)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1])
def test_potential_and_integration_agree_on_fate_period_and_extremes(seed):
    """SciPy's DOP853: after its period a bounded motion is back, a spin-up has grown; components are extreme at
    roots of their rates, and at the ends."""
    for problem, state in problems(seed, 12):
        word = energy.label(problem, state, digits=60)
        exact = np.array([[float(v) for v in row] for row in energy.extremes(problem, state, digits=60)])
        end = float(energy.period(problem, state)) if word == "bounded" else 25.0
        rows = [[float(v) for v in row] for row in (problem.kappa, problem.rho, problem.sigma, problem.m)]
        floats = model.Model(*rows, None)
        rate = lambda t, x, floats=floats: floats.rate(list(map(float, x)))
        run = solve_ivp(rate, (0, end), state, "DOP853", rtol=1e-12, atol=1e-13,
                        events=[lambda t, x, i=i: rate(t, x)[i] for i in range(3)])
        seen = np.concatenate([run.y.T[[0, -1]], *(y for y in run.y_events if len(y))])
        box, finite = np.stack([seen.min(axis=0), seen.max(axis=0)], axis=1), np.isfinite(exact)
        assert np.all(np.abs(box - exact)[finite] < 1e-8 * np.abs(exact[finite]).max())
        if word == "bounded":
            np.testing.assert_allclose(run.y[:, -1], state, atol=1e-8 * np.abs(exact).max())
        else:
            assert np.all(np.abs(box[~finite]) > 1)


@pytest.mark.slow
def test_a_taylor_run_over_one_exact_period_returns_to_its_start():
    for problem, state in list(problems(7, 12)):
        if energy.label(problem, state, digits=60) != "bounded":
            continue
        period = energy.period(problem, state, nodes=30)
        (end,), gap = taylor.integrate_checked(problem, state, [period], digits=25)
        assert gap < 1e-18
        assert max(abs(p - mp.mpf(q)) for p, q in zip(end, state)) < 1e-18


def test_quadrature_of_the_period_has_converged():
    for problem, state in list(problems(8, 8)):
        if energy.label(problem, state, digits=60) == "bounded":
            coarse, fine = energy.period(problem, state), energy.period(problem, state, nodes=30)
            assert abs(coarse - fine) < 1e-16 * fine


def test_margin_is_zero_to_all_digits_on_a_separatrix_found_by_energy():
    problem = model.scaled(0.25, 0.5, (0, 0, 1))
    with mp.workdps(100):
        gap = energy.margin(problem, (-3.0, 1.0, 0.0))
        assert gap > 0
        speed = mp.sqrt(2 * gap)
    below, above = (float(speed * (1 + s * mp.mpf("1e-15"))) for s in (-1, 1))
    assert below < speed < above
    assert energy.label(problem, (-3.0, 1.0, below)) == "bounded"
    assert energy.label(problem, (-3.0, 1.0, above)) == "spin-up"
