"""The separatrix of a case as meshes beside its page, which need no renderer; the page draws its own."""
from __future__ import annotations

from pathlib import Path

from ...errors import StabilabError
from ...orbit.separatrix.sheets import separatrix
from ..surface import write as surface

SHAPE = (48, 97)  # rows and columns of a sheet: smooth to the eye, 1.5 MB of meshes a scene


def surface_of(case, stem: str, folder: Path) -> dict | None:
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
    return {"title": case.heading, "reason": found.reason, "triangles": summary["triangles"], "residual": summary["largest_residual"],
            "files": [file.name for file in files]}
