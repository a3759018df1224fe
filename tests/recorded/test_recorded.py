"""The program says of every case what it said when it was recorded: words, labels and levels exactly, numbers
to their tolerance."""
import pytest

from .answers import ALL, RELATIVE, USUAL, differences, now, recorded

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
