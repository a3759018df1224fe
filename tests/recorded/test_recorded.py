"""The program says of every case what it said when it was recorded: words, labels and levels exactly, numbers
to their tolerance. The default suite looks at a few cases of each command; the slow one at all."""
import pytest

from . import answers
from .answers import ALL, ONE_CASE, RELATIVE, SEVERAL, USUAL, differences, now, record, recorded

# The words of these are made from the JSON of the same command, of which the default suite has some: long
DRAWN = "page", "pictures", "explorer"  # minutes of all cases
LONG = {"audit",  # which tests/papers/test_audit.py holds against the equations
        *(name for name in ALL if name.endswith(("-text", "-csv"))), *DRAWN}

# What the default suite looks at: of every command these cases, of some commands others too; of command lines
# those that take less than a second
FEW = {"minor-axis-100", "torque-free-body", "wheel-and-thruster", "uncertain-separatrix"}
ALSO = {"attitude-text": {"middle-axis-double-well", "liquid-base", "top-lx30-lz30", "phone"},
        "extremes": {"symmetric-spin-up", "charged-body"}, "extremes-csv": {"symmetric-spin-up", "off-axis-two"},
        "period": {"charged-body"}, "fate": {"charged-body"}, "classify": {"charged-body"},
        "fate-text": {"uncertain-minor-axis", "charged-body", "cubesat-3u-detumbling"},
        "classify-text": {"charged-body", "uncertain-minor-axis"}, "simulate": {"charged-body"}}
QUICK = [(name, line) for name in ("words", "certificates") for line in map(" ".join, SEVERAL[name])
         if not line.startswith(("atlas", "bifurcation", "stuck cases/upper-stage"))
         and (not line.startswith("compare") or "minor-axis" in line)]


@pytest.mark.parametrize("name", ONE_CASE)
def test_a_command_says_of_a_few_cases_what_is_recorded(name, tmp_path):
    wanted = FEW | ALSO.get(name, set())
    before = {key: one for key, one in recorded(name).items() if key in wanted}
    assert before.keys() == wanted
    assert differences(before, now(name, tmp_path, wanted.__contains__), RELATIVE.get(name, USUAL)) == []


@pytest.mark.parametrize("name", ["words", "certificates"])
def test_quick_command_lines_say_what_is_recorded(name, tmp_path):
    wanted = {line for record, line in QUICK if record == name}
    before = {key: one for key, one in recorded(name).items() if key in wanted}
    assert differences(before, now(name, tmp_path, wanted.__contains__), USUAL) == [] and before.keys() == wanted


@pytest.mark.slow
@pytest.mark.parametrize("name, step", [
    *(pytest.param(name, 1, marks=[pytest.mark.long] if name in LONG else []) for name in ALL),
    *((name, 6) for name in DRAWN)])  # of each sixth case
def test_a_command_answers_as_it_is_recorded(name, step, tmp_path):
    every = recorded(name)
    before = {key: every[key] for key in sorted(every)[::step]}
    wanted = before.__contains__ if step > 1 else lambda key: True
    assert differences(before, now(name, tmp_path, wanted), RELATIVE.get(name, USUAL)) == []


def test_differences_are_seen_and_last_digits_are_not():
    before = {"fate": "bounded", "extremes": [[1.0, 2.0]], "n": 3,
              "because": "reached after 12.5 s at 2 of 4"}
    same = {"fate": "bounded", "extremes": [[1.0 + 1e-15, 2.0 - 1e-12]], "n": 3,
            "because": "reached after 12.6 s at 2 of 4"}
    assert differences(before, same, USUAL) == []
    for key, value in (("fate", "spins up"), ("extremes", [[1.0, 2.0 + 1e-9]]), ("extremes", [[1.0, None]]),
                       ("n", 4),
                       ("because", "reached after 12.5 s at 3 of 4"),
                       ("because", "reached after 13.5 s at 2 of 4")):
        assert len(differences(before, {**before, key: value}, USUAL)) == 1
    assert differences(before, {"fate": "bounded"}, USUAL)


@pytest.mark.parametrize("name, key, found", [
    ("fate", "a-case", {"exit": 0, "message": "", "answer": [{"fate": "bounded", "at": [0.1, 1e-300, None]}]}),
    ("fate-text", "a-case", {"exit": 2, "message": "first: line\n  second\n", "answer": ""}),
    ("show", "a-case", {"exit": 0, "message": "", "answer": "first\n\nω' = 2\n"}),
    ("words", "when cases/a.toml --rate 2 rad/s", {"exit": 3, "message": "", "answer": "a: NEVER\n"}),
    ("page", "a-case", {"headline": "x" * 200, "rows": [[1, "2"], []], "none": None})])
def test_a_record_is_text_that_is_read_back_and_written_only_where_answers_differ(
        monkeypatch, tmp_path, name, key, found):
    monkeypatch.setattr(answers, "HERE", tmp_path)
    assert len(record(name, {key: found})) == 1
    assert recorded(name) == {key: found}
    assert record(name, {key: found}) == []
    assert len(record(name, {"another": found})) == 2  # one file more, one less
