"""`stabilab papers`: nothing of a paper is missing. Numbers of equations, figures and tables are the papers' own."""
import json
from collections import Counter

import pytest

# paper -> (last equation, figures, tables): as printed in each paper
CONTENTS = {"constant-torque-gyrostat": (84, 17, {"1", "2", "3", "4"}), "liquid-cavity": (26, 13, set())}


@pytest.mark.slow  # the audit of a paper takes five seconds
@pytest.mark.parametrize("paper", CONTENTS)
def test_every_equation_figure_and_table_has_a_verdict_and_a_place(stabilab, paper):
    equations, figures, tables = CONTENTS[paper]
    rows = json.loads(stabilab("papers", paper, "--json")[1])["rows"]
    items = Counter(row["item"] for row in rows)
    assert max(items.values()) == 1
    numbered = {item for item in items if item.startswith("(")}
    assert {f"({n})" for n in range(1, equations + 1)} <= {item.rstrip("abcd)") + ")" for item in numbered}
    assert {item for item in items if item.startswith("figure")} == {f"figure {n}" for n in range(1, figures + 1)}
    assert {item for item in items if item.startswith("table")} == {f"table {n}" for n in tables}
    assert items["data"] == 1
    assert all(row["verdict"] for row in rows)
    assert all(row["place"] for row in rows)
