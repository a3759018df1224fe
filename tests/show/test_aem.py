"""`simulate --out FILE.aem`: a CCSDS attitude ephemeris, against SciPy."""
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

OBLIQUE = [[3, 0.3, 0.1], [0.3, 2, -0.2], [0.1, -0.2, 4]]
RATES = [0.3, 0.1, -0.2]


def followed(D, times, start):
    """Attitudes of a free body with this tensor, by DOP853 from Euler's equations and q' = q omega/2 in the frame of the file."""
    D = np.array(D, float)

    def slope(t, y):
        w = y[:3]
        x, v, z, s = y[3:]
        a, b, c = w
        return np.concatenate([np.linalg.solve(D, np.cross(D @ w, w)), 0.5 * np.array(
            [s*a + v*c - z*b, s*b + z*a - x*c, s*c + x*b - v*a, -x*a - v*b - z*c])])
    return solve_ivp(slope, (0, times[-1]), [*RATES, *start.as_quat()], "DOP853", times, rtol=1e-12, atol=1e-13).y


@pytest.mark.parametrize("tensor, attitude", [(OBLIQUE, None), ([3, 2, 4], None), ([3, 2, 4], [0.3, -0.4, 0.5])])
def test_the_ephemeris_is_the_motion_in_the_frame_of_the_file(case_file, tmp_path, stabilab, tensor, attitude):
    """F2.1 of CCSDS 504.0-B-2: the quaternion takes the axes of space to those of the body, as SciPy's with its scalar last."""
    path = case_file(f"[body]\ninertia = {tensor}\n[motion]\nangular_velocity = {RATES}\n"
                     + (f"attitude = {attitude}\n" if attitude else ""))
    code, _, err = stabilab("simulate", path, "--at", "0,5,12.5", "--out", tmp_path / "run.aem", "--epoch",
                            "2026-01-01T23:59:59.25")
    assert code == 0, err
    lines = (tmp_path / "run.aem").read_text().splitlines()
    values = dict(line.split(" = ") for line in lines if " = " in line)
    assert lines[0] == "CCSDS_AEM_VERS = 2.0" and values["ATTITUDE_TYPE"] == "QUATERNION/ANGVEL"
    assert values["START_TIME"] == "2026-01-01T23:59:59.250000000" and values["STOP_TIME"] == "2026-01-02T00:00:11.750000000"
    data = lines[lines.index("DATA_START") + 1:lines.index("DATA_STOP")]
    assert [line.split()[0][-12:] for line in data] == ["59.250000000", "04.250000000", "11.750000000"]
    table = np.array([line.split()[1:] for line in data], float)
    psi, phi, theta = attitude or (0, 0, 0)
    D = np.diag(tensor) if np.ndim(tensor) == 1 else tensor
    y = followed(D, [0, 5, 12.5], Rotation.from_euler("ZXY", [theta, psi, phi]))
    off = Rotation.from_quat(table[:, :4]).inv() * Rotation.from_quat(y[3:].T)
    assert off.magnitude() == pytest.approx(0, abs=1e-9) and table[:, 4:] == pytest.approx(np.degrees(y[:3].T), abs=1e-8)


def test_the_same_run_gives_the_same_bytes(case_file, tmp_path, stabilab, monkeypatch):
    """The date of the message is no clock's: that of time 0, which a comment says, or SOURCE_DATE_EPOCH's (1767225600 s is
    2026-01-01 UTC, by `date -u -d @1767225600`)."""
    path = case_file(f"[body]\ninertia = [3, 2, 4]\n[motion]\nangular_velocity = {RATES}\n")

    def head(stamp):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", stamp)
        code, _, err = stabilab("simulate", path, "--at", "0,5", "--out", tmp_path / "run.aem", "--epoch",
                                "2030-05-06T07:08:09.5")
        return (tmp_path / "run.aem").read_text().splitlines()[:3] if not code else err
    version, comment, date = head("")
    assert version == "CCSDS_AEM_VERS = 2.0" and comment.startswith("COMMENT CREATION_DATE is the date of time 0")
    assert date == "CREATION_DATE = 2030-05-06T07:08:09"
    assert head("1767225600")[1] == "CREATION_DATE = 2026-01-01T00:00:00"
    for wrong in ("yesterday", "1e9", "9" * 30):
        assert "SOURCE_DATE_EPOCH (environment): expected whole seconds" in head(wrong)


@pytest.mark.parametrize("options, words", [
    (("--out", "run.aem"), "--epoch 2026-01-01T00:00:00"), (("--out", "run.aem", "--epoch", "tomorrow"), "got tomorrow"),
    (("--out", "run.aem", "--epoch", "2026-13-01T00:00:00"), "--epoch 2026-13-01T00:00:00: "),
    (("--out", "run.csv", "--epoch", "2026-01-01T00:00:00"), "give it with --out FILE.aem"),
    (("--out", "run.aem", "--epoch", "2026-01-01T00:00:00", "--matrix"), "--matrix: "),
    (("--out", "run.aem", "--epoch", "2026-01-01T00:00:00", "--at", "1"), "two times or more")])
def test_what_is_no_ephemeris_is_said(case_file, stabilab, monkeypatch, tmp_path, options, words):
    path = case_file(f"[body]\ninertia = [3, 2, 4]\n[motion]\nangular_velocity = {RATES}\nspan = [0, 9]\n")
    monkeypatch.chdir(tmp_path)
    code, _, err = stabilab("simulate", path, *options)
    assert code == 2 and words in err and "Traceback" not in err and not list(tmp_path.glob("run.*"))
