"""Every item of the papers leads to a place that is there, and the claims of the main paper stand on its page."""
import re
from types import SimpleNamespace

import pytest
from markupsafe import Markup

from stabilab.papers import index, table
from stabilab.papers.audit import page
from stabilab.papers.figures import catalogue
from stabilab.papers.table import html_fragment
from stabilab.show.report import html
from stabilab.theories.printed.claims import MAIN, paper, papers


def unaudited(name):
    """(paper, its rows as findings that hold): places do not hang on verdicts, and the audit takes a minute."""
    one = paper(name)
    found = {"verdict": "wrong", "condition": "", "correction": "so", "method": "", "residual": 0.0, "repairs": (),
             "corrected_residual": 0.0, "unit_fault": "", "judged_by": "", "exact_motion": ""}
    return one, [SimpleNamespace(row=row, **found) for row in one.rows]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    found = [unaudited(name) for name in papers()]
    out = tmp_path_factory.mktemp("where")
    index.page(found, out)
    page.page(found, out / "audit.html")
    figure = {"title": "", "caption": "", "tolerance": "", "command": "", "file": "a.png", "size": [1, 1],
              "differences": (), "rows": (), "claims": (), "cases": (), "narrow": None, "more": ()}
    tables = [{"number": one.number, "title": "", "wide": False, "rows": (), "files": (),
               "html": Markup(html_fragment(one))} for one in table.tables()]
    main, others = catalogue.FIRST, [name for name in catalogue.PAPERS if name != catalogue.FIRST]
    html.write(out / "constant-torque.html", "constant_torque.html", title="", paper="", tables=tables,
               data=index.data(), claims=index.claims(*found[0]),
               figures=[figure | {"number": row.number, "id": f"figure-{row.number}",
                                  "cases": index.cases_of(row, {"minor-axis-100": "cases/minor-axis-100.html"})}
                        for row in catalogue.of_paper(main)])
    for name in others:
        chapter = {"id": name, "title": "", "about": "", "paper": "", "problem": "", "parameters": "D",
                   "compared": (), "sensible": None, "end": 1.0,
                   "figures": [figure | {"number": row.number, "id": f"{name}-{row.number}"}
                               for row in catalogue.of_paper(name)]}
        claims = index.claims(*next(one for one in found if one[0].figures == name))
        html.write(out / f"{name}.html", "chapter.html", chapter=chapter, claims=claims)
    index.hard_cases(out)
    return out


@pytest.mark.slow
def test_every_item_of_every_paper_leads_to_a_place_that_is_there(folder):
    """But the models of figure 1, where they are not drawn."""
    pages = {file.name: file.read_text(encoding="utf-8") for file in folder.glob("*.html")}
    links = re.findall(r'<a href="([\w-]+\.html)#([^"]+)">([^<]+)<', pages["where.html"])
    assert len(links) > 300
    missing = [(file, anchor, item) for file, anchor, item in links if f'id="{anchor}"' not in pages[file]]
    assert [item for _, _, item in missing if item != "figure 1"] == []


def test_anchors_of_the_audit_are_unique_and_the_main_paper_is_the_first(folder):
    text = (folder / "audit.html").read_text(encoding="utf-8")
    anchors = re.findall(r'id="([^"]+)"', text)
    assert len(anchors) == len(set(anchors)) and papers()[0] == MAIN
    assert text.index(f'href="#{MAIN}"') < text.index(f'id="{MAIN}"') < text.index('id="charged-axisymmetric"')
    assert f'id="{MAIN}-30"' in text


def test_the_claims_of_every_paper_stand_on_its_page_with_their_rows_of_the_audit(folder):
    audit = (folder / "audit.html").read_text(encoding="utf-8")
    for name in catalogue.PAPERS:
        links = re.findall(r'"audit.html#([^"]+)">not so<', (folder / f"{name}.html").read_text(encoding="utf-8"))
        assert len(links) > 5 and all(f'id="{anchor}"' in audit for anchor in links), name


def test_the_data_of_the_main_paper_are_those_that_it_prints(folder):
    """k1 = 1/4, k2 = 2/3, k3 = 1/2 by hand from D = (2000, 1500, 1000); a = 100/(1000 sqrt(1/4)) = 0.2 and b twice
    that at lambda1 = 100."""
    data = dict(index.data())
    assert data["k1, k2, k3"].startswith("1/4, 2/3, 1/2: ") and "k = k1 k2 k3 = 1/12" in data["k1, k2, k3"]
    assert data["a"].startswith("0.2, 0.6, 1: ") and data["b"].startswith("0.4, 1.2, 2: ")
    text = (folder / "constant-torque.html").read_text(encoding="utf-8")
    assert all(words in text for words in ("CP is a centre", "SP a saddle", "LS and RS", "VC where"))


def test_the_page_of_hard_cases_has_every_row_of_the_docs(folder):
    rows = [line for line in index.HARD.read_text(encoding="utf-8").splitlines() if line.startswith("| ")]
    text = (folder / "hard-cases.html").read_text(encoding="utf-8")
    assert text.count("<tr>") == len(rows) > 40 and text.count("<h2 ") == 2


@pytest.mark.parametrize("name", catalogue.PAPERS)
def test_every_figure_leads_to_the_cases_that_it_draws(name):
    """A combination of a sweep to its row, with its numbers in words; figure 18 alone is of no case of the paper."""
    cases = {path.stem: f"cases/{path.stem}.html" for path in table.cases_folder().glob("*.toml")}
    for row in catalogue.of_paper(name):
        links = index.cases_of(row, cases)
        assert bool(links) != row.added, row.number
        assert all(link["link"].split("#")[0] in cases.values() for link in links)
    if name == "charged":
        links = index.cases_of(catalogue.figure(21, name), cases)
        assert len(links) == len({link["link"] for link in links}) == 7  # three families of three, one in all
        assert links[0] == {"name": "\u03bb3 = 1.3 kg m\u00b2/s, e = 0.003 C, M1 = 4 N m (charged-sweep-1-2-1)",
                            "link": "cases/charged-sweep.html#charged-sweep-1-2-1"}


def test_the_sentences_on_a_figure_stand_beside_it_with_what_they_were_held_against():
    """Of the six figures of the cavity whose wheel is completed: each has what its text says of waves or spirals."""
    one, found = unaudited("liquid-cavity")
    for number in (6, 7, 9, 10, 12, 13):
        beside = index.of_figure(one, found, number)
        assert any(re.search("waves|spirals", row["says"]) for row in beside["claims"]), number
        assert [row["equation"] for row in beside["rows"]] == ["3", "24", "27"]
    words = {verdict: index.of_figure(one, [SimpleNamespace(**vars(row) | {"verdict": verdict}) for row in found],
                                      6)["claims"][0]["word"] for verdict in ("holds", "only-if", "wrong")}
    assert words == {"holds": "right", "only-if": "only if", "wrong": "not so"}
