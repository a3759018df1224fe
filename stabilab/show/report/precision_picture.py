"""The work-precision picture: time against error, a line a method, the front marked."""
from __future__ import annotations

import math
import textwrap

from ...cost.accuracy import EPS, digit_price
from ...errors import InputError
from .. import style
from ..terminal.letters import RAISED
from ..text.cost.words import FORMULAS, NAMES, caption, methods, title

LOOKS = {  # method -> how its line is drawn; the same in every picture
    "taylor": {"color": style.BLUE, "marker": "o"},
    "taylor-batch": {"color": style.SKY, "marker": "o", "linestyle": "--"},
    "RK45": {"color": style.ORANGE, "marker": "s"},
    "RK23": {"color": style.ORANGE, "marker": "v", "linestyle": "--"},
    "DOP853": {"color": style.VERMILION, "marker": "D"}, "Radau": {"color": style.PURPLE, "marker": "^"},
    "BDF": {"color": style.PURPLE, "marker": "<", "linestyle": "--"},
    "LSODA": {"color": style.GREY, "marker": ">"},
    "reduced": {"color": style.GREEN, "marker": "P"},
    "balls": {"color": style.BLACK, "marker": "X", "linestyle": "none"},
    "reference": {"color": style.BLACK, "marker": "h", "linestyle": "none"},
    "linear": {"color": style.BLACK, "marker": "1", "linestyle": "none"},
    "corrected": {"color": style.PURPLE, "marker": "x", "linestyle": "none"},
    "printed": {"color": style.ORANGE, "marker": "*", "linestyle": "none"},
    "averaged1": {"color": style.GREEN, "marker": "2", "linestyle": "none"},
    "averaged2": {"color": style.BLUE, "marker": "3", "linestyle": "none"},
    "lindstedt": {"color": style.GREEN, "marker": "4", "linestyle": ":"}}
WORST, LEAST = 10.0, 1e-17  # errors beyond are drawn at the edge
PANEL = (3.4, 2.6)  # inches that a panel needs at least
NOTED = 1.5  # digits: stretches of the front at least so long have their price written on them


def picture(plt, found, size=None, most=None):
    """Time against error, both logarithmic: a panel per question, a line per method, the front as a grey
    band. size: (width, height) in inches; a figure of that size has as many of the questions, in their order,
    as have room. most: of panels; where it is given the legend has the methods without their prices."""
    questions = found.questions[:most]
    if not questions:
        raise InputError(f"{found.case.name}: nothing to draw: {found.reference.reason}")
    columns = min(2, len(questions))
    if size is not None:
        columns = max(1, min(columns, int(size[0] / PANEL[0])))
        questions = questions[:columns * max(1, int(size[1] / PANEL[1]))]
    rows = -(-len(questions) // columns)
    usual = (5.6 * columns, 4.0 * rows + (1.3 if columns == 2 else 2.1))
    figure, axes = plt.subplots(rows, columns, figsize=size or usual, layout="constrained", squeeze=False)
    for ax, question in zip(axes.flat, questions):
        panel(ax, found, question)
    for ax in axes.flat[len(questions):]:
        ax.set_visible(False)
    looks = meanings(found, questions, most is None and (size is None or size[0] >= usual[0]))
    style.legend(figure, looks, (3 if columns == 2 else 1) if size is None else None)
    figure.suptitle(f"{found.case.name}: what accuracy costs", fontsize=11 * style.share(), parse_math=False)
    if size is not None and style.share() < 1:
        return figure  # without the note, which a small figure has no room for
    formulas = ("Dotted: the error of a formula, at whatever time. "
                if any(p.method in FORMULAS for p in found.points) else "")
    power = math.ceil(math.log10(found.reference.error.max() or LEAST))
    ten = f"10{'⁻' * (power < 0)}{str(abs(power)).translate(RAISED)}"
    note = (
        f"Thin lines reach up to the slowest of several runs. {formulas}Error of the reference at most "
        f"{ten}. {caption()}")
    width = int((150 if columns == 2 else 84) * figure.get_figwidth() / usual[0])
    figure.legends[0].set_title("\n".join(textwrap.wrap(note, width)), prop={"size": 7.5})
    figure.legends[0].get_title().set(color=style.GREY, parse_math=False)
    return figure


FRONT = {"color": "#CDD5DA", "linewidth": 7, "marker": "o", "markersize": 11, "markeredgewidth": 0,
         "solid_joinstyle": "round"}


def meanings(found, questions=None, prices=True) -> list[tuple[str, dict]]:
    """Rows (name, look) of the legend: methods, with the price of a digit or alone, and the front."""
    asked = [p.method for p in found.points if questions is None or p.question in questions]
    asked += ["reference"] * ("span" in (questions or found.questions))
    rows = []
    for method in (one for one in LOOKS if one in asked):
        factors = (digit_price(found.of(q, method)) for q in found.questions) if prices else ()
        factor = next((f for f in factors if f is not None), None)
        rows.append((NAMES.get(method, method) + ("" if factor is None else f": ×{factor:.2f} a digit"),
                     LOOKS[method]))
    return [*rows, ("front: no single run beats it" if prices else "front", FRONT)]


def panel(ax, found, question):
    """One question of a measurement on given axes: a line a method, the front as a grey band."""
    ax.set(xscale="log", yscale="log", xlabel="largest relative error", ylabel="processor time (s)",
           title=title(found, question))
    front = found.front(question)
    ax.plot([_clipped(p.error) for p in front], [p.seconds for p in front], zorder=1, **FRONT)
    for method in methods(found, question):
        points = [p for p in found.of(question, method) if not math.isinf(p.error)]
        x, y = [_clipped(p.error) for p in points], [p.seconds for p in points]
        ax.vlines(x, y, [p.slowest for p in points], color=LOOKS[method]["color"], linewidth=0.6, alpha=0.3,
                  zorder=2)
        ax.plot(x, y, markersize=5, linewidth=1.3, zorder=3, **LOOKS[method])
        if method in FORMULAS and points:
            ax.axvline(min(x), color=LOOKS[method]["color"], linewidth=0.8, linestyle=":", zorder=1)
        for p in (points[0], points[-1]) if len(points) > 1 and points[0].setting == "rtol" else ():
            ax.annotate(f"{p.value:.0e}".replace("e-0", "e-"), (_clipped(p.error), p.seconds), (0, 5),
                        textcoords="offset points", ha="center", fontsize=6.5 * style.share(),
                        color=LOOKS[method]["color"])
    if question == "span":
        ax.plot([LEAST], [found.reference_seconds], markersize=7, clip_on=False, **LOOKS["reference"])
        ax.annotate(f"{found.reference.digits[0]} digits", (LEAST, found.reference_seconds), (-7, 0),
                    textcoords="offset points", ha="right", va="center", fontsize=7 * style.share())
    if question in ("span", "end") and found.sensitivity is not None:
        ax.axvline(_clipped(found.sensitivity * EPS), color=style.GREY, linestyle="--", linewidth=0.9)
        ax.annotate("last place of the start", (_clipped(found.sensitivity * EPS), 0.98),
                    xycoords=("data", "axes fraction"),
                    rotation=90, va="top", ha="right", fontsize=7 * style.share(), color=style.GREY)
    ax.invert_xaxis()  # better to the right
    for one, two in zip(front, front[1:]):
        if two.digits - one.digits >= NOTED:
            factor = (two.seconds / one.seconds) ** (1 / (two.digits - one.digits))
            ax.annotate(f"×{factor:.2f} a digit", (math.sqrt(_clipped(one.error) * _clipped(two.error)),
                        math.sqrt(one.seconds * two.seconds)), xytext=(0, 9), textcoords="offset points",
                        ha="center", fontsize=7.5 * style.share())


def _clipped(error) -> float:
    return min(max(error, LEAST), WORST)
