"""The documentation as a site: `make docs` writes it to docs/_site. Sphinx, because the reference comes from docstrings and a warning can fail the build."""
import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE)]

from making import gallery, notebooks, reference, written  # noqa: E402

import stabilab  # noqa: E402

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
