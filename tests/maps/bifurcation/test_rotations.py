"""Rotations over a wheel's speed: their number by a search over the sphere written here, and thresholds that are
known."""
import json

import numpy as np
import pytest

from stabilab import InputError, bifurcation, load
from tests.equilibrium.test_momentum_sphere import searched
from tests.shared import CASES

CASE = CASES / "dual-spin-damper.toml"
SPEED = "wheels.flywheel.speed"


def test_the_spin_about_the_intermediate_axis_is_stable_from_300_rpm_on():
    """h = (400 - 350) 2 pi N m s by Likins' rule, over a wheel of 10 kg m^2 at 60 rpm; with h = -(350 - 300) 2 pi
    it has the most energy, and from h = -350 2 pi on, where H = 0, the least again."""
    found = bifurcation(load(CASE), {SPEED: "-3000:500 rpm"}, spin="60 rpm")
    assert [float(value) for value in found.changes] == pytest.approx([-2100, -300, 300], rel=1e-15)
    natures = [piece.rotations[0].nature for piece in found.pieces]
    assert natures == ["minimum", "maximum", "saddle", "minimum"]
    for piece in found.pieces:
        assert piece.rotations[0].rates == pytest.approx((2 * np.pi, 0, 0))


def test_at_one_momentum_the_thresholds_of_a_wheel_along_an_axis_are_those_by_hand():
    """The pair about z begins where h = |H| (1 - 350/400), that about y where h = |H| (350/300 - 1)."""
    found = bifurcation(load(CASE), {SPEED: "0:500 rpm"}, momentum="2600 N m s")
    rpm = 30 / np.pi / 10
    assert [float(value) for value in found.changes] == pytest.approx([2600 / 8 * rpm, 2600 / 6 * rpm], rel=1e-14)
    assert [piece.stable for piece in found.pieces] == [2, 1, 1]


@pytest.mark.parametrize("axis", [(1, 2, 5), pytest.param((3, -1, 1), marks=pytest.mark.slow)], ids=str)
def test_between_the_changes_the_number_is_that_of_a_search_over_the_sphere(axis):
    """Newton's method from 400 points, just before and after each change and in between."""
    text = f"""[body]
inertia = [2000, 1500, 1000]
[[wheels]]
name = "rotor"
axis = {list(axis)}
momentum = 100
"""
    found = bifurcation(load(text), {"wheels.rotor.momentum": "-3000:3000"}, momentum=1600)
    unit = np.array(axis) / np.linalg.norm(axis)
    assert len(found.changes) == 4  # two pairs vanish on either side: lambda and -lambda are mirror images
    assert found.changes == pytest.approx([-value for value in reversed(found.changes)], rel=1e-12)
    counts = [len(piece.rotations) for piece in found.pieces]
    assert counts == [2, 4, 6, 4, 2]
    for value, before, after in zip(found.changes, counts, counts[1:]):
        for shift, count in ((-1.0, before), (1.0, after)):
            assert len(searched((2000, 1500, 1000), (float(value) + shift) * unit, 1600.0, 400)) == count


@pytest.mark.parametrize(("vary", "options", "words"), [
    ({"inertia[1]": "300:400"}, {"momentum": 2600}, "do not depend on it"),
    ({SPEED: "0:500 rpm", "inertia[1]": "300:400"}, {"momentum": 2600}, "one number"),
    ({SPEED: "0:500 rpm"}, {"momentum": -1}, "at least 0"),
    ({SPEED: "0:500 rpm"}, {"momentum": 1, "spin": 1}, "different questions"),
    ({SPEED: "0:500 rpm"}, {"spin": "60 kg"}, "spin")])
def test_what_cannot_be_varied_is_one_error(vary, options, words):
    with pytest.raises(InputError, match=words):
        bifurcation(load(CASE), vary, **options)


def test_a_wheel_along_no_principal_axis_has_no_rotation_at_one_rate():
    text = CASE.read_text(encoding="utf-8").replace("axis = [1, 0, 0]", "axis = [1, 1, 0]")
    with pytest.raises(InputError, match="no principal axis"):
        bifurcation(load(text), {SPEED: "0:500 rpm"}, spin="60 rpm")


def test_the_command_prints_draws_and_writes_what_is_found(stabilab, tmp_path):
    options = ("bifurcation", CASE, "--vary", f"{SPEED}=280:320 rpm", "--spin", "60 rpm")
    code, printed, _ = stabilab(*options, "--out", tmp_path / "a.png")
    assert code == 0 and "attracts for 300 < speed < 320 rpm" in printed and (tmp_path / "a.png").stat().st_size > 5000
    data = json.loads(stabilab(*options, "--json")[1])
    assert [piece["natures"] for piece in data["pieces"]] == [{"saddle": 1}, {"minimum": 1}]
    rows = stabilab(*options, "--csv")[1].splitlines()
    assert rows[0].startswith("value,nature") and len(rows) > 100
    assert stabilab(*options, "--certify", tmp_path / "a.json")[0] == 2
