"""XML files of other programs as elements that know their lines. A file with a document type is refused: none
of these formats has one, and entities of it can grow without end."""
from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from xml.parsers import expat

from ...errors import InputError, printable
from ...numbers.exact import exact

DEPTH = 200  # of elements inside each other
_COMMENT = re.compile(r"<!\[CDATA\[.*?\]\]>|<!--.*?-->", re.S)
_MACRO = re.compile(r"\$[({]")


@dataclass
class Element:
    """tag: without its namespace; text: of the element itself; line: where it begins."""

    tag: str
    attributes: dict[str, str]
    line: int
    path: Path
    text: str = ""
    children: list[Element] = field(default_factory=list)

    def all(self, *tags: str) -> Iterator[Element]:
        """The children with one of these tags."""
        return (child for child in self.children if child.tag in tags)

    def one(self, tag: str) -> Element | None:
        """The only child with this tag, None without any; a second one is a fault."""
        first, *others = [*self.all(tag)] or [None]
        if others:
            raise others[0].fault(f"a second <{tag}> in <{self.tag}>; the first is in line {first.line}: "
                                  "keep one")
        return first

    def within(self) -> Iterator[Element]:
        """The element and all inside it."""
        yield self
        for child in self.children:
            yield from child.within()

    @property
    def name(self) -> str:
        """Its attribute name."""
        return self.attributes.get("name", "")

    def fault(self, words: str, key: str = "") -> InputError:
        """The error with file, line and the tag or key."""
        return InputError(f"{printable(str(self.path))}:{self.line}: <{self.tag}>{f' {key}' if key else ''}: "
                          f"{printable(words)}")

    def numbers(self, text: str | None, count: int, key: str = "") -> list[str]:
        """So many numbers of a text, as they are written."""
        if _MACRO.search(text or ""):
            raise self.fault(f"an expression of xacro, {_quoted(text)}, is not evaluated: `xacro FILE > "
                             "robot.urdf` writes the number", key)
        parts = (text or "").split()
        if len(parts) != count:
            wanted = {1: "a number", 3: "three numbers", 4: "four numbers", 6: "six numbers"}[count]
            raise self.fault(f"expected {wanted}, got {_quoted(text)}", key)
        for part in parts:
            try:
                exact(part)
            except InputError as error:
                raise self.fault(str(error), key) from None
        return parts

    def attribute(self, key: str, count: int, default: str | None = None) -> list[str]:
        """The numbers of an attribute; a fault where it is missing and has no default."""
        text = self.attributes.get(key, default)
        if text is None:
            raise self.fault(f'expected the attribute {key}: add {key}="{" ".join(["0"] * count)}" with its '
                             f"number{'s' * (count > 1)}", key)
        return self.numbers(text, count, key)


def fractions(texts: Sequence[str]) -> list[Fraction]:
    """The numbers exactly as they are written."""
    return [exact(text) for text in texts]


def _quoted(text: str | None) -> str:
    return f'"{(text or "")[:60]}"' if text and text.strip() else "nothing"


def without_comments(text: str) -> str:
    """The text with blanks for comments, so that lines stay. Simulators read two things that XML forbids: two
    dashes inside a comment, and comments or blanks before the declaration."""
    return _COMMENT.sub(lambda match: match[0] if match[0].startswith("<![") else
                        re.sub(r"[^\n]", " ", match[0]), text)


def tree(text: str, path: Path) -> Element:
    """The root element of a text. Raises InputError where it is not XML."""
    # the text is decoded by now, whatever its declaration says of an encoding
    parser, stack = expat.ParserCreate("utf-8"), [Element("", {}, 0, path)]
    text = without_comments(text)
    begin = len(text) - len(text.lstrip())
    above = text.count("\n", 0, begin)

    def start(tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag.rpartition(":")[2], attributes, parser.CurrentLineNumber + above, path)
        if len(stack) > DEPTH:
            raise element.fault("nested too deeply to be read")
        stack[-1].children.append(element)
        stack.append(element)

    def end(tag: str) -> None:
        stack.pop()

    def data(characters: str) -> None:
        stack[-1].text += characters

    def document_type(*_: object) -> None:
        line = parser.CurrentLineNumber + above
        raise InputError(f"{printable(str(path))}:{line}: a document type (<!DOCTYPE ...>) is not read, as "
                         "its entities may stand for anything: take it away")

    parser.buffer_text = True
    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler, parser.StartDoctypeDeclHandler = data, document_type
    try:
        parser.Parse(text[begin:].encode(), True)
    except expat.ExpatError as error:
        line, words = error.lineno + above, expat.ErrorString(error.code)
        raise InputError(f"{printable(str(path))}:{line}: this is not well-formed XML ({words}): correct it "
                         "there, or write the file anew with the program that made it") from None
    return stack[0].children[0]
