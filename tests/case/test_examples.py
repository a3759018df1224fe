"""Cases to begin with: each is there, says whence its numbers are, and has the answer that mechanics gives."""
import math

import pytest

import stabilab
from stabilab.case.source import EXAMPLES, command_of, example


@pytest.mark.parametrize("name", [name for name in EXAMPLES if command_of(name) == "classify"])
def test_an_example_is_a_case_with_a_source_and_an_outcome(name):
    case = stabilab.load(example(name))
    assert case.title and case.source and case.span
    assert case.fate().outcome in ("bounded", "spin-up")


@pytest.mark.parametrize("name, answer", [("boom", "16 EQUILIBRIA, 2 STABLE"), ("stage", "CLOSED at t = 20.4")])
def test_an_example_of_one_question_is_answered_by_its_command_and_refused_by_others(
        stabilab, tmp_path, name, answer):
    """Answers: of docs/circular-orbit.md; 12 kg at 9.8 g/s last 20.4 min."""
    path = tmp_path / f"{name}.toml"
    path.write_text(example(name))
    code, out, _ = stabilab(command_of(name), path)
    assert code == 0 and out.startswith(f"{name}: {answer}")
    code, out, err = stabilab("classify", path)
    assert code == 2 and not out and f"stabilab {command_of(name)}" in err


def test_the_command_lists_and_writes_them(stabilab, tmp_path):
    code, out, _ = stabilab("example")
    assert code == 0 and all(f"\n  {name} " in out for name in EXAMPLES)
    code, out, _ = stabilab("example", "phone")
    (tmp_path / "phone.toml").write_text(out)
    assert code == 0 and out == example("phone")
    assert stabilab("classify", tmp_path / "phone.toml")[0] == 0
    code, out, err = stabilab("fate", "toutatis")
    assert code == 2 and err == "toutatis: no such file; `stabilab example toutatis > toutatis.toml` writes one\n"
    code, out, err = stabilab("example", "phon")
    assert code == 2 and not out and err.strip().endswith("there is none of this name; did you mean phone?")


def test_moments_of_the_phone_are_those_of_a_cuboid():
    """m (b^2 + c^2)/12 for 146.7 x 71.5 x 7.65 mm and 174 g."""
    m, a, b, c = 0.174, 0.1467, 0.0715, 0.00765
    assert stabilab.load(example("phone")).scene.body.inertia == pytest.approx(
        [m * (b * b + c * c) / 12, m * (a * a + c * c) / 12, m * (a * a + b * b) / 12], rel=1e-9)


def test_moments_of_the_t_handle_are_those_of_two_cylinders():
    """Of each about its own centre, and the parallel-axis theorem."""
    bar, stem = (0.006, 0.080), (0.005, 0.040)
    masses = [2700 * math.pi * r * r * length for r, length in (bar, stem)]
    across = [m * (3 * r * r + length**2) / 12 for m, (r, length) in zip(masses, (bar, stem))]
    along = [m * r * r / 2 for m, (r, _) in zip(masses, (bar, stem))]
    apart = masses[0] * masses[1] / sum(masses) * (bar[0] + stem[1] / 2) ** 2  # reduced mass times distance squared
    body = stabilab.load(example("t-handle")).scene.body
    assert body.inertia == pytest.approx([along[0] + across[1] + apart, across[0] + along[1],
                                          across[0] + across[1] + apart], rel=1e-5)
    assert body.inertia[0] < body.inertia[1] < body.inertia[2]  # the stem is the intermediate axis


def test_explorer_1_precesses_as_a_symmetric_body():
    """|H|/D1 = sqrt(w1^2 + (D3 w3/D1)^2) for D1 = D2."""
    case = stabilab.load(example("explorer-1"))
    across, _, along = case.scene.body.inertia
    assert case.attitude().precession_period == pytest.approx(
        2 * math.pi / math.hypot(case.state[0], along * case.state[2] / across), rel=1e-12)


def test_toutatis_has_the_periods_that_radar_saw():
    """Hudson & Ostro 1995: 5.41 and 7.35 days."""
    turn = stabilab.load(example("toutatis")).attitude()
    assert turn.rotation_period / 86400 == pytest.approx(5.41, abs=0.005)
    assert turn.precession_period / 86400 == pytest.approx(7.35, abs=0.005)


def test_the_top_spins_faster_than_a_sleeping_top_must():
    """Lagrange: C^2 w^2 > 4 M g l A, here 16.8 turns a second."""
    case = stabilab.load(example("top"))
    (A, _, C), weight = case.scene.body.inertia, math.hypot(*map(float, case.scene.vector("gravity")))
    assert math.sqrt(4 * weight * A) / C / (2 * math.pi) == pytest.approx(16.8, abs=0.05)
    assert case.state[2] > math.sqrt(4 * weight * A) / C


def test_the_station_s_gyros_lose_to_the_thruster_when_torque_over_moment_says():
    """About y: (0.5 deg/s - rate at the start) times the moment over 8000 N m, to a percent: the products are small."""
    case = stabilab.load(example("station"))
    time = (math.radians(0.5) - 1.1363312657e-3) * 9.5144639344e7 * 1.3558179483 / 8000
    assert case.when().low == pytest.approx(time, rel=0.01)
