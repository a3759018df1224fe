"""The separatrix as files: meshes of every branch, a summary and a picture."""
from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from ...case.read import blamed_on
from ...errors import RenderingUnavailable, printable
from ...orbit.separatrix.branches import separatrix
from ...packages import present
from .. import style
from ..data import plain
from ..files import endings, manifest
from ..progress import each
from . import picture as drawing
from .mesh import Mesh, glb, stl, triangulate
from .render_probe import probe

SCHEMA = "stabilab.surface/1"


def write_all(cases, out, arguments=None) -> list[dict]:
    """Write the separatrices of cases into the folder `out` and return a summary of each.

    NAME.vtp (double precision, point arrays "sheet" and "residual"), NAME.glb and NAME.stl (single
    precision, as those formats are), NAME.json (the summary), NAME.png and manifest.json (arguments: of the
    command line, for it); NAME is that of the case. A case that was read from a text has no file among the
    inputs of the manifest. A case without a separatrix has no files; its summary gives the reason. Where no
    case has one, nothing is written. Raises RenderingUnavailable (with the summaries as its
    attribute `summaries`), after the meshes are written, where this machine cannot draw.
    """
    out = endings.folder(out)
    rows = [(case, *_found(case)) for case in each(cases, lambda one: printable(one.name))]
    summaries = [summarise(case, found, meshes) | {"files": []} for case, found, meshes in rows]
    if not any(meshes for *_, meshes in rows):
        return summaries
    renderer = probe()
    inputs = dict.fromkeys(case.path for case in cases if Path(case.path).is_file())
    residual = max(summary["largest_residual"] for summary in summaries)
    with manifest.written(out, arguments, inputs,
                          {"distance of a vertex from its surface": residual}) as folder:
        for (case, _, meshes), summary in each(zip(rows, summaries),
                                                   lambda row: f"drawing {printable(row[1]['case'])}"):
            if meshes:
                _write(case, meshes, folder, renderer, summary)
    if not renderer.available:
        written = ", ".join(name for summary in summaries for name in summary["files"])
        unavailable = RenderingUnavailable(f"the meshes are in {out} ({written}), but no picture could be "
                                           f"drawn: {renderer.words}. "
                                           f"Cure: {renderer.cure}")
        unavailable.summaries = summaries
        raise unavailable
    return summaries


def _found(case):
    """(separatrix, its meshes) of a case."""
    with blamed_on(case):
        found = separatrix(case.scene)
    return found, [triangulate(branch) for branch in found.branches]


def _write(case, meshes, folder, renderer, summary):
    """The files of one case; the summary is completed and written with them."""
    files = write_meshes(meshes, folder, case.name)
    summary["rendering"] = renderer.words if renderer.available else f"unavailable: {renderer.words}"
    if renderer.available:
        files.append(drawing.draw(case, folder / f"{case.name}.png"))
    summary["files"] = sorted([f"{case.name}.json", *(f.name for f in files)])
    with style.whole_file(folder / f"{case.name}.json") as waiting:
        waiting.write_text(json.dumps(plain(summary), indent=1, allow_nan=False) + "\n", encoding="utf-8")


def summarise(case, found, meshes) -> dict:
    """Counts and the largest residual, branch by branch and in all; plain JSON values."""
    rows = []
    for branch, mesh in zip(found.branches, meshes):
        invariant = np.asarray(branch.invariant, float)
        rows.append({"name": branch.name, "rows": int(branch.points.shape[0]),
                     "columns": int(branch.points.shape[1]),
                     "vertices": len(mesh.points), "triangles": len(mesh.triangles),
                     "largest_residual": float(mesh.residual.max(initial=0.0)),
                     "invariant": [float(invariant.min()), float(invariant.max())],
                     "bounds": [[float(v) for v in pair]
                                for pair in zip(mesh.points.min(0), mesh.points.max(0))]})
    return {"schema": SCHEMA, "case": case.name, "variables": case.scene.variables,
            "components": list(case.scene.components), "sheets": rows,
            "vertices": sum(r["vertices"] for r in rows),
            "triangles": sum(r["triangles"] for r in rows),
            "largest_residual": max((r["largest_residual"] for r in rows), default=0.0),
            "reason": found.reason}


def write_meshes(meshes: list[Mesh], out: Path, name: str) -> list[Path]:
    """NAME.vtp (where vtk is installed), NAME.glb, NAME.stl; none of them needs GL. Returns their paths."""
    out.mkdir(parents=True, exist_ok=True)
    writers = {"glb": lambda path: path.write_bytes(glb(meshes, style.BRANCHES)),
               "stl": lambda path: path.write_bytes(stl(meshes))}
    if present("vtkmodules"):
        writers = {"vtp": lambda path: _write_vtp(meshes, path), **writers}
    for kind, write_one in writers.items():
        with style.whole_file(out / f"{name}.{kind}") as waiting:
            write_one(waiting)
    return [out / f"{name}.{kind}" for kind in writers]


def _write_vtp(meshes, path):
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(polydata(meshes))
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    if not writer.Write():
        raise OSError(f"{path}: VTK could not write it")


def polydata(meshes):
    """All branches in one vtkPolyData: double-precision points, point arrays "sheet" (int32) and "residual"
    (float64)."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    points = np.concatenate([m.points for m in meshes] or [np.zeros((0, 3))])
    shifts = np.cumsum([0, *(len(m.points) for m in meshes)])
    triangles = np.concatenate([m.triangles + s for m, s in zip(meshes, shifts)] or [np.zeros((0, 3), int)])
    arrays = {"sheet": np.concatenate([np.full(len(m.points), i, np.int32) for i, m in enumerate(meshes)]
                                      or [np.zeros(0, np.int32)]),
              "residual": np.concatenate([m.residual for m in meshes] or [np.zeros(0)])}
    data, where, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    where.SetDataTypeToDouble()
    where.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    cells.SetData(3, numpy_to_vtkIdTypeArray(np.ascontiguousarray(triangles, np.int64).ravel(), deep=True))
    data.SetPoints(where)
    data.SetPolys(cells)
    for name, values in arrays.items():
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    return data
