"""Which uncertain numbers of a case are correlated.

[[correlations]] gives the correlation of two uncertain numbers, that of the numbers themselves. Samples have
a Gaussian copula: normal numbers z of mean 0 and deviation 1, of which a uniform number is Phi(z). With z
correlated by r two normal numbers are by r, a normal and a uniform one by r (3/pi)^(1/2), two uniform ones by
(6/pi) asin(r/2) (Pearson 1907), so that r follows from what is stated."""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

from ..errors import printable
from .table import Table
from .uncertain import NORMAL, Correlation, Uncertain

ROUNDING = 1e-12  # of a matrix of correlations: a pivot below it is none


def correlations_of(top: Table, numbers: Sequence[Uncertain]) -> tuple[Correlation, ...]:
    """Those of the tables [[correlations]]; a fault for a number that is none of the uncertain ones, and for
    values that no numbers have together."""
    if "correlations" not in top:
        return ()
    rows: list[Correlation] = []
    tables = top.tables("correlations")
    before = len(top.faults.problems)
    for table in tables:
        table.known(("of", "value"))
        if not table.required("of", "value", value="add their correlation, from -1 to 1",
                              of='add the two numbers, such as of = ["P2.force", "inertia[3]"]'):
            continue
        value, pair = table.number("value"), _pair(table, numbers)
        if value is not None and not -1 <= value <= 1:
            table.fault(f"expected a correlation from -1 to 1, got {float(value):.10g}", "value")
        elif value is not None and pair is not None:
            if any({row.first, row.second} == {pair[0].key, pair[1].key} for row in rows):
                table.fault("the correlation of these two is given above: keep one of them", "of")
            elif _normal_pair(value, pair) is None:
                table.fault(f"a normal and a uniform number have at most the correlation 0.977, got "
                            f"{float(value):.10g}: make it less", "value")
            else:
                rows.append(Correlation(pair[0].key, pair[1].key, value))
    if len(top.faults.problems) == before and rows and factor(numbers, rows) is None:
        tables[-1].fault("no numbers have these correlations together (their matrix is not positive "
                         "semidefinite): make one of them smaller", "value")
    return tuple(rows)


def _pair(table: Table, numbers: Sequence[Uncertain]) -> tuple[Uncertain, Uncertain] | None:
    """The two numbers of `of`; None, and a fault, where they are not."""
    names = table.data["of"]
    if not isinstance(names, list) or len(names) != 2 or not all(isinstance(name, str) for name in names):
        table.fault('expected the keys of two uncertain numbers, such as ["P2.force", "inertia[3]"]', "of")
        return None
    out = []
    for name in names:
        request = "".join(name.split())
        same = [item for item in numbers if _ends_so(item, request)]
        if len(same) != 1:
            listed = ", ".join(item.key for item in (same or numbers))
            what = (f"may be {listed}: write one of them" if same else
                    f"is no number with an uncertainty; these are {listed}" if numbers else
                    'is no number with an uncertainty: this case states none; write one as "2 N, sigma 5 %"')
            table.fault(f"{printable(name)[:60]}: {what}", "of")
            return None
        out += same
    if out[0] is out[1]:
        table.fault("a number is not correlated with itself: give two", "of")
        return None
    return out[0], out[1]


def _ends_so(item: Uncertain, request: str) -> bool:
    key = "".join(item.key.split())
    return key == request or key.endswith(f".{request}")


def _normal_pair(value: Fraction, pair: Sequence[Uncertain]) -> float | None:
    """The correlation of the normal numbers behind two that are correlated by `value`; None where none is."""
    normal = [item.law == NORMAL for item in pair]
    if all(normal):
        return float(value)
    if not any(normal):
        return 2 * math.sin(math.pi * float(value) / 6)
    result = float(value) * math.sqrt(math.pi / 3)
    return result if abs(result) <= 1 else None


def factor(numbers: Sequence[Uncertain], rows: Sequence[Correlation]) -> list[list[float]] | None:
    """Lower triangle L with L L' the correlations of the normal numbers behind `numbers`; None where these
    are not positive semidefinite."""
    n = len(numbers)
    at = {item.key: index for index, item in enumerate(numbers)}
    matrix = [[float(i == j) for j in range(n)] for i in range(n)]
    for row in rows:
        if row.first not in at or row.second not in at:  # varies by itself
            continue
        i, j = at[row.first], at[row.second]
        value = _normal_pair(row.value, (numbers[i], numbers[j]))
        matrix[i][j] = matrix[j][i] = 0.0 if value is None else value
    lower = [[0.0] * n for _ in range(n)]
    for j in range(n):
        pivot = matrix[j][j] - sum(v * v for v in lower[j][:j])
        if pivot < -ROUNDING:
            return None
        lower[j][j] = root = math.sqrt(pivot) if pivot > ROUNDING else 0.0
        for i in range(j + 1, n):
            rest = matrix[i][j] - sum(a * b for a, b in zip(lower[i][:j], lower[j][:j]))
            if not root and abs(rest) > math.sqrt(ROUNDING):
                return None
            lower[i][j] = rest / root if root else 0.0
    return lower
