"""A mass and a tensor, or a place of a thruster, that do not belong to one craft: a caveat of every answer."""
import math

import pytest

from stabilab import Body
from stabilab.case.read import read_text

TENSOR = "[[412.0, -6.3, 11.8], [-6.3, 297.5, 4.4], [11.8, 4.4, 351.2]]"
CRAFT = """[body]
inertia = {tensor}
mass = {mass}
[[thrusters]]
position = {place}
direction = [0, 1, 0.5]
force = 1
stuck = true
[motion]
angular_velocity = [0.001, 0, 0.002]
span = [0, 20]
"""


def found(tensor=TENSOR, mass=640, place="[0.05, 0.55, -0.48]"):
    read = read_text("own.toml", CRAFT.format(tensor=tensor, mass=mass, place=place))
    return [one.words for one in read.caveats if one.kind == "size"]


def times(factor):
    return f"[412e{factor}, 297.5e{factor}, 351.2e{factor}]"


def test_a_tensor_without_its_unit_beside_a_mass_is_no_craft():
    """sqrt(4.12e8/640) = 802 m by hand: 640/802^3 = 1.2e-6 kg/m^3."""
    assert not found() and not found('["4.12e8 kg mm^2", "2.975e8 kg mm^2", "3.512e8 kg mm^2"]')
    (words,) = found(times(6))
    assert words.startswith("the radius of gyration is 802.3 m beside a mass of 640 kg, beyond all reason")


@pytest.mark.parametrize("inertia, mass", [  # in kg m^2 and kg, from their published descriptions or by hand
    ((1.29e8, 1.07e8, 2.01e8), 419_725),            # the space station
    ((0.03, 0.03, 0.007), 4), ((0.001, 0.001, 0.001), 0.8),  # CubeSats of three units and of one
    ((100 * 100**2 / 12, 100 * 100**2 / 12, 100 * 100**2 / 6), 100),  # a sail of 100 m and 10 g/m^2
    ((4e29, 4e29, 4.1e29), 4e19),                  # an asteroid of 200 km
    ((0.4 * 10 * 0.05**2,) * 3, 10)])              # a ball of 10 kg and 5 cm: of osmium nearly
def test_what_is_built_or_found_is_none(inertia, mass):
    assert not [one for one in Body(inertia, mass).caveats if one.kind == "size"]


@pytest.mark.parametrize("share, said", [(0.98, True), (1.02, False)])
def test_no_body_is_denser_than_osmium(share, said):
    """A ball has the least trace of all bodies of a mass and a density, 3 x 2/5 m R^2."""
    radius = (3 * 7 / (4 * math.pi * 22_600)) ** (1 / 3)
    assert bool(Body((0.4 * 7 * radius**2 * share,) * 3, 7).caveats) is said


def test_a_mass_in_g_is_no_craft():
    assert found(tensor="[0.03, 0.03, 0.007]", mass=4000, place="[0.05, 0, 0]")[0].endswith("leaves out")


@pytest.mark.parametrize("tensor, place, words", [
    (times(4), "[0.05, 0.55, -0.48]", "is the tensor in kg mm^2"),   # 80 m beside 0.73 m
    (TENSOR, "[50, 550, -480]", "is the position in mm")])
def test_a_thruster_far_from_all_mass_is_no_craft(tensor, place, words):
    (one,) = found(tensor, place=place)
    assert words in one and "the farthest thruster stands" in one


@pytest.mark.parametrize("options", [("fate",), ("fate", "--json"), ("when", "--rate", "1 rad/s", "--csv"),
                                     ("show",),
                                     ("simulate", "--at", "1", "--json"), ("stuck", "--json"), ("classify",)])
def test_every_view_shows_it(stabilab, tmp_path, options):
    (tmp_path / "own.toml").write_text(CRAFT.format(tensor=times(6), mass=640, place="[0.05, 0.55, -0.48]"))
    command, *rest = options
    assert "beyond all reason" in stabilab(command, tmp_path / "own.toml", *rest)[1]
