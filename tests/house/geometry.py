"""Who asks for the sign of the geometry: tests of a name or an attribute `e`, found in the syntax tree."""
from __future__ import annotations

import ast
from collections.abc import Iterator

from tests.house.rooms import PACKAGE, tree_of


def is_sign(node, beside=()) -> bool:
    """Whether an expression is the sign e of p q: an attribute `.e`, or a name `e` that is not compared with
    anything but 0."""
    if isinstance(node, ast.Name) and node.id == "e":
        return all(isinstance(other, ast.Constant) and other.value == 0 for other in beside
                   if other is not node)
    return isinstance(node, ast.Attribute) and node.attr == "e"


def asks(tree, names=True) -> Iterator[int]:
    """The lines that test it: a comparison, the truth of it, or a table that it opens. names: the name `e`
    counts too."""
    nodes = list(ast.walk(tree))
    caught = {id(n) for h in nodes if isinstance(h, ast.ExceptHandler) and h.name == "e" for n in ast.walk(h)}
    for node in nodes:
        tested, beside = [], []
        if isinstance(node, ast.Compare):
            tested = beside = [node.left, *node.comparators]
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
        yield from (one.lineno for one in tested if (names or isinstance(one, ast.Attribute))
                    and is_sign(one, beside) and id(one) not in caught)


def places() -> list[str]:
    """file:line of every test in the package: of attributes anywhere, of names in `orbit`, for elsewhere an e
    is an effect or an entry. The checker's geometry is its own."""
    found = []
    for path in sorted(PACKAGE.rglob("*.py")):
        file = path.relative_to(PACKAGE).as_posix()
        if not file.startswith("verify/"):
            found += [f"{file}:{line}" for line in asks(tree_of(path), names=file.startswith("orbit/"))]
    return found


if __name__ == "__main__":
    print(*places(), sep="\n")
