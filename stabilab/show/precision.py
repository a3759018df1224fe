"""What accuracy costs: as text, CSV and JSON, as a picture, and as a page of the report.

The work-precision picture has time against error, a line a method, the front marked."""
from __future__ import annotations

import math
import textwrap
from pathlib import Path

from ..answers.caveats import of_case
from ..cost import accuracy
from ..cost.accuracy import EPS, Point, Precision, digit_price
from ..errors import InputError
from ..files import write_text
from ..packages import demand
from ..processes import machine, versions
from . import endings, limiting, narrow, precision_overview, style
from .report import html
from .terminal import RAISED, written
from .text.cost import (
    DOUBLES,
    FORMULAS,
    NAMES,
    by_digits,
    caption,
    duration,
    flat,
    methods,
    setting,
    so_many,
    title,
    words,
)

# --- The picture
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
SAID = (50, 1000, 10_000)  # digits whose price in balls is told in text
NOTED = 1.5  # digits: stretches of the front at least so long have their price written on them


def picture(plt, result, size=None, largest=None):
    """Time against error, both logarithmic: a panel per question, a line per method, the front as a grey
    band. size: (width, height) in inches; a figure of that size has as many of the questions, in their order,
    as have room. largest: of panels; where it is given the legend has the methods without their prices."""
    questions = result.questions[:largest]
    if not questions:
        raise InputError(f"{result.case.name}: nothing to draw: {result.reference.reason}")
    beyond = bool(result.many) and size is None and largest is None  # a panel for it
    panels = len(questions) + beyond
    columns = min(2, panels)
    if size is not None:
        columns = max(1, min(columns, int(size[0] / PANEL[0])))
        questions = questions[:columns * max(1, int(size[1] / PANEL[1]))]
        panels = len(questions)
    rows = -(-panels // columns)
    usual = (5.6 * columns, 4.0 * rows + (1.3 if columns == 2 else 2.1))
    figure, axes = plt.subplots(rows, columns, figsize=size or usual, layout="constrained", squeeze=False)
    for ax, question in zip(axes.flat, questions):
        panel(ax, result, question)
    for ax in axes.flat[panels:]:
        ax.set_visible(False)
    if beyond:
        many_panel(axes.flat[len(questions)], result)
    looks = meanings(result, questions, largest is None and (size is None or size[0] >= usual[0]))
    style.legend(figure, looks, (3 if columns == 2 else 1) if size is None else None)
    figure.suptitle(f"{result.case.name}: what accuracy costs", fontsize=11 * style.share(), parse_math=False)
    if size is not None and style.share() < 1:
        return figure  # without the note, which a small figure has no room for
    formulas = ("Dotted: the error of a formula, at whatever time. "
                if any(p.method in FORMULAS for p in result.points) else "")
    power = math.ceil(math.log10(result.reference.error.max() or LEAST))
    ten = f"10{'⁻' * (power < 0)}{str(abs(power)).translate(RAISED)}"
    note = (
        f"Thin lines reach up to the slowest of several runs. {formulas}Error of the reference at most "
        f"{ten}.")
    width = int((150 if columns == 2 else 84) * figure.get_figwidth() / usual[0])
    figure.legends[0].set_title("\n".join(textwrap.wrap(note, width)), prop={"size": 7.5})
    figure.legends[0].get_title().set(color=style.GREY, parse_math=False)
    return figure


FRONT = {"color": "#CDD5DA", "linewidth": 7, "marker": "o", "markersize": 11, "markeredgewidth": 0,
         "solid_joinstyle": "round"}


def meanings(result, questions=None, prices=True) -> list[tuple[str, dict]]:
    """Rows (name, look) of the legend: methods, with the price of a digit or alone, and the front."""
    request = [p.method for p in result.points if questions is None or p.question in questions]
    request += ["reference"] * ("span" in (questions or result.questions))
    rows = []
    for method in (look for look in LOOKS if look in request):
        factors = (digit_price(result.of(q, method)) for q in result.questions) if prices else ()
        factor = next((f for f in factors if f is not None), None)
        rows.append((NAMES.get(method, method) + ("" if factor is None else f": ×{factor:.2f} a digit"),
                     LOOKS[method]))
    return [*rows, ("front: no single run beats it" if prices else "front", FRONT)]


def panel(ax, result, question):
    """One question of a measurement on given axes: a line a method, the front as a grey band."""
    ax.set(xscale="log", yscale="log", xlabel="largest relative error", ylabel="processor time (s)",
           title=title(result, question))
    front = result.front(question)
    ax.plot([_clipped(p.error) for p in front], [p.seconds for p in front], zorder=1, **FRONT)
    for method in methods(result, question):
        points = [p for p in result.of(question, method) if not math.isinf(p.error)]
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
        ax.plot([LEAST], [result.reference_seconds], markersize=7, clip_on=False, **LOOKS["reference"])
        ax.annotate(f"{result.reference.digits[0]} digits", (LEAST, result.reference_seconds), (-7, 0),
                    textcoords="offset points", ha="right", va="center", fontsize=7 * style.share())
    if question in ("span", "end") and result.sensitivity is not None:
        ax.axvline(_clipped(result.sensitivity * EPS), color=style.GREY, linestyle="--", linewidth=0.9)
        ax.annotate("last place of the start", (_clipped(result.sensitivity * EPS), 0.98),
                    xycoords=("data", "axes fraction"),
                    rotation=90, va="top", ha="right", fontsize=7 * style.share(), color=style.GREY)
    ax.invert_xaxis()  # better to the right
    for item, two in zip(front, front[1:]):
        if two.digits - item.digits >= NOTED:
            factor = (two.seconds / item.seconds) ** (1 / (two.digits - item.digits))
            ax.annotate(f"×{factor:.2f} a digit", (math.sqrt(_clipped(item.error) * _clipped(two.error)),
                        math.sqrt(item.seconds * two.seconds)), xytext=(0, 9), textcoords="offset points",
                        ha="center", fontsize=7.5 * style.share())


MANY_LOOKS = {"period": {"color": style.ORANGE, "marker": "v"},
              "extremes": {"color": style.GREEN, "marker": "^"}}


def many_panel(ax, result):
    """Time against digits, a line a question, where formulas in balls give them."""
    ax.set(xscale="log", yscale="log", xlabel="digits, each proved", ylabel="processor time (s)",
           title="beyond doubles: formulas in balls")
    ax.margins(y=0.12)  # the word at the end of each line stands above it
    for question, looks in MANY_LOOKS.items():
        points = [item for item in result.many if item.question == question]
        ax.plot([item.digits for item in points], [item.seconds for item in points], markersize=5,
                linewidth=1.3, **looks)
        if points:
            ax.annotate(question, (points[-1].digits, points[-1].seconds), (0, 6), ha="right",
                        textcoords="offset points", fontsize=8 * style.share(), color=looks["color"])


def _clipped(error) -> float:
    return min(max(error, LEAST), WORST)


# --- Text, JSON, CSV, files
COLUMNS = ("case", "question", "method", "setting", "value", "error", "digits", "steps", "evaluations",
           "seconds", "slowest", "repeats", "compile_seconds", "lanes", "parts", "on_front",
           "loading_seconds", "first_seconds")


def text(result, all_settings: bool = False) -> str:
    """The cheapest method for each number of digits; with all settings their table, too, * marking the front,
    and the words. rates: how often the rates were evaluated; the slowest run is in CSV and JSON."""
    printed = words(result)
    answer = next((line for line in printed if "six digits cost" in line), printed[0])
    lines = [f"{result.case.name}: {answer}", *([written(result.case.title)] if result.case.title else []),
             *(["", *_by_digits(result)] if by_digits(result) else []), *_many(result)]
    if not all_settings:
        return "\n".join([*lines, "", "--all prints every setting of every method."])
    for question in result.questions:
        front = set(map(id, result.front(question)))
        lines += ["", title(result, question),
                  f"  {'method':<13}{'setting':<13}{'error':>8}{'digits':>8}{'steps':>8}{'rates':>8}"
                  f"{'time':>10}{'compile':>9}"]
        lines += [_line(p, id(p) in front) for p in result.of(question)]
    left_out: dict = {}  # reason -> the methods that it holds for, each from its coarsest setting on
    for name, value, why in result.left_out:
        left_out.setdefault(why, {}).setdefault(name, []).append(value)
    for why, settings in left_out.items():
        coarsest = [f"{name}, {values[0]:g}{' and finer' if len(values) > 1 else ''}"
                    for name, values in settings.items()]
        lines.append(f"  left out: {'; '.join(coarsest)}: {why}")
    return "\n".join([*lines, "", *printed, "", caption()])


def _by_digits(result):
    """The table by digits wanted: the cheapest method of a first run and of one that is repeated, with their
    times, and the latter's with that of fewest digits as one."""
    lines = [f"{'digits':>6}  {'first run':<29}{'time':>9}  {'again':<29}{'time':>9}{'times 3 digits':>16}"]
    for row in by_digits(result):
        once = row["once"]
        lines.append(f"{row['digits']:>6}  {NAMES.get(once['method'], once['method']):<29}"
                     f"{duration(once['first_seconds']):>9}  {NAMES.get(row['method'], row['method']):<29}"
                     f"{duration(row['seconds']):>9}{row['relative']:>16.3g}")
    return [*lines, FIRST_RUN, *filter(None, [flat(result)])]


FIRST_RUN = ("First run: the integrator is imported and compiled for its setting; again: in the same "
             "process, or with what is cached.")


def _many(result):
    """A line a question of what digits beyond doubles cost."""
    for question in dict.fromkeys(item.question for item in result.many):
        prices = (f"{item.digits:,} digits {duration(item.seconds)}" for item in result.many
                  if item.question == question and item.digits in SAID)
        yield f"  {question} in balls, each digit proved: {', '.join(prices)}"


def _line(p, best) -> str:
    error = "none" if math.isinf(p.error) else f"{p.error:.1e}"
    counts = "".join(f"{'' if n is None else n:>{width}}" for n, width in ((p.steps, 8), (p.evaluations, 8)))
    times = f"{duration(p.seconds):>10}{duration(p.compile) if p.compile > 1e-4 else '':>9}"
    return (f"{'*' if best else ' '} "
            f"{p.method:<13}{setting(p)[2:]:<13}{error:>8}{p.digits:>8.1f}{counts}{times}".rstrip())


def as_dict(result) -> dict:
    """The object of `stabilab precision --json`. Errors are null where no answer came."""
    r = result.reference
    return {"schema": "stabilab.precision/1", "case": result.case.name, "time": result.case.scene.time_unit,
            "quick": result.quick,
            "times": r.t, "machine": machine(), "versions": versions(),
            "reference": {"digits": r.digits, "error": float(r.error.max()) if len(r.t) else None,
                          "status": r.status,
                          "reason": r.because, "why": r.reason.as_dict(),
                          "multiplications": r.work, "period": r.period and r.period[0],
                          "period_error": r.period and r.period[2], "extremes_error": r.extremes_error},
            "sensitivity": result.sensitivity, "points": [_row(result, p) for p in result.points],
            "digit_price": {q: {m: digit_price(result.of(q, m)) for m in methods(result, q)}
                            for q in result.questions},
            "by_digits": by_digits(result), "many_digits": [vars(item) for item in result.many],
            "fates": [vars(f) for f in result.fates],
            "left_out": [{"method": m, "value": v, "reason": why} for m, v, why in result.left_out],
            "words": words(result)}


def _row(out: Precision, p: Point) -> dict:
    values = (out.case.name, p.question, p.method, p.setting, p.value, p.error, min(p.digits, 99.0),
              p.steps, p.evaluations, p.seconds,
              p.slowest, p.repeats, p.compile, p.lanes, p.parts, any(p is q for q in out.front(p.question)),
              p.loading, p.first)
    return dict(zip(COLUMNS, values))


def lines(case, result):
    """A line per point for CSV; empty where a count does not exist, inf where no answer came."""
    return [limiting.Line(tuple(_row(result, p).values())) for p in result.points]


CSV = (COLUMNS, lines)


def csv(result) -> str:
    """The points as a file."""
    case = result.case
    return limiting.table(COLUMNS, [(case, of_case(case, result.validity), lines(case, result))])


FILES = (*endings.PICTURES, ".csv")


def write(result, path, size=None, most=None) -> Path:
    """The picture (.png, .svg, .pdf) or the points (.csv). size, most: as of `picture`."""
    path = checked(path)
    if endings.ending(path) == ".csv":
        return write_text(path, csv(result) + "\n")
    with style.drawing() as plt:
        return style.save(picture(plt, result, size, most), path)


def checked(path) -> Path:
    """The path, if its ending is one that can be written."""
    path = endings.file(path, FILES)
    if endings.ending(path) != ".csv":
        demand(*style.PACKAGES)
    return path


# --- The page of the report
SHORT = {"reduced": "closed form", "reference": "many digits"}
OVERVIEW = "precision/overview.png"  # with which the page begins
FIRST = "minor-axis-100"  # the motion that the page begins with, where it was measured


def page(cases, folder, tell=None, passed=(), **around) -> Path:
    """Measure every case that has a motion and a span and write precision.html with its pictures and points
    (in precision/) into the folder; returns its path. The first case of every kind (the same effects, the
    torque along an axis or not) is measured with every method and drawn; the others, with the methods that
    are likely to be best, are told in words. passed: lines on cases that are left out; around: of the pages
    beside it (`html.render`)."""
    folder, tell, sections, passed, seen = Path(folder), tell or (lambda label: None), [], list(passed), set()
    for case in cases:
        if case.state is None or case.span is None:
            passed.append(f"{case.name}: no motion with a span")
            continue
        tell(f"precision of {case.name}")
        of = kind(case)
        section, why = _section(case, folder, "glance" if of in seen else "brief", not seen)
        if section is None:
            passed.append(f"{case.name}: {why}")
            continue
        seen.add(of)
        sections.append(section)
    drawn = [section for section in sections if section["picture"]]
    first = next((section for section in drawn if section["name"] == FIRST), drawn[0] if drawn else None)
    return html.write(folder / "precision.html", "precision.html", cases=sections, passed=passed, first=first,
                      machine=caption(), priced=DOUBLES, **around)


def kind(case) -> tuple:
    """What cases have in common that are measured alike: variables, blocks of the state, the effects by name,
    and whether a torque acts along one principal axis or along several."""
    scene = case.scene
    acting = sum(m != 0 for m in scene.quadratic().m) if scene.plain else 0
    return scene.variables, tuple(case.blocks), tuple(effect.name for effect in scene.effects), min(acting, 2)


def _section(case, folder, effort, opens):
    """(what the template says of a case, None), or (None, why nothing could be measured). opens: whether the
    page begins with it unless `FIRST` follows."""
    try:
        result = accuracy.precision(case, effort)
    except InputError as error:
        return None, str(error)
    if not result.questions:
        return None, result.reference.because
    drawn = opening = None
    if effort == "brief":
        if case.name == FIRST or opens:
            opening = html.picture(*precision_overview.write_both(result, folder / OVERVIEW), "precision/")
        with style.drawing() as plt:
            drawn = html.picture(*narrow.save_both(picture(plt, result),
                                                   folder / "precision" / f"{case.name}.png"), "precision/")
    write(result, folder / "precision" / f"{case.name}.csv")
    rows = {row["digits"]: row for row in by_digits(result)}
    return {"name": case.name, "title": case.title or case.name, "words": words(result), "picture": drawn,
            "opening": opening,
            "csv": f"precision/{case.name}.csv", "flat": flat(result), "times": len(result.reference.t),
            "command": f"stabilab precision {case.path}", "error": f"{result.reference.error.max():.0e}",
            "prices": [_price(rows.get(digits)) for digits in DOUBLES],
            "firsts": [_price(row and row["once"] | {"seconds": row["once"]["first_seconds"]})
                       for row in map(rows.get, DOUBLES)],
            "rows": [{"digits": row["digits"], "relative": so_many(row["relative"], 3),
                      "method": NAMES.get(row["method"], row["method"]), "time": duration(row["seconds"]),
                      "once": NAMES.get(row["once"]["method"], row["once"]["method"]),
                      "first": duration(row["once"]["first_seconds"]),
                      "second": second and NAMES.get(second["method"], second["method"]),
                      "its": second and duration(second["seconds"])}
                     for row in rows.values() for second in [row["second"] or ""]]}, None


def _price(row) -> str:
    """The cheapest time for some digits, with the method where that is no Taylor series."""
    if row is None:
        return "–"
    named = "" if row["method"] == "taylor" else f", {SHORT.get(row['method'], row['method'])}"
    return duration(row["seconds"]) + named
