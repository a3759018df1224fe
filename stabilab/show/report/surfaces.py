"""The separatrix of a case as files beside its page: meshes, and a still picture where this machine can draw."""
from __future__ import annotations

from pathlib import Path

from ...errors import StabilabError
from ...orbit.separatrix.sheets import separatrix
from ..surface import write as surface

SHAPE = (48, 97)  # rows and columns of a sheet: smooth to the eye, 1.5 MB of meshes a scene


def surface_of(case, stem: str, folder: Path, drawn: bool) -> dict | None:
    """Names of the files, counts and what the sheets part; None where the case has no separatrix, whose reason its own section gives."""
    try:
        found = separatrix(case.scene, shape=SHAPE)
    except StabilabError:
        return None
    if not found.sheets:
        return None
    meshes = [surface.triangulate(sheet) for sheet in found.sheets]
    summary = surface.summarise(case, found, meshes)
    files = surface.write_meshes(meshes, folder, stem)
    still = surface.draw(case.scene, found, meshes, folder / f"{stem}.png") if drawn else None
    return {"title": case.heading, "reason": found.reason, "triangles": summary["triangles"], "residual": summary["largest_residual"],
            "files": [file.name for file in files], "still": still and still.name}


def note(renderer) -> str:
    """What to say where no picture of a surface can be drawn; empty where one can."""
    return "" if renderer.available else (f"Pictures of surfaces could not be drawn on this machine ({renderer.words}); the meshes are here all the "
                                          f"same. Cure: {renderer.cure}")
