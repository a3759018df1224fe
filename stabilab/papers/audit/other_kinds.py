"""Claims that are no identities: the order of a remainder, a printed number, a named test."""
from __future__ import annotations

from decimal import Decimal, InvalidOperation

from ...errors import InputError
from ...theories.printed.claims import Paper, Row, parse
from ...theories.printed.evaluate import Evaluator, Undefined, points, precise, settled
from .checks import bound_of, residuals_of
from .decide import Decision, free
from .systems import system_of

TEST_BOUND = 1e-12  # residuals of named tests: 30 digits or exact counts


def order(paper: Paper, row: Row, pairs, bound, system) -> Decision:
    """Whether left - right falls like the stated power of the small symbol: halved thrice, watched."""
    small, claimed = row.options["small"], row.options["order"]
    symbols = [s for s in free(pairs, (), bound, system) if s.name != small]
    least, numbers = float("inf"), precise(60)
    for point in points(symbols, row.equation, 3,
                        [parse(t, paper.symbols) for t in row.domain if small not in t], bound, system):
        sizes = []
        for halvings in (14, 16, 18):
            ready = settled(numbers, point, None, bound, system) | {small: numbers.mpf(2) ** -halvings}
            value = Evaluator(numbers, ready, bound, system)
            try:
                sizes.append(max(abs(value(left) - value(right)) for left, right in pairs))
            except Undefined:
                return Decision(None, float("nan"), f"no value at a small {small}")
        for first, second in zip(sizes, sizes[1:]):
            if second:
                least = min(least, float(numbers.log(first / second, 4)))
    return Decision(least > claimed - 0.1, least, f"observed order {least:.3g} in {small}, claimed {claimed}")


def number(paper: Paper, row: Row) -> tuple:
    """(verdict, condition, correction, method, residual, corrected residual) of printed digits held against
    the value of an expression."""
    bound = bound_of(paper, row)
    value = Evaluator(precise(40), {}, bound,
                      system_of(paper, row.system, row.place))(parse(row.options["value"], paper.symbols))
    try:
        text = row.printed[0].replace("\u2212", "-")
        # finite, so its exponent is a number
        printed, step = Decimal(text), Decimal(1).scaleb(Decimal(text).as_tuple().exponent)  # type: ignore[arg-type]
    except (InvalidOperation, IndexError):
        raise InputError(f"{row.place}: expected a printed number, got {row.printed}") from None
    error = abs(float(value.real) - float(printed))
    holds = error <= 0.5 * float(step) * (1 + 1e-9) and abs(float(value.imag)) < 1e-12
    digits = max(0, -printed.as_tuple().exponent) + 2  # type: ignore[operator]
    correction = "" if holds else f"{float(value.real):.{digits}f}"
    return ("holds" if holds else "wrong", "", correction, f"value of {row.options['value']} with 40 digits",
            error, float("nan") if holds else 0.0)


def tested(row: Row) -> tuple:
    """The same six of a claim that a named test decides; InputError where the stated verdict is not that of
    its residuals."""
    printed, corrected = residuals_of(row)
    bound = row.options.get("bound", TEST_BOUND)
    stated = row.options.get("verdict", "holds" if printed <= bound else "wrong")
    if (stated == "holds") != (printed <= bound) or (stated != "holds" and row.corrected
                                                     and not corrected <= bound):
        raise InputError(
            f"{row.place}: stated {stated}, but its residuals are {printed:.3g} (printed) and "
            f"{corrected:.3g} (corrected), with the bound {bound:.3g}"
        )
    words = row.options.get("residual", "residual of the claim")
    conditions = row.options.get("conditions", ())
    return (stated, conditions[0] if stated == "only-if" and conditions else "", "; ".join(row.corrected),
            words, printed, corrected)
