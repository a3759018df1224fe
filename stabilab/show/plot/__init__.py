"""Plots of a case or a scene: each takes Matplotlib axes and returns them; `write` makes a file."""
from .basins import basin as basin
from .body import body as body
from .equilibria import equilibria as equilibria
from .histogram import histogram as histogram
from .in_space import space as space
from .nutation import nutation as nutation
from .over_time import state as state
from .over_time import tilt as tilt
from .over_time import time as time
from .over_time import wheel as wheel
from .path import budget as budget
from .phase_plane import phase as phase
from .phase_plane import potential as potential
from .phase_plane import section as section
from .surfaces import sphere as sphere
from .to_file import write as write
from .turning import attitude as attitude

__all__ = ["attitude", "basin", "body", "budget", "equilibria", "histogram", "nutation", "phase", "potential",
           "section", "space", "sphere", "state", "tilt", "time", "wheel", "write"]
