"""A robot description (URDF) as a case: its links as one rigid body, in the frame of the root link.

A joint's origin places its child link in its parent link, xyz in m and rpy in rad about fixed axes x, y, z:
R = Rz(yaw) Ry(pitch) Rx(roll), at the joint's zero position. A link's inertial has its mass centre at the
origin of a frame of its own, along whose axes its moments are. A link without inertial has no mass.
"""
from __future__ import annotations

from pathlib import Path

import numpy as np

from .imported import Craft
from .parts import turn_of_radians
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

MOVING = ("revolute", "continuous", "prismatic", "spherical")  # the last: of Bullet alone
FREE = ("floating", "planar")
KINDS = ("fixed", *MOVING, *FREE)
WORDS = {"visual": "shapes and meshes that are seen", "collision": "shapes for "
                                                                   "contact", "transmission": "transmissions",
         "gazebo": "settings of a simulator", "dynamics": "damping and friction of "
                                                          "joints", "mimic": "coupled joints",
         "sensor": "sensors", "ros2_control": "settings of a controller"}
ENTRIES = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def read(text: str, path: Path, body: str | None = None) -> Craft:
    """What the description says. Raises InputError where no link has an inertial, or links are not one
    tree."""
    root = tree(text, path)
    if any(element.tag in ("macro", "property", "include", "arg") for element in root.children):
        raise root.fault("this is a xacro file, whose macros are not read: `xacro FILE > robot.urdf` writes "
                         "the URDF")
    links = by_name(root.all("link"), "link")
    judge_inertials(root, "link", any(link.one("inertial") for link in links.values()),
                    '<inertial><mass value="..."/><inertia ixx="..." .../></inertial>')
    joints = [*root.all("joint")]
    frames, locked, loose = _placed(root, links, joints)
    pieces = [_piece(link, frames[name]) for name, link in links.items() if name in frames]
    heavy = {item.name for item in pieces if item.part.mass}
    for joint, below in loose:
        if heavy & below and heavy - below and body is None:
            raise free(joint, f"{joint.name} lets links with mass move freely of each other", "link")
    craft = Craft(root.name or "robot")
    unread(craft, root, set(), WORDS)
    return combined(craft, pieces, Frame(), "link", locked, body, path)


def _placed(root: Element, links: dict[str, Element], joints: list[Element]
            ) -> tuple[dict[str, Frame], list[str], list[tuple[Element, set[str]]]]:
    """(frame of every link in that of the root, joints that move, (joint, links beyond it) of free ones)."""
    parents: dict[str, tuple[str, Element]] = {}
    for joint in joints:
        if joint.attributes.get("type") not in KINDS:
            raise joint.fault(f"expected a type of {', '.join(KINDS)}, got "
                              f"{joint.attributes.get('type')}", "type")
        ends = []
        for tag in ("parent", "child"):
            end = joint.one(tag)
            name = end.attributes.get("link", "") if end else ""
            judge_end(joint, name, links, tag)
            ends.append(name)
        if ends[1] in parents:
            raise joint.fault(f"link {ends[1]} is the child of two joints: a description is a tree", "child")
        parents[ends[1]] = (ends[0], joint)
    roots = [name for name in links if name not in parents]
    if len(roots) != 1:
        raise root.fault(f"expected one link that is no child of a joint, got {', '.join(roots) or 'none'}: "
                         "tie the links by joints")
    frames = {roots[0]: Frame()}
    for name in links:
        chain = []
        while name not in frames:
            if name in chain:
                raise links[name].fault("its joints go round in a circle: a description is a tree")
            chain.append(name)
            name = parents[name][0]
        for child in reversed(chain):
            parent, joint = parents[child]
            frames[child] = frames[parent].then(_origin(joint))
    locked = [joint.name for joint in joints if joint.attributes["type"] in MOVING]
    loose = [(joint, _beyond(child, parents)) for child, (_, joint) in parents.items()
            if joint.attributes["type"] in FREE]
    return frames, locked, loose


def _beyond(child: str, parents: dict[str, tuple[str, Element]]) -> set[str]:
    """A link and all that hang on it."""
    result, size = {child}, 0
    while size != len(result):
        size = len(result)
        result |= {name for name, (parent, _) in parents.items() if parent in result}
    return result


def _origin(element: Element) -> Frame:
    """The frame that the origin of an element describes, none where there is none."""
    origin = element.one("origin")
    if origin is None:
        return Frame()
    place, angles = origin.attribute("xyz", 3, "0 0 0"), origin.attribute("rpy", 3, "0 0 0")
    return Frame(turn_of_radians(angles[::-1], "321"), np.array(fractions(place)))


def _piece(link: Element, frame: Frame) -> Piece:
    inertial = link.one("inertial")
    if inertial is None:
        return piece(link.name, "0", tensor_of(["0"] * 6), frame, frame, link)
    mass, inertia = (_needed(inertial, tag, link.name) for tag in ("mass", "inertia"))
    numbers = [inertia.attribute(key, 1)[0] for key in ENTRIES]
    return piece(link.name, mass.attribute("value", 1)[0], tensor_of(numbers),
                 frame.then(_origin(inertial)), frame, inertia)


def _needed(inertial: Element, tag: str, name: str) -> Element:
    result = inertial.one(tag)
    if result is None:
        raise inertial.fault(f"link {name}: <{tag}> is missing: add it")
    return result
