"""`stabilab export`: the body of a case as a robot description, read by ElementTree and read back by `import`."""
import xml.etree.ElementTree as ET
from fractions import Fraction

import numpy as np
import pytest

from stabilab.case.programs.parts import ending_decimal
from stabilab.case.read import load


def tensor_of(root):
    values = {key: Fraction(value) for key, value in root.find("link/inertial/inertia").attrib.items()}
    return [[values["i" + "".join(sorted("xyz"[i] + "xyz"[j]))] for j in range(3)] for i in range(3)]


def written(rows):
    return f"[{', '.join(f'[{chr(44).join(row)}]' for row in rows)}]"


def moments(body):
    return body.scene.body.exact


@pytest.mark.parametrize("seed", range(4))
def test_a_body_comes_back_exactly(case_file, tmp_path, stabilab, seed):
    """Random decimals of up to nine digits, from 1e-9 to 1e9; the numbers of the XML by ElementTree and Fraction."""
    rng = np.random.default_rng(seed)
    unit = f"e{rng.integers(-9, 9)}"
    points = rng.uniform(-1, 1, (5, 3))  # five point masses: moments that bodies have
    t = np.round(sum(p @ p * np.eye(3) - np.outer(p, p) for p in points), 8)
    rows = [[f"{v:.8f}{unit}" for v in row] for row in t]
    centre, mass = [f"{v:.7f}" for v in rng.uniform(-1, 1, 3)], f"{rng.uniform(1, 9):.6f}{unit}"
    path = case_file(f"title = 'own'\n[body]\ninertia = {written(rows)}\nmass = {mass}\n"
                     f"centre_of_mass = [{', '.join(centre)}]\n")
    code, _, err = stabilab("export", path, "--out", tmp_path / "own.urdf")
    assert code == 0 and "no place for" not in err
    root = ET.parse(tmp_path / "own.urdf").getroot()
    assert tensor_of(root) == [[Fraction(v) for v in row] for row in rows]
    inertial = root.find("link/inertial")
    assert Fraction(inertial.find("mass").get("value")) == Fraction(mass)
    assert [Fraction(v) for v in inertial.find("origin").get("xyz").split()] == [Fraction(v) for v in centre]
    code, out, err = stabilab("import", tmp_path / "own.urdf")
    assert code == 0, err
    back = load(out)
    assert moments(back) == moments(load(path)) and back.scene.body.mass == float(mass) and back.title == "own"
    assert stabilab("export", case_file(out, "again"))[1] == (tmp_path / "own.urdf").read_text()


@pytest.mark.parametrize("body, entries", [  # by hand; 1 lb = 0.45359237 kg, 1 ft = 0.3048 m
    ('inertia = ["12 lb ft^2", 0.5, "1/3"]\nmass = "10 lb"',
     [12 * Fraction("0.45359237") * Fraction("0.3048") ** 2, "0.5", "1/3", "0", "0", "0"]),
    ('inertia = [3, 2, 4]\nmass = 2\nproducts = {xy = 0.1, xz = 0, yz = -0.2, convention = "positive"}',
     ["3", "2", "4", "-0.1", "0", "0.2"]),
    ('inertia = [["3 +- 1 %", 0, 0], [0, 2, 0], [0, 0, 4]]\nmass = 2', None),
    ('inertia = ["3 +- 1 %", 2, 4]\nmass = 2', ["3", "2", "4", "0", "0", "0"])])
def test_units_products_and_uncertain_numbers(case_file, stabilab, body, entries):
    path = case_file(f"[body]\n{body}\n")
    code, out, err = stabilab("export", path)
    if entries is None:
        assert code == 2 and "takes no uncertainty" in err
        return
    values = ET.fromstring(out).find("link/inertial/inertia").attrib
    for key, entry in zip(("ixx", "iyy", "izz", "ixy", "ixz", "iyz"), entries):
        assert float(values[key]) == float(Fraction(entry))
    assert ("middles" in err) == ("<!--" in out) == ("+-" in body)


def test_what_an_inertial_has_no_place_for_is_named(case_file, stabilab):
    scheduled = ("[body]\ninertia = [3, 2, 4]\nmass = 2\n[motion]\nangular_velocity = [0.1, 0, 0]\n[[thrusters]]\n"
                 "position = [1, 0, 0]\ndirection = [0, 1, 0]\nforce = 1\nstart = 0\nstop = 5\n")
    orbiting = '[body]\ninertia = [3, 2, 4]\nmass = 2\n[circular_orbit]\naltitude = "700 km"\n'
    for text, words in ((scheduled, "no place for: thrusters, a motion"), (orbiting, "no place for: an orbit")):
        code, out, err = stabilab("export", case_file(text))
        assert code == 0 and words in err and tensor_of(ET.fromstring(out))[1][1] == 2


def test_a_sweep_has_a_file_for_each_combination(case_file, tmp_path, stabilab):
    path = case_file("[body]\ninertia = [3, 2, 4]\nmass = 2\n[sweep]\n\"body.mass\" = [5, 6]\n"
                     '"body.inertia" = [[3, 2, 4], [1, 2, 2.5]]\n')
    code, out, err = stabilab("export", path)
    assert code == 2 and "makes 4 cases: give --out" in err and not out
    assert stabilab("export", path, "--out", tmp_path / "own.urdf")[0] == 0
    root = ET.parse(tmp_path / "own-2-2.urdf").getroot()
    assert root.find("link/inertial/mass").get("value") == "6" and tensor_of(root)[0][0] == 1


@pytest.mark.parametrize("text, line, words", [
    ("title = 'a'\n[body]\ninertia = [3, 2, 4]\n", 2, 'body: mass is missing, and an inertial has one: add it, such as mass'),
    ("[scaled]\na = 0.2\nb = 0.4\nmu = [0, 0, 1]\n", 1, "a [scaled] system has no body"),
    ("[body]\ninertia = [3, -2, 4]\nmass = 1\n", 2, "principal moments are positive")])
def test_a_case_without_an_inertial_is_a_fault_at_its_line(case_file, stabilab, text, line, words):
    code, out, err = stabilab("export", case_file(text))
    assert code == 2 and not out and f".toml:{line}: " in err and words in err


def test_titles_and_caveats_are_well_formed(case_file, stabilab):
    """A caveat of the file, and that no rigid body has the moments, stand in comments; no comment of XML holds two dashes."""
    path = case_file('title = "<a> & \'b\' -- c"\ncaveats = ["one -- two-"]\n[body]\ninertia = [1, 2, 9]\nmass = 1\n')
    code, out, err = stabilab("export", path)
    assert code == 0 and ET.fromstring(out).get("name") == "<a> & 'b' -- c"
    assert "<!-- one - - two -->" in out and "one -- two-" in err and "no rigid body" in out
    code, back, _ = stabilab("import", case_file(out, "back"))
    assert code == 0 and load(back).title == "<a> & 'b' -- c"


@pytest.mark.parametrize("number, text", [
    ("10", "10"), ("-0.25", "-0.25"), ("1e30", "1e30"), ("2.5e-12", "2.5e-12"), ("0", "0"), ("1/3", None),
    ("1/8", "0.125")])
def test_a_decimal_is_written_whole(number, text):
    assert ending_decimal(Fraction(number)) == text
