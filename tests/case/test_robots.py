"""Robot descriptions (URDF, SDFormat, MJCF) as one rigid body: random trees against matrices of 4 x 4, and faults."""
import tomllib
import xml.etree.ElementTree as ET
from decimal import ROUND_DOWN, Decimal

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from stabilab import load


def placed(xyz, rotation):
    """The matrix (4, 4) that takes coordinates in a frame to those in the one it is placed in."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation.as_matrix(), xyz
    return matrix


def moments(mass, tensor, at):
    """The pseudo-inertia (4, 4) of a mass, the integral of (r, 1)(r, 1)^T dm, in the frame that `at` leads to."""
    second = np.zeros((4, 4))
    second[:3, :3], second[3, 3] = np.trace(tensor) / 2 * np.eye(3) - tensor, mass
    return at @ second @ at.T


def symmetric(xx, yy, zz, xy, xz, yz):
    return np.array([(xx, xy, xz), (xy, yy, yz), (xz, yz, zz)])


def about_mass_centre(J):
    """(mass, centre, tensor) of a pseudo-inertia: no parallel axes are used."""
    mass, centre = J[3, 3], J[:3, 3] / J[3, 3]
    second = J[:3, :3] - mass * np.outer(centre, centre)
    return mass, centre, np.trace(second) * np.eye(3) - second


def numbers(text):
    return [float(v) for v in text.split()]


QUARTER = Decimal("1.57079632679489661923132169163975")


def angles(text):
    """Angles in rad of files; a multiple of a quarter turn that is rounded or cut off to the digits shown is meant as one."""
    result = []
    for word in text.split():
        number = Decimal(word)
        multiple = round(number / QUARTER) * QUARTER
        step = Decimal(1).scaleb(number.as_tuple().exponent)
        meant = len(number.as_tuple().digits) > 2 and number in (multiple.quantize(step), multiple.quantize(step, ROUND_DOWN))
        result.append(float(multiple if meant else number))
    return result


def of_urdf(root):
    """SciPy: small letters turn about fixed axes."""
    def origin(element):
        at = element.find("origin")
        return np.eye(4) if at is None else placed(numbers(at.get("xyz", "0 0 0")),
                                                   Rotation.from_euler("xyz", angles(at.get("rpy", "0 0 0"))))
    parent = {joint.find("child").get("link"): joint for joint in root.findall("joint")}

    def frame(name):
        return frame(parent[name].find("parent").get("link")) @ origin(parent[name]) if name in parent else np.eye(4)
    return sum(moments(float(item.find("mass").get("value")),
                       symmetric(*(float(item.find("inertia").get(key)) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))),
                       frame(link.get("name")) @ origin(item))
               for link in root.findall("link") if (item := link.find("inertial")) is not None)


def of_sdf(root, folder=None):
    """Files of includes are in the folder beside that of this one, as collections of models have them."""
    def pose(element):
        text = element.findtext("pose") if element is not None else None
        parts = (text or "0 0 0 0 0 0").split()
        return placed([float(v) for v in parts[:3]], Rotation.from_euler("xyz", angles(" ".join(parts[3:]))))

    def relative(element):
        at = element.find("pose")
        return (at.get("relative_to") if at is not None else None) or element.findtext("child")  # the last of a joint
    matrices, links = {"": np.eye(4)}, []

    def collect(model, prefix, own):
        def full(name):
            return prefix + name if name and name != "__model__" else own
        rows = [(item, prefix + item.get("name"), pose(item), full(relative(item) or item.get("attached_to")))
                for item in model if item.tag in ("link", "joint", "frame")]
        links.extend((item, name) for item, name, _, _ in rows if item.tag == "link")
        inner = [(item, item, False) for item in model.findall("model")]
        for item in model.findall("include"):
            file = folder.parent / item.findtext("uri").removeprefix("model://") / "model.sdf"
            inner.append((item, ET.parse(file).getroot().find("model"), item.get("merge") == "true"))
        for item, other, merged in inner:
            name = prefix + (item.findtext("name") or other.get("name"))
            rows.append((item, name, pose(item if item.find("pose") is not None else other), full(relative(item))))
            collect.later.append((other, prefix if merged else f"{name}::", name))
        collect.rows += rows
    collect.rows, collect.later = [], []
    collect(next(item for item in root.iter("model") if item.findtext("static") not in ("true", "1")), "", "")
    while collect.later:
        collect(*collect.later.pop())
    while len(matrices) < len({name for _, name, _, _ in collect.rows}) + 1:  # whose frame is known, one after the other
        matrices |= {name: matrices[base] @ at for _, name, at, base in collect.rows if base in matrices and name not in matrices}

    def value(element, tag, otherwise):
        text = element.findtext(tag) if element is not None else None
        return float(text or otherwise)
    total = 0
    for link, name in links:
        item = link.find("inertial")
        inertia = None if item is None else item.find("inertia")
        entries = [value(inertia, key, key[1] == key[2]) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")]
        total = total + moments(value(item, "mass", 1), symmetric(*entries), matrices[name] @ pose(item))
    return total


def of_mjcf(root):
    degrees = (root.find("compiler") is None or root.find("compiler").get("angle", "degree") == "degree")

    def pose(element):
        turn = Rotation.identity()
        if element.get("quat"):
            turn = Rotation.from_quat(numbers(element.get("quat")), scalar_first=True)
        if element.get("euler"):
            turn = Rotation.from_euler("XYZ", numbers(element.get("euler")), degrees=degrees)
        if element.get("axisangle"):
            *axis, angle = numbers(element.get("axisangle"))
            turn = Rotation.from_rotvec(np.array(axis) / np.linalg.norm(axis) * (np.radians(angle) if degrees else angle))
        if element.get("zaxis"):
            z = np.array(numbers(element.get("zaxis")))
            z /= np.linalg.norm(z)
            across = np.cross([0, 0, 1], z)
            turn = Rotation.from_rotvec(across / np.linalg.norm(across) * np.arccos(z[2]))
        if element.get("xyaxes"):
            x, y = np.array(numbers(element.get("xyaxes"))).reshape(2, 3)
            q, r = np.linalg.qr(np.array([x, y, np.cross(x, y)]).T)
            turn = Rotation.from_matrix(q * np.sign(np.diag(r)))
        return placed(numbers(element.get("pos", "0 0 0")), turn)

    def of(body, frame):
        total, item = 0, body.find("inertial")
        if item is not None:
            entries = (numbers(item.get("fullinertia")) if item.get("fullinertia")
                       else [*numbers(item.get("diaginertia")), 0, 0, 0])
            total = moments(float(item.get("mass")), symmetric(*entries), frame @ pose(item))
        for child in body:
            if child.tag == "body":
                total = total + of(child, frame @ pose(child))
        return total
    return of(root.find("worldbody/body"), np.eye(4))


OF = {".urdf": of_urdf, ".sdf": of_sdf, ".xml": of_mjcf}


def read_back(text):
    body = tomllib.loads(text)["body"]
    tensor = np.array(body["inertia"], float)
    return body["mass"], np.array(body["centre_of_mass"], float), np.diag(tensor) if tensor.ndim == 1 else tensor


def compared(path, out):
    """To the 12 digits that a case is written in, and what doubles leave."""
    more = (path.parent,) if path.suffix == ".sdf" else ()
    mass, centre, tensor = about_mass_centre(OF[path.suffix](ET.parse(path).getroot(), *more))
    got = read_back(out)
    assert got[0] == pytest.approx(mass, rel=1e-11)
    assert got[1] == pytest.approx(centre, abs=1e-11 * (1 + np.abs(centre).max()))
    assert got[2] == pytest.approx(tensor, abs=2e-11 * np.abs(tensor).max())


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("ending", [".urdf", ".sdf", ".xml"])
def test_random_trees_of_bodies(tmp_path, stabilab, seed, ending):
    rng = np.random.default_rng([seed, ord(ending[1])])

    def vector(n=3):
        return " ".join(f"{v:.3f}" for v in rng.uniform(-2, 2, n))
    bodies = []
    for _ in range(5):  # moments of five random points: those of a body
        points = rng.uniform(-1, 1, (5, 3))
        t = np.round(sum(p @ p * np.eye(3) - np.outer(p, p) for p in points), 4)
        bodies.append((f"{rng.uniform(0.5, 3):.3f}", (t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[0, 2], t[1, 2])))
    if ending == ".urdf":
        text = "<robot name='r'>" + "".join(
            f"<link name='l{i}'><inertial><origin xyz='{vector()}' rpy='{vector()}'/><mass value='{m}'/><inertia " + " ".join(
                f"{key}='{v}'" for key, v in zip(("ixx", "iyy", "izz", "ixy", "ixz", "iyz"), t)) + "/></inertial></link>"
            + (f"<joint name='j{i}' type='revolute'><parent link='l{rng.integers(i)}'/><child link='l{i}'/>"
               f"<origin xyz='{vector()}' rpy='{vector()}'/></joint>" if i else "")
            for i, (m, t) in enumerate(bodies)) + "</robot>"
    elif ending == ".sdf":
        text = "<sdf version='1.9'><model name='r'>" + "".join(
            f"<link name='l{i}'><pose" + (f" relative_to='l{rng.integers(i)}'" if i else "") + f">{vector(6)}</pose><inertial>"
            f"<pose>{vector(6)}</pose><mass>{m}</mass><inertia>" + "".join(
                f"<{key}>{v}</{key}>" for key, v in zip(("ixx", "iyy", "izz", "ixy", "ixz", "iyz"), t))
            + "</inertia></inertial></link>" + (f"<joint name='j{i}' type='ball'><parent>l{i - 1}</parent><child>l{i}</child>"
                                                "</joint>" if i else "")
            for i, (m, t) in enumerate(bodies)) + "</model></sdf>"
    else:
        turns = ["quat='{}'", "euler='{}'", "axisangle='{}'", "zaxis='{}'", "xyaxes='{}'"]
        count = [4, 3, 4, 3, 6]
        text = "<mujoco><worldbody>" + "".join(
            f"<body name='b{i}' " + (f"pos='{vector()}' " + turns[i].format(vector(count[i])) if i else "") + f"><joint name='j{i}'/>"
            f"<inertial pos='{vector()}' mass='{m}' fullinertia='" + " ".join(map(str, t)) + "'/>"
            for i, (m, t) in enumerate(bodies)) + "</body>" * 5 + "</worldbody></mujoco>"
    path = tmp_path / f"own{ending}"
    path.write_text(text)
    code, out, err = stabilab("import", path)
    assert code == 0, err
    compared(path, out)


def test_fixed_axes_and_frames_of_mjcf(tmp_path, stabilab):
    """eulerseq in capitals is about fixed axes; SciPy has them in small letters."""
    turn = Rotation.from_euler("zxy", [20, 30, 40], degrees=True)
    (tmp_path / "own.xml").write_text(
        "<mujoco><compiler eulerseq='ZXY'/><worldbody><body name='a'><inertial pos='0 0 0' mass='1' diaginertia='3 2 4'/>"
        "<frame pos='1 2 3' euler='20 30 40'><body name='b' pos='0.5 0 0'><inertial pos='0 0 0' mass='2' diaginertia='1 2 2.5'/>"
        "</body></frame></body></worldbody></mujoco>")
    _, out, _ = stabilab("import", tmp_path / "own.xml")
    J = moments(1, np.diag([3.0, 2, 4]), np.eye(4)) + moments(
        2, np.diag([1, 2, 2.5]), placed([1, 2, 3], turn) @ placed([0.5, 0, 0], Rotation.identity()))
    assert read_back(out)[2] == pytest.approx(about_mass_centre(J)[2], abs=1e-10)


LINK = "<link name='{}'><inertial><mass value='1'/><inertia ixx='3' iyy='2' izz='4' ixy='0' ixz='0' iyz='0'/></inertial></link>"
JOINT = "<joint name='j' type='{}'><parent link='{}'/><child link='{}'/></joint>"
BODY = "<body name='{}'><inertial pos='0 0 0' mass='1' diaginertia='3 2 4'/></body>"
SDF = "<link name='{}'><inertial><mass>1</mass><inertia><ixx>3</ixx><iyy>2</iyy><izz>4</izz></inertia></inertial></link>"


@pytest.mark.parametrize("text, line, words", [
    ("<robot name='r'>\n<link name='a'/>\n</robot>", 1, "no link has an <inertial>"),
    ("<robot name='r'>\n<link name='a'><inertial>\n<mass value='1'/></inertial></link></robot>", 2, "<inertia> is missing"),
    ("<robot>\n" + LINK.format("a").replace("ixx='3'", "ixx='-3'") + "</robot>", 2, "no body has a mass of 1 kg with these"),
    ("<robot>\n" + LINK.format("a").replace("value='1'", "value='one'") + "</robot>", 2, "<mass> value: expected a decimal"),
    ("<robot>" + LINK.format("a") + "\n" + LINK.format("b") + "</robot>", 2, "no joint ties link b to link a"),
    ("<robot>" + LINK.format("a") + "\n" + JOINT.format("fixed", "a", "c") + "</robot>", 2, "no link c"),
    ("<robot>" + LINK.format("a") + LINK.format("b") + "\n" + JOINT.format("floating", "a", "b") + "</robot>", 2, "move freely"),
    ("<robot>" + LINK.format("a") + LINK.format("b") + "\n" + JOINT.format("hinge", "a", "b") + "</robot>", 2, "expected a type of"),
    ("<robot xmlns:xacro='x'>\n<xacro:macro name='m'/></robot>", 1, "this is a xacro file"),
    ("<robot>\n" + LINK.format("a").replace("value='1'", "value='${m}'") + "</robot>", 2, "an expression of xacro, \"${m}\", is not"),
    ("<robot>\n" + LINK.format("a").replace(" iyz='0'", "") + "</robot>", 2, 'expected the attribute iyz: add iyz="0"'),
    ("\n<!-- -- -->\n<?xml version='1.0'?>\n<robot>\n<link></robot>", 5, "not well-formed XML"),
    ("<robot>\n<link></robot>", 2, "not well-formed XML"),
    ("<!DOCTYPE r [<!ENTITY a 'b'>]>\n<robot/>", 1, "a document type"),
    ("<mujoco>\n<worldbody><body name='a'/></worldbody></mujoco>", 1, "no body has an <inertial>"),
    ("<mujoco><worldbody>\n<body name='a'><geom mesh='m'/></body></worldbody></mujoco>", 2, "finds its mass and moments from a mesh"),
    ("<mujoco><worldbody>\n<body name='a'><geom type='box' size='1 2'/></body></worldbody></mujoco>", 2, "expected three numbers of a"),
    ("<mujoco><worldbody>\n<body name='a'><geom size='-1'/></body></worldbody></mujoco>", 2, "expected positive numbers"),
    ("<mujoco><worldbody>\n<body name='a'><geom size='1' class='b'/></body></worldbody></mujoco>", 2, "no class b in <default>"),
    ("<mujoco><worldbody>\n<body name='a'><geom size='1' fromto='0 0 0 0 0 1'/></body></worldbody></mujoco>", 2, "no two points"),
    ("<mujoco><worldbody>\n<body name='a'><geom size='1' type='capsule' fromto='0 0 0 0 0 0'/></body></worldbody></mujoco>", 2,
     "two points that differ"),
    ("<mujoco><worldbody>\n<body name='a'><geom size='1' shellinertia='true'/></body></worldbody></mujoco>", 2, "moments of a shell"),
    ("<mujoco><worldbody>\n" + BODY.format("a").replace("diaginertia='3 2 4'", "") + "</worldbody></mujoco>", 2, "expected one of diag"),
    ("<mujoco>\n<compiler boundmass='0.1'/><worldbody/></mujoco>", 2, "boundmass"),
    ("<mujoco><worldbody>\n" + BODY.format("a").replace("name='a'", "name='a' quat='1 0 0 0' euler='0 0 0'")
     + "</worldbody></mujoco>", 2, "in two ways"),
    ("<sdf>\n<model name='m'><link name='a'/></model></sdf>", 2, "no link has an <inertial>"),
    ("<sdf>\n<model name='hall'><static>true</static></model></sdf>", 2, "static models alone (hall), which do not move: take"),
    ("<sdf>\n<world name='w'><include><uri>model://sun</uri></include></world></sdf>", 1, "model://sun, which it includes, is not beside"),
    ("<sdf>\n<model name='m'/>\n<model name='n'/></sdf>", 1, "the models m, n move freely"),
    ("<sdf><model>" + SDF.format("a") + "\n" + SDF.format("b") + "</model></sdf>", 2, "no joint ties link b"),
    ("<sdf><model>\n" + SDF.format("a").replace("<inertial>", "<pose>1 2 3</pose><inertial>") + "</model></sdf>", 2, "six numbers"),
    ("<sdf><model>\n" + SDF.format("a").replace("<inertial>", "<pose relative_to='q'>1 2 3 0 0 0</pose><inertial>")
     + "</model></sdf>", 2, "no frame q"),
    ("<sdf><model>\n" + SDF.format("a").replace("<inertial>", "<inertial auto='true'>") + "</model></sdf>", 2, "auto"),
    ("<sdf><model>" + SDF.format("a") + "\n" + SDF.format("a") + "</model></sdf>", 2, "a second link a, the first is in line 1"),
    ("<robot>" + LINK.format("a") + "\n" + LINK.format("a") + "</robot>", 2, "a second link a, the first is in line 1")])
def test_a_fault_has_its_line_and_what_to_do(tmp_path, stabilab, text, line, words):
    (tmp_path / "own.txt").write_text(text)
    code, out, err = stabilab("import", tmp_path / "own.txt")
    assert code == 2 and not out and f"own.txt:{line}: " in err and words in err and "Traceback" not in err
    assert len(err.strip().splitlines()) == 1


def test_bodies_that_are_free_of_each_other_are_no_rigid_body(tmp_path, stabilab):
    (tmp_path / "own.xml").write_text("<mujoco><worldbody>" + BODY.format("a") + BODY.format("b") + "</worldbody></mujoco>")
    code, _, err = stabilab("import", tmp_path / "own.xml")
    assert code == 2 and "the bodies a, b move freely of each other" in err
    assert stabilab("import", tmp_path / "own.xml", "--body", "b")[0] == 0
    (tmp_path / "own.xml").write_text("<mujoco><worldbody>" + "\n".join([BODY.format("").replace(" name=''", "")] * 20) + "</worldbody></mujoco>")
    code, _, err = stabilab("import", tmp_path / "own.xml")
    assert code == 2 and "the bodies body in line 1, body in line 2," in err and "body in line 12 and 8 more move freely" in err
    assert stabilab("import", tmp_path / "own.xml", "--body", "body in line 7")[0] == 0


ODD = ("<link name='{}'><inertial><origin xyz='0.1 0 0.2'/><mass value='{}'/><inertia ixx='{}' iyy='{}' izz='{}' ixy='{}' ixz='0' "
       "iyz='0'/></inertial></link>")


@pytest.mark.parametrize("odd", [("base", "0.1", 0, 0, 0, 0), ("base", "1e-6", "1e-6", "1e-6", "1e-6", "1e-6"),
                                 ("base", "0", "1e-6", "1e-6", "1e-6", 0), ("base", "0.02", "2e-8", "3e-8", "4e-8", "6e-8")])
def test_a_part_that_no_body_is_counts_where_all_together_are_one(tmp_path, stabilab, odd):
    """Marks with moments of any size, and masses without extension, as descriptions of the field have them."""
    path = tmp_path / "own.urdf"
    path.write_text("<robot name='r'>" + ODD.format(*odd) + LINK.format("arm") + JOINT.format("fixed", "base", "arm") + "</robot>")
    code, out, err = stabilab("import", path)
    assert code == 0, err
    compared(path, out)
    assert "no body has the mass and moments that the imported file gives of base" in load(out).caveats[0].words
    code, _, err = stabilab("import", path, "--body", "base")
    assert code == 2 and "own.urdf:1: <inertia>: base: no body has a mass of" in err
    code, out, _ = stabilab("import", path, "--body", "arm")
    assert code == 0 and not load(out).caveats


def test_what_a_model_includes_is_missing_from_every_answer(tmp_path, stabilab):
    include = "<include><uri>model://camera</uri></include>"
    (tmp_path / "own.sdf").write_text("<sdf><model name='m'>" + include + SDF.format("a") + "</model></sdf>")
    code, out, _ = stabilab("import", tmp_path / "own.sdf")
    assert code == 0 and "are not read (model://camera)" in load(out).caveats[0].words
    tied = "<joint name='j' type='fixed'><parent>a</parent><child>lens</child></joint>"
    (tmp_path / "own.sdf").write_text("<sdf><model name='m'>" + include + SDF.format("a") + tied + "</model></sdf>")
    code, _, err = stabilab("import", tmp_path / "own.sdf")
    assert code == 2 and "no link lens: expected one of the links; files of <include> that are not beside this one" in err


def test_a_description_of_what_does_not_move_is_a_fault(tmp_path, stabilab):
    """A floor, as simulators have it: a mass of 0."""
    nothing = LINK.format("a").replace("'1'", "'0'").replace("'3'", "'0'").replace("'2'", "'0'").replace("'4'", "'0'")
    (tmp_path / "own.urdf").write_text(f"<robot name='floor'>{nothing}</robot>")
    code, out, err = stabilab("import", tmp_path / "own.urdf")
    assert code == 2 and not out and "own.urdf: every link has the mass 0" in err


@pytest.mark.parametrize("head, encoding", [
    ("<!-- (c) -- no \u2265 -->\n<?xml version='1.0' encoding='utf-8'?>", "utf-8"), ("\n  <?xml version='1.0'?>", "utf-8-sig"),
    ("<?xml version='1.0' encoding='ISO-8859-1'?>", "latin-1"), ("<?xml version='1.0' encoding='gb2312'?>", "utf-8"),
    ("<?xml version='1.0' encoding='UTF-16'?>", "utf-16")])
def test_headings_and_encodings_that_simulators_read(tmp_path, stabilab, head, encoding):
    name = "gyro-\xe9"
    (tmp_path / "own.urdf").write_bytes(f"{head}\n<robot name='{name}'>{LINK.format('a')}</robot>".encode(encoding))
    code, out, err = stabilab("import", tmp_path / "own.urdf")
    assert code == 0, err
    assert load(out).title == name and read_back(out)[2].tolist() == np.diag([3, 2, 4]).tolist()


@pytest.mark.parametrize("angle, turned", [("1.57", True), ("-1.57079", True), ("3.14", True), ("1.58", False), ("3.15", False),
                                           ("2", False)])
def test_angles_near_a_quarter_turn_that_are_none_stay(tmp_path, stabilab, angle, turned):
    """1.57 and 3.14 are pi/2 and pi to two decimals, 1.58 and 3.15 are not; a product of inertia by hand: (3 - 2) sin cos."""
    link = LINK.format("a").replace("<mass", f"<origin rpy='0 0 {angle}'/><mass")
    (tmp_path / "own.urdf").write_text(f"<robot name='r'>{link}</robot>")
    product = read_back(stabilab("import", tmp_path / "own.urdf")[1])[2][0, 1]
    expected = 0 if turned else np.sin(float(angle)) * np.cos(float(angle))
    assert product == pytest.approx(expected, abs=1e-11)


def test_a_long_description_is_read_and_one_without_end_is_not(tmp_path, stabilab):
    for size, code in ((200, 0), (4200, 2)):
        (tmp_path / "own.urdf").write_text(f"<robot name='r'>{LINK.format('a')}<!--{'x' * 1024 * size}--></robot>")
        result, _, err = stabilab("import", tmp_path / "own.urdf")
        assert result == code and (code == 0 or "longer than 4096 KiB: this is more than is read" in err)


def test_an_old_simulation_description_is_named(tmp_path, stabilab):
    (tmp_path / "own.sdf").write_text("<gazebo version='1.2'><model name='m'/></gazebo>")
    code, _, err = stabilab("import", tmp_path / "own.sdf")
    assert code == 2 and "older than SDFormat 1.3, which `gz sdf -p FILE` writes anew" in err


def nested(rng, names, base="", joint=""):
    """The text of a model of links in a chain, each with its pose, which ends in what `joint` says."""
    def numbers(n, low=-2):
        return " ".join(f"{v:.3f}" for v in rng.uniform(low, 2, n))
    text = base
    for i, name in enumerate(names):
        relative = f" relative_to='{names[i - 1]}'" if i else ""
        text += (f"<link name='{name}'><pose{relative}>{numbers(6)}</pose><inertial><pose>{numbers(6)}</pose><mass>{numbers(1, 1)}</mass>"
                 "<inertia><ixx>3.1</ixx><iyy>2.2</iyy><izz>4.3</izz><ixy>0.1</ixy></inertia></inertial></link>")
        text += f"<joint name='j{name}' type='ball'><parent>{names[i - 1]}</parent><child>{name}</child></joint>" if i else ""
    return text + joint


@pytest.mark.parametrize("seed", range(3))
def test_models_inside_a_model_and_of_other_files_are_placed_in_it(tmp_path, stabilab, seed):
    """One inside the file, placed relative to a link; one of a file beside it, by another name; one of a file, merged."""
    rng = np.random.default_rng(seed)
    for name in ("own", "arm", "tip"):
        (tmp_path / name).mkdir()
    sdf = "<sdf version='1.9'><model name='{}'>{}</model></sdf>"
    inner = f"<model name='inside'><pose relative_to='b'>1 2 3 0.1 0.2 0.3</pose>{nested(rng, 'cd')}</model>"
    (tmp_path / "arm/model.sdf").write_text(sdf.format("arm", "<pose>9 9 9 0 0 0</pose>" + nested(rng, "ef", inner.replace("'b'", "'f'"))))
    (tmp_path / "tip/model.sdf").write_text(sdf.format("tip", "<pose>0.5 0 0.25 0.3 0 0.1</pose>" + nested(rng, "gh")))
    text = sdf.format("own", nested(rng, "ab", inner, """
        <include><uri>model://arm</uri><name>left</name><pose relative_to='inside::c'>0 1 0.5 0.4 0 0.2</pose></include>
        <include merge='true'><uri>model://tip</uri></include><frame name='hook' attached_to='b'><pose>1 0 0 0 0 0</pose></frame>
        <joint name='j1' type='fixed'><parent>hook</parent><child>inside</child></joint>
        <joint name='j2' type='fixed'><parent>inside::d</parent><child>left::e</child></joint>
        <joint name='j3' type='fixed'><parent>left::f</parent><child>left::inside::c</child></joint>
        <joint name='j4' type='revolute'><parent>world</parent><child>g</child></joint>
        <joint name='j5' type='fixed'><parent>a</parent><child>h</child></joint>"""))
    (tmp_path / "own/model.sdf").write_text(text)
    code, out, err = stabilab("import", tmp_path / "own/model.sdf")
    assert code == 0, err
    compared(tmp_path / "own/model.sdf", out)
    assert "10 links are joined" in err and "read with it: ../arm/model.sdf, ../tip/model.sdf" in err
    assert "left::inside::jd" in load(out).caveats[0].words
    (tmp_path / "own/model.sdf").write_text(text.replace("<child>left::e</child>", "<child>left::x</child>"))
    code, _, err = stabilab("import", tmp_path / "own/model.sdf")
    assert code == 2 and "joint j2: no link left::x: expected one of the links" in err
    (tmp_path / "tip/model.sdf").write_text(sdf.format("tip", "<include><uri>model://own</uri></include>"))
    code, _, err = stabilab("import", tmp_path / "own/model.sdf")
    assert code == 2 and "includes itself" in err


def test_bodies_of_files_that_a_model_of_mujoco_includes(tmp_path, stabilab):
    (tmp_path / "parts").mkdir()
    (tmp_path / "own.xml").write_text("<mujoco><include file='parts/set.xml'/><worldbody><body name='a' pos='0 0 1'>"
                                      "<inertial pos='0 0 0' mass='1' diaginertia='3 2 4'/><include file='parts/b.xml'/></body></worldbody></mujoco>")
    (tmp_path / "parts/set.xml").write_text("<mujocoinclude><compiler angle='radian'/></mujocoinclude>")
    (tmp_path / "parts/b.xml").write_text("<mujoco><body name='b' euler='0 0 0.5'>"
                                          "<inertial pos='1 0 0' mass='2' diaginertia='1 2 2.5'/></body></mujoco>")
    code, out, err = stabilab("import", tmp_path / "own.xml")
    assert code == 0 and "read with it: parts/set.xml, parts/b.xml" in err
    J = moments(1, np.diag([3.0, 2, 4]), np.eye(4)) + moments(
        2, np.diag([1, 2, 2.5]), placed([0, 0, 0], Rotation.from_euler("z", 0.5)) @ placed([1, 0, 0], Rotation.identity()))
    assert read_back(out)[2] == pytest.approx(about_mass_centre(J)[2], abs=1e-10)
    (tmp_path / "parts/b.xml").unlink()
    code, _, err = stabilab("import", tmp_path / "own.xml")
    assert code == 2 and "<include> file: no file parts/b.xml, which this model includes" in err


def of_shape(kind, size):
    """(volume, moments per mass) of a shape by quadrature over its sections across z, ellipses or rectangles with half axes a, b."""
    top = {"sphere": size[0], "capsule": size[0] + size[-1], "cylinder": size[-1], "ellipsoid": size[-1], "box": size[-1]}[kind]

    def axes(z):
        if kind == "capsule":
            return [np.sqrt(max(size[0]**2 - max(abs(z) - size[1], 0)**2, 0))] * 2
        if kind in ("sphere", "ellipsoid"):
            return [v * np.sqrt(max(1 - (z / top)**2, 0)) for v in (size * 2 if kind == "sphere" else size)[:2]]
        return [size[0], size[1] if kind == "box" else size[0]]
    area, square = (4, 1 / 3) if kind == "box" else (np.pi, 1 / 4)

    def integral(weight):
        breaks = [-size[-1], size[-1]] if kind == "capsule" else None
        return quad(lambda z: area * np.prod(axes(z)) * weight(z, *axes(z)), -top, top, points=breaks, epsabs=0, epsrel=1e-12)[0]
    volume = integral(lambda z, a, b: 1)
    xx, yy, zz = (integral(of) / volume for of in (lambda z, a, b: square * a * a, lambda z, a, b: square * b * b, lambda z, a, b: z * z))
    return volume, np.diag([yy + zz, xx + zz, xx + yy])


SHAPED = """<mujoco><compiler angle="radian" inertiagrouprange="0 3"/><default><geom density="700"/>
<default class="thin"><geom type="capsule" size="0.1 0.4" quat="1 0 0 0.2"/><default class="tiny"><geom size="0.05" mass="3"/></default></default>
</default><worldbody><geom type="plane" size="1 1 1"/><body name="a" childclass="thin"><joint/>
<geom pos="0.1 0.2 0.3"/><geom class="tiny" euler="0.3 0.4 0.5"/><geom type="box" size="0.2 0.3 0.4" density="250" pos="1 0 0"/>
<geom class="main" size="0.3" pos="0 1 0"/><geom class="main" type="sphere" size="5" group="4"/><geom class="main" mesh="m" type="mesh" mass="0"/>
<frame pos="0 0 1" euler="0.1 0 0"><geom type="ellipsoid" size="0.2 0.3 0.5" mass="2" euler="0 0.7 0"/></frame>
<body name="b" pos="0 0 2" childclass="main"><geom type="cylinder" size="0.2" fromto="0 0 0 0.6 0.8 0"/>
<inertial pos="0 0 0.5" mass="4" diaginertia="1 2 2.5"/></body></body></worldbody></mujoco>"""


@pytest.mark.parametrize("compiler, total", [("", None), (" inertiafromgeom='true'", None), (" settotalmass='10'", 10)])
def test_shapes_of_mujoco_have_the_moments_of_their_volumes(tmp_path, stabilab, compiler, total):
    """By quadrature; classes, groups and points as the file has them, set out here by hand."""
    (tmp_path / "own.xml").write_text(SHAPED.replace(' angle="radian"', f' angle="radian"{compiler}'))
    code, out, err = stabilab("import", tmp_path / "own.xml")
    assert code == 0, err

    def of(kind, size, at, density=None, mass=None):
        volume, tensor = of_shape(kind, size)
        mass = mass or density * volume
        return moments(mass, mass * tensor, at)
    euler, none = lambda *angles: Rotation.from_euler("XYZ", angles), Rotation.identity()
    J = (of("capsule", [0.1, 0.4], placed([0.1, 0.2, 0.3], Rotation.from_quat([1, 0, 0, 0.2], scalar_first=True)), 700)
         + of("capsule", [0.05, 0.4], placed([0, 0, 0], euler(0.3, 0.4, 0.5)), mass=3)
         + of("box", [0.2, 0.3, 0.4], placed([1, 0, 0], Rotation.from_quat([1, 0, 0, 0.2], scalar_first=True)), 250)
         + of("sphere", [0.3], placed([0, 1, 0], none), 700)
         + of("ellipsoid", [0.2, 0.3, 0.5], placed([0, 0, 1], euler(0.1, 0, 0)) @ placed([0, 0, 0], euler(0, 0.7, 0)), mass=2))
    if "true" in compiler:  # the shape of b in place of its inertial: of length 1 from (0, 0, 2) along (0.6, 0.8, 0)
        turn = Rotation.align_vectors([[0.6, 0.8, 0]], [[0, 0, 1]])[0]
        J = J + of("cylinder", [0.2, 0.5], placed([0.3, 0.4, 2], turn), 700)
    else:
        J = J + moments(4, np.diag([1, 2, 2.5]), placed([0, 0, 2.5], none))
    J = J if total is None else J * total / J[3, 3]
    for got, expected in zip(read_back(out), about_mass_centre(J)):
        assert got == pytest.approx(expected, abs=1e-10 * np.abs(expected).max())
    assert ("scaled to 10 kg" in err) == (total is not None) and "as MuJoCo has them: a" in err
