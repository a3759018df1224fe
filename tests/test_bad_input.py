"""Whatever stands in a case file: it is a case, or an error that names file and line; nothing in it is ever run."""
from fractions import Fraction

import pytest
from hypothesis import HealthCheck, given, settings

from stabilab import case_sweep
from stabilab.case import load
from stabilab.errors import CaseError, printable

from .fuzz.grammar import mutated_cases, written_cases
from .fuzz.judge import judged

QUICK = settings(max_examples=400, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


@QUICK
@given(written_cases())
def test_a_file_by_grammar_is_a_case_or_names_its_faults(tmp_path_factory, raw):
    judged(raw, tmp_path_factory.getbasetemp() / "written.toml")


@QUICK
@given(mutated_cases())
def test_a_mutated_case_is_a_case_or_names_its_faults(tmp_path_factory, raw):
    judged(raw, tmp_path_factory.getbasetemp() / "mutated.toml")


# -- what fuzzing found ------------------------------------------------------------------------------------------------

BODY = "[body]\ninertia = [3, 2, 1]\n"


@pytest.fixture
def judge(tmp_path):
    """The words of the faults of a text, or its cases."""
    def result(text):
        found = judged(text.encode(), tmp_path / "my.toml")
        return found if isinstance(found, list) else [printable(p.message) for p in found.problems]
    return result


def test_a_long_number_with_a_wrong_letter_is_refused_at_once(judge):
    """A pattern that could match digits in many ways tried them all: 2^50 of them."""
    (message,) = judge(BODY + f'[motion]\nx = [0, 0, "{"1234567890" * 30}b1"]\n[effects.constant_torque]\nmu = [0, 0, 1]\n')
    assert "expected a decimal or a ratio" in message


@pytest.mark.parametrize("number", ["1\\t/\\t2", " 1 / 2 ", "\\n1/2"])
def test_a_ratio_may_have_any_blank_in_it(judge, number):
    one, *_ = judge(f'[scaled]\na = "{number}"\nb = 1\nmu = [0, 0, 1]\n')
    assert one.scene.exact_ab == (Fraction(1, 2), 1)


@pytest.mark.parametrize("number", ["١", "１", "1\\u00a0/2", "1__0", "1_", "_1", "1e", ".", "0x1", "1e12345", "", " "])
def test_what_only_looks_like_a_number_is_refused(judge, number):
    (message,) = judge(f'[scaled]\na = "{number}"\nb = 1\nmu = [0, 0, 1]\n')
    assert "expected a decimal or a ratio" in message


@pytest.mark.parametrize("text, words", [
    ('[scaled]\na = "\\u001b[31m\\u0007"\nb = 1\nmu = [0, 0, 1]\n', "\\x1b[31m\\x07"),
    (BODY + '"\\u202e" = 1\n', "unknown key"), ('title = "\\u001b[2J"\n' + BODY, "U+001B"),
    ('source = "a\\u202eb"\n' + BODY, "U+202E"), (BODY + '[effects]\n"a\\nb.toml:1: forged" = 1\n', "unknown effect")])
def test_no_file_sends_escape_codes_or_forges_a_line(judge, text, words):
    """`judged` looks at every character of the message."""
    (message,) = judge(text)
    assert words in message


def test_a_file_of_ten_thousand_faults_is_answered_with_the_first_fifty(judge, tmp_path):
    messages = judge(BODY + "".join(f"k{i} = 1\n" for i in range(10_000)))
    assert len(messages) == 10_000
    with pytest.raises(CaseError, match=f"and {10_000 - CaseError.SHOWN} more$") as caught:
        load(tmp_path / "my.toml")
    assert str(caught.value).count("\n") == CaseError.SHOWN


def test_one_case_of_a_sweep_file_makes_no_combinations(tmp_path, monkeypatch):
    """10,000 combinations of a large file would be copied only to be thrown away."""
    path = tmp_path / "my.toml"
    path.write_text(BODY + '[sweep]\n"body.inertia" = [[1, 1, 1], [2, 2, 1]]\n')
    monkeypatch.setattr(case_sweep, "_with", lambda *_: pytest.fail("a combination was made"))
    assert load(path).scene.body.exact == (3, 2, 1)
