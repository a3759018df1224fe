"""`stabilab show`: the equations of a case and the laws that hold."""
from __future__ import annotations

from ..show.text.scene_text import of_all
from .common.cases import load_cases
from .common.output import tell


def show(case):
    """Equations and laws of a case, of every combination where it has a [sweep]."""
    tell(of_all(load_cases([case])))
