"""The scene of gyrostat and torque that turns exactly as a given one does, where there is one."""
from __future__ import annotations

from ..asked import checked_scene


def effective(scene):
    """The scene itself, or, where charges of constant angle and forces are all it has besides, its twin with the
    gyrostatic moment lambda - k e3. Other scenes come back as they are."""
    if checked_scene(scene).plain:
        return scene
    from .coefficients import content, gyrostat_scene
    parts = content(scene)
    return gyrostat_scene(parts) if parts is not None and parts.kind == "gyrostat" else scene
