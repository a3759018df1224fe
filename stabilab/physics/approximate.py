"""Approximate laws of a scene: how far they hold is asked through here, so that a scene of exact laws loads nothing of it."""
from __future__ import annotations

from types import ModuleType

from .scene import AnyScene


def limits_of(scene: AnyScene) -> ModuleType | None:
    """What tells how far the approximate laws of a scene hold, `law_limits`; None where all its laws are exact."""
    if not scene.approximate:
        return None
    from . import law_limits
    return law_limits
