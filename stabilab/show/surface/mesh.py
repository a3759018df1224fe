"""Triangles of the separatrix: from parametric grids to watertight meshes, and to .glb and .stl without any
GL."""
from __future__ import annotations

import json
import struct
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Mesh:
    """Triangles of one branch: points (n, 3) doubles, triangles (t, 3) indices, residual (n,) at the points.
    """

    name: str
    points: np.ndarray
    triangles: np.ndarray
    residual: np.ndarray


def triangulate(branch) -> Mesh:
    """The mesh of a branch. Points of the grid that coincide (a row shrunk to the fold; columns 0 and -1 at
    the saddle) become one vertex, and triangles that lost a corner or their area are dropped."""
    points = np.asarray(branch.points, float) + 0.0  # -0.0 and 0.0 are one place
    _, first, place = np.unique(points.reshape(-1, 3), axis=0, return_index=True, return_inverse=True)
    vertices = points.reshape(-1, 3)[np.sort(first)]  # in the order of the grid, whatever their last digits
    where = np.argsort(np.argsort(first))[place]
    triangles = _triangles(where.reshape(points.shape[:2]), branch.cut)
    corner = vertices[triangles]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    residual = np.zeros(len(vertices))
    np.maximum.at(residual, where.ravel(), np.abs(np.asarray(branch.residual, float)).ravel())
    return Mesh(branch.name, vertices, triangles[area > 0], residual)


def _triangles(where, cut):
    """(t, 3) triangles of a grid of vertex numbers (n, m), cut as the branch says, without those that lost a
    corner."""
    a, b, c, d = where[:-1, :-1], where[1:, :-1], where[:-1, 1:], where[1:, 1:]
    along = np.stack([np.stack([a, b, d], -1), np.stack([a, d, c], -1)], axis=2)
    against = np.stack([np.stack([a, b, c], -1), np.stack([c, b, d], -1)], axis=2)
    first = np.arange(where.shape[1] - 1) < where.shape[1] // 2
    triangles = np.where((first == (cut > 0))[:, None, None], along, against).reshape(-1, 3)
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


def stl(meshes) -> bytes:
    """Binary STL of all meshes (single precision, as the format has it)."""
    corners = [mesh.points[mesh.triangles] for mesh in meshes]
    corner = np.concatenate(corners) if corners else np.zeros((0, 3, 3))
    face = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    size = np.linalg.norm(face, axis=1, keepdims=True)
    record = np.zeros(len(corner), dtype=[("normal", "<f4", 3), ("corner", "<f4", (3, 3)), ("flags", "<u2")])
    record["normal"], record["corner"] = face / np.where(size > 0, size, 1), corner
    return b"stabilab separatrix".ljust(80) + struct.pack("<I", len(record)) + record.tobytes()


def glb(meshes, colours) -> bytes:
    """glTF 2.0 binary: one node a branch, with normals and a two-sided material (single precision)."""
    document: dict = {"asset": {"version": "2.0", "generator": "stabilab"}, "scene": 0,
                      "scenes": [{"name": "separatrix"}]}
    binary = bytearray()

    def accessor(array, kind, component, target):
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
        part = {"attributes": {"POSITION": accessor(mesh.points.astype("<f4"), "VEC3", 5126, 34962),
                               "NORMAL": accessor(normals(mesh).astype("<f4"), "VEC3", 5126, 34962)},
                "indices": accessor(mesh.triangles.astype("<u4"), "SCALAR", 5125, 34963), "material": number}
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
