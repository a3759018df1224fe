"""Bodies of a robot description as one rigid body: what is common to URDF, SDFormat and MJCF."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ...errors import InputError, printable
from .imported import LOCKED, Craft, listed
from .parts import ONE, Part, as_given, decimals, full, is_positive, joined, rows_of
from .xml_tree import Element, fractions

ORIGIN = 0 * ONE[0]


class Frame(NamedTuple):
    """turn: components of the frame that all are placed in to those of this one; origin: of this one in that
    frame, m."""

    turn: np.ndarray = ONE
    origin: np.ndarray = ORIGIN

    def then(self, inner: Frame) -> Frame:
        """A frame that is placed in this one."""
        return Frame(inner.turn @ self.turn, self.origin + self.turn.T @ inner.origin)

    def seen_from(self, other: Frame) -> Frame:
        """The frame placed in another one."""
        return Frame(self.turn @ other.turn.T, other.turn @ (self.origin - other.origin))


class Piece(NamedTuple):
    """name: of a link or body; part: about its mass centre, along the axes of `frame`, whose origin is the
    mass centre; own: the frame of the link itself; inertia: the element that gives its moments."""

    name: str
    part: Part
    frame: Frame
    own: Frame
    inertia: Element

    @property
    def empty(self) -> bool:
        """Whether it has neither mass nor moments."""
        return not self.part.mass and not self.part.tensor.any()

    @property
    def odd(self) -> bool:
        """Whether no body has its mass and moments, extension in all directions included."""
        return not self.empty and not (self.part.mass and is_positive(self.part.tensor))

    def fault(self) -> InputError:
        """That it is no body."""
        return self.inertia.fault(
            f"{self.name}: no body has a mass of {float(self.part.mass):.6g} kg with these moments: expected "
            "a positive mass, and moments of inertia about the mass centre in kg m^2 that are positive along "
            "all axes")


def piece(name: str, mass: str, tensor: np.ndarray, frame: Frame, own: Frame, inertia: Element) -> Piece:
    """A piece, whose mass is not negative; a fault of any other."""
    kilograms, = fractions([mass])
    result = Piece(name, Part(kilograms, tensor, ORIGIN, ORIGIN), frame, own, inertia)
    if kilograms < 0:
        raise result.fault()
    return result


def tensor_of(numbers: Sequence[str]) -> np.ndarray:
    """xx, yy, zz, xy, xz, yz as they are written."""
    return full(*fractions(numbers))


def combined(craft: Craft, pieces: Sequence[Piece], root: Frame, kind: str, locked: Sequence[str],
             body: str | None, path: object) -> Craft:
    """The craft with these pieces as one body in the frame `root`, or with the one named `body` in its own
    frame. locked: names of joints that may move. Of a piece that is no body, such as a mark with moments of
    any size or a mass without extension, the numbers count where all together are one."""
    heavy = [item for item in pieces if not item.empty]
    if body is not None:
        named = [item for item in pieces if item.name == body]
        if not named:
            raise InputError(f"--body {printable(body)}: no such {kind}; the file has {_names(pieces)}")
        if named[0].empty:
            raise InputError(f"--body {printable(body)}: this {kind} has no mass; those that have one are "
                             f"{_names(heavy)}")
        heavy, root = named, named[0].own
    if not heavy:
        raise InputError(f"{printable(str(path))}: every {kind} has the mass 0 and no moments, as one has "
                         "that does not move, and without them no motion can be found: write its mass and "
                         "moments")
    where = dict(enumerate(item.frame.seen_from(root) for item in heavy))
    odd = [item for item in heavy if item.odd]
    mass = sum(item.part.mass for item in heavy)
    whole = joined([item.part for item in heavy], where) if mass else None  # type: ignore[arg-type]
    if whole is None or odd and not is_positive(whole.tensor):
        raise odd[0].fault()
    # of one body, unturned, the numbers are those of the file
    write = as_given if len(heavy) == 1 and (where[0].turn == ONE).all() else decimals
    craft.mass, craft.inertia = write([whole.mass])[0], rows_of(whole, write)
    craft.centre = write(whole.centre)
    if len(heavy) > 1:
        craft.said.append(f"{len(heavy)} {'bodies' if kind == 'body' else kind + 's'} are joined into one "
                          f"rigid body about their common mass centre: {_names(heavy)} (--body NAME takes "
                          "one alone)")
    if locked and len(heavy) > 1:
        craft.caveats.append(LOCKED.format(listed(locked)))
    if odd:
        craft.caveats.append("no body has the mass and moments that the imported file gives of "
                             f"{_names(odd)}; they count as they are")
    empty = [item.name for item in pieces if item.empty]
    if empty and body is None:
        craft.said.append(f"without mass, and left out: {listed(empty)}")
    return craft


# --- What every description may have wrong
def by_name(elements: Iterable[Element], kind: str) -> dict[str, Element]:
    """The elements by their names, which differ; a fault where two share one."""
    result: dict[str, Element] = {}
    for element in elements:
        if element.name in result:
            raise element.fault(f"a second {kind} {element.name}, the first is in line "
                                f"{result[element.name].line}: names differ", "name")
        result[element.name] = element
    return result


def judge_inertials(parent: Element, kind: str, present: bool, example: str, more: str = "") -> None:
    """A fault where no link or body has an inertial. example: of one; more: what else can be done."""
    if not present:
        raise parent.fault(f"no {kind} has an <inertial>, and without mass and moments no motion can be "
                           f"found: add {example} to a {kind}{more}")


def free(element: Element, words: str, kind: str) -> InputError:
    """That parts move freely of each other, in words."""
    return element.fault(f"{words} move freely of each other: they are no rigid body; --body NAME takes one "
                         f"{kind} alone")


def _names(pieces: Sequence[Piece]) -> str:
    return listed([item.name for item in pieces])


def unread(craft: Craft, roots: Sequence[Element], words: dict[str, str]) -> None:
    """Name what the elements inside the roots have that is not read. words: what each tag is."""
    present = {element.tag for root in roots for element in root.within()}
    craft.omitted += [f"{words[tag]} (<{tag}>)" for tag in words if tag in present]
