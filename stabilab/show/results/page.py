"""Results as notebooks show them."""
from __future__ import annotations

import re
from html import escape
from typing import Any

import numpy as np

from ..terminal.letters import MINUS
from .convert import columns
from .variables import variables
from .words import short

MOST = 10  # rows
EXPONENT = re.compile(r"(?<=\de)-(?=\d)")


def html(result: Any) -> str:
    """The line of a result, and its first rows; what is in it is text and never a tag."""
    found = variables(result)
    rows = columns(found)
    index = found.index[0] if len(found.index) == 1 else ""
    labels = found.coordinates[index][0] if index in found.coordinates else range(len(rows[0][1]))
    head = "".join(f"<th>{escape(name)}</th>" for name in (index, *(name for name, _ in rows)))
    number = len(rows[0][1])
    body = "".join(f"<tr><th>{_cell(labels[n])}</th>{''.join(f'<td>{_cell(values[n])}</td>' for _, values in rows)}</tr>" for n in range(min(MOST, number)))
    more = f"<p>and {number - MOST} more</p>" if number > MOST else ""
    return f"<div><p><b>{_text(short(result))}</b></p><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}</div>"


def _cell(value: Any) -> str:
    return f"{float(value) + 0.0:.6g}".replace("-", "−") if isinstance(value, (float, np.floating)) else _text(str(value))


def _text(words: str) -> str:
    """Words as text; the minus of a number as print has it, the hyphens of words as they are."""
    return escape(EXPONENT.sub("−", MINUS.sub("−", words)))
