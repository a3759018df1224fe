"""The documentation as a site: `make docs` writes it to docs/_site. Sphinx, because the reference comes from docstrings and a warning can fail the build."""
import inspect
import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))

import stabilab  # noqa: E402

project, author, release = "stabilab", "the stabilab developers", stabilab.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc"]
exclude_patterns = ["_site"]
html_theme, html_title = "furo", "stabilab"
html_show_copyright = False
myst_heading_anchors = 3
autodoc_typehints = "none"  # docstrings give shapes and units, which types do not
autodoc_member_order = "bysource"
# What stands outside of docs/ has its page here under another name
ELSEWHERE = {"../README.md": "readme.md", "../benchmarks/RESULTS.md": "results.md"}
GROUPS = {
    "A case": ("load", "Case", "Body", "Scene", "ScaledGyrostat", "Gyrostat", "ConstantTorque", "Charge", "Resistance", "LiquidCavity", "NewtonianField",
               "Gravity", "BodyForce"),
    "Questions about a motion": ("fate", "Fate", "fate_grid", "motion", "extremes", "period", "spin_up", "stuck", "time_to", "TimeTo", "validity"),
    "Questions about all motions": ("equilibria", "separatrix"),
    "Motions in time": ("trajectory", "ensemble", "simulate", "compare", "theory", "derive"),
    "Errors": ("InputError",),
}


def setup(app):
    app.connect("builder-inited", write_pages)
    app.connect("source-read", point_inside)
    app.connect("autodoc-process-docstring", as_rst)


def write_pages(app):
    """The pages that are made from what the repository holds: README, results of the benchmarks, reference, gallery of cases."""
    made = {"readme.md": (HERE.parent / "README.md").read_text(encoding="utf-8").replace("](docs/", "](").replace("](figures/", "](../figures/"),
            "results.md": (HERE.parent / "benchmarks/RESULTS.md").read_text(encoding="utf-8"), "api.md": reference(), "gallery.md": gallery()}
    for name, text in made.items():
        path = HERE / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def reference() -> str:
    """A heading a group, an entry a public name. A public name that no group has is an error: the page is whole."""
    placed = {name for names in GROUPS.values() for name in names} | {"plot", "__version__"}
    if missing := set(stabilab.__all__) ^ placed:
        raise ValueError(f"docs/conf.py, GROUPS: {', '.join(sorted(missing))} stand in one of it and stabilab.__all__ only")
    parts = ["# Reference\n\nEvery public name of `import stabilab`. Arrays have their components in the last place.\n"]
    for title, names in GROUPS.items():
        parts.append(f"## {title}\n")
        for name in names:
            thing = getattr(stabilab, name)
            kind = "function" if not inspect.isclass(thing) else "exception" if issubclass(thing, Exception) else "class"
            members = "\n:members:" if kind == "class" else ""
            parts.append(f"```{{eval-rst}}\n.. auto{kind}:: stabilab.{name}{members.replace(chr(10), chr(10) + '   ')}\n```\n")
    return "\n".join(parts)


def gallery() -> str:
    """Every case of the repository: its title, what it is taken from, and the file itself."""
    import tomllib
    parts = ["# Cases\n\nEach file is a whole case: `stabilab classify FILE`, `stabilab plot FILE --out picture.png`.\n"]
    for path in sorted((HERE.parent / "cases").glob("*.toml")):
        text = path.read_text(encoding="utf-8")
        data = tomllib.loads(text)
        parts.append(f"## {path.stem}\n\n{data.get('title', '')}. {data.get('source', '')}\n\n```toml\n{text}```\n")
    return "\n".join(parts)


def point_inside(app, name, source):
    """Links to files outside of docs/ lead to their pages here."""
    for outside, inside in ELSEWHERE.items():
        source[0] = source[0].replace(f"]({outside}", f"]({inside}")
    source[0] = source[0].replace("](benchmarks/RESULTS.md", "](results.md")


def as_rst(app, what, name, obj, options, lines):
    """Docstrings are plain sentences with names in single backticks: as literals, and nothing else as markup."""
    text = re.sub(r"(?<!`)`([^`\n]+)`(?!`)", r"``\1``", "\n".join(lines))
    parts = re.split(r"(``[^`]+``)", text)
    lines[:] = "".join(part if part.startswith("``") else re.sub(r"([*|\\]|_(?=\W|$))", r"\\\1", part) for part in parts).split("\n")
