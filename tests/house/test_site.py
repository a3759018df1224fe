"""The site of the documentation: `make docs` builds it and ends at a warning; what its pages hold is told
here without Sphinx."""
import inspect
import re
import runpy
import sys
from xml.etree import ElementTree

import pytest

import stabilab

from .test_readme import MADE, ROOT, make_knows

sys.path.insert(0, str(ROOT / "docs"))
from making import commands, gallery, notebooks, reference

CASES = sorted((ROOT / "cases").glob("*.toml"))
NOTEBOOKS = sorted((ROOT / "docs/notebooks").glob("*.ipynb"))
STEMS = sorted(path.stem for path in CASES)


def pages():
    """Every page that is written by hand, from docs/."""
    made = {"_site", gallery.FOLDER, notebooks.FOLDER}
    return {path.relative_to(ROOT / "docs").with_suffix("").as_posix()
            for path in (ROOT / "docs").rglob("*.md")
            if not made & set(path.relative_to(ROOT / "docs").parts) and path.name not in MADE
            and path != ROOT / "docs/index.md"}


def contents(page, folder=""):
    """What the tables of contents of a page list."""
    tables = re.findall(r"```{toctree}\n(.*?)```", (ROOT / "docs" / page).read_text(encoding="utf-8"), re.S)
    return {folder + name for name in re.findall(r"^(?:.*<)?([\w/-]+)>?$", "\n".join(tables), re.M)}


def test_every_page_stands_in_the_contents_of_the_site():
    assert contents("index.md") | contents("mathematics/index.md",
                                           "mathematics/") == pages() | {f"notebooks/{path.stem}"
                                                                         for path in NOTEBOOKS} \
        | {name.removesuffix(".md") for name in MADE}
    assert "-m sphinx" in make_knows("docs") and "-W" in make_knows("docs") and "make docs" in (
        ROOT / ".ci/run").read_text()


def test_every_public_name_stands_in_the_reference():
    text = reference.text()
    assert all(f":: stabilab.{name}\n" in text for name in stabilab.__all__
               if name not in ("plot", "__version__"))


def test_every_command_stands_on_its_page_by_the_question_it_answers(stabilab):
    text = commands.text()
    listed = re.findall(r"^  ([a-z][a-z-]+) {2,}\S", stabilab("--help")[1], re.M)
    rows = re.findall(r"^\| ([A-Z].*\?) \| `stabilab ([a-z-]+) ?(.*)` \|$", text, re.M)
    assert [name for _, name, _ in rows] == listed and len({question for question, *_ in rows}) == len(rows) > 30
    for name in ("fate", "sweep", "import"):
        (example,) = [rest for _, one, rest in rows if one == name]
        assert f"Example: stabilab {name} {example}" in " ".join(stabilab(name, "--help")[1].split())


def public():
    """(name, function or class) of everything public, the plots among it."""
    return [(name, getattr(stabilab, name)) for name in stabilab.__all__
            if name not in ("plot", "__version__")] \
        + [(f"plot.{name}", getattr(stabilab.plot, name)) for name in stabilab.plot.__all__]


def test_every_public_function_has_types_and_says_what_it_takes_and_refuses():
    functions = [(name, thing) for name, thing in public() if inspect.isfunction(thing)]
    assert len(functions) > 25
    for name, function in functions:
        signature, says = inspect.signature(function), inspect.getdoc(function)
        bare = ([p.name for p in signature.parameters.values() if p.annotation is p.empty]
                + ["return"] * (signature.return_annotation is signature.empty))
        assert not bare, f"{name}: no type for {', '.join(bare)}"
        assert re.search(r"Raises|InputError",
                         says) or name.startswith("plot."), f"{name}: what does it refuse?"


def test_every_public_class_says_its_units_or_what_it_stands_for():
    units = ("kg", "rad/s", "N m", "1/s", "N,", "scene's time", "dimensionless", "word", "user")
    for name, thing in public():
        if inspect.isclass(thing):
            assert any(unit in inspect.getdoc(thing) for unit in units), name


UNDRAWN = {"file": "a.png", "size": [2, 1], "narrow": {"file": "a-narrow.png", "size": [1, 1]}}


def test_every_case_stands_in_the_gallery_under_its_outcome_below_the_questions(tmp_path, monkeypatch):
    from stabilab.papers.report import LOOKS
    outcomes = list(LOOKS.values())

    def undrawn(path, folder):
        return {"picture": UNDRAWN, "title": path.stem, "source": "", "scene": 0, "group": outcomes[len(path.stem) % 4],
                "kind": "time", "answer": "none", "card": f"{path.stem}-card.png", "badge": "bounded",
                "look": "bounded", "line": "none"}

    monkeypatch.setattr(gallery, "made", undrawn)
    monkeypatch.setattr(gallery.cards, "draw", lambda about, case, path: path.touch())
    assert sorted(gallery.write(tmp_path)) == STEMS
    page = (tmp_path / "gallery.md").read_text(encoding="utf-8")
    titles = re.findall(r"^## \[(.*)\]\((.*)\)$", page, re.M)
    assert [title for title, _ in titles] == outcomes
    held = [name for _, path in titles
            for name in re.findall(r"^## (.*)$", (tmp_path / path).read_text(encoding="utf-8"), re.M)]
    asked = re.findall(r'<a href="([\w-]+)\.html">', page[:page.index(titles[0][0])])
    assert len(asked) == 5 and all((ROOT / f"docs/{guide}.md").exists() for guide in asked)
    assert sorted(held) == STEMS and all(f'src="_static/{name}-card.png"' in page for name in held)


def test_a_case_of_the_gallery_has_picture_answer_file_and_commands_and_is_kept_until_it_changes(
    tmp_path, monkeypatch):
    folder = tmp_path / gallery.FOLDER
    (minor,) = [path for path in CASES if path.stem == "minor-axis-100"]
    monkeypatch.setattr(gallery.cards, "draw", lambda about, case, path: None)
    gallery.write(tmp_path, [minor])
    card = (tmp_path / "gallery.md").read_text(encoding="utf-8")
    assert '<b class="conditional">bounded on a condition</b><strong>Torque on the minor axis' in card
    assert (folder / "cards" / "minor-axis-100-card.png").stat().st_size < 20_000
    page = (folder / "bounded-on-a-condition-or-undecided.md").read_text(encoding="utf-8")
    assert "BOUNDED only while the torque is exactly along x3" in page and minor.read_text(
        encoding="utf-8") in page
    assert "stabilab plot cases/minor-axis-100.toml --kind phase" in page and "λ1 = 100" in page
    for name in ("minor-axis-100.png", "minor-axis-100-narrow.png"):  # the other one on telephones
        assert (folder / "cards" / name).read_bytes().startswith(b"\x89PNG") and f'="../_static/{name}"' in page
    (gone := folder / "cards" / "of-a-case-that-is-gone.png").touch()
    with monkeypatch.context() as patch:
        patch.setattr(gallery, "made", lambda path, folder: pytest.fail("drawn again"))
        gallery.write(tmp_path, [minor])
    assert not gone.exists()
    (changed := tmp_path / minor.name).write_text(minor.read_text(encoding="utf-8") + "# more\n",
                                                  encoding="utf-8")
    drawn = []
    monkeypatch.setattr(gallery, "made", lambda path, folder: drawn.append(path)
                        or {"picture": UNDRAWN, "title": "", "source": "", "scene": 0, "group": "Bounded for ever", "kind": "",
                            "answer": "", "card": "", "badge": "", "look": "", "line": ""})
    gallery.write(tmp_path, [changed])
    assert drawn == [changed]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_a_notebook_is_whole_and_its_page_has_every_cell_picture_and_link(path):
    notebook = notebooks.read(path)
    text, pictures = notebooks.page(path)
    assert notebook["nbformat"] == 4 and all("id" in cell for cell in notebook["cells"])
    assert all("".join(cell["source"]) in text for cell in notebook["cells"][1:]) and text.startswith("# ")
    assert len(pictures) == text.count("![What the cell above draws]") >= 1 and all(
        drawn.startswith(b"\x89PNG") for drawn in pictures.values())
    assert all((path.parent / target.split("#")[0]).exists()
               for target in re.findall(r"\]\((\.\./[^)]+)\)", text))


def test_a_cell_shows_what_it_prints_its_value_and_its_own_figures():
    from matplotlib import pyplot as plt
    # a figure that somebody else left open is none of the cell's
    others = [plt.figure(figsize=(1, 1)).number, *plt.get_fignums()]
    made = notebooks.outputs("import matplotlib.pyplot as plt\nprint(1)\na = 2\na + 1", names := {}, 1)
    assert [one["output_type"] for one in made] == ["stream", "execute_result"] and names["a"] == 2
    assert notebooks.texts({"cells": [{"outputs": made}]}) == ["1\n", "3"]
    (drawn,) = notebooks.outputs("_ = plt.subplots(figsize=(1, 1))", names, 2)
    assert drawn["output_type"] == "display_data" and sorted(set(others)) == plt.get_fignums()
    plt.close(others[0])


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_a_notebook_that_is_run_today_prints_what_it_shows(path):
    kept = notebooks.read(path)
    assert notebooks.texts(notebooks.executed(kept)) == notebooks.texts(kept)


@pytest.fixture
def conf(monkeypatch):
    """What docs/conf.py defines."""
    pytest.importorskip("sphinx")
    monkeypatch.setattr(sys, "path", list(sys.path))  # conf.py puts its own folders there
    return runpy.run_path(str(ROOT / "docs/conf.py"))


def test_words_have_the_signs_of_a_book_and_commands_stay_as_they_are_typed(conf):
    from docutils import nodes
    from docutils.utils import new_document
    page = new_document("page")
    page += [nodes.paragraph("", "", nodes.Text("x is -5, to "), nodes.literal("", "f -5")),
             nodes.paragraph("",
                             "alpha’’ = U’, the papers’ 1 - x1’, 0.25 us with us, x^2 + A^(1/2) in N m^-1, 2 "
                             "of test_x - one - by the bodies’"),
             nodes.paragraph("", "one-sided - as ever")]
    conf["set_as_a_book"](None, page)
    assert page[0].astext() == "x is −5, to f -5"
    assert page[
        1].astext() == "alpha″ = U′, the papers’ 1 − x1′, 0.25 µs with us, x2 + A1/2 in N m−1, 2 of test_x − one − by the bodies’"
    assert [one.astext() for one in page[1].findall(nodes.superscript)] == ["2", "1/2", "−1"]


@pytest.mark.parametrize(("written", "told"), [
    ("[docs/atlas.md](atlas.md) and [benchmarks/RESULTS.md](../benchmarks/RESULTS.md)",
     "[](atlas.md) and [](results.md)"),
    ("[the README](../README.md), [docs/index.md](index.md)",
     "[the README](readme.md), [docs/index.md](index.md)"),
    ('takes [2 us](../benchmarks/RESULTS.md#arrays-plain "theirs").',
     'takes <a href="results.html#arrays-plain">2 us</a>.')])
def test_a_link_that_a_file_names_has_the_heading_of_the_page(conf, written, told):
    source = [written]
    conf["point_inside"](None, "page", source)
    assert source == [told]


def test_a_record_shows_its_fields_as_its_signature():
    shown, returned = reference.of_fields(None, "class", "stabilab.Body", stabilab.Body, None,
                                          "(*given: Any, **named: Any)", "Any")
    # and not what the class works out of them
    assert re.fullmatch(r"\(inertia: [^,]+, mass: [^,]+ = None, slack: [^,]+ = None\)",
                        shown) and returned == "Any"
    assert reference.of_fields(None, "class", "", stabilab.Fate, None, "", "") is None
    assert "expect: dict = dict()" in reference.of_fields(None, "class", "stabilab.Case", stabilab.Case, None,
                                                          "", "")[0]


def plain(made):
    """The signs of a formula in MathML, in order; a thin space as a blank."""
    return "".join(" " if sign.tag.endswith("mspace") else (sign.text or "").strip()
                   for sign in ElementTree.fromstring(made).iter())


def test_formulas_are_set_as_latex_sets_them():
    pytest.importorskip("latex2mathml")
    from making import mathml
    made = mathml.formula("8c^3 + 2cm - n > 0")
    assert plain(made) == "8c3+2cm−n>0" and "<mn>2</mn>" in made  # two times c times m, no centimetres
    assert mathml.formula(r"\gamma_0''^2").count("<msubsup>") == 1 and plain(
        mathml.formula(r"\gamma_0''^2")) == "γ0′′2"
    assert "<mfrac><mn>1</mn><mi>h</mi></mfrac>" in mathml.formula(r"c + \frac1h")
    assert plain(mathml.formula(r"A\cos\varphi\sin^2(x)")) == "A cos φ sin2(x)"
    assert plain(mathml.formula(r"L := \infty")) == "L≔∞" and "<mi>∞</mi>" in mathml.formula(r"s = \infty")
    assert 'lspace="0.278em" rspace="0.278em"' in mathml.formula(r"c \sim v")
    assert mathml.formula("|c|/x").count('lspace="0" rspace="0"') == 3
    assert [plain(one)
            for one in mathml.equations(r"a = b, \qquad \left(c \quad d\right) = e, \quad f")] == [
                "a=b,", "(c d)=e,", "f"]
