"""The judge of every fuzzed case file: a good case, or a CaseError that a terminal can show."""
import math

from stabilab.case.read import Case, load, load_all
from stabilab.errors import CaseError

# characters of all messages about one file: 10,000 faults would help nobody, nor would a screenful of one
LONGEST = 200_000
# these may name no line
WHOLE_FILE = ("expected a table [body]", "longer than", "exceed the largest double", "more than 4000 digits")


def judged(raw: bytes, path) -> list[Case] | CaseError:
    """What becomes of a file with these bytes; anything but cases or a CaseError in order is an
    AssertionError or comes through."""
    path.write_bytes(raw)
    try:
        cases = [load(path), *load_all(path)]
    except CaseError as error:
        _in_order(error, str(path), lines=raw.count(b"\n") + 1)
        return error
    for case in cases:
        numbers = (*(case.state or ()), *(case.span or ()),
                   *(v for block in case.blocks.values() for v in block))
        assert all(map(math.isfinite, numbers)), numbers
        assert case.span is None or case.span[0] < case.span[1], case.span
    return cases


def _in_order(error: CaseError, path: str, lines: int):
    shown = str(error)
    assert error.problems and len(shown) <= LONGEST, len(shown)
    for text in shown.split("\n"):
        assert text.startswith(path + ":"), text  # a message of two lines would not
        assert text.isprintable(), text           # nor may a file send escape codes to the terminal
    for problem in error.problems:
        assert problem.message, error
        if problem.line is None:
            assert problem.message.startswith(WHOLE_FILE) or any(words in problem.message
                                                                 for words in WHOLE_FILE), problem
        else:
            assert 1 <= problem.line <= lines, problem
