"""Faults to write into a module: cosmic-ray's mutations as changed source text."""
import ast
import random
from dataclasses import dataclass
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "stabilab"


@dataclass(frozen=True)
class Fault:
    """One mutation: the changed line as it was and as it is, and the whole changed source."""
    module: str
    operator: str
    occurrence: int
    line: int
    was: str
    now: str
    source: str


def drawn(modules, count: int, seed: int) -> list[Fault]:
    """`count` faults of these modules at random, all with 0; in the order of the text."""
    every = [(module, *spot) for module in modules for spot in spots(module)]
    rng = random.Random(f"{seed} {' '.join(modules)}")
    rng.shuffle(every)
    found, seen = [], set()
    for module, name, occurrence in every:
        if count and len(found) == count:
            break
        fault = _fault(module, name, occurrence)
        if fault and (module, fault.source) not in seen:
            seen.add((module, fault.source))
            found.append(fault)
    return sorted(found, key=lambda f: (modules.index(f.module), f.line))


def again(rows) -> list[Fault]:
    """The faults of a report's rows, where the text is still the same."""
    found = [(r, _fault(r["module"], f"core/{r['operator']}", r["occurrence"])) for r in rows]
    return [fault for r, fault in found if fault and (fault.was, fault.now) == (r["was"], r["now"])]


def spots(module: str):
    """(operator, occurrence) of every mutation outside annotations."""
    from cosmic_ray.ast import ast_nodes, get_ast
    from cosmic_ray.plugins import get_operator, operator_names
    text = (PACKAGE / f"{module}.py").read_text(encoding="utf-8")
    silent = _annotations(text)
    for name in sorted(operator_names()):
        if name.split("/")[-1] in ("VariableInserter", "VariableReplacer"):  # need arguments of their own
            continue
        operator = get_operator(name)()
        positions = [place for node in ast_nodes(get_ast(text))
                     for place in operator.mutation_positions(node)]
        yield from ((name, n) for n, (start, _) in enumerate(positions)
                    if not any(a <= start < b for a, b in silent))


def _annotations(text):
    """((line, column), (line, column)) of annotations: strings here, so no change in them does anything."""
    spans = []
    for node in ast.walk(ast.parse(text)):
        for child in (getattr(node, "annotation", None), getattr(node, "returns", None)):
            if child is not None:
                spans.append(((child.lineno, child.col_offset), (child.end_lineno, child.end_col_offset)))
    return spans


def _fault(module, name, occurrence):
    from cosmic_ray.mutating import mutate_code
    from cosmic_ray.plugins import get_operator
    path = PACKAGE / f"{module}.py"
    text = path.read_text(encoding="utf-8")
    source = mutate_code(text, get_operator(name)(), occurrence)
    if source is None or source == text:
        return None
    changed = [(n, a, b) for n, (a, b) in enumerate(zip(text.splitlines(), source.splitlines()), 1) if a != b]
    line, was, now = changed[0]
    return Fault(module, name.split("/")[-1], occurrence, line, was.strip(), now.strip(), source)
