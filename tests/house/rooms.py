"""The rooms of the package and what each may import; the walk over all imports; the drawing in docs/house.md.

`python -m tests.house.rooms` writes the drawing and its picture anew from the imports as they stand.
"""
from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "stabilab"
PAGE = ROOT / "docs" / "house.md"
ASIDE = ("case", "maps", "verify")  # drawn at the side of the others
PICTURE = ROOT / "docs" / "static" / "rooms.svg"
GROUND = {"errors", "files", "interrupt", "packages", "reasons", "streams", "validation",
          "version", "representation", "processes", "threads", "tasks", "rubbish"}
# room -> rooms that it may import, besides itself and the ground; None: nothing, the ground included
MAY: dict[str, str | None] = {
    "numbers": "", "physics": "numbers", "case": "physics numbers", "integrate": "physics numbers",
    "equilibrium": "physics numbers",
    "orbit": "physics numbers", "unreduced": "orbit equilibrium integrate physics numbers",
    "answers": "unreduced orbit equilibrium integrate case physics numbers",
    "theories": "answers case integrate physics numbers",
    "maps": "answers orbit equilibrium case integrate physics numbers",
    "cost": "theories answers orbit integrate physics numbers", "verify": None,
    "show": "maps cost theories answers unreduced orbit equilibrium integrate case physics numbers verify",
    "papers": "show maps cost theories answers unreduced orbit equilibrium integrate case physics numbers",
    "commands": "papers show maps cost theories answers unreduced orbit equilibrium integrate case physics "
                "numbers verify"}


class Import(NamedTuple):
    """One imported name: importing module, imported module, the name (None where the module itself is meant),
    the line, and whether the import stands inside a function."""

    source: str
    target: str
    name: str | None
    line: int
    inside: bool


def modules() -> dict[str, Path]:
    """Dotted name -> file of every module of the package."""
    return {dotted(path): path for path in sorted(PACKAGE.rglob("*.py"))}


def dotted(path: Path) -> str:
    """The dotted name of a file of the package."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@cache
def tree_of(path: Path) -> ast.Module:
    """The syntax tree of a file."""
    return ast.parse(path.read_text(encoding="utf-8"))


def statements(node, inside=False, left_out=lambda node: False) -> Iterator[tuple[ast.AST, bool]]:
    """(statement, whether it stands inside a function) of all below a node, but for those left out and what
    is in them. Expressions, nineteen of twenty nodes of a file, hold no statement and are not walked."""
    for child in (child for part in ("body", "handlers", "orelse", "finalbody", "cases")
                  for child in getattr(node, part, ())):
        if not left_out(child):
            yield child, inside
            yield from statements(child, inside or isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef)),
                                  left_out)


def imports(name: str, path: Path, known) -> list[Import]:
    """Every import of a file that leads inside the package, those inside functions too."""
    # the public table names every room for type checkers, and loads none
    left_out = for_types if name == "stabilab" else lambda node: False
    return [Import(name, target, imported, node.lineno, inside) for node,
            inside in statements(tree_of(path), left_out=left_out)
            for target, imported in _names(node, name, path.name == "__init__.py", known)]


def for_types(node) -> bool:
    """Whether it is a block that type checkers alone read."""
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def _names(node, name, is_room, known):
    """(module, imported name or None) of one statement, where it leads inside the package."""
    if isinstance(node, ast.Import):
        yield from ((alias.name, None) for alias in node.names if alias.name.split(".")[0] == "stabilab")
    elif isinstance(node, ast.ImportFrom):
        package = name.split(".") if is_room else name.split(".")[:-1]
        base = package[:len(package) + 1 - node.level] if node.level else []
        stem = ".".join(base + (node.module.split(".") if node.module else []))
        if stem.split(".")[0] == "stabilab":
            for alias in node.names:
                whole = f"{stem}.{alias.name}"
                yield (whole, None) if whole in known else (stem, alias.name)


@cache
def all_imports() -> list[Import]:
    """Every import inside the package, in the order of the files."""
    known = modules()
    return [one for name, path in known.items() for one in imports(name, path, known)]


def room(name: str) -> str:
    """The room of a module: the first folder below the package, or the module itself where it lies in none.
    """
    return name.split(".")[1] if "." in name else "stabilab"


def circles(arrows) -> list[list[str]]:
    """The circles among (source, target) arrows: strongly connected components of more than one member
    (Tarjan)."""
    graph = defaultdict(set)
    for source, target in arrows:
        graph[source].add(target)
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in sorted(graph[node]):
            if other not in index:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in stack:
                low[node] = min(low[node], index[other])
        if low[node] == index[node]:
            circle = stack[stack.index(node):]
            del stack[stack.index(node):]
            if len(circle) > 1:
                found.append(sorted(circle))
    for node in sorted(graph):
        if node not in index:
            visit(node)
    return found


def _used() -> dict[str, set[str]]:
    """Of each room the rooms that it imports, as the imports stand."""
    into: dict[str, set[str]] = defaultdict(set)
    for one in all_imports():
        into[room(one.source)].add(room(one.target))
    return {name: {other for other in into[name] - {name} if other in MAY} for name in [*_floors(), "cli"]}


def drawing() -> str:
    """The rooms from the top down, a line each with the rooms that it imports."""
    used = _used()
    lines = (f"    {name:<12}-> {', '.join(other for other in reversed(used) if other in used[name])}"
             for name in reversed(used))
    return "\n".join(line.removesuffix("-> ").rstrip() for line in lines)


def picture() -> str:
    """The same as a picture (SVG): every room above those that it imports, with a line to each that it does
    not also reach through another."""
    used, floors = _used(), defaultdict(list)
    level: dict[str, int] = {}
    for name in used:
        level[name] = 1 + max((level[other] for other in used[name]), default=-1)
        if name not in ASIDE:
            floors[level[name]].append(name)
    top = max(floors)
    columns = {name: 2 + n - (len(row) - 1) / 2 for row in floors.values() for n, name in enumerate(row)}
    columns |= {name: 4 + n for n, name in enumerate(ASIDE)}
    middle = {name: (118 * column - 56, 24 + 62 * (top - level[name])) for name, column in columns.items()}
    lines, boxes = [], []
    for name, (x, y) in middle.items():
        boxes.append(f'<rect x="{x - 48:.0f}" y="{y - 14:.0f}" width="96" height="28" rx="4"/>'
                     f'<text x="{x:.0f}" y="{y + 5:.0f}">{name}</text>')
        reached = {far for other in used[name] for far in _below(other, used)}
        ends = [middle[other] for other in sorted(used[name] - reached)]
        lines += [f'<line x1="{x:.0f}" y1="{y + 14:.0f}" x2="{u:.0f}" y2="{v - 14:.0f}"/>' for u, v in ends]
    size = f"{118 * (4 + len(ASIDE)) - 110} {48 + 62 * top}"
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}" '
            'font-family="sans-serif" font-size="14" text-anchor="middle">'
            '<rect width="100%" height="100%" fill="white"/>'
            f'<g stroke="#777">{"".join(lines)}</g><g fill="#dbe9f6" stroke="#0072b2">'
            + "".join(boxes).replace("<text", '<text fill="black" stroke="none"') + "</g></svg>\n")


def _below(name: str, used: dict[str, set[str]]) -> set[str]:
    """The rooms that a room imports, and those that they import."""
    return used[name] | {far for other in used[name] for far in _below(other, used)}


def _floors() -> list[str]:
    """The rooms from the lowest to the highest: each after those that it may import."""
    order: list[str] = []
    while len(order) < len(MAY):
        order += [name for name, may in MAY.items() if name not in order
                  and set((may or "").split()) <= set(order)]
    return order


def main() -> None:
    """Write the drawing into docs/house.md, between its two marks, and the picture beside it."""
    text = PAGE.read_text(encoding="utf-8")
    head, rest = text.split("<!-- drawing -->\n", 1)
    tail = rest.split("<!-- end of drawing -->", 1)[1]
    PAGE.write_text(f"{head}<!-- drawing -->\n\n{drawing()}\n\n<!-- end of drawing -->{tail}",
                    encoding="utf-8")
    PICTURE.write_text(picture(), encoding="utf-8")


if __name__ == "__main__":
    main()
