"""A table of bodies (CSV) as a case whose [sweep] takes its rows one after the other; keys that vary together."""
import json
import math

import pytest

from stabilab.case.read import load_all

TABLE = """# from a data sheet
name, Ixx [kg m^2], Iyy [kg m^2], Izz [kg m^2], mass (kg), wx [deg/s], wy [deg/s], wz [deg/s], drag area [m^2]
cube, 0.02, 0.03, 0.01, 4, 5, 1, 2, 0.03
smallsat, 12, 9, 5.5, 120, 0.5, 0.1, 0.2, 1
comsat, 3000, 2500, 900, 2500, 0.05, 0.01, 0.02, 20
"""
# OpenSat moments and rates as three teams write them: tabs, semicolons, other units and names
OTHERS = ("I11 (g cm^2)\tI22 (g cm^2)\tI33 (g cm^2)\tp (rad/s)\tq (rad/s)\tr (rad/s)\n2e5\t3e5\t1e5\t0.1\t0.2\t0.3\n",
          "Jx [kg*m^2];Jy [kg*m^2];Jz [kg*m^2];Jxy [kg*m^2];h_x [N m s];h_y [N m s];h_z [N m s]\n"
          "3;2;1.5;0.1;0.2;0;0\n3;2;1.5;-0.1;0.4;0;0\n")


@pytest.fixture
def imported(tmp_path, stabilab):
    """(cases, path) of a table."""
    def run(text):
        (tmp_path / "own.csv").write_text(text)
        code, _, err = stabilab("import", tmp_path / "own.csv", "--out", tmp_path / "own.toml")
        assert code == 0, err
        return load_all(tmp_path / "own.toml"), tmp_path / "own.toml"
    return run


def test_every_row_is_a_case(imported, stabilab):
    cases, path = imported(TABLE)
    rows = [line.split(",") for line in TABLE.splitlines()[2:]]
    assert [case.name for case in cases] == ["own-1", "own-2", "own-3"]
    for case, (_, *cells) in zip(cases, rows):
        numbers = [float(cell) for cell in cells]
        assert [float(v) for v in case.scene.body.exact] == numbers[:3] and float(case.scene.body.mass) == numbers[3]
        assert [math.degrees(v) for v in case.state] == pytest.approx(numbers[4:7], rel=1e-14)
        assert case.caveats[0].words == "columns of the imported table that are not read: drag area [m^2]"
    assert "1 cube, 2 smallsat, 3 comsat" in cases[0].source
    assert len(json.loads(stabilab("fate", path, "--json")[1])) == 3 and "each of 3 BOUNDED" in stabilab("fate", path)[1]


def test_other_marks_names_and_units(imported):
    (case,), _ = imported(OTHERS[0])
    assert [float(v) for v in case.scene.body.exact] == [0.02, 0.03, 0.01] and case.state == (0.1, 0.2, 0.3)
    cases, _ = imported(OTHERS[1])
    assert [float(case.frame.back(case.scene.vector("gyrostat"))[0]) for case in cases] == pytest.approx([0.2, 0.4])
    axes = [case.frame.axes[0] for case in cases]  # an entry of the tensor that is positive turns the major axis to +y
    assert axes[0][0] * axes[0][1] > 0 > axes[1][0] * axes[1][1]


@pytest.mark.parametrize("change, line, words", [
    (("Izz [kg m^2]", "Iz2 [kg m^2]"), 2, "the head has no Izz [kg m^2]"),
    (("Izz [kg m^2]", "Izz"), 2, "Izz: a unit is missing"), (("Izz [kg m^2]", "Izz [m]"), 2, "Izz [m]: expected moment of inertia"),
    (("wz [deg/s]", "zeta"), 2, "expected three components"), (("0.03, 0.01", "0.03, small"), 3, "Izz [kg m^2]: expected a decimal"),
    (("12, 9, 5.5,", "12, 9,"), 4, "expected 9 cells as in the head, got 8"), (("mass (kg)", "Ixx [kg m^2]"), 2, "a second column")])
def test_a_fault_has_its_line_and_column(tmp_path, stabilab, change, line, words):
    (tmp_path / "own.csv").write_text(TABLE.replace(*change))
    code, out, err = stabilab("import", tmp_path / "own.csv")
    assert code == 2 and not out and f"own.csv:{line}: " in err and words in err and len(err.strip().splitlines()) == 1


def test_a_body_that_cannot_be_is_a_fault_of_its_row(tmp_path, stabilab):
    (tmp_path / "own.csv").write_text(TABLE.replace("12, 9, 5.5", "12, -9, 5.5"))
    code, _, err = stabilab("import", tmp_path / "own.csv")
    assert code == 2 and "a value of [sweep]" in err and "-9" in err


SWEEP = "[body]\ninertia = [3, 2, 1.5]\n[effects.gyrostat]\nmomentum = [0, 0, 1]\n[motion]\nangular_velocity = [1, 0, 0]\n[sweep]\n"


def test_keys_of_a_sweep_vary_together(case_file, stabilab):
    path = case_file(SWEEP + 'together = true\n"effects.gyrostat.momentum" = [[0, 0, 1], [0, 0, 2]]\n'
                     '"motion.angular_velocity" = [[1, 0, 0], [2, 0, 0]]\n')
    cases = load_all(path)
    assert [(c.state[0], float(c.scene.vector("gyrostat")[2])) for c in cases] == [(1, 1), (2, 2)]
    assert [c.name for c in cases] == ["case-1", "case-2"] and [dict(c.swept)["motion.angular_velocity"][0] for c in cases] == [1, 2]
    assert stabilab("extremes", path, "--csv")[1].count("case-2,") == 3


@pytest.mark.parametrize("sweep, words", [
    ('together = true\n"effects.gyrostat.momentum" = [[0, 0, 1], [0, 0, 2]]\n"motion.angular_velocity" = [[1, 0, 0]]\n',
     "sweep.together: expected as many values of each key, got 1, 2"), ('together = "yes"\n', "sweep.together: expected true or false")])
def test_a_fault_of_keys_that_vary_together(case_file, stabilab, sweep, words):
    code, _, err = stabilab("fate", case_file(SWEEP + sweep))
    assert code == 2 and words in err


LINKS = ("Link Name,Center of Mass X,Center of Mass Y,Center of Mass Z,Center of Mass Roll,Mass,Moment Ixx,Moment Ixy,Moment Ixz,"
         "Moment Iyy,Moment Iyz,Moment Izz\nbase,0.1,0,0.2,{},4,3,0.1,0,2,0,1.5\nmark,0,0,0,0,0.0,0,0,0,0,0e-3,0\n")


def test_a_link_without_mass_is_left_out_of_solidworks_table(imported):
    (case,), _ = imported(LINKS.format(0))
    assert case.title == "base" and case.scene.body.mass == 4 and case.frame is not None
    assert "without mass and moments are left out: mark" in case.caveats[0].words


@pytest.mark.parametrize("text, line, words", [
    (LINKS.format(0.1), 2, "Center of Mass Roll: expected 0, got 0.1"),
    ("\n".join((LINKS.splitlines()[0], LINKS.splitlines()[2])), 1, "every row has the mass 0")])
def test_a_link_along_other_axes_or_a_table_of_marks_is_a_fault(tmp_path, stabilab, text, line, words):
    (tmp_path / "own.csv").write_text(text)
    code, _, err = stabilab("import", tmp_path / "own.csv")
    assert code == 2 and f"own.csv:{line}: " in err and words in err
