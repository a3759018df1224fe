"""How cost grows, drawn: time against the number of states, the digits, and closeness to the separatrix."""
from __future__ import annotations

from dataclasses import astuple, fields
from pathlib import Path

from ...case.read import load
from ...show import style
from ...show.files import comma
from ...show.report import html
from ...show.text.cost.words import caption, duration
from .growth import NODE_DIGITS, Growth, with_closeness, with_digits, with_states

LOOKS = {("fate", "NumPy"): {"color": style.BLUE, "marker": "o"},
         ("fate", "numba"): {"color": style.BLUE, "marker": "s", "linestyle": "--"},
         ("extremes", "row by row"): {"color": style.GREEN, "marker": "o"},
         ("period", "row by row"): {"color": style.VERMILION, "marker": "o"},
         ("states over the span", "taylor"): {"color": style.BLUE, "marker": "o"},
         ("states over the span", "DOP853"): {"color": style.VERMILION, "marker": "D"},
         ("states over the span", "reduced"): {"color": style.GREEN, "marker": "P"},
         ("states over the span",
          "Taylor in many digits"): {"color": style.BLUE, "marker": "s", "linestyle": "--"},
         ("extremes", "formulas"): {"color": style.GREEN, "marker": "*", "linestyle": "none", "zorder": 5},
         ("period", "formulas"): {"color": style.ORANGE, "marker": "*", "linestyle": "none", "zorder": 5},
         ("extremes", "balls"): {"color": style.GREEN, "marker": "^", "linestyle": ":"},
         ("period", "balls"): {"color": style.ORANGE, "marker": "v", "linestyle": ":"},
         ("margin", "balls"): {"color": style.PURPLE, "marker": "<", "linestyle": ":"},
         ("fate", "as called"): {"color": style.BLUE, "marker": "o"},
         ("extremes", "as called"): {"color": style.GREEN, "marker": "^"},
         ("period", "as called"): {"color": style.ORANGE, "marker": "v"}}
TITLES = {"states": "Time against the number of states", "digits": "Time against digits",
          "separatrix": "Time against closeness to the separatrix"}
AXES = {"states": "states", "digits": "digits reached",
        "separatrix": "relative distance from the separatrix, in energy"}


def page(case, folder, tell=None, full: bool = False, **around) -> Path:
    """Measure how cost grows about a case (torque on an axis, bounded, no wheel momentum along the torque)
    and write growth.html, growth.csv and three pictures (in growth/) into the folder; returns the page's
    path. full: every decade of states; around: of the pages beside it (`html.render`)."""
    folder, tell = Path(folder), tell or (lambda words: None)
    rows = [*with_states(case, full, tell), *with_digits(case, "full" if full else "brief", tell),
            *with_closeness(case, tell)]
    with style.whole_file(folder / "growth.csv") as waiting:
        waiting.write_text(csv(rows), encoding="utf-8")
    pictures = []
    for about in TITLES:
        with style.drawing() as plt:
            style.save(picture(plt, [r for r in rows if r.about == about], about),
                       folder / "growth" / f"{about}.png")
        pictures.append({"file": f"growth/{about}.png", "title": TITLES[about], "words": words(rows, about)})
    return html.write(folder / "growth.html", "growth.html", pictures=pictures, machine=caption(),
                      case=case.name, full=full, **around)


def csv(rows) -> str:
    """One line per measurement; empty where there is no count."""
    return comma.lines([[f.name for f in fields(Growth)], *map(astuple, rows)])


def picture(plt, rows, about):
    """Seconds against x, a line per question and method; for closeness a second panel with bits and nodes."""
    panels = 2 if about == "separatrix" else 1
    figure, axes = plt.subplots(1, panels, figsize=(5.6 * panels + 1.6, 5.0), layout="constrained",
                                squeeze=False)
    groups = {}
    for row in rows:
        groups.setdefault((row.question, row.method), []).append(row)
    ax = axes[0][0]
    ax.set(yscale="log", xlabel=AXES[about], ylabel="time (s)", title=TITLES[about],
           xscale="linear" if about == "digits" else "log")
    for key, points in groups.items():
        points = sorted(points, key=lambda r: r.x)
        ax.plot([r.x for r in points], [r.seconds for r in points], markersize=5, linewidth=1.3, **LOOKS[key])
    if about == "digits":
        ax.axvspan(15.95, max(r.x for r in rows) + 0.5, color="#EEEEEE", zorder=0)
        ax.annotate("more than a double holds", (16.2, 0.985), xycoords=("data", "axes fraction"), va="top",
                    fontsize=8, color=style.GREY)
    if panels == 2:
        _counts(axes[0][1], groups)
    if about == "separatrix":
        for one in axes[0]:
            one.invert_xaxis()
    style.legend(figure, [(", ".join(dict.fromkeys((q, m) if m != "as called" else (q,))), LOOKS[q, m]) for q,
                          m in groups], columns=3)
    return figure


def _counts(ax, groups):
    ax.set(xscale="log", yscale="log", xlabel=AXES["separatrix"], ylabel="bits, nodes",
           title=f"Bits for the fate, nodes for {NODE_DIGITS} digits of the period")
    for (question, method), points in groups.items():
        known = [r for r in points if r.count is not None]
        if known:
            ax.plot([r.x for r in known], [r.count for r in known], markersize=5, linewidth=1.3,
                    **LOOKS[question, method])


def words(rows, about) -> str:
    """What the picture shows, with its numbers."""
    mine = [r for r in rows if r.about == about]
    pick = lambda question, method=None: sorted((r for r in mine if r.question == question
                                                 and method in (None, r.method)), key=lambda r: r.x)
    if about == "states":
        ends = [(q, m, pick(q, m)) for q, m in dict.fromkeys((r.question, r.method) for r in mine)]
        return ("Random states (seeded). "
                + "; ".join(f"{q}, {m}: {duration(p[0].seconds / p[0].x)} a state at {p[0].x:,.0f}, "
                f"{duration(p[-1].seconds / p[-1].x)} at {p[-1].x:,.0f}" for q, m, p in ends) + ".")
    if about == "digits":
        many, periods = pick("states over the span", "Taylor in many digits"), pick("period", "balls")
        return (f"A Taylor series in many digits takes {duration(many[0].seconds)} for {many[0].x:.0f} "
                f"digits and {duration(many[-1].seconds)} for "
                f"{many[-1].x:.0f}: the order grows with the digits, a product of two series with its "
                f"square. The balls of a period take "
                f"{duration(periods[0].seconds)} and {duration(periods[-1].seconds)}.")
    fates, periods = pick("fate"), pick("period")
    nodes = [r for r in reversed(periods) if r.count is not None]
    lost = ("" if len(nodes) == len(periods)
            else (
                f"; nearer than {nodes[-1].x:.0e} the rule in doubles does not get there at all, and balls "
                f"answer"))
    return (f"From 1e-1 to 1e-15 the fate's time goes from {duration(fates[-1].seconds)} to "
            f"{duration(fates[0].seconds)}, and its bits in balls from "
            f"{fates[-1].count} to {fates[0].count}: a state is as hard as its margin is small. The period "
            f"itself grows like the logarithm of the "
            f"distance; the midpoint rule takes {nodes[0].count} nodes at 1e-1 and {nodes[-1].count} at "
            f"{nodes[-1].x:.0e}{lost}.")


def main(case, folder) -> None:
    """The whole measurement, every decade of states and every setting: minutes."""
    print(page(load(case), folder, full=True))


if __name__ == "__main__":
    import sys
    main(*sys.argv[1:3])
