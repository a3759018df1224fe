"""The separatrix as files: watertight meshes of every branch, a summary in words, and a picture.

Meshes are .vtp (where vtk is installed), .glb and .stl, and need no GL. The picture is drawn by VTK, in the
space of rates that every view draws, with title and legend by Matplotlib."""
from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby, product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..case.read import blamed_on
from ..errors import RenderingUnavailable, printable
from ..orbit.separatrix.branches import separatrix
from ..packages import present
from ..reasons import outward
from . import endings, manifest, style
from .axes import PLAIN
from .data import plain
from .names import spare
from .plot import canvas
from .plot.in_space import FACETS, PALEST, SHEER, away, rows, sight, space_of
from .plot.subject import measures, subject
from .progress import each
from .render_probe import probe, use
from .space.box import numbers, shifted
from .space.drawing import Space, across, look
from .terminal import some

if TYPE_CHECKING:
    from ..orbit.separatrix.homoclinic import Branch


# --- In words
def text(summary: dict[str, Any], out: Path) -> str:
    """The answer in a line, a line a branch, and the files; why there is no surface where there is none.
    summary: of `summarise`."""
    name, branches = summary["case"], summary["sheets"]
    spare(map(str, (out, *(out / file for file in summary["files"]))))
    if not branches:
        return f"{name}: no surface to write: {summary['reason']}"
    lines = [f"{name}: {some(len(branches), 'separatrix surface')}; {summary['reason']}"]
    lines += [f"  {branch['name']}: {branch['triangles']} triangles, every vertex within "
              f"{outward(branch['largest_residual'], 2, 1):.1e} of the surface (relative)"
              for branch in branches]
    return "\n".join([*lines, *(f"  {out / file}" for file in summary["files"])])


# --- Meshes
@dataclass(frozen=True)
class Mesh:
    """Triangles of one branch: points (n, 3) doubles, triangles (t, 3) indices, residual (n,) at the points.
    """

    name: str
    points: np.ndarray
    triangles: np.ndarray
    residual: np.ndarray


def triangulate(branch: Branch) -> Mesh:
    """The mesh of a branch. Points of the grid that coincide (a row shrunk to the fold; columns 0 and -1 at
    the saddle) become one vertex, and triangles that lost a corner or their area are dropped."""
    points = np.asarray(branch.points, float) + 0.0  # -0.0 and 0.0 are one place
    places = points.reshape(-1, 3)
    first, where = _numbered(places)
    vertices = places[first]
    triangles = _triangles(where.reshape(points.shape[:2]), branch.cut)
    corner, one, other = (vertices[corners] for corners in triangles.T)
    one -= corner
    other -= corner
    wide = np.zeros(len(triangles), bool)  # a component of the cross product that is not zero
    for k in range(3):
        wide |= one[:, k] * other[:, k - 1] != one[:, k - 1] * other[:, k]
    residual = np.zeros(len(vertices))
    np.maximum.at(residual, where, np.abs(np.asarray(branch.residual, float)).ravel())
    return Mesh(branch.name, vertices, triangles[wide], residual)


def _numbered(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(Where the first of equal places (n, 3) stand, in their order; the number of each place among these,
    (n,)). np.unique along an axis gives the same, but compares rows as records, which takes longer."""
    order = np.lexsort(places.T)  # the first of equal ones comes first
    rows = places[order]
    begins = np.append(True, (rows[1:] != rows[:-1]).any(axis=1))[:len(rows)]
    same = np.empty(len(rows), np.intp)
    same[order] = order[begins][np.cumsum(begins) - 1]
    kept = same == np.arange(len(rows))
    return np.flatnonzero(kept), (np.cumsum(kept) - 1)[same]


def _triangles(where: np.ndarray, cut: int):
    """(t, 3) triangles of a grid of vertex numbers (n, m), cut as the branch says, without those that lost a
    corner."""
    a, b, c, d = where[:-1, :-1], where[1:, :-1], where[:-1, 1:], where[1:, 1:]
    along, against = ((a, b, d), (a, d, c)), ((a, b, c), (c, b, d))
    half = where.shape[1] // 2
    out = np.empty((*a.shape, 2, 3), where.dtype)
    for columns, pair in ((slice(half), along if cut > 0 else against),
                          (slice(half, None), against if cut > 0 else along)):
        for n, corners in enumerate(pair):
            for k, corner in enumerate(corners):
                out[:, columns, n, k] = corner[:, columns]
    triangles = out.reshape(-1, 3)
    p, q, r = triangles.T
    return triangles[(p != q) & (q != r) & (r != p)]


def normals(mesh: Mesh) -> np.ndarray:
    """Unit normals (n, 3) at the vertices: area-weighted mean of the triangles around each."""
    corner = mesh.points[mesh.triangles]
    face = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    out = np.zeros_like(mesh.points)
    for side in range(3):
        np.add.at(out, mesh.triangles[:, side], face)
    size = np.linalg.norm(out, axis=1, keepdims=True)
    return np.divide(out, size, out=np.tile([0.0, 0.0, 1.0], (len(out), 1)), where=size > 0)


def stl(meshes: Sequence[Mesh]) -> bytes:
    """Binary STL of all meshes (single precision, as the format has it)."""
    corners = [mesh.points[mesh.triangles] for mesh in meshes]
    corner = np.concatenate(corners) if corners else np.zeros((0, 3, 3))
    face = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    size = np.linalg.norm(face, axis=1, keepdims=True)
    record = np.zeros(len(corner), dtype=[("normal", "<f4", 3), ("corner", "<f4", (3, 3)), ("flags", "<u2")])
    record["normal"], record["corner"] = face / np.where(size > 0, size, 1), corner
    return b"stabilab separatrix".ljust(80) + struct.pack("<I", len(record)) + record.tobytes()


def glb(meshes: Sequence[Mesh], colours: Sequence[str]) -> bytes:
    """glTF 2.0 binary: one node a branch, with normals and a two-sided material (single precision)."""
    document: dict = {"asset": {"version": "2.0", "generator": "stabilab"}, "scene": 0,
                      "scenes": [{"name": "separatrix"}]}
    binary = bytearray()

    def accessor(array: np.ndarray, kind: str, component: int, target: int):
        view = {"buffer": 0, "byteOffset": len(binary), "byteLength": array.nbytes, "target": target}
        binary.extend(array.tobytes())
        binary.extend(b"\0" * (-len(binary) % 4))
        document.setdefault("bufferViews", []).append(view)
        entry = {"bufferView": len(document["bufferViews"]) - 1, "componentType": component,
                 "count": len(array), "type": kind}
        if kind == "VEC3":
            entry |= {"min": array.min(0).tolist(), "max": array.max(0).tolist()}
        else:
            entry["count"] = array.size
        document.setdefault("accessors", []).append(entry)
        return len(document["accessors"]) - 1

    for number, mesh in enumerate(m for m in meshes if len(m.triangles)):
        # half as many bytes where they reach; the last number of two bytes is no vertex in glTF
        kind, component = ("<u2", 5123) if len(mesh.points) < 65_535 else ("<u4", 5125)
        part = {"attributes": {"POSITION": accessor(mesh.points.astype("<f4"), "VEC3", 5126, 34962),
                               "NORMAL": accessor(normals(mesh).astype("<f4"), "VEC3", 5126, 34962)},
                "indices": accessor(mesh.triangles.astype(kind), "SCALAR", component, 34963),
                "material": number}
        document.setdefault("meshes", []).append({"name": mesh.name, "primitives": [part]})
        document.setdefault("nodes", []).append({"name": mesh.name, "mesh": number})
        document.setdefault("materials", []).append({
            "name": mesh.name, "doubleSided": True,
            "pbrMetallicRoughness": {"baseColorFactor": _linear(colours[number % len(colours)]),
                                     "metallicFactor": 0.0,
                                     "roughnessFactor": 0.6}})
    if "nodes" in document:
        document["scenes"][0]["nodes"] = list(range(len(document["nodes"])))
        document["buffers"] = [{"byteLength": len(binary)}]
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        chunks += struct.pack("<II", len(binary), 0x004E4942) + bytes(binary)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _linear(colour: str) -> list[float]:
    """#RRGGBB (sRGB) as linear RGBA, the colour space of glTF."""
    parts = [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    return [round(v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4, 6) for v in parts] + [1.0]


# --- The picture
SIDE = 1000  # dots
SIZE = (7.6, 8.0)  # inches of the whole picture
AWAY, ANGLE = 9.0, 25.0  # of the eye, in halves of the box; deg of what it sees
GLASS = 0.75  # of a surface: what is behind it is seen
LINE, THIN, GRID, BALL = 0.014, 0.005, 0.002, 0.034  # radii, of half of the box


def draw(case: Any, path: Path) -> Path:
    """The still picture (PNG) of a case; needs a renderer that the probe approved."""
    item = subject(case)
    scale = measures(item)
    result = of(item)
    stage = plotter(result)
    try:
        pixels = stage.screenshot(return_img=True)
    finally:
        stage.close()
    with style.drawing() as plt:
        figure = plt.figure(figsize=SIZE, layout="constrained")
        ax = figure.add_subplot()
        ax.imshow(pixels)
        ax.set_axis_off()
        _label(ax, result)
        _times(ax, result)
        canvas.explained(ax, rows(result), True, item.heading, canvas.answer(item, scale),
                         away(item, result, scale), notes=canvas.notes(item, scale))
        return style.save(figure, path)


def of(item: Any) -> Space:
    """What is drawn of a subject: the axes have the names of the case."""
    scale = measures(item)
    named = [scale.plain(n) + (f", {item.axes.name(n + 1)}" if item.physical and item.axes != PLAIN else "")
             for n in range(3)]
    return space_of(item, named, scale.rate, shape=FACETS, most=np.inf)


def plotter(result: Space) -> Any:
    """A pyvista plotter with all that is drawn, in halves of the edges of the box; the caller closes it."""
    use()
    style.quiet_matplotlib()  # pyvista loads it
    import pyvista
    stage: Any = pyvista.Plotter(off_screen=True, window_size=[SIDE, SIDE])
    stage.set_background("white")
    share = lambda points: (np.asarray(points, float) - result.box.middle) / result.box.half

    def tube(points, radius, colour):
        for inside, run in groupby(points, lambda at: bool(np.abs(at).max() <= 1)):
            if inside and np.ptp(places := np.array(list(run)), axis=0).any():  # a body at rest has no path
                stage.add_mesh(pyvista.lines_from_points(places).tube(radius=radius), color=colour)
    for n, (colour, branch) in enumerate(result.branches):
        grid = np.moveaxis(share(branch.points).reshape(branch.rows, branch.columns, 3), 2, 0)
        surface = pyvista.StructuredGrid(*(part[..., None] for part in grid)).extract_surface(
            algorithm="dataset_surface")
        stage.add_mesh(surface.clip_box((-1, 1) * 3, invert=False), color=colour, ambient=0.35, diffuse=0.7,
                       specular=0.1, opacity=GLASS, name=f"branch {n}")
    for phrase, places in result.curves:
        tube(share(places), LINE if phrase in style.SPACE else THIN, look(phrase)["color"])
    toward = sight(result.view)
    for route in map(share, result.lines):
        tube(route, LINE, style.VIOLET)
        for axis in range(3):
            wall = np.where(np.arange(3) == axis, -np.sign(toward[axis]), route)
            tube(wall, THIN, PALEST)
    for n, (_, colour, veil) in enumerate(result.veils):
        grid = np.moveaxis(share(veil.points).reshape(veil.rows, veil.columns, 3), 2, 0)
        sheer = pyvista.StructuredGrid(*(part[..., None] for part in grid)).extract_surface(
            algorithm="dataset_surface").clip_box((-1, 1) * 3, invert=False)
        if sheer.n_cells:
            stage.add_mesh(sheer, color=colour, ambient=0.4, diffuse=0.6, opacity=SHEER[colour],
                           name=f"veil {n}")
    for at, step in result.arrows:
        stage.add_mesh(pyvista.Cone(center=share(at), direction=np.divide(step, result.box.half), height=0.11,
                                    radius=0.04),
                       color=style.VIOLET)
    for phrase, at in result.marks:
        location = share(at)
        stage.add_mesh(pyvista.Sphere(radius=BALL, center=location), color=look(phrase)["color"])
        tube([location, np.array([*location[:2], -1.0])], THIN, style.GREY)
    for axis, (ticks, _) in enumerate(_ticks(result)):  # a grid on the walls behind
        for other in (n for n in range(3) if n != axis):
            for mark in (*(tick for tick, _ in ticks), -1.0, 1.0):
                ends = np.tile(-np.sign(toward), (2, 1))
                ends[:, axis], ends[:, other] = mark, (-1, 1)
                tube(ends, GRID, PALEST)
    stage.camera_position = [tuple(AWAY * toward), (0, 0, 0), (0, 0, 1)]
    stage.camera.view_angle = ANGLE
    return stage


def _ticks(result: Space) -> list[tuple[list[tuple[float, str]], str]]:
    """Of each axis [(place in halves of the box, number)] of round numbers, and its name."""
    box, out = result.box.scaled(result.rate), []
    for n, name in enumerate(result.names):
        ticks = box.ticks(n)
        values, named = shifted(ticks, name)
        out.append(([((v - box.middle[n]) / box.half[n], text) for v, text in zip(ticks, numbers(values))],
                    named))
    return out


def _on_screen(result: Space) -> Any:
    """What gives the dots at which a place, in halves of the edges of the box, is seen."""
    toward, per = sight(result.view), SIDE / 2 / np.tan(np.radians(ANGLE / 2))
    return lambda p: SIDE / 2 + per * np.array([1, -1]) * across(p, result.view) / (AWAY - toward @ p)


def _times(ax: Any, result: Space) -> None:
    """The times beside the turns of a motion of many."""
    from matplotlib.patheffects import withStroke
    location = _on_screen(result)
    for at, text in result.times:
        x, y = location(np.array(result.box.share(at)))
        ax.text(x, y, f"  {text}  ", ha="left" if x >= SIDE / 2 else "right", va="center", fontsize=9,
                path_effects=[withStroke(linewidth=2.5, foreground="white")])


def _label(ax: Any, result: Space) -> None:
    """Numbers and names along the outer edges of the box."""
    location = _on_screen(result)
    for axis, (ticks, name) in enumerate(_ticks(result)):
        edges = [np.insert(np.array(corner, float), axis, 0) for corner in product((-1, 1), repeat=2)]
        outer = max(edges, key=lambda at: -location(at)[0] if axis == 2
                    else location(at)[1] + 0.25 * abs(location(at)[0] - SIDE / 2))
        unit = np.eye(3)[axis]
        along = location(outer + unit) - location(outer - unit)
        across_it = np.array([-along[1], along[0]]) / np.hypot(*along)
        out = across_it * np.sign(across_it @ (location(outer) - SIDE / 2))
        for part, phrase in ticks:
            ax.text(*(location(outer + part * unit) + 22 * out), phrase, ha="center", va="center", fontsize=9)
        turn = np.degrees(np.arctan2(-along[1], along[0]))
        ax.text(*(location(outer) + (90 if axis == 2 else 62) * out), name, ha="center", va="center",
                rotation=(turn + 90) % 180 - 90 if axis < 2 else 90)


# --- The files
SURFACE_SCHEMA = "stabilab.surface/1"


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
    rows = [(case, *_found(case)) for case in each(cases, lambda item: printable(item.name))]
    summaries = [summarise(case, result, meshes) | {"files": []} for case, result, meshes in rows]
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
                                           f"drawn: {renderer.description}. "
                                           f"Cure: {renderer.cure}")
        unavailable.summaries = summaries
        raise unavailable
    return summaries


def _found(case):
    """(separatrix, its meshes) of a case."""
    with blamed_on(case):
        result = separatrix(case.scene)
    return result, [triangulate(branch) for branch in result.branches]


def _write(case, meshes, folder, renderer, summary):
    """The files of one case; the summary is completed and written with them."""
    files = write_meshes(meshes, folder, case.name)
    summary["rendering"] = ("" if renderer.available else "unavailable: ") + renderer.description
    if renderer.available:
        files.append(draw(case, folder / f"{case.name}.png"))
    summary["files"] = sorted([f"{case.name}.json", *(f.name for f in files)])
    with style.whole_file(folder / f"{case.name}.json") as waiting:
        waiting.write_text(json.dumps(plain(summary), indent=1, allow_nan=False) + "\n", encoding="utf-8")


def summarise(case, result, meshes) -> dict:
    """Counts and the largest residual, branch by branch and in all; plain JSON values."""
    rows = []
    for branch, mesh in zip(result.branches, meshes):
        invariant = np.asarray(branch.invariant, float)
        rows.append({"name": branch.name, "rows": int(branch.points.shape[0]),
                     "columns": int(branch.points.shape[1]),
                     "vertices": len(mesh.points), "triangles": len(mesh.triangles),
                     "largest_residual": float(mesh.residual.max(initial=0.0)),
                     "invariant": [float(invariant.min()), float(invariant.max())],
                     "bounds": [[float(v) for v in pair]
                                for pair in zip(mesh.points.min(0), mesh.points.max(0))]})
    return {"schema": SURFACE_SCHEMA, "case": case.name, "variables": case.scene.variables,
            "components": list(case.scene.components), "sheets": rows,
            "vertices": sum(r["vertices"] for r in rows),
            "triangles": sum(r["triangles"] for r in rows),
            "largest_residual": max((r["largest_residual"] for r in rows), default=0.0),
            "reason": result.because, "why": result.reason.as_dict()}


def write_meshes(meshes: list[Mesh], out: Path, name: str,
                 wanted: Sequence[str] = ("vtp", "glb", "stl")) -> list[Path]:
    """NAME.vtp (where vtk is installed), NAME.glb, NAME.stl, as far as they are wanted; none needs GL.
    Returns their paths."""
    out.mkdir(parents=True, exist_ok=True)
    writers = {"glb": lambda path: path.write_bytes(glb(meshes, style.SURFACES)),
               "stl": lambda path: path.write_bytes(stl(meshes))}
    if present("vtkmodules"):
        writers = {"vtp": lambda path: _write_vtp(meshes, path), **writers}
    writers = {kind: write_one for kind, write_one in writers.items() if kind in wanted}
    for kind, write_one in writers.items():
        with style.whole_file(out / f"{name}.{kind}") as waiting:
            write_one(waiting)
    return [out / f"{name}.{kind}" for kind in writers]


def _write_vtp(meshes: Sequence[Mesh], path: Path):
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(polydata(meshes))
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    if not writer.Write():
        raise OSError(f"{path}: VTK could not write it")


def polydata(meshes: Sequence[Mesh]):
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
