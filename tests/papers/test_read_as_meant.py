"""The source of the audit is a machine-read text: slips of a mark that a neighbouring line contradicts are read as
meant, and the note of the row says so; no row counts such a slip as an error of its paper."""
import re

import pytest

from tests.papers.recorded import PAPERS, RECORDED

MEANT = {("newtonian-field-top", "3"), ("newtonian-field-top", "6"), ("newtonian-field-top", "13"),
         ("newtonian-field-top", "17"), ("newtonian-field-top", "29"), ("newtonian-field-top", "42"),
         ("liquid-cavity", "7"),
         *(("charged-axisymmetric-short", n) for n in ("3", "11", "13", "17", "18", "26", "27"))}


def test_a_row_that_is_read_as_meant_says_so_and_is_not_wrong():
    rows = {(name, row.equation) for name, paper in PAPERS.items() for row in paper.rows
            if "read as meant: " in row.options.get("note", "")}
    assert rows == MEANT
    assert "wrong" not in {RECORDED[name][equation] for name, equation in rows}


@pytest.mark.parametrize("name", PAPERS)
def test_no_correction_changes_one_mark_alone(name):
    """A digit of an index, or an exponent in its place, and nothing else: a slip of the reading."""
    marks = re.compile(r"([A-Za-z]+)(?:\d+|\*\*\d+)?")
    of = lambda formula: [(match[1], match[0]) for match in marks.finditer(formula)]
    for row in PAPERS[name].rows:
        # the undefined letter of liquid-cavity (19) is typed as d3
        if (row.equation.startswith("text") or row.kind in ("test", "number")
                or (name, row.equation) == ("liquid-cavity", "19")):
            continue
        for printed, corrected in zip(row.printed, row.corrected) if len(row.printed) == len(row.corrected) else ():
            old, new = of(printed), of(corrected)
            rest = marks.sub("_", printed) == marks.sub("_", corrected)
            same_letters = [letter for letter, _ in old] == [letter for letter, _ in new]
            assert not (rest and same_letters and sum(a != b for a, b in zip(old, new)) == 1), row.place
