"""Costs of methods in words, made from the measured front; and models beside the exact motion, as text,
JSON, CSV, and as a picture of histories."""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...cost.accuracy import EPS, WANTED, digit_price
from ...files import write_text
from ...integrate.trajectory import ALL_REACHED, SCIPY_METHODS
from ...physics.scene import PARTS
from ...processes import machine, versions
from ...reasons import Reason, outward
from ...representation import values_of
from ...theories.theory import NO_ANSWER
from .. import style
from ..data import csv_lines
from ..terminal import lettered, some, written
from ..units import SHORT, Units, number, units_of
from . import notes
from .simulation import theory_lines

if TYPE_CHECKING:
    from types import SimpleNamespace

    from matplotlib.axes import Axes

    from ...answers.simulate import Simulation

# --- Costs in words
FORMULAS = ("linear", "corrected", "printed", "averaged1", "averaged2", "lindstedt")
NAMES = {"taylor": "Taylor series (heyoka)",
         "taylor-batch": "Taylor series, four at once (heyoka)",
         "reduced": "reduced equation, closed form", "balls": "ball arithmetic",
         "reference": "series in many digits, twice"} | {
             name: f"{name} (SciPy)" for name in SCIPY_METHODS}
DOUBLES = WANTED[:-1]  # that a run in doubles may have
BLAMED = 20  # an error this many times the effect of the start's last place has other causes
SIX = 6  # digits at which the methods are set side by side
FATES = {"energy": "{0}, by the energy in doubles with its error bound in {1}",
         "balls": "in many digits the energy is {0}: {1}"}


def words(result) -> list[str]:
    """The measurement in plain words, one sentence or two a string."""
    fates = [FATES[f.method].format(f.word, duration(f.seconds)) for f in result.fates]
    return [_reference_words(result), *(s for q in result.questions for s in _question_words(result, q)),
            *([f"Fate: {'; '.join(fates)}."] if fates else []), *_model_words(result)]


def _reference_words(result) -> str:
    r = result.reference
    if not len(r.t):
        return f"Nothing was measured: {r.because}."
    reach = "" if r.status == "agrees" else f" Only so far: {r.because}; the rest of the span is not judged."
    return (f"Judged at {some(len(r.t), 'time')} up to {_moment(result)} by a Taylor series run in "
            f"{r.digits[0]} and in {r.digits[1]} "
            f"digits; the two differ by {outward(r.error.max(), 1, 1):.0e} of the state, which is the "
            f"reference's error.{reach}")


def _question_words(result, question):
    points = [p for p in result.of(question) if p.lanes == 1 and not p.parts]
    prices = [(digits, enough[0]) for digits in DOUBLES if (enough := result.cheapest(digits, question))]
    head = title(result, question)
    if not prices:
        yield f"{head}: no method has {DOUBLES[0]} digits."
        return
    enough = result.cheapest(SIX, question)
    if len(enough) > 1:
        costs = ", ".join(f"{duration(p.seconds)} with {p.method}" for p in enough)
        yield f"{head}: six digits cost {costs}."
    largest = {id(p): (digits, p) for digits, p in prices}  # the most digits that one setting has
    parts = [f"{digits} digits cost {duration(p.seconds)} ({p.method}{setting(p)})"
             for digits, p in largest.values()]
    each = {m: digit_price(result.of(question, m)) for m in methods(result, question) if m != "taylor-batch"}
    resolved = [f"{m} ×{factor:.2f}" for m, factor in each.items() if factor is not None]
    more = f" One more digit: {', '.join(resolved)}." if resolved else ""
    yield f"{head}: {', '.join(parts)}.{_against(points, prices)}{more}"
    missing = next((d for d in DOUBLES if d > prices[-1][0]), None)
    best = max(points, key=lambda p: p.digits)
    if missing:
        reached = f"{best.digits:.1f} ({best.method}{setting(best)})"
        because = _because(result, question, missing, best)
        yield f"No method gets {missing} digits: the best is {reached}{because}."


def title(result, question) -> str:
    """The question of this case, as a heading."""
    named = {"span": f"States at {some(len(result.reference.t), 'time')} up to {_moment(result)}",
             "end": f"The state at {_moment(result)}"}
    return named.get(question, f"The {question}")


def _moment(result):
    """The last time that is judged, with its unit."""
    last = f"{result.reference.t[-1]:.6g}"
    return f"τ = {last}" if result.case.variables == "scaled" else f"t = {last} s"


def by_digits(result) -> list[dict]:
    """A row for each number of digits of the states that some method has: the cheapest method of runs that
    are repeated, how many times the price of the first row that is, and the second best; once: the cheapest
    of a first run, with import and compiling. The reference too stands for its digits, by its own runs, where
    fewer than two methods have them."""
    rows: list[dict] = []
    for digits in WANTED:
        offers = [_offer(p) for p in result.cheapest(digits, "span")[:2]]
        firsts = [_offer(p) for p in result.cheapest(digits, "span", once=True)[:1]]
        exact = result.reference.digits[0]
        if len(result.reference.t) and digits <= exact and len(offers) < 2:
            offers.append({"method": "reference", "setting": "digits", "value": exact,
                           "seconds": result.reference_seconds,
                           "first_seconds": result.reference_seconds})
        once = min(firsts + offers, key=lambda offer: offer["first_seconds"], default=None)
        if offers:
            first = rows[0]["seconds"] if rows else offers[0]["seconds"]
            rows.append({"digits": digits, **offers[0], "once": once,
                         "relative": offers[0]["seconds"] / first,
                         "second": offers[1] if len(offers) > 1 else None})
    return rows


def _offer(p) -> dict:
    return {"method": p.method, "setting": p.setting, "value": p.value, "seconds": p.seconds,
            "first_seconds": p.first}


def flat(result) -> str:
    """Why more digits cost a Taylor series little: it takes as many steps, of a higher order."""
    points = result.of("span", "taylor")
    if len(points) < 2 or not (points[0].steps and points[-1].steps):
        return ""
    first, last = points[0], points[-1]
    order = [round(p.evaluations / p.steps) for p in (first, last)]
    return (f"The Taylor series takes {first.steps} steps at rtol {first.value:.0e} and {last.steps} at "
            f"{last.value:.0e}; its order rises from {order[0]} to {order[1]}: digits are bought with the "
            f"order, which costs little.")


def _against(points, prices) -> str:
    """How much longer SciPy's best takes, for the most digits that it reaches."""
    for digits, p in reversed(prices):
        others = [q for q in points if q.method in SCIPY_METHODS and q.digits >= digits]
        if others and p.method not in SCIPY_METHODS:
            other = min(others, key=lambda q: q.seconds)
            return (f" SciPy's best for {digits} digits among the settings tried, {other.method}, takes "
                    f"{so_many(other.seconds / p.seconds, 3)} times as long ({duration(other.seconds)}).")
    return ""


def _because(result, question, missing, best) -> str:
    shift = (result.sensitivity or 0.0) * EPS if question in ("span", "end") else 0.0
    if shift > max(0.2 * 10.0**-missing, best.error / BLAMED):
        return (f"; a change of the start in its last place (1e-16) moves the state by {shift:.0e} within "
                f"the span, "
                "so doubles do not hold more")
    if result.left_out:
        return "; rounding on the way has the last word, or the finer settings that were left out"
    return "; rounding on the way has the last word"


def _model_words(result):
    for name in FORMULAS:
        points = result.of("span", name)
        if points:
            best = min(points, key=lambda p: p.error)
            yield (f"The model {name}{setting(best)}: its own error is {share(best.error)} the state, "
                   f"whatever is spent on it"
                   f"{f' (of {written(best.parts)} alone)' if best.parts else ''}.")
        elif any(m == name for m, *_ in result.left_out):
            yield f"The model {name} has no answer over the whole span."


def so_many(value: float, digits: int) -> str:
    """A number of so many digits, without an exponent where it is no more than a million."""
    return f"{float(f'{value:.{digits}g}'):,.0f}" if 10**digits <= value <= 1e6 else f"{value:.{digits}g}"


def share(error: float) -> str:
    """An error beside what it is of: 0.02 of, 18 times."""
    return f"{error:.2g} of" if error < 1 else f"{so_many(error, 2)} times"


def duration(seconds) -> str:
    """Seconds in a fitting unit, three digits."""
    for unit, factor in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= 0.9995 * factor:  # what three digits round up to one of it
            return f"{seconds / factor:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def setting(p) -> str:
    """", rtol 1e-09" and its like; nothing for a formula."""
    return ("" if p.setting == "formula" else f", {p.setting} {p.value:.2g}" if p.setting == "rtol"
            else f", {p.setting} {p.value:g}")


def caption() -> str:
    """Machine and versions that the times belong to."""
    m, v = machine(), versions()
    return (f"{m['processor']}, {m['cores']} cores, {m['system']}; "
            + ", ".join(f"{name} {number}" for name, number in v.items()))


def methods(result, question) -> list[str]:
    """Names of the methods that answered a question."""
    return list(dict.fromkeys(p.method for p in result.of(question)))


# --- Models beside the exact motion
LOOKS = {"exact": {"color": style.BLACK, "linewidth": 2.2},
         "linear": {"color": style.GREY, "linewidth": 1.4, "linestyle": "--"},
         "corrected": {"color": style.WINE, "linewidth": 1.5, "linestyle": "-."},
         "printed": {"color": style.SAGE, "linewidth": 1.6, "linestyle": ":"},
         "averaged1": {"color": style.GREY, "linewidth": 1.4, "linestyle": "-."},
         "averaged2": {"color": style.WINE, "linewidth": 1.4, "linestyle": "--"},
         "lindstedt": {"color": style.WINE, "linewidth": 1.2, "linestyle": (0, (5, 2))}}
# of a model that would bury the others: a ground below them
BURIED = {"linestyle": "-", "linewidth": 0.6, "antialiased": False, "alpha": 0.35, "zorder": 1.9}
DARK = {"printed": "#4F6B41"}  # of words, to be read
# where a model ends before the motion does
END = {"marker": "X", "markersize": 7, "linestyle": "none", "zorder": 5}
FLAT = 1e-4  # of its values, a range below which an axis counts from one of them
DENSE = 100  # turns of a model in a panel from which on it would
SYMBOLS = {"omega": (r"$\omega_1$", r"$\omega_2$", r"$\omega_3$"),
         "gamma": (r"$\gamma_1$", r"$\gamma_2$", r"$\gamma_3$"),
         "angles": (r"$\psi$", r"$\phi$", r"$\theta$"), "momentum": (r"$H_1$", r"$H_2$", r"$H_3$"),
         "velocity": (r"$v_1$", r"$v_2$", r"$v_3$"), "position": (r"$x_1$", r"$x_2$", r"$x_3$")}
MODEL_LABELS = {"exact": "exact motion", "printed": "as printed", "linear": "linear model, both rates",
         "corrected": "corrected integrals",
         "averaged1": "averaged, first order", "averaged2": "averaged, second order",
         "lindstedt": "corrected expansion"}
TIMES = 10  # the share of a motion's size from which on an error is given as so many times that size
# inches of a figure of letters of full size, below which there is no room for numbers on each panel
BRIEF = 8.0
ROUNDING = 1e-12  # of the largest component, a range of a panel that is rounding
# a model that leaves the exact motion's range by more than this factor is cut off, and the panel says so
REACH = 1.6


def as_dict(case, result) -> dict:
    """The object of `stabilab compare --json`."""
    return {"schema": "stabilab.compare/1", "case": case.name, "time": case.scene.time_unit, "t": result.t,
            "models": {name: {"status": run.status, "reason": run.because, "why": run.reason.as_dict()}
                       for name, run in result.runs.items()}
            | {name: {"status": "refused", "reason": why.text(), "why": why.as_dict()}
               for name, why in result.refusals.items()},
            "departures": [{**values_of(d, "model part error scale largest"), "relative": _relative(d),
                            "first": {f"{level:g}": time for level, time in d.first.items()}}
                           for d in result.departures],
            "theory": list(result.theory)}


def text(case, result, units: Units) -> str:
    """The closest model, a line per model and part of the state, then what each model says of itself."""
    lines = [f"{case.name}: {_closest(result)}; {', '.join(list(result.runs)[1:]) or 'no model'} against the "
             f"exact motion, "
             f"{units.span(case.scene.time_unit, result.t[0], result.t[-1])}",
             f"  {'model':<10}{'part':<9}{'largest error':>13}{'of':>10}  "
             f"{'':<8}{'1 % from':>12}{'10 % from':>12}"]
    for d in result.departures:
        unit, item = units.of(PARTS[d.part].unit)
        first = ["never" if time is None else units.time(time, SHORT) for time in d.first.values()]
        row = (
            f"  {d.model:<10}{written(d.part):<9}{number(d.largest * item):>13}{number(d.scale * item):>10}  "
            f"{written(unit):<8}{first[0]:>12}{first[1]:>12}")
        lines.append(row)
    return "\n".join([*lines, *(f"  {note}" for note in _notes(result, units))])


def _notes(result, units) -> list[str]:
    """What the models say of themselves, each once, then what the theory says beyond that."""
    models: dict[Reason, list[str]] = {}
    for name, run in result.runs.items():
        if run.reason != ALL_REACHED:
            models.setdefault(run.reason, []).append(name)
    for name, why in result.refusals.items():
        models.setdefault(NO_ANSWER(why=why), []).append(name)
    return [*(f"{', '.join(names)}: {lettered(units.said(reason))}" for reason, names in models.items()),
            *theory_lines([row for row in result.theory if row["reason"] not in models], units)]


def _closest(result) -> str:
    """The model that departs least from the exact rates, and by how much."""
    rates = [(off, d) for d in result.departures if d.part == result.departures[0].part
             if (off := _relative(d)) is not None]
    if not rates:
        return "no model has an answer"
    off, best = min(rates, key=lambda row: row[0])
    by = f"{100 * off:.3g} %" if off < TIMES else f"{off:.3g} times its size"
    return f"{best.model} is closest, its {written(best.part)} off by {by} at most"


def _relative(departure) -> float | None:
    """The largest error over the size of the exact motion; None where that is at rest."""
    return departure.largest / departure.scale if departure.scale else None


def write(case, result, path) -> Path:
    """Errors over time as CSV, whole or not at all."""
    head = [case.scene.time_unit, *(f"{d.model} {d.part}" for d in result.departures)]
    rows = zip(result.t, *(d.error for d in result.departures))
    return write_text(path, csv_lines([head, *(map(float, row) for row in rows)]))


def picture(plt, case, runs, parts=("omega",), size=None, units: Units | None = None, more: str = ""):
    """A figure: one row per part of the state, one column per component, every model of `runs` over the exact
    motion. units: None is those of the case. more: a line below its title."""
    units = units or units_of(case)
    clock, second = units.times(runs["exact"].t[-1])
    parts = [p for p in parts if p in runs["exact"].state]
    figure, axes = plt.subplots(len(parts), 3, figsize=size or (10.5, 0.9 + 2.3 * len(parts)),
                                layout="constrained", squeeze=False,
                                sharex=True)
    looks = {name: LOOKS[name] | (BURIED if name != "exact" and _dense(run, parts) else {})
             for name, run in runs.items()}
    for row, part in zip(axes, parts):
        for column, ax in enumerate(row):
            unit, x = units.of(PARTS[part].unit)
            _curves(ax, {name: (np.asarray(run.t) * second, np.asarray(run.state[part])[:, column] * x)
                         for name, run in runs.items() if part in run.state}, looks)
            low, high = ax.get_ylim()
            size = float(np.abs(runs["exact"].state[part]).max(initial=0.0)) * x
            if high - low < ROUNDING * size:  # beside the whole part of the state no motion
                ax.set_ylim((low + high) / 2 - size / 20, (low + high) / 2 + size / 20)
            for name, run in runs.items():
                if stops(run) and part in run.state and len(run.t):
                    ax.plot(run.t[-1] * second, run.state[part][-1][column] * x, color=LOOKS[name]["color"],
                            scalex=False, scaley=False, **END)
            ax.set_ylabel(_labelled(ax, SYMBOLS[part][column], written(unit)))
    for ax in axes[-1]:
        ax.set_xlabel(f"$t$ ({written(clock)})")
    rest = style.over(figure, case.heading, more)
    rows = [(MODEL_LABELS[name] + (f", ends at {run.t[-1] * second:.3g} {written(clock)}" if stops(run)
                            and len(run.t) else ""),
             looks[name] | ({"linewidth": 2.4} if LOOKS[name] != looks[name] else {}))  # of a ground: seen
            for name, run in runs.items()]
    style.legend(figure, rows, notes=notes.fitted([*map(notes.as_note, rest)], figure.get_figwidth()))
    return figure


def stops(run: SimpleNamespace | Simulation | Sequence[np.ndarray]) -> bool:
    """Whether a run ends before the last time that was asked for."""
    return getattr(run, "status", "reached") != "reached"


def _labelled(ax: Axes, name: str, unit: str) -> str:
    """The label of a panel's axis. One whose range is a small part of its values counts from one of them,
    which the label names: an offset above the panel, a power of ten plus a number, would have to be added in
    the head."""
    low, high = ax.get_ylim()
    if high - low > FLAT * max(abs(low), abs(high)):
        return f"{name} ({unit})" if unit else name
    from matplotlib.ticker import FuncFormatter
    power = math.floor(math.log10((high - low) / 2))
    full = math.floor(low / 10.0 ** (power + 1) + 0.5) * 10.0 ** (power + 1)
    def shown(value, _):
        return f"{round((value - full) / 10.0**power, 4) + 0.0:.6g}".replace("-", "−")
    ax.yaxis.set_major_formatter(FuncFormatter(shown))
    ten = rf"$10^{{{power}}}$" + (f" {unit}" if unit else "")
    return f"{name} {'−' if full >= 0 else '+'} {abs(full):.12g} ({ten})"


def _dense(run: SimpleNamespace | Simulation, parts: Sequence[str]) -> bool:
    """Whether some component of a run turns so often that its curve is a ground and no line."""
    def turns(values: np.ndarray):
        up = np.sign(np.diff(values))
        return int((up[1:] * up[:-1] < 0).sum())
    return any(turns(row) > DENSE for part in parts if part in run.state
               for row in np.asarray(run.state[part]).T)


def _curves(ax: Axes, runs: Mapping[str, tuple[np.ndarray, np.ndarray]], looks: Mapping[str, dict[str, Any]]):
    """The curves, (times, values) by the names of the models."""
    exact = runs["exact"][1]
    for name, (t, values) in runs.items():
        ax.plot(t, values, **looks[name])
    middle, half = (exact.max() + exact.min()) / 2, (exact.max() - exact.min()) / 2
    low, high = ax.get_ylim()
    wide = half * REACH or 1e-9 * max(abs(middle), 1)
    if half and (high - low) > 6 * half:  # a model far off must not flatten the motion itself
        ax.set_ylim(middle - 2 * wide, middle + 2 * wide)
        _tell_cut(ax, [(name, ends) for name, (_, values) in runs.items()
                       if (ends := beyond(values, *ax.get_ylim()))])


def _tell_cut(ax, models):
    """How far the curves go that leave a panel, above it, each in its colour: a third of the width each."""
    brief = ax.figure.get_figwidth() < BRIEF * style.share()
    for (name, ends), (x, side) in zip(models, ((0.0, "left"), (1.0, "right"), (0.5, "center"))):
        printed = f"to {ends[0]}" if len(ends) == 1 else " to ".join(ends)
        ax.text(x, 1.01, "cut" if brief else f"cut: {printed}", color=DARK.get(name, LOOKS[name]["color"]),
                ha=side, va="bottom",
                fontsize=(7.5 if len(models) < 3 else 6.8) * style.share(), transform=ax.transAxes)


def short(value: float) -> str:
    """Three digits without a power of ten where that reads better."""
    return (f"{value:.0f}" if 1000 <= abs(value) < 1e5 else f"{value:.3g}").replace("-", "−")


def beyond(values: np.ndarray, low: float, high: float) -> list[str]:
    """How far values go beyond the ends between which they are drawn: nothing, one end or both."""
    ends = ((np.nanmin(values), np.nanmin(values) < low),
            (np.nanmax(values), np.nanmax(values) > high)) if len(values) else ()
    return [short(end) for end, out in ends if out]
