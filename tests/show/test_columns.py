"""Tables of sweeps on a terminal. Expected: every cell stands once (the keys in each table), below its head,
and no line is too wide."""
import re

import pytest

from stabilab.show import terminal

HEADS = ["torque[3]", "momentum[1]", "fate", "ω1 least", "ω1 most", "period"]
ROWS = [HEADS, ["N m", "N m s", "", "deg/s", "deg/s", "s"], ["0.1", "4", "bounded", "-1.5", "22.25", ""],
        ["0.2", "5", "spin-up", "", "3", "7"]]


@pytest.mark.parametrize("width", [None, 200, 66, 50, 45, 40, 10])
def test_columns_that_do_not_fit_go_on_in_a_table_below_with_their_keys(width):
    parts = "\n".join(terminal.table(ROWS, 2, width)).split("\n\n")
    found = {}
    for part in parts:
        lines = part.split("\n")
        assert max(map(len, lines)) <= max(width or 999, 40)
        ends = {head: match.end() for head in HEADS
                for match in [re.search(rf"(?<= ){re.escape(head)}(?=  |$)", lines[0])] if match}
        assert ends and ("torque[3]" in ends)
        starts = dict(zip(ends, [0, *sorted(ends.values())]))
        for head, end in sorted(ends.items(), key=lambda one: one[1]):
            found.setdefault(head, set()).add(tuple(line[starts[head]:end].strip() for line in lines))
    assert found == {head: {column} for head,
                     column in zip(HEADS, zip(*ROWS))} and (width is None) <= (len(parts) == 1)
