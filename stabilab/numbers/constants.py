"""Constants of the arithmetic."""
from __future__ import annotations

import numpy as np

EPS = float(np.finfo(float).eps)
TURN = 2 * np.pi
