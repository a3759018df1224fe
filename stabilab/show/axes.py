"""What an axis of a case is called: one convention for every text, page, picture and table.

Axes 1, 2, 3 of a scene are the principal axes. Where the tensor of the file is diagonal they are the file's
x, y, z; of a full tensor they are the major, the intermediate and the minor axis, whose direction in the
frame of the file stands beside the word; of a scaled case they are the paper's x1, x2, x3. A body of
revolution has a symmetry axis and two transverse ones.
"""
from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from ..numbers.vectors import Float3
from .names import around, spare_case

if TYPE_CHECKING:
    from fractions import Fraction

    from ..case.read import Case

NUMBERED = re.compile(
    r"\b(?:the )?(?:principal )?axis ([123])\b|\b(?:the )?(?:principal )?axes ([123](?:(?:, | and "
    r")[123])+)\b")
IN_FILE = " in the file's frame"
RANKS = ("major", "intermediate", "minor")


def direction(sign: int) -> str:
    """Of a spin about its axis, by the sign of its rate."""
    return f"{'positive' if sign > 0 else 'negative'} direction"


@dataclass(frozen=True)
class Axes:
    """letters: of the axes of the file or of the paper, "" of a full tensor; ranks: which axis each one is by
    its moment, "" where they are all alike or unknown; directions: unit vectors in the frame of the file,
    right-handed, None of a scaled case and of a scene without a file."""

    letters: tuple[str, ...]
    ranks: tuple[str, ...]
    directions: tuple[Float3, ...] | None = None

    def name(self, number: int) -> str:
        """In a table, a legend or JSON: "z (minor)", of a full tensor "minor", of a scaled case "x3"."""
        letter, word = self.letters[number - 1], self.ranks[number - 1]
        return f"{letter} ({word})" if letter and word else letter or word

    def signed(self, number: int, sense: int) -> str:
        """With the direction as a sign, where there is no room for more: "+z", "-minor"; nothing for 0."""
        if not number:
            return ""
        letter, word = self.letters[number - 1], self.ranks[number - 1]
        return ("+" if sense > 0 else "-") + (letter
                                              or word + (f" {number}" if self.ranks.count(word) > 1 else ""))

    def whole(self, number: int) -> str:
        """Where it is named first: "z (minor axis)", or "the minor axis, (0.019, -0.060, 0.998) in the file's
        frame"."""
        letter, word = self.letters[number - 1], self.ranks[number - 1]
        return (f"{letter} ({word} axis)" if letter and word else letter
                or f"the {word} axis, {self.direction(number)}{IN_FILE}")

    def rank_clause(self, number: int) -> str:
        """Which one an axis with a letter is, a clause: "z is the minor axis"; empty of others."""
        letter, word = self.letters[number - 1], self.ranks[number - 1]
        return f"{letter} is the {word} axis" if number and letter and word else ""

    def head(self, number: int) -> str:
        """In a first line: "z (minor axis)", or "the minor axis", whose direction `direction_clause` says."""
        letter = self.letters[number - 1]
        return self.whole(number) if letter else self.short(number)

    def direction_clause(self, number: int) -> str:
        """Where an axis without a letter lies, a clause; empty of one with a letter."""
        if not number or self.letters[number - 1]:
            return ""
        return f"the {self.ranks[number - 1]} axis is {self.direction(number)}{IN_FILE}"

    def brief(self, number: int) -> str:
        """After another axis of the same line: "x", or what `short` says where there is no letter."""
        return self.letters[number - 1] or self.short(number)

    def short(self, number: int) -> str:
        """Within a sentence: "the z axis", "the minor axis"; of two axes with one word also the direction."""
        letter, word = self.letters[number - 1], self.ranks[number - 1]
        if letter:
            return letter if letter in PLAIN.letters else f"the {letter} axis"
        return f"the {word} axis" + (f" {self.direction(number)}" if self.ranks.count(word) > 1 else "")

    def label(self, number: int) -> str:
        """Beside an axis that is drawn: "z", of a full tensor "minor"."""
        return self.letters[number - 1] or self.ranks[number - 1]

    def full(self, number: int) -> str:
        """Beside an axis of the body: its letter, its number and its rank, "z, 3, minor"."""
        letter, word = self.letters[number - 1], self.ranks[number - 1]
        counted = str(number) not in letter
        return ", ".join(filter(None, (letter, str(number) * counted, word)))

    def in_file(self, vector: Sequence[float]) -> tuple[float, ...]:
        """The components of a vector (3,) along the axes of the file; as they are where these are no others.
        """
        if self.directions is None or any(self.letters):
            return tuple(vector)
        return tuple(sum(v * axis[n] for v, axis in zip(vector, self.directions)) for n in range(3))

    def direction(self, number: int) -> str:
        """Three decimals of its direction in the frame of the file."""
        return told(self.directions[number - 1]) if self.directions else ""

    @around
    def sentence(self, text: str, name: Callable[[int], str] | None = None) -> str:
        """A sentence of the analysis with names (of `short`, where no other are asked) for the numbers of its
        axes."""
        if self == PLAIN:
            return text
        return NUMBERED.sub(lambda match: " and ".join((name or self.short)(int(n))
                                                       for n in re.findall("[123]", match[0])), text)

    def key(self, number: int | None) -> dict[str, Any]:
        """The keys of an axis in JSON: its number, name, and direction in the frame of the file; null where
        there is none."""
        along = self.directions[number - 1] if number and self.directions else None
        return {"axis": number or None, "axis_name": self.name(number) if number else None,
                "axis_direction": along}


PLAIN = Axes(("axis 1", "axis 2", "axis 3"), ("",) * 3)  # of a scene without a case


def axes_of(case: Case) -> Axes:
    """The names of a case's axes; what its user named stays as written from here on."""
    spare_case(case)
    if case.variables == "scaled":
        return Axes(("x1", "x2", "x3"), ("",) * 3)
    frame = case.frame
    rows = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0),
            (0.0, 0.0, 1.0)) if frame is None else tuple(tuple(float(v) + 0.0 for v in row)
                                                         for row in frame.axes)
    letters = tuple("xyz") if frame is None or frame.as_given else ("",) * 3
    # a scene with a body
    return Axes(letters, _ranks(case.scene.body.exact), rows)  # type: ignore[union-attr]


def with_moments(axes: Axes, moments: Sequence[Fraction]) -> Axes:
    """The names of the same axes for other moments about them."""
    ranks = _ranks(moments)
    return replace(axes, ranks=ranks, letters=axes.letters if any(axes.letters + ranks) else PLAIN.letters)


def _ranks(moments: Sequence[Fraction]) -> tuple[str, ...]:
    """Which axis each one is, by moments that are known exactly."""
    similar = len(set(moments))
    if similar == 1:
        return ("",) * 3
    if similar == 2:
        return tuple("symmetry" if moments.count(m) == 1 else "transverse" for m in moments)
    order = sorted(moments, reverse=True)
    return tuple(RANKS[order.index(m)] for m in moments)


def told(vector: Sequence[float]) -> str:
    """A direction to three decimals: 0.06 deg."""
    return f"({', '.join(f'{v:.3f}' if round(v, 3) else '0.000' for v in map(float, vector))})"
