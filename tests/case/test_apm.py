"""CCSDS attitude parameter messages as cases: real files, the motion that spin and nutation state, faults."""
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from stabilab import load

FILES = Path(__file__).parent / "real/apm"
EARTH = [0, 0, math.degrees(7.2921150e-5)]
HEAD = "CCSDS_APM_VERS = {}.0\nOBJECT_NAME = OWN\nEPOCH = 2026-01-01T00:00:00\n"
INERTIA = ("INERTIA_START\nINERTIA_REF_FRAME = SC_BODY_1\nIXX = {}\nIYY = {}\nIZZ = {}\nIXY = {}\nIXZ = 0\nIYZ = 0\n"
           "INERTIA_STOP\n")
FRAMES = "REF_FRAME_A = ICRF\nREF_FRAME_B = SC_BODY_1\n"


@pytest.fixture
def imported(tmp_path, stabilab):
    """(case, what came on stderr) of a message."""
    def run(text, *options):
        path = text
        if not isinstance(text, Path):
            path = tmp_path / "own.txt"
            path.write_text(text)
        code, out, err = stabilab("import", path, *options)
        assert code == 0, err
        return load(out), err
    return run


def rates(case):
    """In deg/s, in the frame of the file."""
    back = case.frame.back(case.exact_state) if case.frame else case.exact_state
    return [math.degrees(float(v)) for v in back]


@pytest.mark.parametrize("name", ["APMExample02.txt", "APMExample02.xml"])
def test_version_1_has_rates_along_the_axes_of_a_frame_that_turns_with_the_earth(imported, name):
    """SciPy: capital letters turn about the axes of the body; as_matrix takes components of the body to "
      "those outside."""
    case, err = imported(FILES / name)
    turn = Rotation.from_euler("ZXY", [-53.3688, 139.7527, 25.0658], degrees=True).as_matrix().T
    assert rates(case) == pytest.approx(turn @ (np.array([0.1045, 0.03214, 0.02156]) + EARTH), abs=1e-13)
    assert tomllib.loads(case.text)["body"]["inertia"] == [[6080, -135.9, 89.3], [-135.9, 5245.5, -90.7],
                                                           [89.3, -90.7, 8067.3]]
    assert "maneuver 1: torque [-1.25, -0.5, 0.5] N m" in case.caveats[0].words
    assert "no counterpart: the attitude" in err


def test_a_maneuver_that_is_stuck_acts_for_ever(imported):
    case, _ = imported(FILES / "APMExample02.txt", "--stuck", "maneuver 1")
    torque = case.frame.back(case.scene.effect("constant_torque").exact)
    assert [float(v) for v in torque] == pytest.approx([-1.25, -0.5, 0.5], abs=1e-13) and not case.caveats


def test_version_2_has_positive_integrals_and_an_angular_velocity(imported):
    """Annex F6 of CCSDS 504.0-B-2: the tensor has -IXY."""
    case, err = imported(FILES / "APM-frame-mapper.txt")
    assert tomllib.loads(case.text)["body"]["inertia"] == [[1443.1, 86.4, 0], [86.4, 1445.2, 0.09], [0, 0.09, 1760.2]]
    assert rates(case) == pytest.approx([0.0001, 0.05, 0.00003], abs=1e-15)
    assert "the rates of the block spin: those of the block angular velocity are read" in err


def test_a_body_that_is_not_symmetric_has_no_motion_of_spin_and_nutation(stabilab):
    code, out, err = stabilab("import", FILES / "APMExample09.txt")
    assert code == 2 and not out and "APMExample09.txt:28: spin: " in err and "ANGVEL_X" in err


def test_an_attitude_is_that_of_the_case(imported):
    """The columns of the body's axes in space by SciPy, those of psi, phi, theta by R = Rz Rx Ry."""
    text = HEAD.format(2) + f"QUAT_START\n{FRAMES}Q1 = 0.1\nQ2 = -0.2\nQ3 = 0.3\nQC = 0.9\nQUAT_STOP\n"
    case, _ = imported(text + INERTIA.format(3, 2, 1.5, 0))
    psi, phi, theta = case.blocks["attitude"]
    assert Rotation.from_euler("ZXY", [theta, psi, phi]).as_matrix() == pytest.approx(
        Rotation.from_quat([0.1, -0.2, 0.3, 0.9]).as_matrix(), abs=1e-14)
    assert case.state is None and "no motion: the message has no angular velocity" in case.caveats[0].words


def test_rates_of_a_quaternion_and_of_angles_are_those_of_differences(imported):
    """Of the same motion by SciPy: the turn from one instant to another that is 1e-6 s later."""
    step, angles, speeds = 1e-6, np.array([20.0, 50.0, -70.0]), np.array([0.3, -0.2, 0.7])
    ends = [Rotation.from_euler("ZXZ", angles + sign * step / 2 * speeds, degrees=True) for sign in (-1, 1)]
    expected = np.degrees((ends[0].inv() * ends[1]).as_rotvec()) / step
    q = Rotation.from_euler("ZXZ", angles, degrees=True).as_quat()
    dot = (ends[1].as_quat() - ends[0].as_quat()) / step
    euler = "".join(f"ANGLE_{n} = {a}\nANGLE_{n}_DOT = {s} "
                    f"[deg/s]\n" for n, a, s in zip("123", angles, speeds))
    for block in (f"EULER_START\n{FRAMES}EULER_ROT_SEQ = ZXZ\n{euler}EULER_STOP\n",
                  f"QUAT_START\n{FRAMES}" + "".join(f"Q{n} = {v:.17g}\nQ{n}_DOT = "
                                                    f"{d:.17g}\n" for n, v, d in zip(
                      "123C", q, dot)) + "QUAT_STOP\n"):
        case, _ = imported(HEAD.format(2) + block + INERTIA.format(3, 2, 1.5, 0))
        assert rates(case) == pytest.approx(expected, abs=1e-8)  # rounding of the differences
    back = block.replace("ICRF", "X").replace("SC_BODY_1", "ICRF").replace("= X", "= SC_BODY_1")  # the inverse attitude
    inverse, _ = imported(HEAD.format(2) + back + INERTIA.format(3, 2, 1.5, 0))
    outside = np.degrees((ends[0] * ends[1].inv()).as_rotvec()) / step  # of space in the body's frame, the other sign
    assert rates(inverse) == pytest.approx(outside, abs=1e-8)


def free(moments, omega, attitude, times):
    """Attitudes (N, 4) of a free body by DOP853, from Euler's equations and q' = q omega/2, scalar last."""
    D = np.array(moments)

    def slope(t, y):
        w, q = y[:3], Rotation.from_quat(y[3:]).as_quat()
        x, y_, z, s = q
        a, b, c = w
        dq = 0.5 * np.array([s*a + y_*c - z*b, s*b + z*a - x*c, s*c + x*b - y_*a, -x*a - y_*b - z*c])
        return np.concatenate([np.cross(D * w, w) / D, dq])
    start = np.concatenate([omega, attitude.as_quat()])
    return solve_ivp(slope, (0, times[-1]), start, "DOP853", times, rtol=1e-12, atol=1e-13).y[3:].T


@pytest.mark.parametrize("A, C, nutation, phase", [(100.0, 125.0, 20.0, 35.0), (300.0, 120.0, 8.0, -85.0),
                                                   (50.0, 80.0, 120.0, 200.0)])
@pytest.mark.parametrize("by", ["NUTATION", "MOMENTUM"])
def test_spin_and_nutation_are_the_motion_of_a_free_symmetric_body(imported, A, C, nutation, phase, by):
    """The model of annex F5 of CCSDS 504.0-B-2, formed here with SciPy's rotations, and the case's rates "
      "followed by DOP853
    from its attitude must be one motion; the moments decide psi' = (A/C - 1) phi' cos nu."""
    speed = 3.0  # phi', deg/s
    spin = (A / C - 1) * speed * math.cos(math.radians(nutation))
    alpha, delta, sigma = 40.0, 25.0, 70.0
    attitude = Rotation.from_euler("ZXZ", [alpha + 90, 90 - delta, sigma], degrees=True)
    n, p = math.radians(nutation), math.radians(phase)
    along = attitude.apply([math.sin(n) * math.cos(p), -math.sin(n) * math.sin(p), math.cos(n)])
    if by == "NUTATION":
        more = f"NUTATION = {nutation}\nNUTATION_PER = {360 / speed!r} [s]\nNUTATION_PHASE = {phase}\n"
    else:
        more = (f"MOMENTUM_ALPHA = {math.degrees(math.atan2(along[1], along[0]))!r}\n"
                f"MOMENTUM_DELTA = {math.degrees(math.asin(along[2]))!r}\nNUTATION_VEL = {speed} [deg/s]\n")
    case, _ = imported(HEAD.format(2) + f"SPIN_START\n{FRAMES}SPIN_ALPHA = {alpha}\nSPIN_DELTA = {delta}\n"
                       f"SPIN_ANGLE = {sigma}\nSPIN_ANGLE_VEL = "
                       f"{spin!r}\n{more}SPIN_STOP\n" + INERTIA.format(A, A, C, 0))
    psi, phi, theta = case.blocks["attitude"]
    start = Rotation.from_euler("ZXY", [theta, psi, phi])
    assert start.as_matrix() == pytest.approx(attitude.as_matrix(), abs=1e-13)
    times = np.array([0.0, 30.0, 100.0])
    followed = Rotation.from_quat(free([A, A, C], np.radians(rates(case)), start, times))
    turn = Rotation.from_rotvec(np.outer(np.radians(speed) * times, along))  # about H
    model = turn * attitude * Rotation.from_rotvec(np.outer(np.radians(spin) * times, [0, 0, 1]))
    assert (followed.inv() * model).magnitude() == pytest.approx(0, abs=1e-8)  # what DOP853 leaves in 100 s


SPIN = ("SPIN_FRAME_A = ICRF\nSPIN_FRAME_B = SC_BODY_1\nSPIN_DIR = A2B\nSPIN_ALPHA = 10\nSPIN_DELTA = "
        "20\nSPIN_ANGLE = 30\n"
        "SPIN_ANGLE_VEL = {}\nNUTATION = 20\nNUTATION_PER = {}\nNUTATION_PHASE = 0\nI11 = 100\nI22 = "
        "100\nI33 = 125\n"
        "I12 = 0\nI13 = 0\nI23 = 0\n")


def test_in_version_1_the_spin_may_be_the_component_of_the_angular_velocity(imported):
    """omega_z = 6 deg/s, H = C omega_z/cos nu, periods 360 A/H about H and 360/((1 - A/C) ... ) in the "
      "body, by hand."""
    momentum = 125 * 6 / math.cos(math.radians(20))
    outside, inside = 360 * 100 / momentum, 360 / abs(6 * (1 - 125 / 100))
    for period in (outside, inside):
        case, err = imported(HEAD.format(1) + SPIN.format(6, period))
        assert rates(case) == pytest.approx([momentum * math.sin(math.radians(20)) / 100, 0, 6], abs=1e-12)
        assert "SPIN_ANGLE_VEL is the component of the angular velocity" in err


def test_without_nutation_the_body_turns_about_its_axis(imported):
    text = "\n".join(line for line in SPIN.splitlines() if not line.startswith("NUTATION"))
    case, _ = imported(HEAD.format(1) + text.format(7))
    assert rates(case) == pytest.approx([0, 0, 7], abs=1e-13)


BODY = INERTIA.format(3, 2, 1.5, 0)
RATE = (f"ANGVEL_START\n{FRAMES}ANGVEL_FRAME = SC_BODY_1\nANGVEL_X = 1\nANGVEL_Y = 2\nANGVEL_Z = 3\n"
        "ANGVEL_STOP\n")


@pytest.mark.parametrize("text, line, words", [
    (HEAD.format(2) + RATE, 1, "has no inertia"), (HEAD.format(3) + BODY, 1, "expected version 1.0 or 2.0"),
    (HEAD.format(2) + BODY.replace("IYZ = 0\n", ""), 4, "IYZ is missing"),
    (HEAD.format(2) + BODY.replace("IYY = 2", "IYY = -2"), 4, "principal moments is not positive"),
    (HEAD.format(2) + BODY.replace("IYY = 2", "IYY = 2 [kg*km**2]"), 7, "expected the unit [kg*m**2], got "
                                                                        "[kg*km**2]"),
    (HEAD.format(2) + BODY.replace("IYY = 2", "IYY = two"), 7, "IYY: expected a decimal"),
    (HEAD.format(2) + BODY + RATE.replace("ICRF", "ANYWHERE"), 14, "unknown frame ANYWHERE"),
    (HEAD.format(2) + BODY + RATE.replace("ANGVEL_FRAME = SC_BODY_1", "ANGVEL_FRAME = "
                                                                      "EME2000"), 16, "expected one of the "
                                                                                      "frames"),
    (HEAD.format(2) + BODY + RATE.replace("ANGVEL_X", "ANGVEL_U"), 17, "did you mean ANGVEL_"),
    (HEAD.format(2) + BODY + RATE + "ANGLE_1\n", 21, "expected KEYWORD = value"),
    (HEAD.format(1) + SPIN.format(6, 100), 12, "NUTATION_PER: a nutation period of 100 s does not agree"),
    ('<?xml version="1.0"?>\n<!DOCTYPE apm [<!ENTITY a "b">]>\n<apm version="2.0"/>', 2, "a document type"),
    ('<?xml version="1.0"?>\n<apm version="2.0">\n<body></apm>', 3, "not well-formed XML")])
def test_a_fault_has_its_line_and_what_to_do(tmp_path, stabilab, text, line, words):
    (tmp_path / "own.txt").write_text(text)
    code, out, err = stabilab("import", tmp_path / "own.txt")
    assert code == 2 and not out and f"own.txt:{line}: " in err and words in err and "Traceback" not in err
    assert len(err.strip().splitlines()) == 1


@pytest.mark.parametrize("text, words", [
    (BODY + RATE.replace("ICRF", "LVLH"), "relative to the orbit frame LVLH"),
    (BODY.replace("SC_BODY_1", "INSTRUMENT_A") + RATE, "does not say how one lies in the other"),
    (BODY + RATE.replace("ICRF", "ITRF2000"), "with which the Earth's rotation would be added")])
def test_rates_that_are_not_known_are_no_motion_and_a_caveat(imported, text, words):
    case, _ = imported(HEAD.format(2) + text)
    assert case.state is None and words in case.caveats[0].words


TWICE = ("EULER_FRAME_A = SC_BODY_1\nEULER_FRAME_B = ICRF\nEULER_DIR = B2A\nEULER_ROT_SEQ = {}\nRATE_FRAME = EULER_FRAME_A\n"
         "Y_ANGLE = -26.78 [deg ]\nX_ANGLE = 46.26 [deg ]\nY_ANGLE = 144.10\nY_RATE = 0.1\nX_RATE = 0.2\nY_RATE = 0.3\n")
DIAGONAL = "I11 = 3\nI22 = 2\nI33 = 1.5\nI12 = 0\nI13 = 0\nI23 = 0\n"


def test_version_1_gives_an_angle_twice_where_its_sequence_does(imported):
    """As figure 3-6 of CCSDS 504.0-B-1 with the sequence 212; the attitude by SciPy, capital letters about axes of the body."""
    case, _ = imported(HEAD.format(1) + TWICE.format(212) + DIAGONAL)
    psi, phi, theta = case.blocks["attitude"]
    assert Rotation.from_euler("ZXY", [theta, psi, phi]).as_matrix() == pytest.approx(
        Rotation.from_euler("YXY", [-26.78, 46.26, 144.10], degrees=True).as_matrix(), abs=1e-14)
    assert case.state is None and "gives Y_RATE twice" in case.caveats[0].words


@pytest.mark.parametrize("sequence, words", [(213, "Z_ANGLE is missing"), (121, "X_ANGLE (second) is missing")])
def test_an_angle_twice_is_a_fault_in_any_other_sequence(tmp_path, stabilab, sequence, words):
    (tmp_path / "own.txt").write_text(HEAD.format(1) + TWICE.format(sequence) + DIAGONAL)
    code, _, err = stabilab("import", tmp_path / "own.txt")
    assert code == 2 and words in err


@pytest.mark.parametrize("name", ["APM-spin-nutation.xml", "NDM-ocm-apm.xml"])
def test_an_attitude_alone_is_no_case(stabilab, name):
    """Also where the message is one of several in a file."""
    code, out, err = stabilab("import", FILES / name)
    assert code == 2 and not out and "has no inertia" in err and len(err.strip().splitlines()) == 1
