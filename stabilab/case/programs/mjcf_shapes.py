"""Mass and moments of the shapes of a body of MuJoCo (`<geom>`), as its compiler finds them where the body
has no `<inertial>`: each shape of uniform density, all of them together.

A shape takes what it leaves out from its class, the class from the one that it stands in. `mass` comes before
`density` (1000 kg/m^3 without either); shapes whose `group` is outside of `inertiagrouprange` do not count.
Numbers are exact but for pi and square roots, which have 240 bits.
"""
from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from ...numbers.exact import precise, sqrt_fraction
from .parts import Part, joined
from .rigid_pieces import ORIGIN, Frame, Piece
from .xml_tree import Element, fractions

ORIENTATIONS = ("quat", "axisangle", "xyaxes", "zaxis", "euler")
SIZES = {"sphere": 1, "capsule": 2, "cylinder": 2, "ellipsoid": 3, "box": 3}
FLAT = ("plane", "hfield")  # of the world, without mass
WATER = "1000"  # kg/m^3
Place = Callable[[Element], Frame]


class Shapes:
    """What the shapes of a model have from their classes. compiled: what to do about those that are not
    read."""

    def __init__(self, root: Element, compiled: str, groups: tuple[Fraction, ...]) -> None:
        self.compiled, self.groups = compiled, groups
        self.classes: dict[str, dict[str, str]] = {"main": {}}
        for top in root.all("default"):
            self._take(top, "main")
            self.classes[top.attributes.get("class", "main")] = self.classes["main"]

    def _take(self, element: Element, name: str, above: dict[str, str] | None = None) -> None:
        own = (above or {}) | self.classes.get(name, {})
        for geom in element.all("geom"):
            own = _with(own, geom.attributes)
        self.classes[name] = own
        for child in element.all("default"):
            self._take(child, child.attributes.get("class", ""), own)

    def piece(self, name: str, body: Element, frame: Frame, inner: str, place: Place) -> Piece | None:
        """The shapes of a body as one piece, None where none has mass. inner: the class of shapes that name
        none; place: what places an element in the one that holds it."""
        parts, where = [], {}
        for geom, at in _geoms(body, Frame(), inner, place):
            element = self._full(geom[0], geom[1])
            part = self._part(element, name)
            if part is None:
                continue
            if "fromto" in element.attributes:
                at = at.then(_between(element))
            else:
                at = at.then(place(element))
            where[len(parts)] = at
            parts.append(part)
        if not parts:
            return None
        full = joined(parts, where)  # type: ignore[arg-type]
        centre = frame.then(Frame(origin=full.centre))
        return Piece(name, Part(full.mass, full.tensor, ORIGIN, ORIGIN), centre, frame, body)

    def _full(self, geom: Element, inner: str) -> Element:
        """The shape with what its class says besides."""
        name = geom.attributes.get("class", inner or "main")
        if name not in self.classes:
            raise geom.fault(f"no class {name} in <default>: correct its name", "class")
        return replace(geom, attributes=_with(self.classes[name], geom.attributes))

    def _part(self, geom: Element, name: str) -> Part | None:
        """A shape about its centre along its own axes, None where it does not count."""
        attributes = geom.attributes
        low, high = self.groups
        group, = fractions(geom.attribute("group", 1, "0"))
        kind = attributes.get("type", "mesh" if "mesh" in attributes else "sphere")
        mass = fractions(geom.attribute("mass", 1))[0] if "mass" in attributes else None
        if kind in FLAT or mass == 0 or not low <= group <= high:
            return None
        if kind not in SIZES or "mesh" in attributes:
            what = "a mesh" if "mesh" in attributes else f"a shape of the type {kind}"
            raise geom.fault(f"{name}: no <inertial>; MuJoCo finds its mass and moments from {what}, which "
                             f"is not read: add <inertial>, or {self.compiled}")
        if attributes.get("shellinertia") == "true":
            raise geom.fault(f"{name}: the moments of a shell are not read: add <inertial>, or "
                             f"{self.compiled}", "shellinertia")
        volume, moments = _uniform(kind, _sizes(geom, kind))
        if mass is None:
            mass = volume * fractions(geom.attribute("density", 1, WATER))[0]
        if mass < 0:
            raise geom.fault(f"{name}: expected a mass that is not negative")
        return Part(mass, mass * np.diag(np.array(moments)), ORIGIN, ORIGIN) if mass else None


def _with(defaults: dict[str, str], own: dict[str, str]) -> dict[str, str]:
    """Attributes over those of a class: an orientation takes the place of any other, a size that of as many
    numbers as it has."""
    if any(key in own for key in (*ORIENTATIONS, "fromto")):
        defaults = {key: text for key, text in defaults.items() if key not in (*ORIENTATIONS, "fromto")}
    result = defaults | own
    if "size" in own and "size" in defaults:
        first = own["size"].split()
        result["size"] = " ".join([*first, *defaults["size"].split()[len(first):]])
    return result


def _geoms(holder: Element, frame: Frame, inner: str, place: Place
           ) -> Iterator[tuple[tuple[Element, str], Frame]]:
    """((shape, the class of one that names none), where its frame counts from) of those of a body, in
    `<frame>` too."""
    for child in holder.children:
        if child.tag == "geom":
            yield (child, inner), frame
        elif child.tag == "frame":
            own = child.attributes.get("childclass", inner)
            yield from _geoms(child, frame.then(place(child)), own, place)


def _between(geom: Element) -> Frame:
    """The frame of a shape between two points: its third axis along them."""
    middle, half = _ends(geom)
    z = half / sqrt_fraction(half @ half)
    helper = np.array([Fraction(1), Fraction(0), Fraction(0)] if abs(z[0]) < abs(z[1]) else
                      [Fraction(0), Fraction(1), Fraction(0)])
    x: Any = np.cross(helper, z)
    x = x / sqrt_fraction(x @ x)  # any: the shape is the same about its third axis
    return Frame(np.array([x, np.cross(z, x), z]), middle)


def _ends(geom: Element) -> tuple[Any, Any]:
    """(middle (3,), half of the vector (3,)) from the first to the second point of fromto."""
    first, second = np.array(fractions(geom.attribute("fromto", 6))).reshape(2, 3)
    if not (second - first).any():
        raise geom.fault("expected two points that differ", "fromto")
    return (first + second) / 2, (second - first) / 2


def _sizes(geom: Element, kind: str) -> list[Fraction]:
    """Half lengths and radii, as many as the shape has."""
    texts = geom.attributes.get("size", "").split()
    count = SIZES[kind]
    if "fromto" in geom.attributes:
        if kind == "sphere":
            raise geom.fault("a sphere lies between no two points: give its pos", "fromto")
        _, half = _ends(geom)
        radius = fractions(geom.numbers(" ".join(texts[:1]), 1, "size"))
        result = [*radius * (count - 1), sqrt_fraction(half @ half)]
    else:
        names = {1: "one number", 2: "two numbers", 3: "three numbers"}
        if len(texts) < count:
            raise geom.fault(f"expected {names[count]} of a {kind}, got {len(texts)}", "size")
        result = [fractions(geom.numbers(text, 1, "size"))[0] for text in texts[:count]]
    if min(result) <= 0:
        raise geom.fault(f"expected positive numbers, got {' '.join(texts)}", "size")
    return result


def _uniform(kind: str, size: list[Fraction]) -> tuple[Fraction, list[Fraction]]:
    """(volume, m^3, moments about the centre of 1 kg, m^2)."""
    pi, third = precise("pi"), Fraction(1, 3)
    if kind == "box":
        squares = [v * v * third for v in size]
        return 8 * size[0] * size[1] * size[2], [sum(squares) - v for v in squares]
    if kind in ("sphere", "ellipsoid"):
        radii = size * 3 if kind == "sphere" else size
        squares = [v * v / 5 for v in radii]
        return 4 * third * pi * radii[0] * radii[1] * radii[2], [sum(squares) - v for v in squares]
    r, h = size  # radius and half length
    tube, ball = 2 * pi * r * r * h, 4 * third * pi * r**3 * (kind == "capsule")
    fraction = ball / (tube + ball)
    # two half balls, each with its centre at 3 r/8 from its base: about the middle (2 r^2/5 + h^2 + 3 r h/4)
    across = (1 - fraction) * (r * r / 4 + h * h * third) + fraction * (2 * r * r / 5 + h * h + 3 * r * h / 4)
    along = (1 - fraction) * r * r / 2 + fraction * 2 * r * r / 5
    return tube + ball, [across, across, along]
