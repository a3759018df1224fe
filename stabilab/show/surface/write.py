"""The separatrix as files: meshes of every sheet, a summary and a picture."""
from __future__ import annotations

import json
from contextlib import nullcontext
from pathlib import Path

import numpy as np

from ...answers.equilibria import equilibria
from ...case.read import blamed_on
from ...errors import RenderingUnavailable, printable
from ...orbit.separatrix.sheets import separatrix
from ...packages import present
from .. import style
from ..axes import axes_of
from ..files import endings, manifest
from ..progress import each
from ..sampling import spread
from ..text.answers import plain
from .mesh import Mesh, glb, normals, stl, triangulate
from .render_probe import probe, use

SCHEMA = "stabilab.surface/1"


def write(case, out, reach=None, shape=None, picture=True, arguments=None) -> dict:
    """Write the separatrix of a case (or scene) into the folder `out` and return its summary.

    The files of `write_all` for one case; raises RenderingUnavailable with the summary as its attribute
    `summary`.
    """
    try:
        return write_all([case], out, reach, shape, picture, arguments)[0]
    except RenderingUnavailable as unavailable:
        unavailable.summary = unavailable.summaries[0]
        raise


def write_all(cases, out, reach=None, shape=None, picture=True, arguments=None) -> list[dict]:
    """Write the separatrices of cases (or scenes) into the folder `out` and return a summary of each.

    NAME.vtp (double precision, point arrays "sheet" and "residual"), NAME.glb and NAME.stl (single precision,
    as those formats are), NAME.json (the summary), NAME.png and manifest.json (arguments: of the command
    line, for it); NAME is that of the case. A case that was read from a text has no file among the manifest's
    inputs. A case without a separatrix has no files; its summary gives the reason. Where no case has one,
    nothing is written. Raises RenderingUnavailable (with the summaries as its attribute `summaries`), after
    the meshes are written, where this machine cannot draw.
    """
    out = endings.folder(out)
    named = [(case, _scene(case)[1]) for case in cases]
    rows = [(case, *_found(case, reach, shape)) for case, _ in each(named, lambda one: printable(one[1]))]
    summaries = [summarise(case, found, meshes) | {"files": []} for case, found, meshes in rows]
    if not any(meshes for *_, meshes in rows):
        return summaries
    renderer = probe() if picture else None
    inputs = dict.fromkeys(case.path for case in cases if hasattr(case, "path") and Path(case.path).is_file())
    residual = max(summary["largest_residual"] for summary in summaries)
    with manifest.written(out, arguments, inputs,
                          {"distance of a vertex from its surface": residual}) as folder:
        for (case, found, meshes), summary in each(zip(rows, summaries),
                                                   lambda row: f"drawing {printable(row[1]['case'])}"):
            if meshes:
                _write(case, found, meshes, folder, renderer, summary)
    if picture and not renderer.available:
        written = ", ".join(name for summary in summaries for name in summary["files"])
        unavailable = RenderingUnavailable(f"the meshes are in {out} ({written}), but no picture could be "
                                           f"drawn: {renderer.words}. "
                                           f"Cure: {renderer.cure}")
        unavailable.summaries = summaries
        raise unavailable
    return summaries


def _found(case, reach, shape):
    """(separatrix, its meshes) of a case or scene."""
    with blamed_on(case) if hasattr(case, "scene") else nullcontext():
        found = separatrix(_scene(case)[0], reach=reach, **({"shape": shape} if shape else {}))
    return found, [triangulate(sheet) for sheet in found.sheets]


def _write(case, found, meshes, folder, renderer, summary):
    """The files of one case; renderer: None where no picture is asked for. The summary is completed and
    written with them."""
    scene, name = _scene(case)
    files = write_meshes(meshes, folder, name)
    if renderer:
        summary["rendering"] = renderer.words if renderer.available else f"unavailable: {renderer.words}"
    if renderer and renderer.available:
        names = map(axes_of(case).name, (1, 2, 3)) if hasattr(case, "scene") else scene.components
        files.append(draw(scene, found, meshes, folder / f"{name}.png", names))
    summary["files"] = sorted([f"{name}.json", *(f.name for f in files)])
    with style.whole_file(folder / f"{name}.json") as waiting:
        waiting.write_text(json.dumps(plain(summary), indent=1, allow_nan=False) + "\n", encoding="utf-8")


def _scene(case):
    return (case.scene, case.name) if hasattr(case, "scene") else (case, "surface")


def summarise(case, found, meshes) -> dict:
    """Counts and the largest residual, sheet by sheet and in all; plain JSON values."""
    scene, name = _scene(case)
    rows = []
    for sheet, mesh in zip(found.sheets, meshes):
        invariant = np.asarray(sheet.invariant, float)
        rows.append({"name": sheet.name, "rows": int(sheet.points.shape[0]),
                     "columns": int(sheet.points.shape[1]),
                     "vertices": len(mesh.points), "triangles": len(mesh.triangles),
                     "largest_residual": float(mesh.residual.max(initial=0.0)),
                     "invariant": [float(invariant.min()), float(invariant.max())],
                     "bounds": [[float(v) for v in pair]
                                for pair in zip(mesh.points.min(0), mesh.points.max(0))]})
    return {"schema": SCHEMA, "case": getattr(case, "name", name), "variables": scene.variables,
            "components": list(scene.components), "sheets": rows,
            "vertices": sum(r["vertices"] for r in rows),
            "triangles": sum(r["triangles"] for r in rows),
            "largest_residual": max((r["largest_residual"] for r in rows), default=0.0),
            "reason": found.reason}


def write_meshes(meshes: list[Mesh], out: Path, name: str) -> list[Path]:
    """NAME.vtp (where vtk is installed), NAME.glb, NAME.stl; none of them needs GL. Returns their paths."""
    out.mkdir(parents=True, exist_ok=True)
    writers = {"glb": lambda path: path.write_bytes(glb(meshes, style.SHEETS)),
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
    """All sheets in one vtkPolyData: double-precision points, point arrays "sheet" (int32) and "residual"
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


# -- pictures


def equilibrium_lines(curves, size, number=240):
    """[(one of style.EQUILIBRIA, points (n, 3))] of the equilibrium curves within `size` of the origin."""
    lines = []
    for curve in curves:
        for segment in curve.segments:
            points = np.array([curve.point(float(t)) for t in spread(*segment.t, number)], float)
            points = points[np.all(np.isfinite(points), axis=1) & (np.linalg.norm(points, axis=1) < size)]
            if len(points) > 1:
                lines.append((style.kind_of(segment), points))
    return lines


def plotter(scene, found, meshes, names):
    """A pyvista plotter with the sheets, the equilibrium curves and the three axes by these names; the caller
    closes it."""
    use()
    style.quiet_matplotlib()  # pyvista loads it
    import pyvista
    stage = pyvista.Plotter(off_screen=True, window_size=(1000, 800))
    stage.set_background("white")
    for number, mesh in enumerate(meshes):
        if len(mesh.triangles):
            faces = np.column_stack([np.full(len(mesh.triangles), 3), mesh.triangles]).ravel()
            surface = pyvista.PolyData(mesh.points.astype(np.float32), faces)
            surface.point_data["Normals"] = _normals(mesh)
            stage.add_mesh(surface, color=style.SHEETS[number % len(style.SHEETS)], smooth_shading=False,
                           ambient=0.35,
                           diffuse=0.7, specular=0.1, name=f"sheet {number}")
    size = 1.15 * max([np.abs(m.points).max(initial=0.0) for m in meshes] or [0.0]) or 5.0
    for number, (kind, points) in enumerate(equilibrium_lines(equilibria(scene).curves, size)):
        stage.add_mesh(pyvista.lines_from_points(points).tube(radius=size * 0.008),
                       color=style.colour_of(kind), name=f"line {number}")
    for axis in range(3):
        ends = np.zeros((2, 3))
        ends[:, axis] = (-size, size)
        stage.add_mesh(pyvista.Line(*ends).tube(radius=size * 0.003), color=style.GREY, name=f"axis {axis}")
    _name_axes(stage, names, size)
    stage.camera_position = [(2.6 * size, -3.4 * size, 2.0 * size), (0, 0, 0), (0, 0, 1)]
    stage.reset_camera()
    stage.camera.zoom(0.94)
    return stage


def _name_axes(stage, names, size):
    """A box about everything with the axes' names (VTK's letters have no Greek) and a scale along its outer
    edges, where no sheet is."""
    power = 10.0 ** np.floor(np.log10(size / 2))
    # round numbers at the edge and half way
    edge = 2 * power * min(k for k in (1, 1.5, 2, 2.5, 3, 4, 5, 10) if 2 * k * power >= 0.95 * size)
    stage.show_bounds(bounds=(-edge, edge) * 3, grid="back", location="outer", ticks="outside", n_xlabels=5,
                      n_ylabels=5, n_zlabels=5, fmt="%.3g",
                      color=style.GREY, font_size=14, use_3d_text=False,
                      **dict(zip(("xtitle", "ytitle", "ztitle"), names)))


def _write_legend(image, scene, meshes):
    """Into the upper corners of a picture: what the colours stand for, and the unit of the axes."""
    from matplotlib import get_data_path
    from PIL import ImageDraw, ImageFont
    font = ImageFont.truetype(str(Path(get_data_path()) / "fonts/ttf/DejaVuSans.ttf"), 16)
    pen, width = ImageDraw.Draw(image), image.width
    kinds = {style.kind_of(segment) for curve in equilibria(scene).curves for segment in curve.segments}
    rows = [(f"separatrix, {mesh.name}", style.SHEETS[number % len(style.SHEETS)]) for number,
            mesh in enumerate(meshes)]
    rows += [(style.EQUILIBRIA[kind], style.colour_of(kind)) for kind in sorted(kinds)]
    left = width - 44 - max((pen.textlength(words, font) for words, _ in rows), default=0)
    for number, (words, colour) in enumerate(rows):
        top = 20 + 24 * number
        pen.rectangle((left, top + 3, left + 14, top + 17), fill=colour)
        pen.text((left + 22, top), words, fill="black", font=font)
    unit = "components of \u03c9 in rad/s" if scene.variables == "physical" else "scaled components, no unit"
    pen.text((20, 20), unit, fill="black", font=font)


def _normals(mesh):
    return normals(mesh).astype(np.float32)


def draw(scene, found, meshes, path, names) -> Path:
    """The still picture (PNG), quantised to keep it small, with these names of its axes; needs a renderer
    that the probe approved."""
    from PIL import Image
    stage = plotter(scene, found, meshes, names)
    try:
        pixels = stage.screenshot(return_img=True)
    finally:
        stage.close()
    image = Image.fromarray(pixels)
    _write_legend(image, scene, meshes)
    style.write_small(image, path)
    return Path(path)
