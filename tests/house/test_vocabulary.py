"""Pages, help and answers use the field's words (`docs/glossary.md`), none of our own."""
import ast
import html
import json
import re
from pathlib import Path

import pytest

from stabilab import load
from stabilab.show.explore import serve
from stabilab.show.explore.pictures import unframed
from stabilab.show.explore.session import Session
from tests.house.rooms import PACKAGE, tree_of
from tests.recorded.answers import ALL, recorded

ROOT = Path(__file__).resolve().parents[2]
# words that stood for: reported, page or part, the user's pointer, exactly as written, compared with, direction
# of spin, branch of the separatrix
OURS = re.compile(r"\b(told|houses?|doors?|your hand|the hand|(?:moving|resting) hand|at its word|"
                  r"held against|holds against|(?:positive|negative|its|which) sense|sense of (?:the )?spin|"
                  r"(?<!data )sheets?|certificate fires)\b", re.IGNORECASE)
# of answers also: trajectory, stays on, is constant, needs, intermediate axis, and a key of JSON
SAID = re.compile(OURS.pattern + r"|\b(sense|the way there|its way|keeps? to|kept|is asked of|at hand|"
                  r"laws kept|margin: none|middle axis|the fate changes)\b", re.IGNORECASE)
MADE = ("commands.md", "changelog.md", "readme.md", "contributing.md", "results.md")  # of other files
PAGES = [ROOT / "README.md", *(page for page in sorted((ROOT / "docs").glob("*.md")) if page.name not in MADE)]
# what every command says of all cases, which test_recorded compares with what it says now
RECORDS = sorted(set(ALL) - {"audit", "certificates"})  # of papers; keys of a format
NAME = re.compile(r"middle-axis-?[\w-]*")  # of a case


def prose(text):
    """A page without its blocks of code, code in lines, and addresses of links."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"`[^`\n]*`", "", re.sub(r"\]\([^)]*\)", "]", text))


def ours(text, words=OURS):
    return [found[0] for found in words.finditer(NAME.sub("", text))]


@pytest.mark.parametrize("page", PAGES, ids=[page.stem for page in PAGES])
def test_a_page_has_none_of_our_own_words(page):
    assert ours(prose(page.read_text(encoding="utf-8"))) == []


@pytest.mark.parametrize("notebook", sorted((ROOT / "docs/notebooks").glob("*.ipynb")), ids=lambda path: path.stem)
def test_a_notebook_has_none_of_our_own_words(notebook):
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    assert ours(prose("\n\n".join("".join(one["source"]) for one in cells if one["cell_type"] == "markdown"))) == []


def test_the_help_of_every_command_has_none_of_our_own_words(stabilab):
    from stabilab.show.command_groups import GROUPS
    for _, names in GROUPS.values():
        for name in names:
            assert ours(stabilab(name, "--help")[1]) == [], name


def texts(said):
    """All texts of an answer but its keys, which scripts read and which therefore stay."""
    if isinstance(said, str):
        yield said
    elif isinstance(said, (list, dict)):
        for one in said.values() if isinstance(said, dict) else said:
            yield from texts(one)


@pytest.mark.parametrize("record", RECORDS)
def test_the_answers_about_all_cases_have_none_of_our_own_words(record):
    for command, said in recorded(record).items():
        if command.endswith("--csv"):  # names of columns are keys
            said = said | {"answer": said["answer"].partition("\n")[2]}
        assert ours("\n".join(texts(said)), SAID) == [], command


@pytest.mark.parametrize("case", [pytest.param("phone", marks=pytest.mark.slow), "upper-stage", "wheel-and-thruster"])
def test_what_is_said_of_a_surface_which_is_not_recorded_has_none_either(stabilab, tmp_path, case):
    *_, out, err = stabilab("surface", ROOT / f"cases/{case}.toml", "--out", tmp_path)
    assert ours(out + err, SAID) == []


def read(page):
    """The words of a page of HTML: without tags, scripts and what is typed, but with alternative texts."""
    spoken = " ".join(re.findall(r'\b(?:alt|aria-label|title|placeholder)="([^"]*)"', page))
    page = re.sub(r"<(script|style|pre|code)\b.*?</\1>", " ", page, flags=re.DOTALL)
    return html.unescape(f"{re.sub(r'<[^>]+>', ' ', page)} {spoken}")


@pytest.mark.parametrize("case", [pytest.param("phone", marks=pytest.mark.slow),
                                  *(pytest.param(name, marks=[pytest.mark.slow, pytest.mark.long])
                                    for name in ("cubesat-3u", "charged-body"))])
def test_the_pages_about_a_case_have_none_of_our_own_words(stabilab, tmp_path, case):
    assert stabilab("report", ROOT / f"cases/{case}.toml", "--out", tmp_path)[0] == 0
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "<h1>" in page and ours(read(page), SAID) == []
    names = re.findall(r'<(?:h2|h3|div) id="([^"]+)"', page)
    links = re.findall(r'class="anchor" href="#([^"]+)"', page)
    assert names == links and len(set(names)) == len(names) > 5 and not re.search("<h[23]>", page)
    assert '<a class="skip" href="#main">' in page and 'id="main"' in page
    assert "alt=" in page and not re.search(r'<img(?![^>]* alt="[^"]{10})', page)  # each picture in words


@pytest.mark.parametrize("case", ["thruster-stuck-major-axis", "cubesat-3u", "charged-sweep", "minor-axis-100"])
def test_the_explorer_has_none_of_our_own_words(case):
    session = Session(load(ROOT / f"cases/{case}.toml"))
    assert ours(read(serve.page(session.about(), "explore-server.js", serve.HOW)), SAID) == []
    for asked in ({}, {"moving": True, "torque": {"axis": 1, "size": "0.02", "tilt": "2", "azimuth": "0"}}):
        answer, _ = unframed(session.answer(asked))
        answer.pop("toml")  # a case file
        assert answer["headline"] and ours("\n".join(texts(answer)), SAID) == []


@pytest.mark.parametrize("script", ["explore", "explore-plots", "explore-browser", "turning", "space", "atlas"])
def test_what_a_script_writes_on_a_page_has_none_of_our_own_words(script):
    text = (ROOT / f"stabilab/show/templates/{script}.js").read_text(encoding="utf-8")
    said = re.findall(r'"[^"\n]*"|`[^`\n]*`', re.sub(r"(?<!:)//.*", "", text))
    assert len(said) > 5 and ours("\n".join(said), SAID) == []


NOT_NAMES = set("one found told asked seen way given known made least most near share words place kept haze spot leaves "
                "stated whole alike".split())


def test_names_in_the_code_are_seldom_words_of_our_own():
    """CONTRIBUTING.md has the table; those that are left are public arguments, fields and keys."""
    names = [getattr(node, {ast.Name: "id", ast.arg: "arg", ast.Attribute: "attr"}.get(type(node), "name")).strip("_").lower()
             for path in PACKAGE.rglob("*.py") for node in ast.walk(tree_of(path))
             if isinstance(node, (ast.Name, ast.arg, ast.Attribute, ast.FunctionDef, ast.ClassDef))]
    assert sum(name in NOT_NAMES for name in names) < 0.01 * len(names)
