"""Notebooks: run with what comes with Python and Matplotlib, and made into pages of the site.

A notebook is a list of texts and cells of code with what these print and draw. Jupyter runs them for people;
here a cell is run by `exec`, as plain Python, so that neither the tests nor the site need a kernel
(ipykernel, nbclient and myst-nb bring some forty packages, and a server that starts for each notebook).
`python docs/making/notebooks.py` runs all of them and keeps their output; the tests compare it with today's.
"""
from __future__ import annotations

import ast
import base64
import contextlib
import io
import json
import os
import sys
import tempfile
from pathlib import Path

FOLDER = "notebooks"
SHARP = 75  # dots an inch


def executed(notebook: dict) -> dict:
    """The notebook with the outputs of its cells, run one after another in an empty folder."""
    import matplotlib
    matplotlib.use("agg")
    names: dict = {"__name__": "__main__"}
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        cells = [dict(cell) for cell in notebook["cells"]]
        for count, cell in enumerate([cell for cell in cells if cell["cell_type"] == "code"], 1):
            cell |= {"execution_count": count, "outputs": outputs("".join(cell["source"]), names, count)}
    return notebook | {"cells": cells}


def outputs(source: str, names: dict, count: int) -> list[dict]:
    """What a cell prints, the value of its last line, and the figures that it opens and leaves open; those of
    others stay as they are."""
    from matplotlib import pyplot as plt
    before = set(plt.get_fignums())
    body = ast.parse(source).body
    last = ast.Expression(body.pop().value) if body and isinstance(body[-1], ast.Expr) else None
    with contextlib.redirect_stdout(io.StringIO()) as screen:
        exec(compile(ast.Module(body, []), "cell", "exec"), names)
        value = None if last is None else eval(compile(last, "cell", "eval"), names)
    made = ([{"output_type": "stream", "name": "stdout", "text": lines(screen.getvalue())}]
            if screen.getvalue() else [])
    figures = [plt.figure(number) for number in plt.get_fignums() if number not in before]
    if value is not None and not figures:
        shown = {"text/plain": lines(repr(value))}
        if hasattr(value, "_repr_html_"):
            shown["text/html"] = lines(value._repr_html_())
        made.append({"output_type": "execute_result", "execution_count": count, "metadata": {},
                     "data": shown})
    for figure in figures:
        drawn = io.BytesIO()
        figure.savefig(drawn, format="png", dpi=SHARP, bbox_inches="tight", metadata={"Software": None})
        data = {"image/png": base64.b64encode(drawn.getvalue()).decode() + "\n", "text/plain": ["<Figure>"]}
        made.append({"output_type": "display_data", "metadata": {}, "data": data})
        plt.close(figure)
    return made


def lines(text: str) -> list[str]:
    """A text as notebooks keep it."""
    return text.splitlines(keepends=True)


def texts(notebook: dict) -> list[str]:
    """What each cell of code prints, with its value; a picture is a word."""
    found = []
    for cell in notebook["cells"]:
        for one in cell.get("outputs", ()):
            found.append("".join(one["text"] if "text" in one else one["data"]["text/plain"]))
    return found


def read(path: Path) -> dict:
    """A notebook of a file."""
    return json.loads(path.read_text(encoding="utf-8"))


def page(path: Path) -> tuple[str, dict[str, bytes]]:
    """(the page in Markdown, the pictures by name)."""
    parts, pictures = [], {}
    for cell in read(path)["cells"]:
        source = "".join(cell["source"])
        parts.append(source if cell["cell_type"] == "markdown" else f"```python\n{source}\n```")
        for one in cell.get("outputs", ()):
            data = one.get("data", {})
            if "image/png" in data:
                name = f"{path.stem}-{len(pictures) + 1}.png"
                pictures[name] = base64.b64decode(data["image/png"])
                parts.append(f"![What the cell above draws]({name})")
            elif "text/html" in data:
                parts.append("```{raw} html\n" + "".join(data["text/html"]) + "\n```")
            else:
                parts.append("```text\n" + "".join(one.get("text") or data["text/plain"]).rstrip() + "\n```")
    title, _, rest = "\n\n".join(parts).partition("\n")
    return (
        f"{title}\n\n*A notebook: `docs/{FOLDER}/{path.name}` of the repository, to be run in "
        f"Jupyter.*\n{rest}\n", pictures)


def write(docs: Path) -> None:
    """Write a page beside each notebook, and its pictures."""
    from .written import page as write_page
    for path in sorted((docs / FOLDER).glob("*.ipynb")):
        text, pictures = page(path)
        write_page(path.with_suffix(".md"), text)
        for name, drawn in pictures.items():
            (path.parent / name).write_bytes(drawn)


def main() -> None:
    """Run every notebook and keep its output."""
    for path in sorted((Path(__file__).parents[1] / FOLDER).glob("*.ipynb")):
        done = json.dumps(executed(read(path)), indent=1, ensure_ascii=False) + "\n"
        path.write_text(done, encoding="utf-8")
        print(path.relative_to(Path(__file__).parents[2]), file=sys.stderr)


if __name__ == "__main__":
    sys.path.insert(0, os.fspath(Path(__file__).parents[2]))
    main()
