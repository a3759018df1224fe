"""What accuracy costs, shown: as a table, in words, as CSV, JSON and the work-precision picture."""
from __future__ import annotations

import math
from pathlib import Path

from ..analysis.precision import EPS, QUESTIONS, digit_price
from ..analysis.precision_front import machine, versions
from ..errors import InputError
from . import style

LOOKS = {  # method -> how its line is drawn; the same in every picture
    "taylor": {"color": style.BLUE, "marker": "o"}, "taylor-batch": {"color": style.SKY, "marker": "o", "linestyle": "--"},
    "RK45": {"color": style.ORANGE, "marker": "s"}, "RK23": {"color": style.ORANGE, "marker": "v", "linestyle": "--"},
    "DOP853": {"color": style.VERMILION, "marker": "D"}, "Radau": {"color": style.PURPLE, "marker": "^"},
    "BDF": {"color": style.PURPLE, "marker": "<", "linestyle": "--"}, "LSODA": {"color": style.GREY, "marker": ">"},
    "reduced": {"color": style.GREEN, "marker": "P"}, "balls": {"color": style.BLACK, "marker": "X", "linestyle": "none"},
    "linear": {"color": style.BLACK, "marker": "1", "linestyle": "none"},
    "printed": {"color": style.ORANGE, "marker": "*", "linestyle": "none"},
    "averaged1": {"color": style.GREEN, "marker": "2", "linestyle": "none"},
    "averaged2": {"color": style.BLUE, "marker": "3", "linestyle": "none"},
    "lindstedt": {"color": style.GREEN, "marker": "4", "linestyle": ":"}}
FORMULAS = ("linear", "printed", "averaged1", "averaged2", "lindstedt")
WANTED = (3, 6, 9, 12, 15)  # digits whose price the words tell
COLUMNS = ("case", "question", "method", "setting", "value", "error", "digits", "steps", "evaluations", "seconds", "slowest",
           "repeats", "compile_seconds", "lanes", "parts", "on_front")


# -- words -------------------------------------------------------------------------------------------------------------


def words(found) -> list[str]:
    """The measurement in plain words, one sentence or two a string."""
    return [_reference_words(found), *(s for q in found.questions for s in _question_words(found, q)), *_fate_words(found),
            *_model_words(found)]


def _reference_words(found) -> str:
    r = found.reference
    if not len(r.t):
        return f"Nothing was measured: {r.reason}."
    reach = "" if r.status == "agrees" else f" Only so far: {r.reason}; the rest of the span is not judged."
    return (f"Judged at {len(r.t)} times up to {_moment(found)} by a Taylor series run in {r.digits[0]} and in {r.digits[1]} "
            f"digits; the two differ by {r.error.max():.0e} of the state, which is the reference's error.{reach}")


def _question_words(found, question):
    points = [p for p in found.of(question) if p.lanes == 1 and not p.parts]
    prices = []
    for digits in WANTED:
        enough = [p for p in points if p.digits >= digits]
        if enough:
            prices.append((digits, min(enough, key=lambda p: p.seconds)))
    title = _title(found, question)
    if not prices:
        yield f"{title}: no method has {WANTED[0]} digits."
        return
    parts = [f"{digits} digits cost {duration(p.seconds)} ({p.method}{setting(p)})" for digits, p in _merged(prices)]
    yield f"{title}: " + ", ".join(parts) + "." + _against(points, prices) + _digit_words(found, question)
    missing = next((d for d in WANTED if d > prices[-1][0]), None)
    best = max(points, key=lambda p: p.digits)
    if missing:
        yield f"No method gets {missing} digits: the best is {best.digits:.1f} ({best.method}{setting(best)}){_because(found, question, missing)}."


def _title(found, question):
    named = {"span": f"States at {len(found.reference.t)} times up to {_moment(found)}", "end": f"The state at {_moment(found)}"}
    return named.get(question, f"The {question}")


def _moment(found):
    """The last time that is judged, with its unit."""
    last = f"{found.reference.t[-1]:.6g}"
    return f"tau = {last}" if found.case.variables == "scaled" else f"t = {last} s"


def _merged(prices):
    """Where one setting has the digits of several lines, the most digits alone."""
    return [(d, p) for (d, p), following in zip(prices, [*prices[1:], (None, None)]) if following[1] is not p]


def _against(points, prices) -> str:
    """How much longer SciPy's best takes, for the most digits that it reaches."""
    from ..analysis.trajectories import SCIPY_METHODS
    for digits, p in reversed(prices):
        others = [q for q in points if q.method in SCIPY_METHODS and q.digits >= digits]
        if others and p.method not in SCIPY_METHODS:
            other = min(others, key=lambda q: q.seconds)
            return f" SciPy's best for {digits} digits, {other.method}, takes {other.seconds / p.seconds:.3g} times as long ({duration(other.seconds)})."
    return ""


def _digit_words(found, question) -> str:
    prices = {m: digit_price(found.of(question, m)) for m in _methods(found, question)}
    known = [f"{m} {price(v)}" for m, v in prices.items() if v is not None and m != "taylor-batch"]
    return f" One more digit: {', '.join(known)}." if known else ""


def price(factor) -> str:
    """A digit's price as a factor in time."""
    return f"x{factor:.2f}"


def _because(found, question, missing) -> str:
    if question in ("span", "end") and found.sensitivity is not None and found.sensitivity * EPS > 0.2 * 10.0**-missing:
        return (f"; a change of the start in its last place (1e-16) moves the state by {found.sensitivity * EPS:.0e} within the span, "
                "so doubles do not hold more")
    if found.left_out:
        return "; finer settings were left out as too costly, or rounding has the last word"
    return "; rounding in doubles has the last word"


def _fate_words(found):
    if found.fates:
        yield "Fate: " + "; ".join(_FATE[f.method].format(f.word, duration(f.seconds)) for f in found.fates) + "."


_FATE = {"energy": "{0}, by the energy in doubles with its error bound in {1}", "balls": "in many digits the energy is {0}: {1}"}


def _model_words(found):
    for name in FORMULAS:
        points = found.of("span", name)
        if points:
            best = min(points, key=lambda p: p.error)
            yield (f"The model {name}{setting(best)}: its own error is {best.error:.2g} of the state, whatever is spent on it"
                   f"{f' (of {best.parts} alone)' if best.parts else ''}.")
        elif any(m == name for m, *_ in found.left_out):
            yield f"The model {name} has no answer over the whole span."


def duration(seconds) -> str:
    """Seconds in a fitting unit, three digits."""
    for unit, factor in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= factor:
            return f"{seconds / factor:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def setting(p) -> str:
    """", rtol 1e-09" and its like; nothing for a formula."""
    return "" if p.setting == "formula" else f", {p.setting} {p.value:.2g}" if p.setting == "rtol" else f", {p.setting} {p.value:g}"


# -- text, CSV, JSON ---------------------------------------------------------------------------------------------------


def text(found) -> str:
    """The table of the terminal, * marking the front, then the words."""
    lines = [f"{found.case.name}: {found.case.title}" if found.case.title else found.case.name]
    for question in found.questions:
        front = set(map(id, found.front(question)))
        lines += ["", _title(found, question),
                  f"  {'method':<14}{'setting':<15}{'error':>9}{'digits':>8}{'steps':>9}{'evaluations':>13}{'time':>10}{'slowest':>10}{'compile':>10}"]
        lines += [_line(p, id(p) in front) for p in found.of(question)]
    lines += [f"  left out: {line}" for line in _left_out(found)]
    return "\n".join([*lines, "", *words(found), "", caption()])


def _left_out(found):
    """A line per method and reason: the coarsest setting that it holds for."""
    first = {}
    for name, value, why in found.left_out:
        first.setdefault((name, why), []).append(value)
    return [f"{name}, {values[0]:g}{' and finer' if len(values) > 1 else ''}: {why}" for (name, why), values in first.items()]


def _line(p, best) -> str:
    error = "none" if math.isinf(p.error) else f"{p.error:.1e}"
    counts = "".join(f"{'' if n is None else n:>{width}}" for n, width in ((p.steps, 9), (p.evaluations, 13)))
    times = "".join(f"{duration(s) if s else '':>10}" for s in (p.seconds, p.slowest, p.compile if p.compile > 1e-4 else 0))
    return f"{'*' if best else ' '} {p.method:<14}{setting(p)[2:]:<15}{error:>9}{p.digits:>8.1f}{counts}{times}"


def caption() -> str:
    """Machine and versions that the times belong to."""
    m, v = machine(), versions()
    return f"{m['processor']}, {m['cores']} cores, {m['system']}; " + ", ".join(f"{name} {number}" for name, number in v.items())


def as_dict(found) -> dict:
    """The object of `stabilab precision --json`. Errors are null where no answer came."""
    r = found.reference
    return {"schema": "stabilab.precision/1", "case": found.case.name, "time": found.case.scene.time_unit, "quick": found.quick,
            "times": r.t, "machine": machine(), "versions": versions(),
            "reference": {"digits": r.digits, "error": float(r.error.max()) if len(r.t) else None, "status": r.status,
                          "reason": r.reason, "multiplications": r.work, "period": r.period and r.period[0],
                          "period_error": r.period and r.period[2], "extremes_error": r.extremes_error},
            "sensitivity": found.sensitivity, "points": [_row(found, p) for p in found.points],
            "digit_price": {q: {m: digit_price(found.of(q, m)) for m in _methods(found, q)} for q in found.questions},
            "fates": [vars(f) for f in found.fates],
            "left_out": [{"method": m, "value": v, "reason": why} for m, v, why in found.left_out], "words": words(found)}


def _methods(found, question):
    return list(dict.fromkeys(p.method for p in found.of(question)))


def _row(found, p) -> dict:
    values = (found.case.name, p.question, p.method, p.setting, p.value, p.error, min(p.digits, 99.0), p.steps, p.evaluations, p.seconds,
              p.slowest, p.repeats, p.compile, p.lanes, p.parts, any(p is q for q in found.front(p.question)))
    return dict(zip(COLUMNS, values))


def csv(found) -> str:
    """One line per point; empty where a count does not exist, inf where no answer came."""
    rows = [",".join(COLUMNS)]
    for p in found.points:
        cells = ["" if v is None else repr(v) if isinstance(v, float) else str(v) for v in _row(found, p).values()]
        rows.append(",".join(f'"{c}"' if "," in c else c for c in cells))
    return "\n".join(rows)


def write(found, path) -> Path:
    """The picture (.png) or the points (.csv), whole or not at all."""
    path = checked(path)
    if path.suffix == ".csv":
        with style.whole_file(path) as waiting:
            waiting.write_text(csv(found) + "\n", encoding="utf-8")
        return path
    with style.drawing() as plt:
        return style.save(picture(plt, found), path)


def checked(path) -> Path:
    """The path, if its ending is one that can be written."""
    path = Path(path)
    if path.suffix not in (".png", ".csv"):
        raise InputError(f"{path}: expected a name that ends in .png or .csv, got {path.suffix or 'no ending'}")
    return path


# -- picture -----------------------------------------------------------------------------------------------------------

WORST, LEAST = 10.0, 1e-17  # errors beyond are drawn at the edge
NOTED = 1.5  # digits: stretches of the front at least so long have their price written on them


def picture(plt, found):
    """Time against error, both logarithmic: a panel per question, a line per method, the front as a grey band."""
    import textwrap
    questions = found.questions
    if not questions:
        raise InputError(f"{found.case.name}: nothing to draw: {found.reference.reason}")
    columns = min(2, len(questions))
    rows = -(-len(questions) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(5.6 * columns, 4.0 * rows + 1.3), layout="constrained", squeeze=False)
    for ax, question in zip(axes.flat, questions):
        _panel(ax, found, question)
    for ax in axes.flat[len(questions):]:
        ax.set_visible(False)
    shown = [m for m in LOOKS if any(p.method == m for p in found.points)]
    style.legend(figure, [(_legend(found, m), LOOKS[m]) for m in shown] + [("front: none is both faster and better", FRONT)], columns=4)
    figure.suptitle(f"{found.case.name}: what accuracy costs", fontsize=11, parse_math=False)
    note = f"Reference error {found.reference.error.max():.0e}. {caption()}"
    width = 150 if columns == 2 else 78
    figure.legends[0].set_title("\n".join(textwrap.wrap(note, width)), prop={"size": 7.5})
    figure.legends[0].get_title().set(color=style.GREY, parse_math=False)
    return figure


FRONT = {"color": "#CDD5DA", "linewidth": 7, "marker": "o", "markersize": 11, "markeredgewidth": 0, "solid_joinstyle": "round"}


def _legend(found, method) -> str:
    factor = next((f for q in found.questions if (f := digit_price(found.of(q, method))) is not None), None)
    name = f"{method} (a motion of {found.of('span', method)[0].lanes})" if method == "taylor-batch" else method
    return name if factor is None else f"{name}: {price(factor)} a digit"


def _panel(ax, found, question):
    ax.set(xscale="log", yscale="log", xlabel="largest relative error", ylabel="time (s)", title=_title(found, question))
    front = found.front(question)
    ax.plot([_clipped(p.error) for p in front], [p.seconds for p in front], zorder=1, **FRONT)
    for method in _methods(found, question):
        points = [p for p in found.of(question, method) if not math.isinf(p.error)]
        x, y = [_clipped(p.error) for p in points], [p.seconds for p in points]
        ax.vlines(x, y, [p.slowest for p in points], color=LOOKS[method]["color"], linewidth=0.6, alpha=0.3, zorder=2)
        ax.plot(x, y, markersize=5, linewidth=1.3, zorder=3, **LOOKS[method])
        if method in FORMULAS and points:
            ax.axvline(min(x), color=LOOKS[method]["color"], linewidth=0.8, linestyle=":", zorder=1)
    if question in ("span", "end") and found.sensitivity is not None:
        ax.axvline(_clipped(found.sensitivity * EPS), color=style.GREY, linestyle="--", linewidth=0.9)
        ax.annotate("last place of the start", (_clipped(found.sensitivity * EPS), 0.98), xycoords=("data", "axes fraction"),
                    rotation=90, va="top", ha="right", fontsize=7, color=style.GREY)
    ax.invert_xaxis()  # better to the right
    for one, two in zip(front, front[1:]):
        if two.digits - one.digits >= NOTED:
            factor = (two.seconds / one.seconds) ** (1 / (two.digits - one.digits))
            ax.annotate(f"{price(factor)} a digit", (math.sqrt(_clipped(one.error) * _clipped(two.error)),
                        math.sqrt(one.seconds * two.seconds)), xytext=(0, 9), textcoords="offset points", ha="center", fontsize=7.5)


def _clipped(error) -> float:
    return min(max(error, LEAST), WORST)


# -- a page of the report ----------------------------------------------------------------------------------------------


def page(cases, folder, tell=None, quick: bool = True) -> Path:
    """Measure every case that has a motion and a span and write precision.html with its pictures (in precision/) into
    the folder; returns its path. quick: coarse ladders, seconds a case. Cases of one motion are measured once."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    from ..analysis.precision import precision
    folder, tell, sections, passed = Path(folder), tell or (lambda words: None), [], []
    for case in cases:
        if case.state is None or case.span is None:
            passed.append(f"{case.name}: no motion with a span")
            continue
        tell(f"precision of {case.name}")
        found = precision(case, quick)
        if not found.questions:
            passed.append(f"{case.name}: {found.reference.reason}")
            continue
        drawn = write(found, folder / "precision" / f"{case.name}.png")
        write(found, folder / "precision" / f"{case.name}.csv")
        sections.append({"name": case.name, "title": case.title or case.name, "words": words(found), "picture": f"precision/{drawn.name}",
                         "csv": f"precision/{case.name}.csv", "command": f"stabilab precision {case.path}{' --quick' if quick else ''}",
                         "front": [{"digits": f"{p.digits:.1f}", "method": p.method, "setting": setting(p)[2:], "time": duration(p.seconds)}
                                   for p in found.front("span")]})
    environment = Environment(loader=FileSystemLoader(Path(__file__).parent / "templates"), autoescape=True, undefined=StrictUndefined)
    html = environment.get_template("precision.html").render(cases=sections, passed=passed, machine=caption(), quick=quick, questions=QUESTIONS)
    with style.whole_file(folder / "precision.html") as waiting:
        waiting.write_text(html, encoding="utf-8")
    return folder / "precision.html"
