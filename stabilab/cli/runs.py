"""Runs and pictures: a motion in time, plots, surfaces, reports, and a page with sliders."""
from __future__ import annotations

from pathlib import Path
from typing import Annotated  # typer reads the annotations at run time

import typer

from ..show import command_groups
from .options import CaseFile, Folder, Json, Order, Strict, UnitsOption, argument, flag, opens, option

commands = typer.Typer()


@commands.command()
@opens("simulate.simulate")
def simulate(
        case: CaseFile,
        at: Annotated[list[str] | None, option("T1,T2,...",
            'Times, with a unit ("2 min") or in that of the case; the state is at 0. Default: 201 '
            "times over the span of the case.")] = None,
        model: Annotated[str, option("NAME",
            "exact, or an analytic solution that applies: linear, corrected, printed, averaged1, averaged2, "
            "lindstedt.", autocompletion=command_groups.models)] = "exact",
        order: Order = None,
        method: Annotated[str | None, option("NAME",
            "taylor (default), a method of SciPy's solve_ivp by name, or reduced (any time at one cost); "
            "for the exact model.", autocompletion=command_groups.methods)] = None,
        rtol: Annotated[float | None, option("TOL", "Relative tolerance; default: the method's own.")] = None,
        digits: Annotated[int | None, option("N",
            "Reach N digits (1 to 15) the cheapest way, check them, or exit with 5. Without it 10 "
            "are the aim, unless --model, --method or --rtol is given.")] = None,
        angles: Annotated[bool, flag("--angles", "Euler angles ψ, θ, φ of the vertical, too.")] = False,
        attitude: Annotated[bool, flag(
            "--attitude", "The attitude as a quaternion and the angular momentum in space, too.")] = False,
        matrix: Annotated[bool, flag("--matrix", "The same with the attitude as a rotation matrix.")] = False,
        out: Annotated[Path | None, option("FILE.nc|.csv", "Write the states to a file.")] = None,
        json: Json = False, strict: Strict = False, units: UnitsOption = None):
    """Follow a motion in time.

    Says by how much first integrals vary along the run; with --model also what the theory says of the motion.

    Example: stabilab simulate cases/major-axis-100.toml --at 0,5,10,15 --json
    """


@commands.command()
@opens("pictures.plot")
def plot(
        case: CaseFile,
        kind: Annotated[str | None, option("KIND",
            "time, phase, potential, sphere, space, section, equilibria, budget, tilt, wheel, body, state "
            "or attitude (moves). Default: the one that says most of the case.",
            autocompletion=command_groups.kinds)] = None,
        out: Annotated[Path | None, option("FILE.png|.svg|.pdf",
            "Picture to write; default: CASE.png in the current folder. Of an attitude .html, .gif "
            "or .mp4.")] = None,
        size: Annotated[str | None, option("WxH", 'Width and height in inches: "8x5".')] = None,
        dpi: Annotated[float | None, option("N", "Dots an inch of a .png; default: 110.")] = None,
        until: Annotated[str | None, option("TIME", 'Draw up to this time: "10 min".')] = None,
        neighbours: Annotated[int | None, option(
            "N", "Of a section: so many motions beside this one; default: 6.")] = None,
        units: UnitsOption = None, strict: Strict = False):
    """Draw a case: rates over time, phase plane, separatrix, more.

    Of a FILE.nc of stabilab sweep it draws the map; --kind is then a column.
    The same case gives the same bytes. What a case has no plot of is refused, with the kinds that it has.

    Example: stabilab plot cases/middle-axis-double-well.toml --kind time --out double-well.svg
    """


@commands.command()
@opens("pictures.surface")
def surface(
        case: CaseFile, out: Folder = ...,  # type: ignore[assignment]  # typer: must be given
        json: Json = False, strict: Strict = False):
    """Write the separatrix surfaces as meshes and a picture.

    Files: .vtp, .glb, .stl, .png, and a summary, .json. Where there is no separatrix, it says why, and no
    file is written.

    Example: stabilab surface cases/minor-axis-100.toml --out surfaces
    """


@commands.command()
@opens("papers.report")
def report(
        cases: Annotated[list[Path] | None, argument("[CASE...]",
            "Case files; none: everything that stabilab brings.",
            autocompletion=command_groups.cases)] = None,
        out: Annotated[Path, option("DIR", "Folder for the report.")] = Path("report"),
        papers: Annotated[bool, flag("--papers",
            "The papers' tables and figures, the audit of their formulas and other tools' numbers "
            "as well: minutes.")] = False,
        precision: Annotated[bool, flag("--precision", "What accuracy costs, too.")] = False,
        certify: Annotated[bool, flag("--certify", "A certificate of each case, checked, too.")] = False,
        workers: Annotated[int | None, option(
            "N", "Processes that share the work; default: one a core.", min=1)] = None,
        strict: Strict = False):
    """Write a report on your cases: web pages.

    Verdict, margins, rates over time, phase plane, separatrix, equilibria, what would change the fate,
    equations. The folder needs no network: open its index.html.

    Example: stabilab report cases/minor-axis-100.toml --out report
    """


@commands.command()
@opens("pictures.explore")
def explore(
        case: Annotated[Path | None, argument("[CASE]",
            "A case file (TOML). Default: one that stabilab brings.",
            autocompletion=command_groups.cases)] = None,
        port: Annotated[int, option("N", "Port of this machine; 0: a free one.", min=0, max=65535)] = 0,
        browser: Annotated[bool, flag(
            "--browser/--no-browser", "Open the page, or only print its address.")] = True,
        static: Annotated[Path | None, option(
            "DIR", "Write the page as a folder for any web server: Python answers in the browser.")] = None,
        pyodide: Annotated[Path | None, option("DIR",
            "With --static: a folder with Pyodide and python-flint's wheel, to be copied in. "
            "Without: loaded from where they are published.")] = None):
    """Move a case with sliders, and the verdict follows.

    Separatrix, equilibria, motion, phase plane and rates over time; the verdict changes as you drag. The page
    is served to this machine alone, under an address with a random token, until Ctrl-C.

    Example: stabilab explore cases/thruster-stuck-major-axis.toml --no-browser
    """
