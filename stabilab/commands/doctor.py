"""`stabilab doctor`: what is installed, and whether pictures can be drawn."""
from __future__ import annotations

from ..show.terminal.page import tell
from ..show.text.doctor import text


def doctor():
    """Tell it, and load no more than that: the program may be asked because something is missing."""
    tell(text())
