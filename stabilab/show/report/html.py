"""Pages of the report from their templates: what comes from case files is escaped, what a template lacks is an error."""
from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from ...files import whole_file

TEMPLATES = Path(__file__).parents[1] / "templates"
ALONE = {"nav": (), "here": "", "up": "", "title": ""}  # of a page that is no part of a folder


@lru_cache(maxsize=1)
def _environment():
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    return Environment(loader=FileSystemLoader(TEMPLATES), autoescape=True, undefined=StrictUndefined)


def render(template: str, **values) -> str:
    """The HTML of a template. nav: rows {file, title} of the pages beside it, here: its own file, up: how it reaches their folder."""
    return _environment().get_template(template).render(**{**ALONE, **values})


def write(path, template: str, **values) -> Path:
    """The page as a file, whole or not at all."""
    path = Path(path)
    with whole_file(path) as waiting:
        waiting.write_text(render(template, **values), encoding="utf-8")
    return path
