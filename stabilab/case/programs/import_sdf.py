"""A simulation description (SDFormat) as a case: the links of its model as one rigid body, in the
model's frame.

A pose (x y z roll pitch yaw, in m and in rad about fixed axes x, y, z) places a link in its model, or in the
frame, link or joint that relative_to names, and an inertial in its link. SDFormat says that what is left out
of `<inertial>` is 1 kg, and 1 kg m^2 about each axis; the case says so where a link relies on it.
"""
from __future__ import annotations

from pathlib import Path

import numpy as np

from ...errors import printable
from .imported import Craft
from .parts import of_quaternion, turn, turn_of_radians
from .rigid_pieces import (
    Frame,
    Piece,
    by_name,
    combined,
    free,
    judge_end,
    judge_inertials,
    piece,
    tensor_of,
    unread,
)
from .xml_tree import Element, fractions, tree

MOVING = ("revolute", "revolute2", "continuous", "prismatic", "ball", "universal", "screw", "gearbox")
WORDS = {"include": "other files", "visual": "shapes and meshes that are seen", "collision": "shapes for "
                                                                                             "contact",
         "plugin": "plugins", "sensor": "sensors", "fluid_added_mass": "added mass of a fluid",
         "gripper": "grippers", "physics": "settings of a simulator", "battery": "batteries"}
ENTRIES = {"ixx": "1", "iyy": "1", "izz": "1", "ixy": "0", "ixz": "0", "iyz": "0"}


def read(text: str, path: Path, body: str | None = None) -> Craft:
    """What the description says. Raises InputError where there is no link with an inertial, or more than one
    model that may move."""
    root = tree(text, path)
    model = _model(root)
    craft = Craft(model.name or "model")
    for nested in model.all("model"):
        raise nested.fault(f"models inside a model are not read: write the links of {nested.name} into "
                           f"{model.name}")
    links = by_name(model.all("link"), "link")
    judge_inertials(model, "link", any(link.one("inertial") for link in links.values()),
                    "<inertial><mass>...</mass><inertia><ixx>...</ixx> ... </inertia></inertial>",
                    _included(model))
    frames = _Frames(model)
    pieces = [_piece(link, frames.of(name, link), craft) for name, link in links.items()]
    joints = [*model.all("joint")]
    _judge_tied(model, links, joints, body, _included(model))
    unread(craft, model, set(), WORDS)
    if uris := _uris(model):
        craft.caveats.append("of the links that the imported file has itself: other files that it includes "
                             f"are not read ({', '.join(uris)})")
    locked = [joint.name for joint in joints if joint.attributes.get("type") in MOVING]
    return combined(craft, pieces, Frame(), "link", locked, body, path)


def _uris(model: Element) -> list[str]:
    """What the model includes."""
    return [uri.text.strip() for include in model.all("include") if (uri := include.one("uri"))]


def _included(model: Element) -> str:
    """What is to be done where something is missing that an included file may have."""
    uris = _uris(model)
    return f"; files of <include> are not read: import {uris[0]}, or write all into one file" if uris else ""


def _model(root: Element) -> Element:
    """The only model that may move, of the file or of its world."""
    models = [model for holder in (root, *root.all("world")) for model in holder.all("model")]
    moving = [model for model in models if _text(model, "static", "false") not in ("true", "1")]
    if len(moving) != 1:
        names = ", ".join(printable(model.name) for model in moving)
        raise root.fault(f"the models {names} move freely of each other: put the one that is meant into a "
                         "file of its own"
                         if moving else "no model that is not static: expected <model> with links")
    return moving[0]


def _text(element: Element, tag: str, default: str) -> str:
    child = element.one(tag)
    return child.text.strip() if child is not None else default


class _Frames:
    """Where links, joints and frames of a model are, by their names."""

    def __init__(self, model: Element) -> None:
        self.model = model
        self.elements = {element.name: element for tag in ("frame", "joint", "link")
                         for element in model.all(tag)}

    def of(self, name: str, element: Element, seen: tuple[str, ...] = ()) -> Frame:
        """The frame of an element in that of the model."""
        if name in seen:
            raise element.fault(f"{name} is placed relative to itself", "relative_to")
        pose = element.one("pose")
        default = {"frame": element.attributes.get("attached_to", ""), "link": ""}.get(
            element.tag, _text(element, "child", ""))
        relative = (pose.attributes.get("relative_to") or pose.attributes.get("frame") or "") if pose else ""
        relative = relative or default
        base = Frame()
        if relative not in ("", "__model__"):
            if relative not in self.elements:
                raise (pose or element).fault(f"no frame {relative}: expected a link, a joint or a frame of "
                                              f"the model{_included(self.model)}", "relative_to")
            base = self.of(relative, self.elements[relative], (*seen, name))
        return base.then(_pose(pose))


def _pose(pose: Element | None) -> Frame:
    if pose is None or not pose.text.strip():
        return Frame()
    if pose.attributes.get("rotation_format") == "quat_xyzw":
        parts = pose.text.split()
        place, q = pose.numbers(" ".join(parts[:3]), 3), fractions(pose.numbers(" ".join(parts[3:]), 4))
        if not any(q):
            raise pose.fault("a quaternion of zeros is no rotation")
        return Frame(of_quaternion(q[3], q[:3]), np.array(fractions(place)))
    numbers = pose.numbers(pose.text, 6)
    angles = numbers[3:][::-1]
    degrees = pose.attributes.get("degrees") in ("true", "1")
    return Frame(turn(fractions(angles), "321") if degrees else turn_of_radians(angles, "321"),
                 np.array(fractions(numbers[:3])))


def _piece(link: Element, frame: Frame, craft: Craft) -> Piece:
    inertial = link.one("inertial")
    if inertial is not None and inertial.attributes.get("auto") in ("true", "1"):
        raise inertial.fault(f"link {link.name}: auto finds mass and moments from shapes, which are not "
                             "read: write <mass> and <inertia>", "auto")
    inertia = inertial.one("inertia") if inertial else None
    missing = [key for key in ("mass",) if inertial is None or inertial.one(key) is None]
    missing += [key for key in ("ixx", "iyy", "izz") if inertia is None or inertia.one(key) is None]
    if missing:
        craft.caveats.append(f"the imported file does not give {', '.join(missing)} of link {link.name}: "
                             "SDFormat takes 1 kg, and 1 kg m^2")
    mass = _number(inertial, "mass", "1")
    tensor = tensor_of([_number(inertia, key, default) for key, default in ENTRIES.items()])
    centre = frame.then(_pose(inertial.one("pose") if inertial else None))
    return piece(link.name, mass, tensor, centre, frame, inertial or link)


def _number(element: Element | None, tag: str, default: str) -> str:
    child = element.one(tag) if element else None
    return child.numbers(child.text, 1)[0] if child else default


def _judge_tied(model: Element, links: dict[str, Element], joints: list[Element], body: str | None,
                more: str) -> None:
    """A fault where joints do not tie all links to each other. more: what else to do about one that is
    missing."""
    groups = {name: {name} for name in links}
    for joint in joints:
        ends = []
        for tag in ("parent", "child"):
            name = _text(joint, tag, "")
            judge_end(joint, name, [*links, *["world"] * (tag == "parent")], tag, more)
            ends.append(name)
        if ends[0] in groups:
            union = groups[ends[0]] | groups[ends[1]]
            groups |= dict.fromkeys(union, union)
    apart = [name for name in links if name not in groups[next(iter(links))]]
    if apart and body is None:
        raise free(links[apart[0]], f"no joint ties link {apart[0]} to link {next(iter(links))}", "link")
