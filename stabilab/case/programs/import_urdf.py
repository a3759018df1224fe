"""A robot description (URDF) as a case: its links as one rigid body, in the frame of the root link.

A joint's origin places its child link in its parent link, xyz in m and rpy in rad about fixed axes x, y, z:
R = Rz(yaw) Ry(pitch) Rx(roll), at the joint's zero position. A link's inertial has its mass centre at the
origin of a frame of its own, along whose axes its moments are. A link without inertial has no mass.
"""
from __future__ import annotations

from pathlib import Path

import numpy as np

from .imported import Craft
from .joined_links import Joint, Placed, end_of, joined_links, placed
from .parts import turn_of_radians
from .rigid_pieces import Frame, Piece, by_name, judge_inertials, piece, tensor_of, unread
from .xml_tree import Element, fractions, tree

MOVING = ("revolute", "continuous", "prismatic", "spherical")  # the last: of Bullet alone
FREE = ("floating", "planar")
KINDS = ("fixed", *MOVING, *FREE)
WORDS = {"visual": "shapes and meshes that are seen", "collision": "shapes for contact",
         "transmission": "transmissions", "gazebo": "settings of a simulator",
         "dynamics": "damping and friction of joints", "mimic": "coupled joints", "sensor": "sensors",
         "ros2_control": "settings of a controller"}
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
    joints = [_joint(element, links) for element in root.all("joint")]
    rows = {name: Placed(link, "", Frame()) for name, link in links.items()}
    for joint in joints:
        if rows[joint.child].relative:
            raise joint.element.fault(f"link {joint.child} is the child of two joints: a description is a "
                                      "tree", "child")
        rows[joint.child] = Placed(joint.element, joint.parent, _origin(joint.element))
    frames = placed(rows)
    craft = Craft(root.name or "robot")
    unread(craft, [root], WORDS)
    pieces = [_piece(link, frames[name]) for name, link in links.items()]
    return joined_links(craft, pieces, joints, rows, body, path)


def _joint(element: Element, links: dict[str, Element]) -> Joint:
    kind = element.attributes.get("type")
    if kind not in KINDS:
        raise element.fault(f"expected a type of {', '.join(KINDS)}, got {kind}", "type")
    ends = [end_of(element, end.attributes.get("link", "") if (end := element.one(tag)) else "", links, tag)
            for tag in ("parent", "child")]
    return Joint(element, element.name, ends[0], ends[1], kind in MOVING, kind not in FREE)


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
