"""Only the effects a scene calls for, shown: what each one adds to the state, the equations and the time of a
rate."""
from __future__ import annotations

from pathlib import Path

from ...show import style
from ...show.report import html
from ...show.text.cost.words import caption, duration
from .effects import EXAMPLES, MANY, NOTHING, alone, counted, imported, ladder, timed, zero_is_absent

PICTURE = "effects.png"


def page(folder, tell=None, **around) -> Path:
    """Count, time and check every effect, and write effects.html with its picture into the folder; returns
    its path.

    tell: called with a line of words before each part of the work (some twenty seconds in all); around: of
    the pages beside it (`html.render`).
    """
    folder, tell = Path(folder), tell or (lambda words: None)
    tell("what each effect costs, one added to the other")
    steps = [(counted(added, scene), timed(scene)) for added, scene in ladder()]
    tell("what each effect costs by itself")
    singles = [(counted(added, scene), timed(scene), imported(added)) for added, scene in alone()]
    tell("effects of zero strength")
    zero = {name: zero_is_absent(name) for name in EXAMPLES}
    with style.drawing() as plt:
        style.save(picture(plt, steps), folder / PICTURE)
    return html.write(
        folder / "effects.html", "effects.html", picture=PICTURE, many=MANY, machine=caption(),
        words=words(steps, singles, zero),
        ladder=[_row(cost, seconds) for cost, seconds in steps],
        alone=[_row(cost, seconds) | {"modules": ", ".join(modules)} for cost, seconds, modules in singles],
        questions=list(next(iter(zero.values()))), **around,
        zero=[{"name": spoken(name), "same": list(same.values())} for name, same in zero.items()])


def spoken(name: str) -> str:
    """An effect's name as words."""
    return name.replace("_", " ").replace("newtonian", "Newtonian")


def _row(cost, seconds) -> dict:
    return {"added": spoken(cost.added), "states": cost.states, "blocks": ", ".join(cost.blocks),
            "parameters": len(cost.parameters),
            "coefficients": cost.coefficients, "operations": cost.operations, "branches": cost.branches,
            "one": duration(seconds.one), "many": duration(seconds.among_many),
            "step": "" if seconds.taylor_step is None else duration(seconds.taylor_step)}


def words(steps, singles, zero) -> list[str]:
    """What the numbers say, in sentences."""
    (first, quick), (last, slow) = steps[0], steps[-1]
    dearest = max(singles, key=lambda single: single[0].operations)[0]
    lines = [f"The body alone has {first.states} states and {first.operations} operations a rate; all "
             f"{len(steps) - 1} effects together have "
             f"{last.states} states and {last.operations} operations. By itself {spoken(dearest.added)} adds "
             f"most: "
             f"{dearest.operations - first.operations} operations."]
    if quick.taylor_step:
        lines.append(
            f"A Taylor step takes {duration(quick.taylor_step)} for the body alone and "
            f"{duration(slow.taylor_step)} with all effects.")
    free = [spoken(b.added) for (a, _), (b, _) in zip(steps, steps[1:]) if b.operations == a.operations]
    if free:
        lines.append(
            f"Added to what stands before it, {' and '.join(free)} costs no operation: its numbers merge "
            f"into coefficients that are there.")
    failed = [f"{spoken(name)} ({question})" for name, same in zero.items() for question,
              equal in same.items() if not equal]
    lines.append("An effect of zero strength changes no bit of any answer below." if not failed else
                 f"An effect of zero strength is not like an absent one: {', '.join(failed)}.")
    return lines


def picture(plt, steps):
    """States and operations, and the time of a rate, against what was added last."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 4.4), layout="constrained", sharey=True)
    names = [spoken(NOTHING) if cost.added == NOTHING else f"+ {spoken(cost.added)}" for cost, _ in steps]
    places = range(len(steps))
    left.barh([p - 0.19 for p in places], [cost.operations for cost, _ in steps], 0.38, color=style.SKY,
              label="operations in the rates")
    left.barh([p + 0.19 for p in places], [cost.states for cost, _ in steps], 0.38, color=style.ORANGE,
              label="states")
    left.set(yticks=list(places), yticklabels=names, xlabel="number", title="what the equations hold")
    left.invert_yaxis()
    left.legend(loc="upper right")
    series = [("rates of one state, floats", style.BLUE, "o", [s.one for _, s in steps]),
              (f"rates of one of {MANY} states, NumPy", style.GREEN, "s", [s.among_many for _, s in steps])]
    if steps[0][1].taylor_step is not None:
        series.append(("one Taylor step, heyoka", style.VERMILION, "D", [s.taylor_step for _, s in steps]))
    looks = [(label, {"color": colour, "marker": marker, "markersize": 5, "linewidth": 1.3}) for label,
             colour, marker, _ in series]
    for (_, look), (*_, values) in zip(looks, series):
        right.plot([v * 1e6 for v in values], places, **look)
    right.set(xscale="log", xlabel="least processor time (microseconds)", title="what they cost")
    right.tick_params(labelleft=False)
    style.legend(figure, looks, columns=3)
    figure.suptitle("Only the effects a scene calls for: one added after the other", fontsize=11)
    return figure
