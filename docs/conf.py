"""The documentation as a site: `make docs` writes it to docs/_site. Sphinx, because the reference comes from docstrings and a warning can fail the build."""
import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE)]

from docutils import nodes  # noqa: E402
from making import gallery, notebooks, reference, written  # noqa: E402
from sphinx import addnodes  # noqa: E402

import stabilab  # noqa: E402
from stabilab.show.report.html import signed  # noqa: E402

project, author, release = "stabilab", "the stabilab developers", stabilab.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "making.mathml"]
myst_enable_extensions, html_math_renderer = ["dollarmath"], "mathml"
exclude_patterns = ["_site"]
html_theme, html_title = "furo", "stabilab"
html_static_path, html_css_files = ["static"], ["site.css"]
html_show_copyright = False
myst_heading_anchors = 3
autodoc_typehints, autodoc_typehints_format, maximum_signature_line_length = "signature", "short", 90
autodoc_member_order = "bysource"
CHECKED = "Evaluated against the program"
# What stands outside of docs/ has its page here under another name
PAGES = {"README.md": "readme.md", "benchmarks/RESULTS.md": "results.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md"}


def setup(app):
    app.connect("builder-inited", write_pages)
    app.connect("source-read", point_inside)
    app.connect("autodoc-process-docstring", reference.as_rst)
    app.connect("doctree-read", set_as_a_book)


def write_pages(app):
    """The pages that are made from what the repository holds: what stands outside of docs/, reference, notebooks, gallery of cases."""
    for outside, name in PAGES.items():
        text = (HERE.parent / outside).read_text(encoding="utf-8")
        written.page(HERE / name, text.replace("](docs/", "](").replace("](figures/", "](../figures/").replace("](CITATION.cff", "](../CITATION.cff"))
    written.page(HERE / "api.md", reference.text())
    notebooks.write(HERE)
    gallery.write(HERE)


def point_inside(app, name, source):
    """Links to files outside of docs/ lead to their pages here."""
    for outside, inside in PAGES.items():
        source[0] = source[0].replace(f"](../{outside}", f"]({inside}").replace(f"]({outside}", f"]({inside}")
    source[0] = source[0].replace(".ipynb)", ".md)")
    if name.startswith("mathematics/"):  # the formulas first, what checks them at a click
        source[0] = re.sub(r"^```python\n.*?^```$", rf"<details><summary>{CHECKED}</summary>\n\n\\g<0>\n\n</details>", source[0], flags=re.M | re.S)


TYPED = (nodes.literal, nodes.literal_block, nodes.math, nodes.math_block, nodes.raw, nodes.comment, addnodes.desc_signature)
# Columns of a table that scrolls in its box anyhow; letters of a cell that stays on one line, and of one that is no paragraph yet
MANY, SHORT, LONG = 5, 26, 120


def set_as_a_book(app, document):
    """The minus of a book in words, which no line ends behind; a table of many columns keeps its rows low (site.css)."""
    for text in list(document.findall(nodes.Text)):
        around = text.parent
        while around is not None and not isinstance(around, TYPED):
            around = around.parent
        if around is None and signed(str(text)) != str(text):
            text.parent.replace(text, nodes.Text(signed(str(text))))
    for table in document.findall(nodes.table):
        if len(list(table.findall(nodes.colspec))) >= MANY:
            table["classes"].append("many")
            for cell in table.findall(nodes.entry):
                size = len(cell.astext())
                cell["classes"].append("whole" if size <= SHORT else "words" if size <= LONG else "paragraph")
