"""Real files of every format that `import` reads: against numbers taken out of them by another route, and written and read back."""
import csv
import math
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from stabilab import load
from stabilab.case.read import load_all, load_orbiting

from .test_robots import about_mass_centre, compared, moments, placed, read_back, symmetric

FILES = Path(__file__).parent / "real"
ROBOTS = {"urdf/07-physics.urdf": (16, 1), "urdf/cf2x.urdf": (1, 0), "urdf/3_DOF_ARM_description.urdf": (4, 1),
          "sdf/pendulum_links.sdf": (3, 2), "sdf/lift_drag_nested.sdf": (4, 1), "sdf/x500_mono_cam/model.sdf": (6, 1),
          "mjcf/arm.xml": (10, 1), "mjcf/barkour_v0_mjx.xml": (13, 1), "mjcf/ray_swing.xml": (1, 0)}


@pytest.fixture
def written_and_read(tmp_path, stabilab):
    """What `import` makes of a file, after `export` and `import` of that have given the same body."""
    def run(file, *options):
        code, out, err = stabilab("import", FILES / file, *options)
        assert code == 0, err
        (tmp_path / "own.toml").write_text(out)
        assert stabilab("export", tmp_path / "own.toml", "--out", tmp_path / "own.urdf")[0] == 0
        code, back, _ = stabilab("import", tmp_path / "own.urdf")
        for first, second in zip(read_back(out), read_back(back)):
            assert code == 0 and np.array_equal(first, second)
        return out, err
    return run


@pytest.mark.parametrize("file, bodies, caveats", [(file, *row) for file, row in ROBOTS.items()])
def test_a_robot_description_is_one_rigid_body(written_and_read, file, bodies, caveats):
    out, err = written_and_read(file)
    assert (f"{bodies} " in err and "are joined into one rigid body" in err) == (bodies > 1)
    compared(FILES / file, out)
    case = load(out)
    assert sum(item.kind == "stated" for item in case.caveats) == caveats
    if caveats:
        assert "locked in the position" in case.caveats[caveats - 1].words


def test_one_link_alone_is_in_its_own_frame(stabilab):
    """The numbers of the file are along principal axes; turned here by SciPy."""
    file = FILES / "mjcf/barkour_v0_mjx.xml"
    mass, centre, tensor = read_back(stabilab("import", file, "--body", "chassis")[1])
    turn = Rotation.from_quat([0.000990813, 0.68703, 0.000216603, 0.726628], scalar_first=True).as_matrix()
    assert mass == 4.48878 and centre.tolist() == [0.0196226, -0.00015133, 0.0611588]
    assert tensor == pytest.approx(turn @ np.diag([0.071033, 0.0619567, 0.0192519]) @ turn.T, abs=1e-12)
    code, _, err = stabilab("import", file, "--body", "tail")
    assert code == 2 and "--body tail: no such body; the file has chassis, abduction_1" in err


def test_a_leg_of_shapes_has_their_moments(written_and_read):
    """By closed forms of a capsule (two half balls and a tube) and a box, each turned along its points and moved by hand."""
    def capsule(begin, end, r):
        along = np.array(end, float) - begin
        h, z = np.linalg.norm(along) / 2, along / np.linalg.norm(along)
        tube, ball = 2000 * math.pi * r**2 * h, 4000 / 3 * math.pi * r**3
        across = tube * (r**2 / 4 + h**2 / 3) + ball * (2 * r**2 / 5 + h**2 + 3 * r * h / 4)
        own = across * (np.eye(3) - np.outer(z, z)) + (tube * r**2 / 2 + ball * 2 * r**2 / 5) * np.outer(z, z)
        return moments(tube + ball, own, placed((np.array(begin) + end) / 2, Rotation.identity()))
    foot = np.array([0.03, 0.1, 0.15])**2 / 3
    J = (capsule((0, 0, 0), (0, 0, -1), 0.04) + capsule((0, 0, -1), (0.05, -0.08, -1.1), 0.02)
         + capsule((0, 0, -1), (-0.6, 0, -1), 0.03)
         + moments(3.6, 3.6 * np.diag(foot.sum() - foot), placed((-0.6, 0, -1.05), Rotation.identity())))
    out, err = written_and_read("mjcf/ten_J2.xml")
    for got, expected in zip(read_back(out), about_mass_centre(J)):
        assert got == pytest.approx(expected, abs=1e-11 * np.abs(expected).max())
    assert "those of shapes of uniform density, as MuJoCo has them: thigh, calf, foot" in err


@pytest.mark.parametrize("name", ["3_DOF_ARM", "4_WHEELER", "ORIGINAL_3_DOF_ARM"])
def test_a_table_of_solidworks_has_a_link_a_row(tmp_path, stabilab, name):
    """The numbers by the csv module; written out as URDF, each is the body of its row."""
    file = FILES / f"csv/{name}_description.csv"
    code, _, err = stabilab("import", file, "--out", tmp_path / "own.toml")
    assert code == 0, err
    rows = list(csv.DictReader(file.read_text().splitlines()))
    cases = load_all(tmp_path / "own.toml")
    assert stabilab("export", tmp_path / "own.toml", "--out", tmp_path / "own.urdf")[0] == 0
    assert len(cases) == len(rows) and all("Visual X" in case.caveats[0].words for case in cases)
    for n, row in enumerate(rows, 1):
        assert f"{n} {row['Link Name']}" in cases[0].source
        mass, centre, tensor = read_back(stabilab("import", tmp_path / f"own-{n}.urdf")[1])
        assert mass == float(row["Mass"]) and centre.tolist() == [float(row[f"Center of Mass {axis}"]) for axis in "XYZ"]
        assert tensor == pytest.approx(symmetric(*(float(row[f"Moment I{key}"]) for key in ("xx", "yy", "zz", "xy", "xz", "yz"))),
                                       rel=1e-15)


def test_the_table_has_the_numbers_of_the_description_beside_it(stabilab):
    """SolidWorks wrote both."""
    row = next(csv.DictReader((FILES / "csv/3_DOF_ARM_description.csv").read_text().splitlines()))
    _, _, tensor = read_back(stabilab("import", FILES / "urdf/3_DOF_ARM_description.urdf", "--body", row["Link Name"])[1])
    assert np.diag(tensor).tolist() == [float(row[f"Moment I{2 * axis}"]) for axis in "xyz"]


def lines_of(file):
    """(value, label) of the lines of a file of 42."""
    return [tuple(part.strip() for part in line.split("!", 1)) for line in (FILES / "42" / file).read_text().splitlines() if "!" in line]


def of_42(file):
    """The pseudo-inertia (4, 4) in the frame of body 0: joints at the angles and displacements 0, as these files have them."""
    lines = lines_of(file)

    def all_of(label, count):
        return [[float(v) for v in value.split()[:count]] for value, own in lines if re.match(f"{label}(?! Props)", own)]
    J = [moments(mass, symmetric(*moment, *np.negative(product)), placed(centre, Rotation.identity()))
         for (mass,), moment, product, centre in zip(all_of("Mass", 1), all_of("Moments of", 3), all_of("Products of", 3),
                                                     all_of("Location of mass", 3))]
    count = int(next(value for value, label in lines if label == "Number of Bodies"))
    frames = {0: np.eye(4)}
    sequences = [[value.split()[3] for value, own in lines if own.startswith(label)] for label in ("Bi to Gi", "Go to Bo")]
    for n, (inner, outer) in enumerate(all_of("Inner, outer", 2)[:count - 1]):
        turns = [Rotation.from_euler(sequence[n].translate(str.maketrans("123", "XYZ")), all_of(label, 3)[n], degrees=True)
                 for label, sequence in zip(("Bi to Gi", "Go to Bo"), sequences)]
        turn = turns[0] * turns[1]  # the axes of the outer body in the inner one's
        origin = np.array(all_of("Position wrt inner", 3)[n]) - turn.apply(all_of("Position wrt outer", 3)[n])
        frames[outer] = frames[inner] @ placed(origin, turn)
    return sum(frames[n] @ J[n] @ frames[n].T for n in range(count))


@pytest.mark.parametrize("name, orbit", [("TumbleSat", None), ("Cubesat3U", "Cube"), ("Aura", "EOS")])
def test_a_spacecraft_of_42_with_its_orbit(written_and_read, name, orbit):
    """Joints by SciPy's rotations; the rate of the orbit by sqrt(mu/r^3), which its rates count from where they are relative."""
    out, err = written_and_read(f"42/SC_{name}.txt")
    for got, expected in zip(read_back(out), about_mass_centre(of_42(f"SC_{name}.txt"))):
        assert got == pytest.approx(expected, abs=2e-11 * np.abs(expected).max() + 1e-12)
    lines = dict(map(reversed, lines_of(f"SC_{name}.txt")))
    rates = [float(v) for v in next(value for label, value in lines.items() if label.startswith("Ang Vel (")).split()]
    if orbit:
        altitude, = {float(v) for v in dict(map(reversed, lines_of(f"Orb_{orbit}.txt")))["Periapsis & Apoapsis Altitude, km"].split()}
        n = math.degrees(math.sqrt(3.986004418e14 / (6378137 + 1000 * altitude)**3))
        assert f"{n:.6g} deg/s" in err or math.degrees(math.sqrt(load_orbiting(out).rate_squared)) == pytest.approx(n, rel=1e-12)
    if name == "Aura":  # the orbit frame turns against its second axis
        assert all(v == 0 for v in rates) and lines["Ang Vel wrt [NL], Att [QA] wrt [NLF]"] == "LAL"
        angles = re.fullmatch(r"([-\d.]+) +([-\d.]+) +([-\d.]+) +(\d+)", lines["Angles (deg) & Euler Sequence"]).groups()
        assert [float(v) for v in angles[:3]] == [0, 0, 0]
        rates = [0, -n, 0]
    case = load_orbiting(out).craft if name == "Aura" else load(out)
    state = case.frame.back(case.exact_state) if case.frame else case.state
    assert [math.degrees(float(v)) for v in state] == pytest.approx(rates, abs=1e-11)
    assert sum("locked in the position" in item.words for item in case.caveats) == (name != "Cubesat3U")
