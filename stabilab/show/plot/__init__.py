"""Plots of a case or a scene: each takes Matplotlib axes and returns them; `write` makes a file."""
from .basins import basin as basin
from .cost import budget as budget
from .in_rates.all_equilibria import equilibria as equilibria
from .in_rates.momentum_surface import sphere as sphere
from .in_rates.rate_space import space as space
from .over_time import time as time
from .phase_plane import phase as phase
from .plane_section import section as section
from .to_file import write as write
from .turning.animation import attitude as attitude
from .whole_state import state as state

__all__ = ["attitude", "basin", "budget", "equilibria", "phase", "section", "space", "sphere", "state", "time", "write"]
