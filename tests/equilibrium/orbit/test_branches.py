"""The equilibria followed over the momentum of a wheel, and their picture."""
import numpy as np
import pytest

from stabilab import InputError, circular_orbit, load_orbiting
from stabilab.answers.circular_orbit import followed
from tests.equilibrium.orbit import newton

CASE = """[body]
inertia = [{moments}]
[[wheels]]
axis = [{axis}]
momentum = "{momentum}"
[circular_orbit]
rate = 0.001
"""


def case(axis="0, 0, 1", moments="3, 2, 1", momentum="0.001 N m s"):
    return load_orbiting(CASE.format(axis=axis, moments=moments, momentum=momentum))


@pytest.fixture(scope="module")
def along_minor():
    """A wheel along the least moment: n |A - B| is 0.001 and 0.002 N m s, four times that 0.004 and 0.008."""
    return followed(circular_orbit(case(), "0.01 N m s"))


def test_branches_along_an_axis_have_the_angles_of_their_formulas(along_minor):
    """With the normal in the plane of C = 1 along the wheel and B: x (B y) = y (C x + h) or y = 0, so that cos = h/((B
    - C) n) = x, or 1; with the vertical there, 4 n a2 . I a3 + a3 . h = 0, cos of the normal is -h/(4 n (C - B))."""
    seen = {name: 0 for name in ("along", "split", "vertical")}
    for branch in along_minor:
        for h, at in zip(branch.momenta, branch.points):
            cosine = at.normal[2]
            formulas = {"along": 1.0, "split": min(abs(abs(cosine) - h / (d * 0.001)) for d in (1, 2)),
                        "vertical": min(abs(abs(cosine) - h / (4 * d * 0.001)) for d in (1, 2))}
            name = ("along" if abs(abs(cosine) - 1) < 1e-6 or abs(cosine) < 1e-6
                    else min(("split", "vertical"), key=formulas.get))
            assert name == "along" or formulas[name] < 1e-6  # 24 bits of all numbers
            seen[name] += 1
    assert all(seen.values())


def test_a_branch_runs_without_jumps_and_keeps_its_verdict(along_minor):
    for branch in along_minor:
        places = [np.array((at.normal, at.vertical)) for at in branch.points]
        steps = [min(np.abs(b - a).max(), np.abs(b * [[1], [-1]] - a).max()) for a, b in zip(places, places[1:])]
        assert branch.momenta == sorted(branch.momenta) and max(steps, default=0) < 0.3
        assert {at.verdict for at in branch.points[1:]} <= {branch.verdict}


def test_every_point_of_a_wheel_off_the_axes_is_an_equilibrium_and_none_is_missing():
    """By Newton's method from many starts at two momenta, and by the torque at all others."""
    found = followed(circular_orbit(case("1, 2, 2", momentum="0.0006 N m s"), "0.0012 N m s"))
    direction, moments = np.array([1, 2, 2]) / 3, np.array([3.0, 2, 1])
    for branch in found:
        for h, at in zip(branch.momenta, branch.points):
            frame = np.array([[at.velocity, at.normal, at.vertical]])
            assert np.abs(newton.torque(moments, h * direction, 0.001, frame)).max() < 1e-12  # of 3e-6, by 24 bits
    momenta = sorted({h for branch in found for h in branch.momenta})
    for h in momenta[5::40]:
        ours = sum(branch.momenta.count(h) for branch in found if branch.momenta[0] < h or len(branch.momenta) == 1)
        assert 2 * ours == len(newton.equilibria(moments, h * direction, 0.001, starts=600))


def test_a_picture_is_drawn_with_the_answer(stabilab, tmp_path):
    path = tmp_path / "wheel.toml"
    path.write_text(CASE.format(moments="3, 2, 1", axis="0, 0, 1", momentum="0.001 N m s"))
    code, out, err = stabilab("orbit", path, "--up-to", "0.003 N m s", "--out", tmp_path / "wheel.png")
    assert code == 0 and (tmp_path / "wheel.png").stat().st_size > 10_000 and "written:" in out + err
    code, _, err = stabilab("orbit", path, "--out", tmp_path / "wheel.png")
    assert code == 2 and "--up-to" in err
    code, _, err = stabilab("orbit", path, "--up-to", "0.003 N m s", "--out", tmp_path / "wheel.txt")
    assert code == 2 and ".png" in err


@pytest.mark.parametrize("asked, up_to, words", [
    (case(), None, "give the momentum"),
    (case(moments="3, 3, 1"), "0.01 N m s", "families")])
def test_what_has_no_branches_is_refused(asked, up_to, words):
    with pytest.raises(InputError, match=words):
        followed(circular_orbit(asked, up_to))
