"""Under which condition a wrong formula is right: a = 0, D1 = D2, no wheel. Singles first, then pairs."""

from __future__ import annotations

from itertools import combinations

from ...errors import InputError
from ...theories.printed.claims import Paper, Row, parse
from ...theories.printed.evaluate import points
from .decide import decide, free, residual


def candidates(paper: Paper, row: Row) -> list[tuple[str, dict]]:
    """(words, {name: expression}) of every condition to try: the row's own, then the paper's."""
    out = []
    for text in dict.fromkeys((*row.options.get("conditions", ()), *paper.conditions)):
        left, _, right = text.partition("=")
        out.append((text.strip(), {left.strip(): parse(right, paper.symbols)}))
    return out


def condition_of(paper: Paper, row: Row, pairs, bound, system, domain) -> tuple[str, str]:
    """(condition, method) under which the pairs agree; ("", "") where none of the candidates helps. Singles
    are tried before pairs."""
    import mpmath

    single = singles(paper, row, pairs, bound, system, domain)
    double = [(f"{a} and {b}", first | second) for (a, first),
              (b, second) in combinations(single, 2) if first.keys() != second.keys()]
    for words, fixed in [*single, *((words, fixed) for words, fixed in double if _plain(fixed))]:
        if not _quick(mpmath.fp, pairs, bound, system, words, domain, fixed):
            continue
        decision = decide(pairs, bound, system, row.equation + words, domain, fixed)
        if decision.holds:
            return words, decision.method
    return "", ""


def singles(paper: Paper, row: Row, pairs, bound, system, domain) -> list[tuple[str, dict]]:
    """(words, {name: expression}) of the single conditions that speak of symbols of the pairs."""
    standing = {s.name for s in free(pairs, domain, bound, system)}
    return [(words, fixed) for words,
            fixed in candidates(paper, row) if fixed.keys() <= standing and _plain(fixed)]


def _plain(fixed):
    """Whether no fixed symbol stands in what another is fixed to."""
    return not any(s.name in fixed for value in fixed.values() for s in value.free_symbols)


def _quick(numbers, pairs, bound, system, seed, domain, fixed):
    """Whether doubles leave it open that the pairs agree under the condition."""
    symbols = free(pairs, domain, bound, system, fixed)
    try:
        chosen = points(symbols, seed, 2, domain, bound, system, fixed)
    except InputError:
        return False
    found = [residual(pairs, numbers, point, bound, system, fixed) for point in chosen]
    return all(r is not None and r < 1e-7 for r in found)
