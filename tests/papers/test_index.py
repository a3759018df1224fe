"""`stabilab papers`: nothing of a paper is missing. Numbers of equations, figures and tables are the papers' own."""
import json
import re
from collections import Counter
from pathlib import Path

import pytest

from stabilab.papers import index, table
from stabilab.papers.figures import catalogue
from stabilab.theories.printed.claims import paper as paper_named

ROOT = Path(__file__).resolve().parents[2]

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


@pytest.fixture(scope="module")
def items():
    return index.items(index.recorded())


def test_every_item_has_a_verdict_a_command_that_exists_and_a_place_of_its_own(items):
    assert len(items) > 450 and all(item.verdict and item.page for item in items)
    names = {item.place.split()[2] for item in items if item.place.split()[1] == "audit"}
    equations = {name: {row.equation for row in paper_named(name).rows} for name in names}
    for item in items:
        words = item.place.split()
        if words[1] == "audit":
            assert words[4] in equations[words[2]]
        elif words[1] == "figures":
            name = words[words.index("--paper") + 1] if "--paper" in words else catalogue.FIRST
            number = next(int(word) for word in words if word.isdigit())
            assert catalogue.figure(number, name).number == int(item.item.removeprefix("figure "))
        elif words[1] == "show":
            assert (table.cases_folder() / words[2].removeprefix("cases/")).is_file()
        else:
            assert item.place == index.TABLES
    places = Counter(item.page for item in items)
    assert max(places.values()) == 1, places.most_common(3)


def test_the_page_of_the_docs_is_that_of_the_record_and_leads_to_what_is_there(items):
    text = (ROOT / "docs/papers.md").read_text(encoding="utf-8")
    assert text == index.markdown(index.recorded())
    assert text.count("\n| [figure") + len(re.findall(r"\n\| (?:\(|text|data|integrals|table)", text)) == len(items)
    links = re.findall(r"\]\(([^)]+)\)", text)
    assert len(links) > 60 and all((ROOT / "docs" / link).is_file() for link in links)


def test_the_list_in_a_terminal_has_all_items_and_their_places(stabilab, items):
    code, out, _ = stabilab("papers")
    assert code == 0
    flat = " ".join(out.split())
    for item in items:
        assert f" {item.item} " in flat
        if item.item.startswith(index.NAMED):  # of the others the head of the list says how both are formed
            assert item.place in flat and item.page in flat
    rows = json.loads(stabilab("papers", "--json")[1])["rows"]
    assert [row["page"] for row in rows] == [item.page for item in items]
