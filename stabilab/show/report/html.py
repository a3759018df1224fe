"""Pages of the report from their templates: what comes from case files is escaped, what a template lacks is an error."""
from __future__ import annotations

from pathlib import Path

from ...files import whole_file

TEMPLATES = Path(__file__).parents[1] / "templates"


def render(template: str, **values) -> str:
    """The HTML of a template."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    environment = Environment(loader=FileSystemLoader(TEMPLATES), autoescape=True, undefined=StrictUndefined)
    return environment.get_template(template).render(**values)


def write(path, template: str, **values) -> Path:
    """The page as a file, whole or not at all."""
    path = Path(path)
    with whole_file(path) as waiting:
        waiting.write_text(render(template, **values), encoding="utf-8")
    return path
