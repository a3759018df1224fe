"""Where each key of a TOML text stands: dotted key -> line (the standard reader gives none)."""
from __future__ import annotations

import re
from dataclasses import dataclass, field

_SPACE = re.compile(r"(?:[ \t\n]|#[^\n]*)*")
_BLANK = re.compile(r"[ \t]*")
_BARE = re.compile(r"[A-Za-z0-9_-]+")
_SCALAR = re.compile(r"[^,\]}\n#]+")
_STRING = re.compile(r'"""(?:[^\\]|\\.)*?"{3,5}|\'\'\'.*?\'{3,5}|"(?:[^"\\\n]|\\.)*"|\'[^\'\n]*\'', re.DOTALL)
_REFUSED = 50  # parts of one dotted key: the standard reader takes time that grows with their square
# keys below this depth take the line of their ancestor: no case has them, and the map stays small
_DEEPEST = 8


@dataclass
class KeyLines:
    """line: path (a tuple of keys; list items by index) -> 1-based line of its first appearance;
    again: path -> line where it is written a second time; too_deep: line of a nesting that no reader should
    try."""

    line: dict[tuple, int] = field(default_factory=dict)
    again: dict[tuple, int] = field(default_factory=dict)
    too_deep: int | None = None

    def of(self, path: tuple) -> int | None:
        """Line of the key, or of its nearest ancestor that is written down."""
        while path and path not in self.line:
            path = path[:-1]
        return self.line.get(path)


def key_lines(text: str) -> KeyLines:
    """Scan a TOML text. Where the text is not TOML the scan ends early and keeps what it found."""
    scan = _Scan(text.replace("\r\n", "\n"))
    try:
        scan.document()
    except RecursionError:
        scan.found.too_deep = scan.here()
    except _NotToml:
        pass
    return scan.found


class _NotToml(Exception):
    pass


class _Scan:
    """One pass over the text; `at` is the place reached, `table` the path of the open table."""

    def __init__(self, text: str):
        self.text, self.at, self.table, self.found = text, 0, (), KeyLines()
        self.counted, self.lines = 0, 1
        self.arrays: dict[tuple, int] = {}
        # tables known only through a child: [a.b] before [a] is no repetition
        self.implied: set[tuple] = set()

    def document(self):
        while self.skip(_SPACE) < len(self.text):
            if self.text.startswith("[[", self.at):
                self.header("]]")
            elif self.text[self.at] == "[":
                self.header("]")
            else:
                self.pair(self.table)

    def header(self, closing: str):
        line = self.here()
        self.at += len(closing)
        path = self.key()
        self.expect(closing)
        if closing == "]]":
            self.arrays[path] = self.arrays.get(path, -1) + 1
            self.note(path, line, repeated=False)
            path += (self.arrays[path],)
        self.table = path
        self.note(path, line, repeated=path in self.found.line and path not in self.implied)

    def pair(self, table: tuple):
        line = self.here()
        path = table + self.key()
        self.expect("=")
        self.note(path, line, repeated=path in self.found.line)
        self.value(path)

    def value(self, path: tuple):
        self.skip(_BLANK)
        opening = self.text[self.at:self.at + 1]
        if opening == "[":
            self.items(path)
        elif opening == "{":
            self.inline(path)
        else:
            self.take(_STRING if opening in "\"'" and opening else _SCALAR)

    def items(self, path: tuple):
        self.at += 1
        index = 0
        while self.peek(_SPACE) != "]":
            if len(path) < _DEEPEST:
                self.found.line[path + (index,)] = self.here()
            self.value(path + (index,))
            index += 1
            if self.peek(_SPACE) == ",":
                self.at += 1
            elif self.peek(_SPACE) != "]":
                raise _NotToml
        self.at += 1

    def inline(self, path: tuple):
        self.at += 1
        while self.peek(_SPACE) != "}":
            self.pair(path)
            if self.peek(_SPACE) == ",":
                self.at += 1
            elif self.peek(_SPACE) != "}":
                raise _NotToml
        self.at += 1

    def key(self) -> tuple:
        parts = []
        while True:
            opening = self.peek(_BLANK)
            word = self.take(_STRING if opening in "\"'" and opening else _BARE)
            parts.append(_unquoted(word) if opening in "\"'" else word)
            if len(parts) > _REFUSED:
                raise RecursionError
            if self.peek(_BLANK) != ".":
                return tuple(parts[:_DEEPEST])
            self.at += 1

    def note(self, path: tuple, line: int, repeated: bool):
        """Keep the line of a key, and of the tables above it that are named by it alone."""
        if repeated:
            self.found.again.setdefault(path, line)
        elif len(path) <= _DEEPEST:
            self.found.line.setdefault(path, line)
            self.implied.discard(path)
        for end in range(1, min(len(path), _DEEPEST)):
            if path[:end] not in self.found.line:
                self.found.line[path[:end]] = line
                self.implied.add(path[:end])

    def here(self) -> int:
        self.lines += self.text.count("\n", self.counted, self.at)
        self.counted = self.at
        return self.lines

    def skip(self, pattern: re.Pattern[str]) -> int:
        self.at = pattern.match(self.text, self.at).end()
        return self.at

    def peek(self, pattern: re.Pattern[str]) -> str:
        self.skip(pattern)
        if self.at >= len(self.text):
            raise _NotToml
        return self.text[self.at]

    def take(self, pattern: re.Pattern[str]) -> str:
        result = pattern.match(self.text, self.at)
        if not result:
            raise _NotToml
        self.at = result.end()
        return result.group()

    def expect(self, mark: str):
        self.skip(_BLANK)
        if not self.text.startswith(mark, self.at):
            raise _NotToml
        self.at += len(mark)


def _unquoted(word: str) -> str:
    """A quoted key as the standard reader gives it (escapes resolved)."""
    if word[0] == "'":
        return word[1:-1]
    import tomllib
    try:
        return tomllib.loads(f"k = {word}")["k"]
    except ValueError:
        raise _NotToml from None
