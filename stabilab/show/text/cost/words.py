"""What accuracy costs, in plain words made from the measured front."""
from __future__ import annotations

import re

from ....cost.accuracy import EPS, WANTED, digit_price
from ....integrate.trajectory import SCIPY_METHODS
from ....processes import machine, versions
from ...terminal.letters import some, written

FORMULAS = ("linear", "corrected", "printed", "averaged1", "averaged2", "lindstedt")
NAMES = {"taylor": "Taylor series (heyoka)",
         "taylor-batch": "Taylor series, four at once (heyoka)",
         "reduced": "reduced equation, closed form", "balls": "ball arithmetic",
         "reference": "series in many digits, twice"} | {
             name: f"{name} (SciPy)" for name in SCIPY_METHODS}
DOUBLES = WANTED[:-1]  # that a run in doubles may have
SPAN = re.compile(r"(up to t = [\d.e+-]+ of [\d.e+-]*\d)")
BLAMED = 20  # an error this many times the effect of the start's last place has other causes
SIX = 6  # digits at which the methods are set side by side
FATES = {"energy": "{0}, by the energy in doubles with its error bound in {1}",
         "balls": "in many digits the energy is {0}: {1}"}


def words(found) -> list[str]:
    """The measurement in plain words, one sentence or two a string."""
    fates = [FATES[f.method].format(f.word, duration(f.seconds)) for f in found.fates]
    return [_reference_words(found), *(s for q in found.questions for s in _question_words(found, q)),
            *([f"Fate: {'; '.join(fates)}."] if fates else []), *_model_words(found)]


def _reference_words(found) -> str:
    r = found.reference
    if not len(r.t):
        return f"Nothing was measured: {r.reason}."
    whole = r.reason if found.case.variables == "scaled" else SPAN.sub(r"\1 s", r.reason)
    reach = "" if r.status == "agrees" else f" Only so far: {whole}; the rest of the span is not judged."
    return (f"Judged at {some(len(r.t), 'time')} up to {_moment(found)} by a Taylor series run in "
            f"{r.digits[0]} and in {r.digits[1]} "
            f"digits; the two differ by {r.error.max():.0e} of the state, which is the reference's "
            f"error.{reach}")


def _question_words(found, question):
    points = [p for p in found.of(question) if p.lanes == 1 and not p.parts]
    prices = [(digits, enough[0]) for digits in DOUBLES if (enough := found.cheapest(digits, question))]
    head = title(found, question)
    if not prices:
        yield f"{head}: no method has {DOUBLES[0]} digits."
        return
    enough = found.cheapest(SIX, question)
    if len(enough) > 1:
        costs = ", ".join(f"{duration(p.seconds)} with {p.method}" for p in enough)
        yield f"{head}: six digits cost {costs}."
    most = {id(p): (digits, p) for digits, p in prices}  # the most digits that one setting has
    parts = [f"{digits} digits cost {duration(p.seconds)} ({p.method}{setting(p)})"
             for digits, p in most.values()]
    each = {m: digit_price(found.of(question, m)) for m in methods(found, question) if m != "taylor-batch"}
    known = [f"{m} ×{factor:.2f}" for m, factor in each.items() if factor is not None]
    more = f" One more digit: {', '.join(known)}." if known else ""
    yield f"{head}: {', '.join(parts)}.{_against(points, prices)}{more}"
    missing = next((d for d in DOUBLES if d > prices[-1][0]), None)
    best = max(points, key=lambda p: p.digits)
    if missing:
        reached = f"{best.digits:.1f} ({best.method}{setting(best)})"
        because = _because(found, question, missing, best)
        yield f"No method gets {missing} digits: the best is {reached}{because}."


def title(found, question) -> str:
    """The question of this case, as a heading."""
    named = {"span": f"States at {some(len(found.reference.t), 'time')} up to {_moment(found)}",
             "end": f"The state at {_moment(found)}"}
    return named.get(question, f"The {question}")


def _moment(found):
    """The last time that is judged, with its unit."""
    last = f"{found.reference.t[-1]:.6g}"
    return f"τ = {last}" if found.case.variables == "scaled" else f"t = {last} s"


def by_digits(found) -> list[dict]:
    """A row for each number of digits of the states that some method has: the cheapest method, how many times
    the price of the first row that is, and the second best. The reference too stands for its digits, by its
    own runs, where fewer than two methods have them."""
    rows: list[dict] = []
    for digits in WANTED:
        offers = [{"method": p.method, "setting": p.setting, "value": p.value, "seconds": p.seconds}
                  for p in found.cheapest(digits, "span")[:2]]
        exact = found.reference.digits[0]
        if len(found.reference.t) and digits <= exact and len(offers) < 2:
            offers.append({"method": "reference", "setting": "digits", "value": exact,
                           "seconds": found.reference_seconds})
        if offers:
            first = rows[0]["seconds"] if rows else offers[0]["seconds"]
            rows.append({"digits": digits, **offers[0], "relative": offers[0]["seconds"] / first,
                         "second": offers[1] if len(offers) > 1 else None})
    return rows


def flat(found) -> str:
    """Why more digits cost a Taylor series little: it takes as many steps, of a higher order."""
    points = found.of("span", "taylor")
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


def _because(found, question, missing, best) -> str:
    shift = (found.sensitivity or 0.0) * EPS if question in ("span", "end") else 0.0
    if shift > max(0.2 * 10.0**-missing, best.error / BLAMED):
        return (f"; a change of the start in its last place (1e-16) moves the state by {shift:.0e} within "
                f"the span, "
                "so doubles do not hold more")
    if found.left_out:
        return "; rounding on the way has the last word, or the finer settings that were left out"
    return "; rounding on the way has the last word"


def _model_words(found):
    for name in FORMULAS:
        points = found.of("span", name)
        if points:
            best = min(points, key=lambda p: p.error)
            yield (f"The model {name}{setting(best)}: its own error is {share(best.error)} the state, "
                   f"whatever is spent on it"
                   f"{f' (of {written(best.parts)} alone)' if best.parts else ''}.")
        elif any(m == name for m, *_ in found.left_out):
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


def methods(found, question) -> list[str]:
    """Names of the methods that answered a question."""
    return list(dict.fromkeys(p.method for p in found.of(question)))
