"""Links that joints join, as URDF and SDFormat describe them: where each is, and all as one rigid body."""
from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

from .imported import Craft
from .rigid_pieces import Frame, Piece, combined, free
from .xml_tree import Element


class Placed(NamedTuple):
    """A frame. element: that says where it is; relative: the name of the frame that it is placed in, "" of
    the root; frame: in that one."""

    element: Element
    relative: str
    frame: Frame


class Joint(NamedTuple):
    """Between two links, each by its name, "" of the world. moves: whether they may turn or slide; ties:
    whether they are one body where they do not."""

    element: Element
    name: str
    parent: str
    child: str
    moves: bool
    ties: bool = True


def placed(rows: Mapping[str, Placed], more: str = "") -> dict[str, Frame]:
    """Every frame in that of the root. A fault where one is placed in none that there is, or in itself. more:
    what else to do about one that is missing."""
    result = {"": Frame()}
    for name in rows:
        chain: list[str] = []
        while name not in result:
            element, relative, _ = rows[name]
            if name in chain:
                raise element.fault(f"{name} is placed relative to itself: a description is a tree")
            if relative and relative not in rows:
                raise element.fault(f"no frame {relative}: expected a link, a joint or a frame of the "
                                    f"model{more}", "relative_to")
            chain.append(name)
            name = relative
        for own in reversed(chain):
            result[own] = result[rows[own].relative].then(rows[own].frame)
    return result


def end_of(joint: Element, name: str, links: Collection[str], key: str, more: str = "") -> str:
    """The link that a joint names; a fault where it is none."""
    if name not in links:
        raise joint.fault(f"joint {joint.name}: no link {name or 'is named'}: expected one of the "
                          f"links{more}", key)
    return name


def joined_links(craft: Craft, pieces: Sequence[Piece], joints: Sequence[Joint], rows: Mapping[str, Placed],
                 body: str | None, path: object) -> Craft:
    """The craft with the links as one body in the frame of the root, or with the one named `body` in its
    own. A fault where links with mass move freely of each other."""
    groups = {item.name: {item.name} for item in pieces}
    for joint in joints:
        if joint.ties and joint.parent in groups:
            union = groups[joint.parent] | groups[joint.child]
            groups |= dict.fromkeys(union, union)
    heavy = [item.name for item in pieces if not item.empty]
    apart = [name for name in heavy if name not in groups[heavy[0]]]
    if apart and body is None:
        raise free(rows[apart[0]].element, f"no joint ties link {apart[0]} to link {heavy[0]}, and they",
                   "link")
    locked = [joint.name for joint in joints if joint.moves]
    return combined(craft, pieces, Frame(), "link", locked, body, path)
