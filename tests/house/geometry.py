"""Who asks for the sign of the geometry: tests of a name or an attribute `e`, found in the syntax tree."""
from __future__ import annotations

import ast
from collections.abc import Iterator

from tests.house.rooms import PACKAGE


def is_sign(node) -> bool:
    """Whether an expression is the sign e of p q: a name `e`, or an attribute `.e`."""
    return isinstance(node, ast.Name) and node.id == "e" or isinstance(node, ast.Attribute) and node.attr == "e"


def asks(tree) -> Iterator[int]:
    """The lines that test it: a comparison, the truth of it, or a table that it opens."""
    caught = {id(n) for h in ast.walk(tree) if isinstance(h, ast.ExceptHandler) and h.name == "e" for n in ast.walk(h)}
    for node in ast.walk(tree):
        tested = []
        if isinstance(node, ast.Compare):
            tested = [node.left, *node.comparators]
        elif isinstance(node, (ast.If, ast.IfExp, ast.While, ast.Assert)):
            tested = [node.test]
        elif isinstance(node, ast.comprehension):
            tested = node.ifs
        elif isinstance(node, ast.BoolOp):
            tested = node.values
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            tested = [node.operand]
        elif isinstance(node, ast.Subscript):
            tested = [node.slice]
        yield from (one.lineno for one in tested if is_sign(one) and id(one) not in caught)


def places() -> list[str]:
    """file:line of every test in the package but the checker's, whose geometry is its own."""
    found = []
    for path in sorted(PACKAGE.rglob("*.py")):
        file = path.relative_to(PACKAGE).as_posix()
        if not file.startswith("verify/"):
            found += [f"{file}:{line}" for line in asks(ast.parse(path.read_text(encoding="utf-8")))]
    return found


if __name__ == "__main__":
    print(*places(), sep="\n")
