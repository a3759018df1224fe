"""Runs and pictures: a motion in time, plots, surfaces, reports, and a page with sliders."""
from __future__ import annotations

from pathlib import Path
from typing import Annotated  # typer reads the annotations at run time

import typer

from ..show import command_groups
from ..show.picture_kinds import KINDS
from .options import CaseFile, Folder, Json, Order, Strict, UnitsOption, argument, flag, opens, option

commands = typer.Typer()


@commands.command()
@opens("simulate.simulate")
def simulate(
        case: CaseFile,
        at: Annotated[list[str] | None, option("T1,T2,...",
            'Times, with a unit ("2 min") or in that of the case; the initial state is at 0. Default: 201 '
            "times over the span of the case.")] = None,
        model: Annotated[str, option("NAME",
            "exact, or an analytic solution that applies: linear, corrected, printed, averaged1, averaged2, "
            "lindstedt.", autocompletion=command_groups.models)] = "exact",
        order: Order = None,
        method: Annotated[str | None, option("NAME",
            "taylor (default), a method of SciPy's solve_ivp by name, or reduced (late times cost no more "
            "than early ones); for the exact model.", autocompletion=command_groups.methods)] = None,
        rtol: Annotated[float | None, option("TOL", "Relative tolerance; default: the method's own.")] = None,
        digits: Annotated[int | None, option("N",
            "Reach N digits (1 to 15) by the cheapest method and check them; exit with 5 where they are not "
            "reached. Default: 10 where possible, unless --model, --method or --rtol is given.")] = None,
        angles: Annotated[bool, flag("--angles", "Add Euler angles ψ, θ, φ of the vertical.")] = False,
        attitude: Annotated[bool, flag(
            "--attitude", "Add the attitude as a quaternion, and the angular momentum in space.")] = False,
        matrix: Annotated[bool, flag("--matrix", "The same with the attitude as a rotation matrix.")] = False,
        nutation: Annotated[str | None, option("AXIS",
            "Add the angle of a body axis to the angular momentum: x, y, z of the file or 1, 2, 3, principal "
            "axes.")] = None,
        out: Annotated[Path | None, option("FILE.nc|.csv|.aem",
            "Write the states to a file; .aem: a CCSDS attitude ephemeris, quaternions and rates.")] = None,
        epoch: Annotated[str | None, option("DATE",
            "The date of time 0 (TAI) in an .aem: 2026-01-01T00:00:00.")] = None,
        json: Json = False, strict: Strict = False, units: UnitsOption = None):
    """Follow a motion in time.

    Also says by how much first integrals vary along the run and, with --model, what the theory says about the
    motion.

    Example: stabilab simulate cases/major-axis-100.toml --at 0,5,10,15 --json
    """


@commands.command()
@opens("pictures.plot")
def plot(
        case: CaseFile,
        kind: Annotated[str | None, option("KIND",
            f"{', '.join(KINDS)} (attitude: an animation). Default: the one that shows most of the case.",
            autocompletion=command_groups.kinds)] = None,
        out: Annotated[Path | None, option("FILE.png|.svg|.pdf",
            "Picture to write; default: CASE.png in the current folder. For --kind attitude: .html, .gif "
            "or .mp4.")] = None,
        size: Annotated[str | None, option("WxH", 'Width and height in inches: "8x5".')] = None,
        dpi: Annotated[float | None, option("N", "Dots per inch of a .png; default: 110.")] = None,
        until: Annotated[str | None, option("TIME", 'Draw up to this time: "10 min".')] = None,
        neighbours: Annotated[int | None, option(
            "N", "For --kind section: number of neighbouring motions; default: 6, of one that repeats 10 "
                 "closed orbits.")] = None,
        axis: Annotated[str | None, option(
            "AXIS", "For --kind nutation: x, y, z of the file or 1, 2, 3, principal axes; default: that of "
                    "[motion] axis, else the one nearest to the angular momentum at the start.")] = None,
        units: UnitsOption = None, strict: Strict = False):
    """Draw a case: rates over time, phase plane, separatrix, more.

    For a FILE.nc of stabilab sweep it draws the map; --kind is then a column. The same case gives the same
    bytes. A kind of picture that the case does not have is an error, which lists those that it has.

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
            "Case files; default: all that come with stabilab.",
            autocompletion=command_groups.cases)] = None,
        out: Annotated[Path, option("DIR", "Folder for the report.")] = Path("report"),
        papers: Annotated[bool, flag("--papers",
            "Add the tables and figures of the papers, the audit of their formulas and the comparison with "
            "other programs; takes minutes.")] = False,
        precision: Annotated[bool, flag("--precision", "Add a page on what accuracy costs.")] = False,
        certify: Annotated[bool, flag("--certify", "Add a certificate of each case, and check it.")] = False,
        workers: Annotated[int | None, option(
            "N", "Processes that share the work; default: one for each core.", min=1)] = None,
        strict: Strict = False):
    """Write a report on your cases: web pages.

    Outcome, margins, rates over time, phase plane, separatrix, equilibria, changes that change the outcome,
    equations. Open index.html in the folder; it needs no network.

    Example: stabilab report cases/minor-axis-100.toml --out report
    """


@commands.command()
@opens("pictures.explore")
def explore(
        case: Annotated[Path | None, argument("[CASE]",
            "A case file (TOML). Default: an example.",
            autocompletion=command_groups.cases)] = None,
        port: Annotated[int, option("N", "Port of this machine; 0: a free one.", min=0, max=65535)] = 0,
        browser: Annotated[bool, flag(
            "--browser/--no-browser", "Open the page, or only print its address.")] = True,
        static: Annotated[Path | None, option(
            "DIR", "Write the page as a folder for any web server: Python then runs in the browser.")] = None,
        pyodide: Annotated[Path | None, option("DIR",
            "With --static: a folder with Pyodide and python-flint's wheel, to be copied in. "
            "Without: loaded from where they are published.")] = None):
    """Change a case with sliders and see the outcome change.

    Separatrix, equilibria, motion, phase plane and rates over time; the outcome changes as you drag. The page
    is served to this machine only, at an address with a random token, until Ctrl-C.

    Example: stabilab explore cases/thruster-stuck-major-axis.toml --no-browser
    """
