"""Times to a limit with many digits, each proved."""
import json
from decimal import Decimal, localcontext
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest

from stabilab import extremes, load, when
from stabilab.errors import InputError
from stabilab.physics.body import Body
from stabilab.physics.effects.constant_torque import ConstantTorque
from stabilab.physics.effects.gyrostat import Gyrostat
from stabilab.physics.scene import Scene
from tests.oracles.model import physical
from tests.oracles.taylor import integrate_checked
from tests.shared import CASES

SCENES = [  # moments, wheel, torque, start: circle, hyperbola and parabola, with a torque and without
    ((3, 2, 1), (0, 0, 0), (0, 0, 0), ("0.25", "0.5", "0.375")),
    ((3, 2, 1), ("0.1", 0, "0.2"), (0, 0, 0), ("0.25", "-0.5", "0.375")),
    ((2, 2, 3), (0, "0.5", "0.25"), (0, 0, 0), (1, "0.5", "0.25")),
    ((3, 2, 1), ("0.1", "-0.2", 0), (0, 0, "0.05"), ("0.25", "0.5", "0.375")),
    ((3, 1, 2), ("0.1", "-0.2", 0), (0, 0, "0.05"), ("0.25", "0.5", "-0.375")),
    ((2, 3, 3), ("0.1", "0.2", 0), (0, 0, "-0.01"), ("0.25", "0.5", "0.375")),
    ((3, 2, 1), (0, 0, 0), (0, 0, "0.05"), ("0.25", "0.5", "-0.625"))]


def exact(row):
    return tuple(map(Fraction, row))


def scene_of(D, wheel, torque):
    return Scene(Body(exact(D)), Gyrostat(exact(wheel)), ConstantTorque(exact(torque)))


@pytest.mark.one_in(3)
@pytest.mark.parametrize("D, wheel, torque, start", SCENES)
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_at_the_time_the_component_is_at_its_limit(D, wheel, torque, start, axis):
    # the Taylor series of tests/oracles/taylor.py in mpmath; that it is the first crossing is the package's own
    # proof in integers, whose two times must hold it
    scene, start = scene_of(D, wheel, torque), exact(start)
    box = np.abs(extremes(scene, [float(v) for v in start]))[axis]
    top = float(box.max())
    if not top < 1e3:  # it grows without bound
        top = 2 * float(abs(start[axis])) + 1
    limit = Fraction(int(9 * top * 2**20), 10 * 2**20)
    if abs(start[axis]) >= limit:
        return
    result = when(scene, [str(v) for v in start], component=(str(axis + 1), f"{limit} rad/s"), digits=25)
    with mp.workdps(40):
        time = mp.mpf(result.decimals)
        assert float(result.low) <= time <= float(result.high)
        (state,), gap = integrate_checked(physical(exact(D), exact(wheel), exact(torque)),
                                          tuple(map(float, start)), [time], 25)
        assert abs(abs(state[axis]) - mp.mpf(limit.numerator) / limit.denominator) < 1e-16 + gap


@pytest.mark.parametrize("digits", [30, 10_000])
def test_a_symmetric_spin_up_reaches_its_rate_by_hand(digits):
    # D3 omega3' = M3: omega3 = -1 + t/30, and |omega|^2 = 1/4 + omega3^2 = 4 at t = 30 + 15 sqrt 15
    result = when(CASES / "symmetric-spin-up.toml", rate="2 rad/s", digits=digits)
    with localcontext() as context:
        context.prec = digits + 10
        assert abs(Decimal(result.decimals) - 30 - 15 * Decimal(15).sqrt()) < Decimal(10) ** (2 - digits)


def test_a_free_body_reaches_a_component_by_an_elliptic_integral():
    # omega2 = B sn(u) of Landau & Lifshitz, section 37: incomplete integrals of mpmath from the start on
    case, digits = load(CASES / "torque-free-body.toml"), 300
    result = when(case, component=("2", "0.45 rad/s"), digits=digits)
    with mp.workdps(digits + 20):
        D, w = [mp.mpf(3), mp.mpf(2), mp.mpf(1)], [mp.mpf(n) / 10 for n in (2, 4, 3)]
        T2, H2 = (sum(d**n * v * v for d, v in zip(D, w)) for n in (1, 2))
        B2 = (H2 - T2 * D[2]) / (D[1] * (D[1] - D[2])), (T2 * D[0] - H2) / (D[1] * (D[0] - D[1]))
        B, m = mp.sqrt(min(B2)), min(B2) / max(B2)
        speed = mp.sqrt((H2 - T2 * D[2]) * (D[0] - D[1]) / (D[0] * D[1] * D[2]))
        at = lambda v: mp.ellipf(mp.asin(v / B), m) / speed
        first, second = at(w[1]), at(mp.mpf("0.45"))
        # omega2' = (D3 - D1) omega3 omega1/D2 < 0: down to -0.45 at a half turn less the sum of both
        exact = first + second
        assert abs(mp.mpf(result.decimals) - exact) < mp.mpf(10) ** (2 - digits)


def test_the_command_writes_the_digits(stabilab):
    request = ("when", CASES / "torque-free-body.toml", "--rate", "0.55 rad/s", "--digits", "40")
    code, out, _ = stabilab(*request)
    found = json.loads(stabilab(*request, "--json")[1])
    found = found[0] if isinstance(found, list) else found
    assert code == 0 and found["decimals"] in out and len(found["decimals"]) == 43
    assert found["time"][0] <= float(found["decimals"]) <= found["time"][1]
    first, written, *_ = out.splitlines()
    assert len(first) <= 100 and written == f"  {found['decimals']} s, each digit proved"


def test_what_has_no_formula_says_so(stabilab):
    free = CASES / "torque-free-body.toml"
    code, _, err = stabilab("when", free, "--tilt", "z = 5 deg", "--digits", "30")
    assert code == 2 and "no formula" in err
    code, _, err = stabilab("when", CASES / "off-axis-two.toml", "--rate", "10 rad/s", "--digits", "30")
    assert code == 2 and "no formula" in err
    code, _, err = stabilab("when", free, "--below", "0.52 rad/s", "--digits", "30")
    assert code == 2 and "reached from below" in err and "--rate" in err
    code, _, err = stabilab("when", free, "--rate", "0.55 rad/s", "--digits", "10001")
    assert code == 2 and "1 to 10000" in err
    with pytest.raises(InputError, match="digits"):
        when(free, rate="0.55 rad/s", digits=0)
    with pytest.raises(InputError, match="one motion"):
        when(free, rate="0.55 rad/s", states=[[0.2, 0.4, 0.3]] * 2, digits=20)
    assert when(free, rate="5 rad/s", digits=20).decimals is None  # it is never reached
