"""`simulate --attitude`: the quaternion beside the rates, against SciPy's rotations and DOP853."""
import json

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from stabilab import Body, ConstantTorque, Gyrostat, InputError, Scene, simulate
from tests.oracles.rigid import euler, in_space
from tests.shared import CASES

BODY = "[body]\ninertia = [3, 2, 1.5]\n"
REST = "[motion]\nangular_velocity = [0.3, -0.2, 0.5]\nspan = [0, 20]\n"
MORE = '[effects.gyrostat]\nmomentum = [0.1, 0.2, -0.3]\n[effects.constant_torque]\ntorque = [0, 0, 0.05]\n'
D, WHEEL, TORQUE, START = np.array([3, 2,
                                    1.5]), np.array([0.1, 0.2,
                                                     -0.3]), np.array([0, 0,
                                                                       0.05]), np.array([0.3, -0.2, 0.5])
TIMES = [0, 4, 9.5, 20]


def _turned(first=None, wheel=WHEEL, torque=TORQUE):
    """(rates, matrices from body to space) at the times, by DOP853 for R' = R [omega x]."""
    first = np.eye(3) if first is None else first
    run = solve_ivp(in_space(euler(D, wheel, torque)), (0, 20), [*START, *first.ravel()], method="DOP853", t_eval=TIMES, rtol=1e-12,
                    atol=1e-13)
    return run.y[:3].T, run.y[3:].T.reshape(-1, 3, 3)


def _asked(stabilab, path, *more):
    return stabilab("simulate", path, "--at", ",".join(map(str, TIMES)), "--attitude", *more)


def test_the_quaternion_of_a_spacecraft_is_scalar_last_from_body_to_space(stabilab, case_file):
    code, out, _ = _asked(stabilab, case_file(BODY + MORE + REST), "--json")
    found = json.loads(out)
    rates, matrices = _turned()
    assert code == 0 and "scalar last" in found["quaternion"]
    assert np.array(found["state"]["omega"]) == pytest.approx(rates, abs=1e-9)
    q = np.array(found["state"]["quaternion"])
    assert Rotation.from_quat(q).as_matrix() == pytest.approx(matrices, abs=1e-9)
    assert np.linalg.norm(q, axis=1) == pytest.approx(1, abs=1e-14)
    assert q[0].tolist() == [0, 0, 0, 1]


def test_it_begins_with_the_attitude_of_the_case(stabilab, case_file):
    """psi, phi, theta of the 3-1-2 sequence: R = Rz(theta) Rx(psi) Ry(phi)."""
    path = case_file(BODY + MORE + REST + "attitude = [0.3, -0.4, 1.1]\n")
    first = Rotation.from_euler("ZXY", [1.1, 0.3, -0.4])
    q = json.loads(_asked(stabilab, path, "--json")[1])["state"]["quaternion"]
    assert Rotation.from_quat(q).as_matrix() == pytest.approx(_turned(first.as_matrix())[1], abs=1e-9)


def test_it_begins_with_the_vertical_of_the_case(stabilab, case_file):
    """Inertial axis 3 is the vertical: its body components are the third row of R."""
    path = case_file(BODY + "[effects.gravity]\nweight = 0.1\ncentre_of_mass = [0, 0, 1]\n" + REST
                + "vertical = [0, 3, 4]\n")
    state = json.loads(_asked(stabilab, path, "--json")[1])["state"]
    assert Rotation.from_quat(state["quaternion"]).as_matrix()[:,
                                                               2] == pytest.approx(np.array(state["gamma"]),
                                                                                   abs=1e-12)
    assert state["gamma"][0] == pytest.approx([0, 0.6, 0.8])


def test_quarter_turns_about_axis_1_pass_where_angles_are_singular():
    """omega = (1, 0, 0): q = (sin t/2, 0, 0, cos t/2); psi = 90 deg leaves phi and theta open."""
    times = np.pi / 2 * np.arange(5)
    q = simulate(Scene(Body((3, 2, 1.5))), (1, 0, 0), times, {"attitude": (0, 0, 0, 1)}).state["quaternion"]
    assert q == pytest.approx(np.column_stack([np.sin(times / 2), 0 * times, 0 * times, np.cos(times / 2)]),
                              abs=1e-14)


@pytest.mark.parametrize("digits", [9, 15])
def test_digits_are_those_of_the_quaternion_too(stabilab, case_file, digits):
    code, out, _ = _asked(stabilab, case_file(BODY + MORE + REST), "--json", "--digits", digits)
    found = json.loads(out)
    assert code == 0 and found["digits"]["reached"] >= digits
    assert Rotation.from_quat(found["state"]["quaternion"]).as_matrix() == pytest.approx(_turned()[1],
                                                                                         abs=1e-8)


def test_nothing_is_carried_that_nobody_asked_for(stabilab, case_file):
    out = stabilab("simulate", case_file(BODY + MORE + REST), "--at", "0,1", "--json")[1]
    assert set(json.loads(out)["state"]) == {"omega"} and "quaternion" not in json.loads(out)


def test_what_has_no_attitude_says_so(stabilab, case_file):
    path = case_file("[scaled]\na = 1\nb = 2\nmu = [0, 0, 1]\n[motion]\nx = [0, 0, 1]\ntau = [0, 20]\n")
    code, out, err = _asked(stabilab, path)
    assert code == 2 and not out and "scaled variables have no attitude" in err
    assert stabilab("simulate", case_file(BODY + REST), "--attitude", "--model", "linear")[0] == 2
    with pytest.raises(InputError, match="not zero"):
        simulate(Scene(Body((3, 2, 1.5)), Gyrostat((0, 0, 1)), ConstantTorque((0, 0, 1))), (1, 0, 0), [0, 1],
                 {"attitude": (0, 0, 0, 0)})


def test_the_first_line_of_a_top_says_how_it_leans_and_a_caveat_is_printed_once(stabilab, tmp_path):
    """Pushed over from upright it comes back to the vertical, where its axis has no direction of precession."""
    path = tmp_path / "top.toml"
    text = (CASES / "toy-top.toml").read_text(encoding="utf-8")
    path.write_text(text.replace('["0.0871557", 0, "-0.9961947"]', "[0, 0, -1]").replace(
        '[0, 0, "25 rev/s"]', '["1 rev/s", 0, "25 +- 1 % rev/s"]'))
    first, *rest = stabilab("attitude", path)[1].splitlines()
    assert first.startswith("top: HEAVY TOP; leaning by 0 deg to 21.82 deg; nutation period 0.18801 s")
    assert rest[0] == "  no precession, for its axis passes through the vertical"
    assert sum("caveat" in line for line in rest) == 1
