"""Packages that a part of the program needs: which one is not there, and what to install."""
from __future__ import annotations

import sys

from .errors import InputError, RenderingUnavailable, StabilabError

INSTALLED_AS = {"flint": "python-flint", "PIL": "pillow", "vtkmodules": "vtk"}
# package -> extra of pyproject.toml that brings it
EXTRAS = {"xarray": "data", "pandas": "data", "distributed": "cluster"}
DRAWING = ("matplotlib", "pillow", "vtk", "pyvista", "contourpy")


def present(name: str) -> bool:
    """Whether a module can be found; it is not imported."""
    from importlib.util import find_spec
    try:
        return find_spec(name) is not None
    except (ImportError, ValueError):
        return False


def cure(module: str) -> str:
    """What to type where a module is not there, and the extra that brings it, if one does."""
    package = INSTALLED_AS.get(module, module)
    extra = (f" (part of stabilab's extra {EXTRAS[package]}: pip install \"stabilab[{EXTRAS[package]}]\")"
             if package in EXTRAS else "")
    return f"pip install {package}{extra}"


def demand(*modules: str):
    """Raise what `explained` says of the first module that is not there: before work that would be lost."""
    for module in modules:
        if not present(module):
            raise explained(ModuleNotFoundError(name=module))


def explained(error: ImportError) -> StabilabError | None:
    """The error in words for the user, without the exit code of a fault; None where the program itself is at
    fault."""
    cause, module = _cause(error)
    if module == "stabilab" or module in sys.stdlib_module_names:
        return None
    package = INSTALLED_AS.get(module, module) or "a package"
    if isinstance(cause, ModuleNotFoundError):
        text = f"{package} is not installed, and stabilab needs it for this: {cure(module)}"
    else:
        why = str(cause).strip().partition("\n")[0] or "no reason given"
        text = (f"{package} cannot be loaded ({why}): install what that names, or the package anew; "
                 "stabilab doctor names the versions that are there")
    return (RenderingUnavailable(f"no picture can be drawn: {text}") if package in DRAWING
            else InputError(text))


def _cause(error):
    """(the error that names a module, its outermost package), looking behind those that packages raise in
    their own words."""
    link = error
    while isinstance(link, ImportError):
        named = str(link).partition("No module named '")[2].partition("'")[0]  # in words of a package's own
        module = (link.name or named).split(".")[0]
        if module:
            return link, module
        link = link.__cause__ or link.__context__
    return error, ""
