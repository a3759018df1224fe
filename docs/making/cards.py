"""Cards of the gallery: a picture of 240 pixels, a badge in the colour of the outcome, a title, one line."""
from __future__ import annotations

import html
from pathlib import Path

import numpy as np

FOLDER = "cards"  # within the gallery: copied to _static
SIZE, DPI = (2.4, 1.35), 200  # inches and dots an inch, as of the cards of a report


def colours() -> str:
    """The colours of badges, those of outcomes on every page of a report."""
    from stabilab.show import style
    ink = {"conditional": " color: #000;"}
    rules = (f".cases b.{look} {{ background: {colour};{ink.get(look, '')} }}"
             for look, colour in style.LOOK.items())
    return "\n".join(["```{raw} html", f"<style>{' '.join(rules)}</style>", "```\n"])


def cards(built: list[str]) -> list[str]:
    """Cards beside each other."""
    return ['```{raw} html\n<div class="cases">', *built, "</div>\n```\n"]


def of_case(where: str, entry: dict) -> str:
    """The card of a case, which leads to its answer, file and commands."""
    badge = f'<b class="{entry["look"]}">{html.escape(entry["badge"])}</b>' if entry["badge"] else ""
    return (f'<a href="{where}">{_image(entry["card"])}{badge}<strong>{html.escape(entry["title"])}</strong>'
            f'<span>{html.escape(entry["line"])}</span></a>')


def wide(picture: dict, alt: str) -> str:
    """A picture as wide as the text of a page of the gallery, and the one that a telephone shows in its place
    (`stabilab.show.narrow`). picture: as of `stabilab.show.report.html.picture`."""
    narrow = picture["narrow"]
    sides = [f'width="{width}" height="{height}"' for width, height in (narrow["size"], picture["size"])]
    return ('```{raw} html\n<p><picture><source media="(max-width: 40em)" '
            f'srcset="../_static/{narrow["file"]}" {sides[0]}><img loading="lazy" '
            f'src="../_static/{picture["file"]}" {sides[1]} alt="{html.escape(alt)}"></picture></p>\n```\n')


def of_question(where: str, question: str, picture: str) -> str:
    """The card of a question, which leads to the page that answers it. picture: a file, or empty."""
    return f'<a href="{where}">{_image(picture)}<strong>{html.escape(question)}</strong></a>'


def _image(file: str) -> str:
    return f'<img loading="lazy" src="_static/{file}" width="240" height="135" alt="">' if file else ""


# --- Pictures of the questions
def draw(question: str, case, path: Path) -> Path | None:
    """The picture of a question's card, of what its page is about; None where that is no picture."""
    from stabilab.show import style
    draws = {"stuck": _limit, "distance": _plane, "cost": _digits, "audit": _printed}.get(question)
    if draws is None:
        return None
    if draws is _limit:
        return _limit(case, path)
    with style.drawing() as plt:
        figure = plt.figure(figsize=SIZE)
        ax = figure.add_axes((0.03, 0.06, 0.94, 0.91))
        draws(case, ax)
        ax.margins(y=0.12)
        ax.set(title="", xlabel="", ylabel="")
        ax.tick_params(which="both", left=False, bottom=False, labelleft=False, labelbottom=False)
        return style.save(figure, path, DPI)


def _limit(case, path: Path) -> Path:
    """The rates and their limit."""
    from stabilab.show.plot import thumbnail
    from stabilab.show.plot.subject import subject
    from stabilab.show.text.headline import look
    item = subject(case)
    return thumbnail.write([(item, look(item.motion))], path)


def _plane(case, ax) -> None:
    """The separatrix and the motion beside it, in the phase plane."""
    import stabilab
    stabilab.plot.phase(case, ax=ax, legend=False)


def _digits(case, ax) -> None:
    """Time against digits, a curve a method, 1 ms and 1 s ruled across."""
    from stabilab.cost.accuracy import precision
    from stabilab.show import precision_overview as overview
    from stabilab.show import style
    ax.set_yscale("log")
    for method, rows in overview.drawn(precision(case, "brief")).items():
        digits, seconds, _ = zip(*rows)
        ax.plot(digits, seconds, color=overview.CURVES[method][0], linewidth=1.6, marker="o", markersize=2.5)
    for seconds, text in overview.RULES:
        ax.axhline(seconds, color=style.GREY, linewidth=0.8)
        ax.annotate(text, (0.99, seconds), (0, 1.5), xycoords=("axes fraction", "data"), ha="right",
                    textcoords="offset points", fontsize=6.8, color=style.GREY)


def _printed(case, ax) -> None:
    """A rate as a paper prints it, on the exact motion."""
    from stabilab.show import style
    from stabilab.show.text.cost import LOOKS
    from stabilab.theories.theory import side_by_side
    runs, _ = side_by_side(case, np.linspace(*map(float, case.span), 801))
    exact = np.asarray(runs["exact"].state["omega"])[:, 0]
    for name in ("exact", "printed"):
        values = np.asarray(runs[name].state["omega"])[:, 0]
        ax.plot(np.asarray(runs[name].t), values, **LOOKS[name])
    reach = 1.2 * float(np.abs(exact).max())
    ax.set_ylim(-reach, reach)
    ax.annotate("as printed", (0.02, 0.03), xycoords="axes fraction", fontsize=6.8,
                color=LOOKS["printed"]["color"])
    ax.annotate("exact", (0.98, 0.03), xycoords="axes fraction", fontsize=6.8, ha="right",
                color=style.BLACK)
