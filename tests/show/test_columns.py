"""Tables of sweeps on a terminal. Expected: every cell stands once (the keys in each table), below its head,
and no line is too wide."""
import re
from pathlib import Path

import pytest

from stabilab.show.terminal import page

CASES = Path(__file__).parents[2] / "cases"
HEADS = ["torque[3]", "momentum[1]", "fate", "ω1 least", "ω1 most", "period"]
ROWS = [HEADS, ["N m", "N m s", "", "deg/s", "deg/s", "s"], ["0.1", "4", "bounded", "-1.5", "22.25", ""],
        ["0.2", "5", "spin-up", "", "3", "7"]]


@pytest.mark.parametrize("width", [None, 200, 66, 50, 45, 40, 10])
def test_columns_that_do_not_fit_go_on_in_a_table_below_with_their_keys(width):
    parts = "\n".join(page.table(ROWS, 2, width)).split("\n\n")
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


def test_a_sweep_tells_rates_in_the_units_of_the_case_under_heads_that_are_those_of_the_extremes(
    stabilab, monkeypatch):
    """Against the CSV of the same sweep, which is in rad/s."""
    words = ("sweep", CASES / "two-wheels-minor-axis.toml", "--vary", "torque[3]=0.1:0.5:3", "--answer",
             "fate,extremes")
    monkeypatch.setattr(page, "width", lambda stream=None: None)
    lines, csv = (stabilab(*words, *more)[1].splitlines() for more in ([], ["--csv"]))
    head = next(n for n, line in enumerate(lines) if line.startswith("  torque"))
    assert re.split("  +", lines[head].strip()) == ["torque[3]", "fate",
                                                    *(f"ω{n} {end}" for end in ("least", "most")
                                                      for n in (1, 2, 3))]
    rates = [[float(cell) for cell in row.split(",")[3:9]] for row in csv[1:]]
    for line, row in zip(lines[head + 2:], rates):
        assert [float(cell)
                for cell in line.split()[2:]] == pytest.approx([57.29577951308232 * value for value in row],
                                                               rel=1e-5)
    assert "rad/s" not in "".join(lines)
