"""The models of a simulation description (SDFormat) with those inside them and those of files that they
include, as one list of links, joints and frames.

Names of a model inside another one have its name and two colons in front, and poses there count from its
frame. A file of `<include>` is looked for beside the description and beside its folder, as collections of
models lie: `model://arm` is `arm/model.sdf` there. One that is merged has no name of its own.
"""
from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from ..source import LARGEST_IMPORT, source_text
from .joined_links import Joint, Placed, end_of
from .rigid_pieces import Frame, by_name
from .xml_tree import Element, tree

MOVING = ("revolute", "revolute2", "continuous", "prismatic", "ball", "universal", "screw", "gearbox")


def text_in(element: Element, tag: str, default: str = "") -> str:
    """The text of the child with a tag."""
    child = element.one(tag)
    return child.text.strip() if child is not None else default


def included(holder: Element) -> tuple[list[tuple[Element, Element]], list[str]]:
    """((`<include>`, the model of its file) of those that are there, what the others ask for)."""
    models, missing = [], []
    for include in holder.all("include"):
        uri = text_in(include, "uri")
        path = _beside(uri, holder.path)
        root = tree(source_text(path, LARGEST_IMPORT), Path(path)) if path else None
        model = root.one("model") if root is not None and root.tag == "sdf" else None
        if model is None:
            missing.append(uri)
        else:
            models.append((include, model))
    return models, missing


def _beside(uri: str, path: Path) -> str:
    """The file that a URI names, "" where it is not there."""
    name = uri.partition("://")[2] or uri
    folder = os.path.dirname(os.path.abspath(path))
    places = [os.path.join(base, *name.split("/"), *end) for base in (folder, os.path.dirname(folder))
              for end in ((), ("model.sdf",))] if name and not os.path.isabs(name) else []
    return next((place for place in places if os.path.isfile(place)), "")


@dataclass
class Links:
    """Links, joints and frames by their full names. pose: what makes a frame of `<pose>`; attached: to which
    name frames and models are; models: all that are read; missing: what is included and not there."""

    pose: Callable[[Element | None], Frame]
    rows: dict[str, Placed] = field(default_factory=dict)
    links: dict[str, Element] = field(default_factory=dict)
    attached: dict[str, str] = field(default_factory=dict)
    found: list[tuple[Element, str, str]] = field(default_factory=list)
    models: list[Element] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)

    def add(self, model: Element, prefix: str = "", own: str = "", above: tuple[str, ...] = ()) -> None:
        """Take a model in. prefix: of names inside it; own: the name of its frame; above: files that include
        it."""
        if str(model.path) in above:
            raise model.fault(f"{model.path} includes itself")
        self.models.append(model)

        def named(name: str) -> str:
            inner = name.removesuffix("__model__").removesuffix("::")
            return prefix + inner if inner else own

        def place(name: str, element: Element, pose: Element | None, default: str) -> None:
            attributes = pose.attributes if pose else {}
            relative = attributes.get("relative_to") or attributes.get("frame") or default
            self.rows.setdefault(name, Placed(pose or element, named(relative), self.pose(pose)))

        # links first: older files give joints the names of links, to which alone names there lead
        for name, link in by_name(model.all("link"), "link").items():
            self.links[prefix + name] = link
            place(prefix + name, link, link.one("pose"), "")
            self.attached.setdefault(own, prefix + name)
        for frame in model.all("frame"):
            base = frame.attributes.get("attached_to", "")
            place(prefix + frame.name, frame, frame.one("pose"), base)
            self.attached[prefix + frame.name] = named(base)
        for joint in model.all("joint"):
            ends = [text_in(joint, tag) for tag in ("parent", "child")]
            place(prefix + joint.name, joint, joint.one("pose"), ends[1])
            self.found.append((joint, prefix + joint.name, prefix))
        files, missing = included(model)
        self.missing += missing
        nested = [(inner, inner, above) for inner in model.all("model")]
        for include, inner, files_above in [*nested, *((*pair, (*above, str(model.path))) for pair in files)]:
            for element in (include, inner):
                if element.attributes.get("placement_frame") or element.one("placement_frame"):
                    raise element.fault("placement_frame is not read: give the pose of the model's own frame")
            name = prefix + (include.name or text_in(include, "name") or inner.name)
            place(name, include, include.one("pose") or inner.one("pose"), "")
            merged = include.attributes.get("merge") in ("true", "1")
            self.add(inner, prefix if merged else f"{name}::", name, files_above)
            self.attached.setdefault(own, name)

    def joints(self, more: str) -> list[Joint]:
        """The joints between the links. more: what to do about one that is missing."""
        return [Joint(joint, name, self._end(joint, prefix, "parent", more),
                      self._end(joint, prefix, "child", more),
                      joint.attributes.get("type") in MOVING) for joint, name, prefix in self.found]

    def _end(self, joint: Element, prefix: str, tag: str, more: str) -> str:
        text = text_in(joint, tag)
        if text == "world" and tag == "parent" and prefix + text not in self.links:
            return ""
        name, inside = prefix + text, prefix.removesuffix("::")
        if text == "__model__":
            name = inside
        for _ in range(len(self.attached) + 1):  # of a frame or a model, the link that it is attached to
            if name not in self.links and name in self.attached and text:
                name = self.attached[name]
        return name if name in self.links else end_of(joint, text, (), tag, more)
