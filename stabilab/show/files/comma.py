"""Rows as comma-separated values, as every reader of them expects: what holds a comma, a quotation mark or a
new line is quoted."""
from __future__ import annotations


def lines(rows) -> str:
    """One line per row, each ended: floats with every digit ("inf" where unbounded), an empty cell for None,
    words quoted where needed."""
    import csv  # classify, which shows no table, does without it
    import io
    out = io.StringIO()
    csv.writer(out,
               lineterminator="\n").writerows([["" if v is None else repr(float(v)) if isinstance(v, float)
                                                else v for v in row] for row in rows])
    return out.getvalue()
