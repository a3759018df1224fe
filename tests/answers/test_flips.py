"""How often a motion turns over: SciPy's events of the momentum's components, from Euler's equations written
here, and what is known of rackets and symmetric bodies by hand."""
import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import Body, ConstantTorque, Gyrostat, Scene, load
from stabilab.answers.motion import motion
from stabilab.show.text.headline import headline
from stabilab.show.units import SI
from tests.oracles.rigid import euler
from tests.shared import case

RACKET = """
[body]
inertia = [0.0164, 0.0154, 0.00121]
[motion]
angular_velocity = ["4 deg/s", "540 deg/s", "3 deg/s"]
span = [0, "6 s"]
"""


def run(D, wheel, torque, omega, end):
    """(SciPy's DOP853, with the zeros of the three components of H = D omega + wheel)."""
    rates = euler(D, wheel, torque)
    zeros = [lambda t, x, i=i: D[i] * x[i] + wheel[i] for i in range(3)]
    return solve_ivp(rates, (0, end), omega, method="DOP853", rtol=1e-10, atol=1e-12, events=zeros,
                     dense_output=True)


def scene_of(D, wheel, torque):
    effects = [Gyrostat(wheel.tolist())] * bool(wheel.any())
    return Scene(Body(D.tolist()), *effects, *[ConstantTorque(torque.tolist())] * bool(torque.any()))


def chosen(rng):
    """A body, wheel or none, torque along an axis without a wheel or none, and rates, many of them near the
    intermediate axis."""
    D = rng.permutation(np.sort(rng.uniform([1, 1.6, 2.1], [1.5, 2, 2.4]))).round(3)
    wheel, torque = (rng.integers(0, 2, 3) * rng.normal(0, 0.6, 3)).round(3), np.zeros(3)
    kind, i = rng.integers(3), rng.integers(3)
    if kind == 0:
        wheel[:] = 0
    if kind == 2:
        torque[i], wheel[i] = round(rng.normal(0, 0.2), 3), 0
    omega = rng.normal(0, 0.3, 3).round(3)
    if rng.random() < 0.6:
        omega[np.argsort(D)[1]] = 1
    return D, wheel, torque, omega


@pytest.mark.parametrize("seed", [0, *(pytest.param(n, marks=pytest.mark.slow) for n in range(1, 12))])
def test_the_times_are_those_of_scipys_events(seed):
    rng, turning = np.random.default_rng(seed), 0
    for _ in range(8):
        D, wheel, torque, omega = chosen(rng)
        found = motion(scene_of(D, wheel, torque), omega.tolist())
        if found.period is None:
            continue
        seen = run(D, wheel, torque, omega, 2.5 * found.period)
        H = D[:, None] * seen.sol(np.linspace(0, found.period, 2001)) + wheel[:, None]
        along = H / np.linalg.norm(H, axis=0)
        reach = [min(H[i].max(), -H[i].min()) for i in range(3)]
        axis = int(np.argmax(reach))
        ends = along[axis].max(), -along[axis].min()
        if any(abs(end - 0.5**0.5) < 1e-3 for end in ends) or sorted(reach)[2] < 1.001 * sorted(reach)[1]:
            continue  # next to 45 degrees, or two axes alike
        turns = min(ends) > 0.5**0.5
        assert (found.flips is not None) == turns, (D, wheel, torque, omega)
        if turns:
            turning += 1
            gaps, times = np.diff(seen.t_events[axis]), found.flips.times
            assert found.flips.axis == axis + 1 and found.flips.free == (not torque.any())
            assert any(np.allclose(gaps, [times[(n + k) % len(times)] for n in range(len(gaps))],
                                   atol=1e-5 * found.period) for k in range(len(times)))
    assert turning > 2


def test_a_racket_says_in_every_view_how_often_it_turns_over(stabilab, tmp_path):
    # half of Jacobi's period 4 K/lambda (Landau & Lifshitz, section 37), and SciPy's events
    D, omega = np.array([0.0164, 0.0154, 0.00121]), np.radians([4.0, 540, 3])
    gaps = np.diff(run(D, np.zeros(3), np.zeros(3), omega, 8).t_events[1])
    assert np.allclose(gaps, 1.674, atol=5e-4)
    path = tmp_path / "racket.toml"
    path.write_text(RACKET)
    found = load(path).motion()
    assert found.flips.axis == 2 and found.flips.times == pytest.approx(gaps[:1], rel=1e-8)
    words = "turns over every 1.674 s"
    for question in ("fate", "extremes", "period", "classify"):
        code, out, _ = stabilab(question, path)
        assert code == 0 and words in out, question
    told = json.loads(stabilab("fate", path, "--json")[1])[0]["flips"]
    assert told["axis"] == 2 and told["times"] == pytest.approx([gaps[0]], rel=1e-8)
    assert words in headline(load(path), found, SI)


def test_the_t_handle_turns_over_twice_a_period():
    handle = case("t-handle")
    assert handle.motion().flips.times == (handle.motion().period / 2,)


@pytest.mark.parametrize("D, wheel, omega", [
    ((3, 2, 1), (0, 0, 0), (0.05, 0.02, 1)),      # a wobble about the minor axis
    ((3, 2, 1), (0, 0, 0), (1, 0.2, 0.1)),        # and about the major one
    ((1, 1, 2), (0, 0, 0), (1, 0.3, 0.02)),       # a disc on edge rolls evenly: no axis of it is singled out
    ((3, 2, 1), (0, 5, 0), (0.1, 1, 0.1)),        # a wheel on the intermediate axis keeps it up
])
def test_what_wobbles_or_rolls_evenly_does_not_turn_over(D, wheel, omega):
    D, wheel, omega = map(np.array, (D, wheel, omega))
    found = motion(scene_of(D.astype(float), wheel.astype(float), np.zeros(3)), omega.tolist())
    assert found.flips is None and found.period and math.isfinite(found.period)


def test_unequal_times_are_told_in_turn():
    D, wheel, omega = np.array([3.0, 2, 1]), np.array([0.2, 0.1, 0]), np.array([0.1, 1, 0.1])
    found = motion(scene_of(D, wheel, np.zeros(3)), omega.tolist())
    gaps = np.diff(run(D, wheel, np.zeros(3), omega, 2 * found.period).t_events[1])  # SciPy
    assert sorted(found.flips.times) == pytest.approx(sorted(gaps[:2]), rel=1e-6)
    assert abs(gaps[0] - gaps[1]) > 0.1
