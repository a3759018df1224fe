"""The sentences with a code that the package has, and the page that lists them.

`python -m tests.house.sentences` writes docs/reasons.md anew from the package as it stands.
"""
from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from stabilab.errors import Caveat, Kind
from stabilab.reasons import Reason, Sentence
from tests.house.rooms import tree_of

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "stabilab"
PAGE = ROOT / "docs" / "reasons.md"
KINDS = {
    "tilt": "the answer is for one direction of the torque; or what a tilt of the torque does",
    "limit": "the limit of the case is reached, and when",
    "law": "the motion leaves the range of an approximate law",
    "unphysical": "no rigid body has this inertia tensor",
    "size": "a tensor, a mass or a length is beyond all reason, as of a wrong unit",
    "stated": "a caveat that the case file states itself",
    "samples": "samples of the uncertain numbers were tried, nothing is proved of all of them",
    "uncertain": "the answer is of the middles of the uncertain numbers alone",
    "burn": "what a burn takes for granted, such as a mass that stays as it is",
    "motor": "the motor of a wheel runs without an end",
    "thrusters": "the case has thrusters, and none of them fires",
    "unstable": "the state is an equilibrium that is unstable, or not known to be stable",
    "tolerance": "the stated tolerance of a thruster's force is not looked at",
    "misalignment": "the stated misalignment of a thruster is not looked at",
    "distribution": "how far the box of normal numbers reaches, or what correlations count for"}
HEAD = """# Codes of caveats and reasons

What limits an answer is a *caveat*. In JSON it stands under the key `caveats`, an object each:

    {"kind": "unstable", "code": "unstable-equilibrium", "time": 1.7320508075688774,
     "words": "unstable: a disturbance grows by the factor e in 1.73205 s"}

- `kind`: what it is about, one of the first table.
- `code`: which sentence it is, for scripts: words may be improved, a code stays. It is empty where a sentence
  has no code yet.
- `words`: the sentence, in SI units. Text on a terminal and pages have it in the units of the case.
- Every quantity of the sentence by its own name, in SI; an axis is the number of a principal axis, 1 to 3; a
  sentence that is part of another one is an object with its own `code` and `text`.

A bound is rounded outward where it is printed: "at most" up, "at least" and "not before" down. The keys of
quantities have all digits.

Why an answer is known stands in the same form under the key `reason` (of the margins of stuck thrusters under
`margin_reason`, of checked digits under `digits`), with `text` in place of `words`, and with the clauses that
follow it in a list under `then`. The key `because` has all of it as one text. Where `reason` is a text, as of
all equilibria, runs, models, references and surfaces, the object stands beside it under `why`; name, equation
and parametrisation of a curve of equilibria stand so under `description`.

In the sentences below a name in code, such as `time`, is such a quantity.
`python -m tests.house.sentences` writes this page from the package.
"""


def held(value: Any) -> Iterator[Sentence]:
    """The sentences in a constant of a module."""
    if isinstance(value, Sentence):
        yield value
    elif isinstance(value, Reason):
        yield from (one.sentence for _, one in value.clauses())
    elif isinstance(value, Caveat):
        yield from held(value.reason)
    elif isinstance(value, (tuple, dict)):
        for one in value.values() if isinstance(value, dict) else value:
            yield from held(one)


def modules() -> Iterator[tuple[ast.Module, ModuleType]]:
    """(syntax, module) of every module of the package that makes a sentence."""
    for path in sorted(PACKAGE.rglob("*.py")):
        words = path.read_text(encoding="utf-8")
        if "Sentence(" in words and path.name != "reasons.py":  # the class itself
            name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
            yield tree_of(path), import_module(name)


@cache
def sentences() -> list[tuple[str, Sentence]]:
    """(the file that makes it, from the package's folder, the sentence) of all that modules have as
    constants, by their codes."""
    found: dict[int, tuple[str, Sentence]] = {}
    for tree, module in modules():
        made = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}
        for value in vars(module).values():
            for one in held(value):
                if one.code in made:  # else it is imported
                    place = Path(str(module.__file__)).relative_to(PACKAGE).as_posix()
                    found.setdefault(id(one), (place, one))
    return sorted(found.values(), key=lambda row: row[1].code)


def page() -> str:
    """docs/reasons.md: the kinds of caveats, and the sentences by their codes."""
    kinds = [f"| `{kind}` | {KINDS[kind]} |" for kind in Kind]
    rows = [f"| `{one.code}` | {cell(one.template)} | `{place}` |" for place, one in sentences()]
    return "\n".join([HEAD, "## Kinds of caveats\n", "| kind | what it is about |", "|---|---|", *kinds, "",
                      "## Sentences\n", "| code | sentence | module |", "|---|---|---|", *rows, ""])


def cell(template: str) -> str:
    """A template in a cell of a table: its holes as code."""
    return re.sub(r"\{(\w+)\}", r"`\1`", template).replace("|", r"\|")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
