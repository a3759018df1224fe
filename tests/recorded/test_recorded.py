"""The program says of every case what it said when it was recorded: words, labels and levels exactly, numbers
to their tolerance."""
import pytest

from . import answers
from .answers import ALL, RELATIVE, USUAL, differences, now, record, recorded

# The words of these are made from the JSON of the same command: long
LONG = {"audit",  # which tests/papers/test_audit.py holds against the equations
        "classify-text", "fate-text", "period-text", "stuck-text"}


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] if name in LONG else [])
                                  for name in ALL])
def test_a_command_answers_as_it_is_recorded(name, tmp_path):
    assert differences(recorded(name), now(name, tmp_path), RELATIVE.get(name, USUAL)) == []


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
