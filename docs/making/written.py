"""Pages written where they differ, so that Sphinx reads anew only what has changed."""
from __future__ import annotations

from pathlib import Path


def page(path: Path, text: str) -> None:
    """Write a page, unless it is there with the same text."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
