"""What is recorded of views that no command prints: the page of a case, the explorer's answer, and all words
of its pictures."""
from __future__ import annotations

from pathlib import Path

import stabilab
from stabilab.errors import InputError
from stabilab.show.explore.pictures import unframed
from stabilab.show.explore.session import Session
from stabilab.show.plot.subject import offered, subject
from stabilab.show.report import one_case

PARTS = ("headline", "first", "small", "law", "caveats", "fate", "look", "tiles", "facts", "extremes", "over",
         "sensitivity",
         "equilibria", "uncertain", "absent")
ANSWERED = ("headline", "first", "small", "fate", "look", "note", "rows", "equilibria")
SLOW = {"attitude", "budget", "section", "tilt", "wheel"}  # kinds of plot that take seconds


def of_page(path: Path) -> dict:
    """Every word and formula of the page of a case; pictures are named and not drawn."""
    write_all, picture, card = one_case.to_file.write_all, one_case.picture, one_case.thumbnail.write
    one_case.thumbnail.write = lambda items, target: target
    one_case.to_file.write_all = lambda one, target, *given, **named: [target]
    one_case.picture = lambda made, *given, **words: words
    try:
        made = one_case.sections(stabilab.load(path), Path(), path.stem)
    finally:
        one_case.to_file.write_all, one_case.picture, one_case.thumbnail.write = write_all, picture, card
    return ({name: made[name] for name in PARTS} | {"space": _of_space(made["space"])}
            | ({"percentiles": made["percentiles"]} if made["percentiles"] else {})
            | {name: made["equations"][name] for name in ("equations", "parameters")}
            | {"pictures": [[one["kind"], one["title"], one["caption"]] for one in made["pictures"]]})


def _of_space(space: dict) -> dict:
    return {name: space.get(name) for name in ("reason", "words", "legend")}


def of_explorer(path: Path) -> dict:
    """Every word of the explorer about a case."""
    try:
        made, _ = unframed(Session(stabilab.load(path)).answer({}))
    except InputError as error:
        return {"refused": str(error)}
    return ({name: made[name] for name in ANSWERED if name in made}
            | {"space": _of_space(made["space"]), "film": (made["film"] or {}).get("words")})


def of_pictures(path: Path) -> dict:
    """{kind of plot: every word in its picture} of a case."""
    from matplotlib import pyplot as plt
    case, found = stabilab.load(path), {}
    for kind in offered(subject(case)):
        if kind not in SLOW:
            made = getattr(stabilab.plot, kind)(case)
            figure = getattr(made, "figure", made)
            found[kind] = [_of_axes(ax) for ax in figure.axes] + [
                [*filter(None, legend.get_title().get_text().split("\n")),
                 *(text.get_text() for text in legend.get_texts())] for legend in figure.legends]
            plt.close("all")
    return found


def _of_axes(ax) -> dict:
    labels = [ax.get_xlabel(), ax.get_ylabel(), *([ax.get_zlabel()] if ax.name == "3d" else [])]
    return {"title": ax.get_title(), "labels": labels, "texts": [text.get_text() for text in ax.texts],
            "lines": sorted({_looks(line) for line in ax.lines}), "limits": [*ax.get_xlim(), *ax.get_ylim()]}


def _looks(line) -> str:
    return f"{line.get_color()} {line.get_linestyle()} {line.get_marker()}"


VIEWS = {"page": of_page, "explorer": of_explorer, "pictures": of_pictures}
