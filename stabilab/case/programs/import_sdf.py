"""A simulation description (SDFormat) as a case: the links of its model as one rigid body, in the
model's frame.

A pose (x y z roll pitch yaw, in m and in rad about fixed axes x, y, z) places a link in its model, or in the
frame, link or joint that relative_to names, and an inertial in its link. SDFormat says that what is left out
of `<inertial>` is 1 kg, and 1 kg m^2 about each axis; the case says so where a link relies on it.
"""
from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from .imported import Craft, listed
from .joined_links import joined_links, placed
from .parts import of_quaternion, turn, turn_of_radians
from .rigid_pieces import Frame, Piece, judge_inertials, piece, tensor_of, unread
from .sdf_models import Links, included, text_in
from .xml_tree import Element, fractions, tree

WORDS = {"visual": "shapes and meshes that are seen", "collision": "shapes for contact", "plugin": "plugins",
         "sensor": "sensors", "fluid_added_mass": "added mass of a fluid", "gripper": "grippers",
         "physics": "settings of a simulator", "battery": "batteries"}
ENTRIES = {"ixx": "1", "iyy": "1", "izz": "1", "ixy": "0", "ixz": "0", "iyz": "0"}


def read(text: str, path: Path, body: str | None = None) -> Craft:
    """What the description says. Raises InputError where there is no link with an inertial, or more than one
    model that may move."""
    model = _model(tree(text, path))
    scene = Links(_pose)
    scene.add(model)
    missing = ", ".join(scene.missing)
    more = (f"; files of <include> that are not beside this one are not read: import {scene.missing[0]}, or "
            "write all into one file" if missing else "")
    judge_inertials(model, "link", any(link.one("inertial") for link in scene.links.values()),
                    "<inertial><mass>...</mass><inertia><ixx>...</ixx> ... </inertia></inertial>", more)
    craft = Craft(model.name or "model")
    joints, frames = scene.joints(more), placed(scene.rows, more)
    pieces = [_piece(name, link, frames[name], craft) for name, link in scene.links.items()]
    unread(craft, scene.models, WORDS)
    if missing:
        craft.caveats.append("of the links that the imported file has itself: other files that it includes "
                             f"are not read ({missing})")
    if files := {str(item.path): None for item in scene.models if item.path != model.path}:
        folder = os.path.dirname(os.path.abspath(path))
        craft.said.append(f"read with it: {', '.join(os.path.relpath(file, folder) for file in files)}")
    return joined_links(craft, pieces, joints, scene.rows, body, path)


def _model(root: Element) -> Element:
    """The only model that may move, of the file or of its world."""
    holders = (root, *root.all("world"))
    own = [model for holder in holders for model in holder.all("model")]
    models = [model for model in own if text_in(model, "static") not in ("true", "1")]
    missing: list[str] = []
    for holder in holders:
        files, left = included(holder)
        models += [model for include, model in files
                   if text_in(include, "static", text_in(model, "static")) not in ("true", "1")]
        missing += left
    if own and not models:
        raise own[0].fault(f"static models alone ({listed([model.name for model in own])}), which do not "
                           "move: take <static> away from the one that is meant")
    if len(models) != 1:
        names = listed([model.name for model in models])
        raise root.fault(f"the models {names} move freely of each other: put the one that is meant into a "
                         "file of its own" if models else
                         "no model: expected <model> with links"
                         + (f"; {missing[0]}, which it includes, is not beside it: import that file"
                            if missing else ""))
    return models[0]


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


def _piece(name: str, link: Element, frame: Frame, craft: Craft) -> Piece:
    inertial = link.one("inertial")
    if inertial is not None and inertial.attributes.get("auto") in ("true", "1"):
        raise inertial.fault(f"link {name}: auto finds mass and moments from shapes, which are not read: "
                             "write <mass> and <inertia>", "auto")
    inertia = inertial.one("inertia") if inertial else None
    missing = [key for key in ("mass",) if inertial is None or inertial.one(key) is None]
    missing += [key for key in ("ixx", "iyy", "izz") if inertia is None or inertia.one(key) is None]
    if missing:
        craft.caveats.append(f"the imported file does not give {', '.join(missing)} of link {name}: SDFormat "
                             "takes 1 kg, and 1 kg m^2")
    tensor = tensor_of([_number(inertia, key, default) for key, default in ENTRIES.items()])
    centre = frame.then(_pose(inertial.one("pose") if inertial else None))
    return piece(name, _number(inertial, "mass", "1"), tensor, centre, frame, inertial or link)


def _number(element: Element | None, tag: str, default: str) -> str:
    child = element.one(tag) if element else None
    return child.numbers(child.text, 1)[0] if child else default
