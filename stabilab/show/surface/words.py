"""What was written of a separatrix, in words."""
from __future__ import annotations

from pathlib import Path
from typing import Any

from ..terminal.letters import some


def text(summary: dict[str, Any], out: Path) -> str:
    """The answer in a line, a line a sheet, and the files; why there is no surface where there is none.
    summary: of `write.summarise`."""
    name, sheets = summary["case"], summary["sheets"]
    if not sheets:
        return f"{name}: no surface to write: {summary['reason']}"
    lines = [f"{name}: {some(len(sheets), 'separatrix surface')}; {summary['reason']}"]
    lines += [f"  {sheet['name']}: {sheet['triangles']} triangles, every vertex within "
              f"{sheet['largest_residual']:.1e} of the surface (relative)"
              for sheet in sheets]
    return "\n".join([*lines, *(f"  {out / file}" for file in summary["files"])])
