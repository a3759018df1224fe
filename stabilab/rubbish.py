"""How often Python looks for objects that nothing refers to any more."""
from __future__ import annotations

import gc

# Reading modules and drawing make many objects and little rubbish: with the interpreter's 700 the collector
# would look through them some hundred times before a small command has begun, at a tenth of its time, and as
# much again while a page is made.
OBJECTS_BETWEEN_COLLECTIONS = 50_000


def seldom() -> None:
    """Let the collector of this process look after that many new objects."""
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)
