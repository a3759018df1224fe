"""What an import takes over of a motion, and what it says of a file that it does not read."""
import json
import math
import sys
from types import ModuleType

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from stabilab.case import formats
from stabilab.case.programs.imported import Craft
from stabilab.case.programs.orbit_42 import from_quaternion
from stabilab.case.read import load, load_orbiting
from stabilab.commands.one_case import import_
from stabilab.errors import InputError

CRAFT = """<<<<<<<<  42: Spacecraft Description File   >>>>>>>>
Own test craft              !  Description
*************** Initial Attitude ***************
{frames}                         ! Ang Vel wrt [NL], Att [QA] wrt [NLF]
0.3    0.4    .5            ! Ang Vel (deg/sec)
{quaternion}    ! Quaternion
{angles}            ! Angles (deg) & Euler Sequence
*************** Body Parameters ***************
1                           ! Number of Bodies
=============== Body 0 ===============
100.0                       ! Mass
100.  200.0  250.0          ! Moments of Inertia (kg-m^2)
0.0  0.0  0.0               ! Products of Inertia (xy,xz,yz)
0.0  0.0  0.0               ! Location of mass center, m
"""
SIMULATION = """<<<<<<<<<<<<<<<<<  42: The Mostly Harmless Simulator  >>>>>>>>>>>>>>>>>
TRUE   Orb_Other.txt            !  Input file name for Orb 0
TRUE   Orb_Own.txt              !  Input file name for Orb 1
TRUE  1 SC_Own.txt              !  Existence, RefOrb, Input file for SC  0
"""
ORBIT = """<<<<<<<<<<<<<<<<<  42: Orbit Description File   >>>>>>>>>>>>>>>>>
CENTRAL                       !  Orbit Type (ZERO, FLIGHT, CENTRAL, THREE_BODY)
EARTH                         !  Orbit Center
KEP                           !  Use Keplerian elements (KEP) or (RV) or FILE
PA                            !  Use Peri/Apoapsis (PA) or min alt/ecc (AE)
500.0   500.0                 !  Periapsis & Apoapsis Altitude, km
200.0  0.1                    !  Min Altitude (km), Eccentricity
"""


@pytest.fixture
def imported(tmp_path, stabilab):
    """(exit code, what came on stderr, path of the case) of a file of 42 with others beside it."""
    def run(frames, quaternion="0.0 0.0 0.0 1.0", angles="0.0 0.0 0.0 123", **beside):
        (tmp_path / "SC_Own.txt").write_text(CRAFT.format(frames=frames, quaternion=quaternion,
                                                          angles=angles))
        for name, text in beside.items():
            (tmp_path / f"{name}.txt").write_text(text)
        code, _, err = stabilab("import", tmp_path / "SC_Own.txt", "--out", tmp_path / "own.toml")
        return code, err, tmp_path / "own.toml"
    return run


def orbital_rate():
    """n in deg/s at 500 km, by hand: sqrt(mu/r^3)."""
    return math.degrees(math.sqrt(3.986004418e14 / (6378137 + 500e3)**3))


@pytest.mark.parametrize("frames, given, turn", [
    ("LQL", {"quaternion": "0.1 -0.2 0.3 0.9"}, Rotation.from_quat([0.1, -0.2, 0.3, 0.9]).as_matrix().T),
    ("LAL", {"angles": "10.0 20.0 -30.0 123"},  # SciPy: capital letters turn about the axes of the body
     Rotation.from_euler("XYZ", [10, 20, -30], degrees=True).as_matrix().T),
    ("LAL", {"angles": "0.0 0.0 0.0 321"}, np.eye(3))])
def test_rates_relative_to_the_orbit_frame_become_those_in_inertial_space(imported, frames, given, turn):
    """The frame turns at n against its second axis; what turns components by SciPy, which shares no code."""
    code, err, path = imported(frames, **given, Inp_Sim=SIMULATION, Orb_Own=ORBIT)
    assert code == 0 and "circular orbit of 500.0 km" in err
    found = load_orbiting(path)
    rates = [math.degrees(v) for v in found.craft.state]
    assert rates == pytest.approx(np.array([0.3, 0.4, 0.5]) + turn @ [0, -orbital_rate(), 0], abs=1e-10)
    assert math.degrees(math.sqrt(found.rate_squared)) == pytest.approx(orbital_rate(), rel=1e-12)
    assert [one.kind for one in found.craft.caveats] == ["stated"]  # [motion] is not looked at


def test_a_quaternion_of_42_turns_as_its_source_says():
    """Q2C of dcmkit.c: C01 = 2 (q0 q1 + q2 q3) and so on, by hand for a turn of 90 deg about the third axis."""
    half = "0.5"
    assert from_quaternion(["0", "0", half, half]).tolist() == [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]


@pytest.mark.parametrize("frames, beside, why", [
    ("LAL", {}, "no Inp_Sim.txt beside it"), ("LAN", {"Inp_Sim": SIMULATION, "Orb_Own": ORBIT},
                                              "its attitude is not"),
    ("LAL", {"Inp_Sim": SIMULATION.replace("SC_Own", "SC_Else"), "Orb_Own": ORBIT}, "names no orbits for it"),
    ("LAL", {"Inp_Sim": SIMULATION}, "Orb_Own.txt is not beside it"),
    ("LAL", {"Inp_Sim": SIMULATION, "Orb_Own": ORBIT.replace("500.0   500.0", "500.0   600.0")},
     "is not circular (eccentricity 0.00722)"),  # 100/(6878.137 + 6978.137) by hand
    ("LAL", {"Inp_Sim": SIMULATION, "Orb_Own": ORBIT.replace("PA ", "AE ")}, "is not circular (eccentricity 0.1)"),
    ("LAL", {"Inp_Sim": SIMULATION, "Orb_Own": ORBIT.replace("EARTH", "MINORBODY_1")}, "is about MINORBODY_1"),
    ("LAL", {"Inp_Sim": SIMULATION, "Orb_Own": ORBIT.replace("CENTRAL ", "THREE_BODY ")}, "libration point"),
    ("LAL", {"Inp_Sim": SIMULATION, "Orb_Own": ORBIT.replace("KEP ", "RV ")}, "given by position and velocity"),
    ("LAL", {"Inp_Sim": SIMULATION, "Orb_Own": ORBIT.replace("KEP ", "FILE ")}, "given in a file of elements")])
def test_rates_that_are_not_known_are_no_motion_and_a_caveat_of_every_answer(imported, stabilab, frames,
                                                                             beside, why):
    code, err, path = imported(frames, **beside)
    assert code == 0 and why in err
    read = load(path)
    assert read.state is None and [one.kind for one in read.caveats] == ["stated"]
    assert "[0.3, 0.4, 0.5] deg/s" in read.caveats[0].words and why in read.caveats[0].words
    for options in ((), ("--json",)):
        assert why in stabilab("classify", path, *options)[1]


@pytest.mark.parametrize("change, words", [
    ({}, '(Orb_Own.txt), 0.0634'), ({"Orb_Own": ORBIT.replace("500.0   500.0", "500.0   600.0")}, "is not circular"),
    ({"Inp_Sim": ""}, None)])
def test_rates_relative_to_inertial_space_stay(imported, change, words):
    """An orbit that they do not need is named: of 500 km, n = 0.063414 deg/s, as `orbital_rate` has it."""
    _, err, path = imported("NAN", **{"Inp_Sim": SIMULATION, "Orb_Own": ORBIT} | change)
    assert [math.degrees(v) for v in load(path).state] == pytest.approx([0.3, 0.4, 0.5])
    assert (words in err and "no counterpart" in err) if words else "orbit" not in err
    if words and "circular orbit of" in err:
        assert f"{orbital_rate():.6g} deg/s" in err and 'add [circular_orbit] altitude = "500.0 km"' in err


def test_an_orbit_about_another_world_has_the_rate_of_42(imported):
    """42's own constants of the Moon, 4.902801e12 m^3/s^2 and 1738 km (LoadMoonOfEarth in 42init.c): sqrt(mu/r^3)."""
    _, err, path = imported("LAL", Inp_Sim=SIMULATION, Orb_Own=ORBIT.replace("EARTH", "LUNA"))
    rate = math.degrees(math.sqrt(4.902801e12 / 2238e3**3))
    found = load_orbiting(path)
    assert math.degrees(math.sqrt(found.rate_squared)) == pytest.approx(rate, rel=1e-11)
    assert math.degrees(found.craft.state[1]) == pytest.approx(0.4 - rate, rel=1e-11) and "above the Moon" in err


@pytest.mark.parametrize("text, words", [(ORBIT, "own.txt: an orbit file of 42"), (SIMULATION, "the simulation file of 42")])
def test_a_file_beside_that_of_a_spacecraft_is_no_spacecraft(tmp_path, stabilab, text, words):
    (tmp_path / "own.txt").write_text(text)
    code, out, err = stabilab("import", tmp_path / "own.txt")
    assert code == 2 and not out and words in err and "import the SC_*.txt beside it" in err


TABLES = {"body": {"inertia": [100, 120.5, 180]}, "motion": {"angular_velocity": ["1 deg/s", 0, 0.1]},
          "effects": {"constant_torque": {"torque": [0, 0, 1e-3]}}}


@pytest.mark.parametrize("ending, write", [(".json", json.dumps), (".py",
                                                                   lambda data: f"craft = {data!r}\n")])
def test_the_tables_of_a_case_stay_whole(tmp_path, stabilab, ending, write):
    path = tmp_path / f"own{ending}"
    path.write_text(write(TABLES))
    code, out, err = stabilab("import", path)
    (tmp_path / "own.toml").write_text(out)
    assert code == 0 and "no counterpart" not in err and load(tmp_path / "own.toml") == load(TABLES)


def test_a_key_of_these_tables_that_is_none_is_a_fault_not_a_loss(tmp_path, stabilab):
    (tmp_path / "own.json").write_text(json.dumps({**TABLES, "motion": {"omega": [0, 0, 1]}}))
    code, _, err = stabilab("import", tmp_path / "own.json", "--out", tmp_path / "own.toml")
    assert code == 2 and "motion.omega: unknown key; write angular_velocity = [0, 0, 1]" in err


@pytest.mark.parametrize("name, read", [("angular_velocity", True), ("omega", True), ("omega_deg", False)])
def test_a_motion_of_a_flat_dictionary_is_read_or_a_caveat(tmp_path, stabilab, name, read):
    (tmp_path / "own.json").write_text(json.dumps({"inertia": [100, 120, 180], name: [0.1, 0, 0.2]}))
    code, out, _ = stabilab("import", tmp_path / "own.json")
    (tmp_path / "own.toml").write_text(out)
    found = load(tmp_path / "own.toml")
    assert code == 0 and (found.state == (0.1, 0, 0.2) if read else name in found.caveats[0].words)


@pytest.mark.parametrize("text, words", [
    ("CCSDS_OPM_VERS = 2.0\nCREATION_DATE = 2026-01-01T00:00:00\nORIGINATOR = TEST\n",
     "CCSDS orbit parameter message (OPM)"),
    ('<?xml version="1.0"?>\n<COLLADA version="1.4"><asset/></COLLADA>\n', "a mesh (COLLADA, XML)"),
    ("t,x,y,z\n0,100,120,180\n", "table of values (CSV)"),
    ("body:\n  inertia: [1, 2, 3]\n  mass: 4\n", "YAML"), ("[body]\ninertia = [3, 2, 1]\n",
                                                           "a case already")])
def test_a_file_of_another_kind_is_named_with_what_is_read(tmp_path, stabilab, text, words):
    (tmp_path / "own.txt").write_text(text)
    code, out, err = stabilab("import", tmp_path / "own.txt")
    assert code == 2 and not out and words in err and "SC_*.txt" in err and "Traceback" not in err


def test_a_new_importer_is_a_module_and_a_row(tmp_path, monkeypatch, capsys):
    """What the errors say is read, and what an error calls the file where a case is expected, are of the table."""
    module = ModuleType("stabilab.case.programs.import_toy")
    module.read = lambda text, path, body=None: Craft("toy", inertia=text.split()[1:4])
    monkeypatch.setitem(sys.modules, module.__name__, module)
    row = formats.Importer("a toy", lambda text: text.startswith("TOY"), "import_toy")
    monkeypatch.setattr(formats, "IMPORTERS", (row, *formats.IMPORTERS))
    path = tmp_path / "a.toy"
    path.write_text("TOY 3 4 5\n", encoding="utf-8")
    import_(path, None, None)
    assert "inertia = [3, 4, 5]" in capsys.readouterr().out
    assert formats.seems("TOY 3 4 5") == "a toy"
    with pytest.raises(InputError, match="takes a body of .*NASA 42 spacecraft file, .*MuJoCo, and .*a.toy is none"):
        import_(path, None, None, 0)
