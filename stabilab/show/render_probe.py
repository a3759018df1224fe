"""Can this machine draw 3-D pictures? Asked in a child process: without GL libraries VTK does not raise, it
crashes.
"""
from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from functools import lru_cache

from ..packages import INSTALLED_AS, cure, present

# the scene, its plotter, and the letters of the legend
NEEDED = ("vtkmodules", "pyvista", "matplotlib", "PIL")
CURE = "apt install libegl1 libgl1-mesa-dri"
SECONDS = 90  # a first start of the software renderer on a slow machine takes about 5 s


@dataclass(frozen=True)
class Renderer:
    """available; name of the renderer (OpenGL string), or why there is none; what to type to have one."""

    available: bool
    description: str
    cure: str = CURE


_CHILD = """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(32, 32))
plotter.add_mesh(pyvista.Sphere(), color="white")
image = plotter.screenshot(return_img=True)
told = plotter.render_window.ReportCapabilities().splitlines()
lines = [line.split(":", 1)[1].strip() for line in told if "renderer string" in line]
if not image.max() > image.min():
    raise SystemExit("an empty picture")
print("RENDERER", lines[0] if lines else "unknown")
"""


def use() -> None:
    """Have VTK draw into an EGL window where there is no display; call before pyvista is loaded."""
    if not os.environ.get("DISPLAY"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")


@lru_cache
def probe() -> Renderer:
    """Draw one sphere in a child process; the verdict is kept for the life of this process."""
    use()
    for module in NEEDED:
        if not present(module):
            return Renderer(False, f"{INSTALLED_AS.get(module, module)} is not installed", cure(module))
    try:
        child = subprocess.run([sys.executable, "-c", _CHILD], capture_output=True, text=True,
                               timeout=SECONDS, stdin=subprocess.DEVNULL)
    except (OSError, subprocess.TimeoutExpired) as error:
        return Renderer(False, f"the test picture did not come: {error.__class__.__name__}")
    rows = [line.removeprefix("RENDERER ") for line in child.stdout.splitlines()
             if line.startswith("RENDERER ")]
    if child.returncode == 0 and rows:
        return Renderer(True, rows[0])
    if child.returncode < 0 or child.returncode == 139:
        return Renderer(False, f"VTK crashed for want of GL libraries (signal {abs(child.returncode)})")
    last = child.stderr.strip().splitlines()
    return Renderer(False, last[-1] if last else f"the test picture failed with exit code {child.returncode}")
