"""A question pays for what it prints: what is worked out of a motion, counted by the files whose functions run."""
import sys
from pathlib import Path

import pytest

import stabilab
from stabilab.answers.motion import Needs, motion
from stabilab.case.read import load
from stabilab.commands import classify
from tests.shared import CASES

PACKAGE = str(Path(stabilab.__file__).parent)
FIELDS = {Needs.EXTREMES: "extremes", Needs.PERIOD: "period", Needs.LARGEST: "largest", Needs.FLIPS: "flips",
          Needs.DISTANCE: "velocity_bounds", Needs.INVARIANTS: "invariants"}
# a reduction; no torque, and a wheel with no zero component; a wheel along the torque; a torque in the plane of
# two equal moments; more than wheels and a torque
ONE_OF_EACH = ("minor-axis-100", "major-axis-captured", "torque-free-gyrostat", "middle-axis-spin-up",
               "symmetric-body", "symmetric-spin-up", "t-handle", "explorer-1", "liquid-base", "toy-top")


def entered(ask) -> set[str]:
    """The files of the package of which a function runs while `ask` does; what an import runs is left out."""
    files, importing = set(), [0]

    def see(frame, event, _):
        code = frame.f_code
        if code.co_name == "<module>":
            importing[0] += {"call": 1, "return": -1}.get(event, 0)
        elif event == "call" and not importing[0] and code.co_filename.startswith(PACKAGE):
            files.add(code.co_filename[len(PACKAGE) + 1:])
    sys.setprofile(see)
    try:
        ask()
    finally:
        sys.setprofile(None)
    return files


@pytest.mark.parametrize("question, pays", [("fate", True), ("extremes", False), ("period", False)])
def test_the_distance_from_the_separatrix_is_worked_out_where_it_is_printed(question, pays, capsys):
    path = CASES / "minor-axis-100.toml"
    files = entered(lambda: classify.answer(question, [path], True, None, False, None, False))
    assert capsys.readouterr().out.startswith("[")
    assert any(name.startswith("orbit/separatrix/") for name in files) == pays


def test_the_fate_of_one_state_enters_few_files():
    case = stabilab.load(CASES / "minor-axis-100.toml")
    files = entered(lambda: stabilab.fate(case))
    assert {"orbit/fate.py", "orbit/one_state.py"} <= files and len(files) <= 35, sorted(files)


@pytest.mark.parametrize("name", ONE_OF_EACH)
def test_a_part_of_a_motion_is_that_of_the_whole(name):
    case = load(CASES / f"{name}.toml")
    whole = motion(case.scene, case.start, None, exact=case.exact_state)
    for part, field in FIELDS.items():
        found = motion(case.scene, case.start, None, part, case.exact_state)
        assert getattr(found, field) == getattr(whole, field), field
        assert (found.fate, found.margin_energy) == (whole.fate, whole.margin_energy)


def test_what_is_not_needed_is_not_there():
    case = load(CASES / "minor-axis-100.toml")
    bare = motion(case.scene, case.start, None, Needs.FATE)
    assert bare.fate is stabilab.Fate.BOUNDED and {field: getattr(bare, field) for field in FIELDS.values()} == {
        field: {} if field == "invariants" else None for field in FIELDS.values()}
