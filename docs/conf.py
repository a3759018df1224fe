"""The documentation as a site: `make docs` writes it to docs/_site. Sphinx, because the reference comes from
docstrings and a warning can fail the build."""
import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE)]

from docutils import nodes  # noqa: E402
from making import cards, commands, gallery, notebooks, reference, written  # noqa: E402
from sphinx import addnodes  # noqa: E402

import stabilab  # noqa: E402
from stabilab.show.report.html import signed  # noqa: E402

project, author, release = "stabilab", "the stabilab developers", stabilab.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "making.mathml"]
myst_enable_extensions, html_math_renderer = ["dollarmath"], "mathml"
exclude_patterns = ["_site"]
html_theme, html_title = "furo", "stabilab"
(HERE / gallery.FOLDER / cards.FOLDER).mkdir(parents=True, exist_ok=True)  # Sphinx looks before it is written
html_static_path = ["static", f"{gallery.FOLDER}/{cards.FOLDER}"]
html_css_files = ["site.css"]
html_show_copyright = False
# they are fetched page by page, which a browser refuses from the disk: an error for every result
html_show_search_summary = False
myst_heading_anchors = 3
autodoc_typehints, autodoc_typehints_format, maximum_signature_line_length = "signature", "short", 90
autodoc_member_order = "bysource"
autodoc_type_aliases = {"ArrayLike": "ArrayLike"}  # else what it stands for, in private names of NumPy
CHECKED = "Evaluated against the program"
# What stands outside of docs/ has its page here under another name
PAGES = {"README.md": "readme.md", "benchmarks/RESULTS.md": "results.md",
         "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md"}

# A link that is named by its file, as the repository needs it: here by the page's heading. All pages together
# have none
FILES = re.compile(r"\[[\w./-]+\.md\]\(((?!index\.md)[\w./-]+\.md(?:#[\w-]+)?)\)")

# A speed, which leads to its row of the results; what is meant of the row stands in a title
SPEEDS = re.compile(r"\[([^\]\n]*)\]\((?:\.\./)*benchmarks/RESULTS\.md#([\w-]+)(?: \"\w+\")?\)")


def setup(app):
    app.connect("builder-inited", write_pages)
    app.connect("source-read", point_inside)
    app.connect("autodoc-process-docstring", reference.as_rst)
    app.connect("autodoc-process-signature", reference.of_fields)
    app.connect("doctree-read", set_as_a_book)


def write_pages(app):
    """The pages that are made from what the repository holds: what stands outside of docs/, reference,
    notebooks, gallery of cases."""
    for outside, name in PAGES.items():
        text = (HERE.parent / outside).read_text(encoding="utf-8")
        written.page(HERE / name,
                     text.replace("](docs/",
                                  "](").replace("](figures/",
                                                "](../figures/").replace("](CITATION.cff",
                                                                         "](../CITATION.cff"))
    written.page(HERE / "api.md", reference.text())
    written.page(HERE / "commands.md", commands.text())
    notebooks.write(HERE)
    gallery.write(HERE)


def point_inside(app, name, source):
    """Links to files outside of docs/ lead to their pages here, those of speeds to their rows."""
    up = "../" * name.count("/")
    source[0] = SPEEDS.sub(rf'<a href="{up}results.html#\2">\1</a>', source[0])
    for outside, inside in PAGES.items():
        source[0] = source[0].replace(f"](../{outside}", f"]({inside}").replace(f"]({outside}", f"]({inside}")
    source[0] = source[0].replace(".ipynb)", ".md)")
    source[0] = FILES.sub(r"[](\1)", source[0])
    if name.startswith("mathematics/"):  # the formulas first, what checks them at a click
        source[0] = re.sub(r"^```python\n.*?^```$",
                           rf"<details><summary>{CHECKED}</summary>\n\n\\g<0>\n\n</details>", source[0],
                           flags=re.M | re.S)


TYPED = (nodes.literal, nodes.literal_block, nodes.math, nodes.math_block, nodes.raw, nodes.comment,
         addnodes.desc_signature)
# Columns of a table that scrolls in its box anyhow; letters of a cell that stays on one line, and of one that
# is no paragraph yet
MANY, SHORT, LONG = 5, 26, 120


# Derivatives, whose primes have become quotation marks; a minus between two things; powers
PRIMES = re.compile(r"(?<![\w’])((?:[A-Za-zα-ω]|alpha|gamma|psi)\d?)(’{1,3})(?!\w)")
MINUS = re.compile(r"(?<=[\w)²³]) - (?=[\w(])")
POWER = re.compile(r"\^(?:([-−]?\d+|[a-z]\b)|\(([^()]+)\))")


def printed(words):
    """Words with the signs of a book: minus, primes, micro."""
    words = PRIMES.sub(lambda found: found[1] + "′″‴"[len(found[2]) - 1], signed(words))
    return re.sub(r"(?<=\d) us\b", " µs", MINUS.sub(" − ", words))


def set_as_a_book(app, document):
    """Signs and powers of a book in words; a table of many columns keeps its rows low (site.css), with a long
    last cell in a row of its own below, and names its columns in each cell for telephones."""
    for text in list(document.findall(nodes.Text)):
        around = text.parent
        while around is not None and not isinstance(around, TYPED):
            around = around.parent
        if around is None and (POWER.search(text) or printed(str(text)) != str(text)):
            words, powers = POWER.split(printed(str(text)))[::3], [one[1] or one[2]
                                                                   for one in POWER.finditer(
                                                                       printed(str(text)))]
            made = [nodes.Text(words[0])]
            for power, after in zip(powers, words[1:], strict=True):
                made += [nodes.superscript("", power.replace("-", "−")), nodes.Text(after)]
            text.parent.replace(text, [one for one in made if one.astext()])
    for table in document.findall(nodes.table):
        columns = len(list(table.findall(nodes.colspec)))
        if columns >= MANY:
            table["classes"].append("many")
            heads = [cell.astext() for head in table.findall(nodes.thead)
                     for cell in head.findall(nodes.entry)]
            for row in list(table.findall(nodes.row)):
                for cell in row:
                    size = len(cell.astext())
                    cell["classes"].append("whole" if size <= SHORT else "words" if size <= LONG
                                           else "paragraph")
                for cell, head in zip(row, [] if isinstance(row.parent, nodes.thead) else heads):
                    for words in cell[:1]:
                        words.insert(0, nodes.inline("", f"{head}: ", classes=["column"]))
                if len(row) == columns and "paragraph" in row[-1]["classes"]:
                    note = nodes.entry("", *row[-1].children, morecols=columns - 1, classes=["note"])
                    row.replace(row[-1], nodes.entry("", classes=["whole"]))
                    row.parent.insert(row.parent.index(row) + 1, nodes.row("", note))
