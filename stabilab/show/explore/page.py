"""The page itself, one for both ways of answering."""
from __future__ import annotations

from typing import Any

from ..report.html import render

WAITING = "The first answer is on its way ..."


def page(about: dict[str, Any], backend: str, how: str, policy: str = "", **more: Any) -> str:
    """The HTML. about: of `Session.about`; backend: the template that defines how a question is asked; how: words on it; policy: what the page may load."""
    return render("explore.html", setup=about | more, backend=backend, how=how, policy=policy, waiting=WAITING)
