"""Plots of a case or a scene: each takes Matplotlib axes and returns them; `write` makes a file."""
from .cost import budget as budget
from .over_time import time as time
from .phase_plane import phase as phase
from .to_file import write as write
from .whole_state import state as state

__all__ = ["budget", "phase", "state", "time", "write"]
