"""A model of MuJoCo (MJCF) as a case: its bodies as one rigid body, in the frame of the outermost body.

A body is placed in the one that holds it by pos and one of quat (scalar first), axisangle, xyaxes, zaxis and
euler; its `<inertial>` has the mass centre at pos, and the moments along axes that are placed alike. Angles
are in deg unless `<compiler angle="radian">` says otherwise; eulerseq names axes that turn with the body in
small letters, fixed ones in capitals. Joints are where the file places the bodies (qpos0). Mass and moments
of a body without `<inertial>`, and of all under `inertiafromgeom="true"`, are those of its shapes.
"""
from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...numbers.exact import precise, sqrt_fraction
from ..source import LARGEST_IMPORT, source_text
from .imported import Craft, listed
from .mjcf_shapes import ORIENTATIONS, Shapes
from .parts import ONE, cosine, of_quaternion, turn, turn_of_radians
from .rigid_pieces import Frame, Piece, combined, free, judge_inertials, piece, tensor_of, unread
from .xml_tree import Element, fractions, tree

WORDS = {"keyframe": "positions of keyframes", "actuator": "actuators", "tendon": "tendons",
         "equality": "constraints", "sensor": "sensors", "contact": "contacts", "plugin": "plugins"}
NOT_READ = {"replicate": "copies of bodies", "attach": "bodies of other models",
            "composite": "composite bodies", "flexcomp": "flexible bodies"}
COMPILED = "save the model as MuJoCo compiled it (mj_saveLastXML)"


class _Compiler(NamedTuple):
    """degrees: of angles; sequence: of Euler angles; shapes: "true", "false" or "auto", whether moments are
    those of shapes; groups: of shapes that count; total: to which all masses are scaled, kg, or None."""

    degrees: bool
    sequence: str
    shapes: str
    groups: tuple[Fraction, ...]
    total: Fraction | None


class _Model(NamedTuple):
    """compiler; shapes: of its classes; pieces, locked: bodies and joints that are read; shaped: names of
    those whose moments are those of shapes."""

    compiler: _Compiler
    shapes: Shapes
    pieces: list[Piece]
    locked: list[str]
    shaped: list[str]


def read(text: str, path: Path, body: str | None = None) -> Craft:
    """What the model says. Raises InputError where no body, or more than one free of each other, has mass."""
    root = tree(text, path)
    files = _include(root, os.path.dirname(os.path.abspath(path)), (os.path.basename(path),))
    compiler = _compiler(root)
    worlds = [*root.all("worldbody")]
    for element in (element for world in worlds for element in world.within() if element.tag in NOT_READ):
        raise element.fault(f"{NOT_READ[element.tag]} are not read: {COMPILED}")
    model = _Model(compiler, Shapes(root, COMPILED, compiler.groups), [], [], [])
    pieces = model.pieces
    outermost: list[tuple[str, Frame, int]] = []
    for world in worlds:
        for element, frame, inner in _bodies(world, Frame(), "", compiler):
            first = len(pieces)
            _walk(element, frame, inner, model)
            if any(item.part.mass for item in pieces[first:]):
                outermost.append((pieces[first].name, frame, first))
    judge_inertials(root, "body", bool(outermost), '<inertial pos="..." mass="..." diaginertia="..."/>',
                    f"; for moments of meshes {COMPILED}")
    if len(outermost) > 1 and body is None:
        names = listed([name for name, _, _ in outermost])
        raise free(root, f"the bodies {names}", "body")
    craft = Craft(root.attributes.get("model", "") or "model")
    unread(craft, [root], WORDS)
    craft.said += [f"read with it: {', '.join(dict.fromkeys(files))}"] if files else []
    if model.shaped:
        craft.said.append("mass and moments are those of shapes of uniform density, as MuJoCo has them: "
                          f"{listed(model.shaped)}")
    if compiler.total is not None:
        scale = compiler.total / sum(item.part.mass for item in pieces)
        pieces[:] = [item._replace(part=item.part._replace(mass=scale * item.part.mass,
                                                          tensor=scale * item.part.tensor))
                     for item in pieces]
        craft.said.append(f"all masses are scaled to {float(compiler.total):.6g} kg together (settotalmass)")
    return combined(craft, pieces, outermost[0][1], "body", model.locked, body, path)


def _include(element: Element, folder: str, above: tuple[str, ...]) -> list[str]:
    """Put what is in files of `<include>`, which count from the folder of the model, in their place; their
    names."""
    children, names = [], []
    for child in element.children:
        if child.tag != "include":
            names += _include(child, folder, above)
            children.append(child)
            continue
        name = child.attributes.get("file", "")
        path = os.path.join(folder, name)
        if not os.path.isfile(path):
            raise child.fault(f"no file {name}, which this model includes: put it there, or {COMPILED}",
                              "file")
        if name in above:
            raise child.fault(f"{name} includes itself", "file")
        inner = tree(source_text(path, LARGEST_IMPORT), Path(path))
        names += [name, *_include(inner, folder, (*above, name))]
        children += inner.children
    element.children = children
    return names


def _compiler(root: Element) -> _Compiler:
    settings: dict[str, str] = {}
    for element in root.all("compiler"):
        settings |= element.attributes
        if element.attributes.get("coordinate") == "global":
            raise element.fault(f"global coordinates are not read: {COMPILED}", "coordinate")
        for key in ("balanceinertia", "boundmass", "boundinertia"):
            value = element.attributes.get(key)
            if value not in (None, "false", "0"):
                raise element.fault(f"{key} changes masses or moments when MuJoCo compiles the model: "
                                    f"{COMPILED}", key)
    sequence = settings.get("eulerseq", "xyz")
    if len(sequence) != 3 or not set(sequence) <= set("xyz") and not set(sequence) <= set("XYZ"):
        raise root.fault(f"compiler: expected eulerseq of three letters x, y, z or X, Y, Z, got {sequence}")
    numbers = replace(root, attributes={"inertiagrouprange": "0 5", "settotalmass": "-1", **settings})
    groups = fractions(numbers.attribute("inertiagrouprange", 2))
    total, = fractions(numbers.attribute("settotalmass", 1))
    return _Compiler(settings.get("angle", "degree") != "radian", sequence,
                     settings.get("inertiafromgeom", "auto"), (groups[0], groups[1]),
                     total if total > 0 else None)


def _bodies(holder: Element, frame: Frame, inner: str, compiler: _Compiler
            ) -> Iterator[tuple[Element, Frame, str]]:
    """(body, its frame, the class of its shapes that name none) of the bodies right inside an element, those
    in <frame> too."""
    for child in holder.children:
        if child.tag in ("body", "frame"):
            at, own = frame.then(_frame(child, compiler)), child.attributes.get("childclass", inner)
            if child.tag == "body":
                yield child, at, own
            else:
                yield from _bodies(child, at, own, compiler)


def _walk(element: Element, frame: Frame, inner: str, model: _Model) -> None:
    """Collect a body and those inside it. inner: the class of its shapes that name none."""
    compiler, pieces = model.compiler, model.pieces
    model.locked.extend(joint.name or f"of {element.name or 'a body'}" for joint in element.all("joint")
                        if joint.attributes.get("type") != "free")
    inertial = element.one("inertial")
    name = element.name or f"body in line {element.line}"
    shaped = None
    if compiler.shapes == "true" or inertial is None and compiler.shapes != "false":
        shaped = model.shapes.piece(name, element, frame, inner, lambda child: _frame(child, compiler))
    if shaped is not None:
        model.shaped.append(name)
    elif inertial is not None:
        shaped = _piece(name, inertial, frame, compiler)
    pieces.append(shaped or piece(name, "0", tensor_of(["0"] * 6), frame, frame, element))
    for child, at, own in _bodies(element, frame, inner, compiler):
        _walk(child, at, own, model)


def _piece(name: str, inertial: Element, frame: Frame, compiler: _Compiler) -> Piece:
    present = [key for key in ("diaginertia", "fullinertia") if key in inertial.attributes]
    if len(present) != 1:
        raise inertial.fault(f"{name}: expected one of diaginertia and fullinertia, got "
                             f"{' and '.join(present) or 'none'}")
    if present == ["fullinertia"]:
        numbers = inertial.attribute("fullinertia", 6)
        if any(key in inertial.attributes for key in ORIENTATIONS):
            raise inertial.fault(f"{name}: fullinertia is along the axes of the body: take the orientation "
                                 "away",
                                 "fullinertia")
    else:
        numbers = [*inertial.attribute("diaginertia", 3), "0", "0", "0"]
    inertial.attribute("pos", 3)
    return piece(name, inertial.attribute("mass", 1)[0], tensor_of(numbers),
                 frame.then(_frame(inertial, compiler)), frame, inertial)


def _frame(element: Element, compiler: _Compiler) -> Frame:
    """Where pos and the orientation of an element place it."""
    present = [key for key in ORIENTATIONS if key in element.attributes]
    if len(present) > 1:
        raise element.fault(f"{' and '.join(present)} say the same thing in two ways: keep one of them")
    origin = np.array(fractions(element.attribute("pos", 3, "0 0 0")))
    return Frame(_turn(element, present[0], compiler) if present else ONE, origin)


def _turn(element: Element, key: str, compiler: _Compiler) -> np.ndarray:
    counts = {"quat": 4, "axisangle": 4, "xyaxes": 6, "zaxis": 3, "euler": 3}
    texts = element.attribute(key, counts[key])
    numbers = fractions(texts)
    if not any(numbers[:3 if key == "axisangle" else len(numbers)]) and key != "euler":
        raise element.fault("expected numbers that are not all zero", key)
    if key == "quat":
        return of_quaternion(numbers[0], numbers[1:])
    if key == "euler":
        fixed = compiler.sequence.isupper()
        order = "".join(str("xyz".index(letter) + 1) for letter in compiler.sequence.lower())
        if fixed:  # about fixed axes: the last first about those that turn
            order, texts = order[::-1], texts[::-1]
        return (turn(fractions(texts), order) if compiler.degrees else turn_of_radians(texts, order))
    if key == "axisangle":
        angle = numbers[3] * (1 if compiler.degrees else 180 / precise("pi"))
        length = sqrt_fraction(sum((v * v for v in numbers[:3]), Fraction(0)))
        half = [v / length * cosine(angle / 2 - 90) for v in numbers[:3]]
        return of_quaternion(cosine(angle / 2), half)
    if key == "xyaxes":
        return _axes(element, np.array(numbers[:3]), np.array(numbers[3:]))
    z = _unit(np.array(numbers))  # the smallest turn from (0, 0, 1)
    if z[0] == z[1] == 0:
        return ONE if z[2] > 0 else turn([Fraction(180)], "1")
    return of_quaternion(1 + z[2], [-z[1], z[0], Fraction(0)])


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / sqrt_fraction(vector @ vector)


def _axes(element: Element, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The turn to axes of which x is one and y, made orthogonal, the next."""
    if not x.any() or not np.cross(x, y).any():
        raise element.fault("expected two directions that are not along one line", "xyaxes")
    first = _unit(x)
    second = _unit(y - (y @ first) * first)
    return np.array([first, second, np.cross(first, second)])
