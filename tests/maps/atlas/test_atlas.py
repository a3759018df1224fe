"""An atlas has in each cell the answer of the scene with that torque, the symmetries of the body, and the
same bytes whoever computes it."""
from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from stabilab.case.read import read_text
from stabilab.errors import InputError
from stabilab.maps import run as machinery
from stabilab.maps.atlas import asked, drawn, kinds_of
from stabilab.maps.pointed import neighbours
from stabilab.orbit.result import Fate
from stabilab.show.maps import atlas as atlas_files
from stabilab.show.maps import atlas as atlas_words
from stabilab.show.units import units_of
from tests.oracles.rigid import euler
from tests.shared import CASES

BODY = """[body]
inertia = {inertia}
[effects.gyrostat]
momentum = {wheel}
[effects.constant_torque]
torque = {torque}
[motion]
angular_velocity = {start}
{rest}
"""


def case_of(inertia=(3.1, 2.3, 1.45), wheel=(0.0, 0.0, 0.0), torque=(0.0, 0.0, 1.0), start=(0.0, 0.0, 0.0),
            rest=""):
    return read_text("body.toml", BODY.format(inertia=list(inertia), wheel=list(wheel), torque=list(torque),
                                              start=list(start), rest=rest))


UNITS = units_of(case_of())


def made(case, level=1, refine=0, **options):
    with drawn(asked(case, level=level, refine=refine, **options), workers=1) as found:
        return found


@pytest.fixture(scope="module")
def spinning():
    return made(case_of(wheel=(0.0, 0.2, 0.0), start=(0.3, -0.2, 0.5)), rate="2")


def test_cells_have_the_answers_of_their_scenes_alone(spinning):
    body, wheel = stabilab.Body(("3.1", "2.3", "1.45")), stabilab.Gyrostat((0, "0.2", 0))
    for n in (0, 5, 13, 22, 31):
        scene = stabilab.Scene(body, wheel, stabilab.ConstantTorque(spinning.directions[n].tolist()))
        alone, when = stabilab.motion(scene,
                                      (0.3, -0.2, 0.5)), stabilab.time_to(scene, (0.3, -0.2, 0.5), rate="2")
        row = spinning.records[n]
        assert (row["fate"], row["spin_axis"]) == (alone.fate, alone.axis * alone.sense)
        assert row["when_low"] <= when.high and when.low <= row["when_high"]  # both enclose the same time
        assert row["equilibria"] == len(stabilab.equilibria(scene).points)


def test_brute_force_sees_the_axis_of_a_cell(spinning):
    """Euler's equations written anew, DOP853: the last rate is far beyond the others, about the axis of the
    cell and in its sense."""
    D, wheel = np.array([3.1, 2.3, 1.45]), np.array([0.0, 0.2, 0.0])
    for n in (2, 19):
        torque = spinning.directions[n]
        run = solve_ivp(euler(D, wheel, torque), (0, 60), (0.3, -0.2, 0.5),
                        "DOP853", rtol=1e-8, atol=1e-8)
        last = run.y[:, -1]
        axis = int(np.abs(last).argmax())
        assert abs(last[axis]) > 4 * np.delete(np.abs(last), axis).max()
        assert spinning.records["spin_axis"][n] == (axis + 1) * np.sign(last[axis])
        reached = run.t[np.linalg.norm(run.y, axis=0) >= 2][0]
        before = run.t[np.flatnonzero(run.t < reached)[-1]]
        assert before <= spinning.records["when_high"][n] and spinning.records["when_low"][n] <= reached


def test_from_rest_without_a_wheel_a_half_turn_about_an_axis_maps_the_atlas_onto_itself():
    """Turned by half a turn about a principal axis the equations are the same, and rest stays rest."""
    found = made(case_of())
    told = _by_direction(found)
    for signs in ((1, -1, -1), (-1, 1, -1), (-1, -1, 1)):
        for direction, axis in told.items():
            sense = signs[abs(axis) - 1] if axis else 1
            assert told[tuple(v * s for v, s in zip(direction, signs))] == axis * sense


@pytest.mark.parametrize("order", [(1, 2, 0), (0, 2, 1)])
def test_other_names_of_the_axes_permute_the_atlas(order):
    """A cyclic exchange turns vectors of rates and torques; one of two axes is a mirror, which turns them the
    other way as well."""
    moments, wheel, start = (3.1, 2.3, 1.45), (0.1, 0.0, -0.2), (0.2, -0.1, 0.3)
    sign = 1 if order == (1, 2, 0) else -1
    one = _by_direction(made(case_of(moments, wheel, start=start)))
    other = _by_direction(made(case_of([moments[n] for n in order], [sign * wheel[n] for n in order],
                                       start=[sign * start[n] for n in order])))
    for direction, axis in one.items():
        named = order.index(abs(axis) - 1) + 1 if axis else 0
        assert other[tuple(sign * direction[n] + 0.0 for n in order)] == sign * np.sign(axis) * named


def _by_direction(found):
    rows = found.directions.round(10) + 0.0
    return dict(zip(map(tuple, rows.tolist()), found.records["spin_axis"].tolist()))


def test_without_a_wheel_equilibria_are_two_where_the_product_of_the_torques_has_one_sign():
    """M1 M2 M3 > 0 for moments that descend: by hand in cases/off-axis-two.toml."""
    found = made(case_of())
    assert (found.records["equilibria"] == np.where(found.directions.prod(axis=1) > 0, 2, 0)).all()


def test_an_axis_is_a_point_of_its_own_with_the_verdict_of_its_reduction():
    found = made(stabilab.load(CASES / "off-axis-two.toml"))
    own = {point.number: row for point, row in zip(found.named, found.named_records) if point.level == -1}
    for number, row in own.items():
        torque = [0.0, 0.0, 0.0]
        torque[number // 2] = float(found.asked.torque) * (-1) ** number
        scene = stabilab.Scene(stabilab.Body((3, 2, "1.5")), stabilab.ConstantTorque(torque))
        alone = stabilab.motion(scene, (0.1, 0.2, 0.3))
        assert (row["fate"], row["level"]) == (alone.fate, 2)  # exact
    # a torque on the middle axis keeps every motion bounded, and no cell beside it is bounded
    assert own[2]["fate"] == own[3]["fate"] == Fate.BOUNDED and not (
        found.records["fate"] == Fate.BOUNDED).any()


def test_refinement_leaves_both_sides_of_every_boundary_at_the_last_depth():
    found = made(case_of(wheel=(0.0, 0.2, 0.0), start=(0.3, -0.2, 0.5)), level=1, refine=1)
    pairs, kinds = found.leaves.beside(), kinds_of(found.records)
    across = pairs[kinds[pairs[:, 0]] != kinds[pairs[:, 1]]]
    assert len(across) and (found.leaves.level[across] == 2).all()
    assert found.share.sum() == pytest.approx(1, abs=1e-12) and set(found.leaves.level.tolist()) == {1, 2}
    first = made(case_of(wheel=(0.0, 0.2, 0.0), start=(0.3, -0.2, 0.5)), level=1)
    uncut = found.leaves.level == 1
    same = kinds_of(first.records)[neighbours(1, found.leaves.number[uncut])] == kinds[uncut][:, None]
    assert same.all()  # what was left whole differs from none of its neighbours


@pytest.mark.slow
def test_cells_beside_another_number_of_equilibria_are_cut_too():
    """A torque off the axes leaves two equilibria or none: the real roots of one quadratic."""
    found = made(case_of(wheel=(0.0, 0.2, 0.0)), level=2, refine=1)
    pairs, number = found.leaves.beside(), found.records["equilibria"]
    across = pairs[number[pairs[:, 0]] != number[pairs[:, 1]]]
    assert set(number.tolist()) == {0, 2} and len(across) and (found.leaves.level[across] == 3).all()


def test_no_time_is_asked_on_request(tmp_path):
    case = case_of(rest='[limits]\nrate = "2 rad/s"')
    assert "when_low" in made(case, level=0).records.dtype.names
    found = asked(case, level=0, timed=False)
    assert "when" not in found.answers and found.command.endswith("--no-time")
    with pytest.raises(InputError, match="contradict"):
        asked(case, timed=False, rate="2")
    pytest.importorskip("xarray")
    again = stabilab.atlas(case, level=0, refine=0, timed=False, out=tmp_path / "atlas.nc")
    assert "when_low" not in again and atlas_words.answer(atlas_files.atlas_of(again, tmp_path / "atlas.nc"),
                                                          UNITS).count("time") == 0


@pytest.mark.parametrize("wheel, words",
                         [((0.1, 0.2, 0.4), "the wheel's axis"), ((0, 0, 0), "the torque's axis")])
def test_a_sphere_spins_up_about_the_axis_of_its_wheel_or_of_the_torque(wheel, words):
    # by hand, D w' = l x w + M up to the sign: the part along l grows at the rate M.l/|l|, all of it along M
    # without a wheel
    found = made(case_of(inertia=(2, 2, 2), wheel=wheel), level=0)
    assert f"all directions spin up about {words}" in atlas_words.answer(found, UNITS)
    assert "no principal axis" not in atlas_words.text(found, UNITS)


def test_wheel_momenta_are_along_the_wheel_or_along_the_axis_that_is_named(spinning):
    found = made(case_of(wheel=(0.0, 0.2, 0.0), start=(0.3, -0.2, 0.5)), level=0, wheel="-0.2, 0, 0.2")
    assert [tuple(map(float, wheel))
            for wheel in found.asked.wheels] == [(0, -0.2, 0), (0, 0, 0), (0, 0.2, 0)]
    alone = made(case_of(wheel=(0.0, 0.2, 0.0), start=(0.3, -0.2, 0.5)), level=0)
    assert (found.records[found.leaves.wheel == 2] == alone.records).all()
    assert asked(case_of(), wheel="z=0.1:0.3:3").wheels[2][2] == pytest.approx(0.3)
    assert asked(case_of(), wheel="1=0:1:2 mN m s").unit == "mN m s"


@pytest.mark.slow
def test_directions_of_a_full_tensor_are_told_in_the_frame_of_the_file():
    found = made(stabilab.load(CASES / "upper-stage.toml"), level=0)
    thruster = next(n for n, point in enumerate(found.named) if point.level == -2)
    torque = np.array(list(map(float, found.asked.case.thrusters[0].torque)))
    assert found.in_file(found.named_directions)[thruster] == pytest.approx(torque / np.linalg.norm(torque),
                                                                            abs=1e-12)
    # the case's torque is that of its one thruster
    assert [point.level for point in found.named] == 6 * [-1] + [-2]
    assert found.named_records["fate"][thruster] == stabilab.motion(found.asked.case.scene,
                                                                    found.asked.case.state).fate


@pytest.mark.slow
def test_several_processes_give_the_same_bytes():
    case = case_of(wheel=(0.0, 0.2, 0.0), start=(0.3, -0.2, 0.5))
    with drawn(asked(case, level=2, refine=0), workers=2) as found:
        assert found.records.tobytes() == made(case, level=2).records.tobytes()


@pytest.mark.slow
def test_certified_fates_are_proved_on_request():
    found = made(case_of(wheel=(0.0, 0.2, 0.0), start=(0.3, -0.2, 0.5)), level=0, certify=True)
    assert (found.records["level"] == 3).all()


@pytest.mark.parametrize("options, words", [
    ({"torque": "1 N"}, "torque: expected energy|torque: expected torque"),
    ({"torque": "-1 N m"}, "torque: expected a positive size"),
    ({"torque": "strong"}, "torque: expected a decimal"),
    ({"wheel": "0:2:5"}, "wheel: the case has no wheel that turns: say along which axis"),
    ({"wheel": "q=0:2:5"}, "wheel: expected a range.*the axis \"q\""),
    ({"wheel": "z=0:2:5 N m"}, "wheel: expected angular momentum"),
    ({"wheel": "z=0:2:0"}, "wheel: expected at least one point"),
    ({"level": -1}, "level: expected a whole number"), ({"refine": 1.5}, "refine: expected a whole number"),
    ({"level": 9, "refine": 5}, "at most 12 in all"),
    ({"level": 9}, "at most 2,000,000 are asked"), ({"rate": "3 kg"}, "rate: expected angular velocity"),
    ({"until": "3 s"}, "no limit: give --rate")])
def test_what_cannot_be_asked_is_told(options, words):
    with pytest.raises(InputError, match=words):
        asked(case_of(), **options)


def test_a_case_that_has_no_atlas_says_why():
    with pytest.raises(InputError, match="no torque acts, so its size is not known: give --torque"):
        asked(CASES / "torque-free-gyrostat.toml")
    with pytest.raises(InputError, match="scaled variables"):
        asked(CASES / "minor-axis-100.toml")
    with pytest.raises(InputError, match="covers a gyrostat and a constant torque; the scene also has"):
        asked(CASES / "liquid-base.toml", torque="1 N m")
    with pytest.raises(InputError, match="expected angular_velocity in .motion."):
        asked(read_text("still.toml",
                        BODY.partition("[motion]")[0].format(inertia=[3, 2, 1.5], wheel=[0, 0, 0],
                                                             torque=[1, 0, 0])))


@pytest.mark.slow
def test_a_motion_on_an_island_is_marked_where_its_torque_points():
    """The island of docs/spin-up.md, whose elliptic periodic motion `unreduced.periodic` finds by Newton's
    method."""
    case = case_of((1.2412, 0.3937, 1.3650), (-0.5224, 0.8309, 0.1914), (0.0987, 0.8450, 0.5255),
                   (-1.572, 0.657, 0.738))
    plan = asked(case, level=0).plan(asked(case, level=0).named[-1:])
    (own,) = machinery.answered(plan, 0)
    assert (own["fate"], own["island"], own["level"]) == (Fate.UNDECIDED, 2, 0)


def test_motions_are_followed_as_long_as_is_asked():
    case = case_of(wheel=(0.0, 0.2, 0.0), start=(0.3, -0.2, 0.5))
    brief = made(case, level=0, follow="1 s")
    assert (brief.records["fate"] == Fate.UNDECIDED).any() and "'--follow=1 s'" in brief.asked.command
    with pytest.raises(InputError, match="follow"):
        asked(case, follow="long")
