"""What was written of a separatrix, in words."""
from __future__ import annotations

from pathlib import Path
from typing import Any

from ..terminal.letters import some


def text(summary: dict[str, Any], out: Path) -> str:
    """The answer in a line, a line a branch, and the files; why there is no surface where there is none.
    summary: of `write.summarise`."""
    name, branches = summary["case"], summary["sheets"]
    if not branches:
        return f"{name}: no surface to write: {summary['reason']}"
    lines = [f"{name}: {some(len(branches), 'separatrix surface')}; {summary['reason']}"]
    lines += [f"  {branch['name']}: {branch['triangles']} triangles, every vertex within "
              f"{branch['largest_residual']:.1e} of the surface (relative)"
              for branch in branches]
    return "\n".join([*lines, *(f"  {out / file}" for file in summary["files"])])
