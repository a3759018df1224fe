"""Many cases at once: one case over ranges of its numbers."""
from __future__ import annotations

from pathlib import Path
from typing import Annotated  # typer reads the annotations at run time

import typer

from .options import (
    Below,
    CaseFile,
    Component,
    CsvOfCells,
    Energy,
    Follow,
    Json,
    NutationBy,
    Scheduler,
    StrictFate,
    TiltBy,
    UnitsOption,
    Until,
    Workers,
    flag,
    opens,
    option,
)

commands = typer.Typer()


@commands.command()
@opens("sweep.sweep")
def sweep(
        case: CaseFile,
        vary: Annotated[list[str] | None, option("KEY=VALUES",
            'A number that varies: "torque[3]=0:0.1:101", "motion.angular_velocity[1]=-30:30:61 '
            'deg/s", "speed=1:1000:31:log rpm", "torque[1]=0, 1, 2". Up to four.')] = None,
        samples: Annotated[int | None, option(
            "N", "Random points of the uncertain numbers of the case, by their distributions.")] = None,
        seed: Annotated[int, option("S", "Seed of the random points.")] = 1,
        answer: Annotated[str | None, option("A,B,...",
            "fate, level, reason, island, margin, distance, extremes, period, when, largest, "
            "equilibria, verdict, chaos. Default: fate,level,margin.")] = None,
        out: Annotated[Path | None, option("FILE.nc",
            "Write NetCDF. Finished parts remain after an interrupted run: the same command "
            "continues it.")] = None,
        workers: Workers = None, scheduler: Scheduler = None,
        rate: Annotated[str | None, option("RATE", "Limit of the answer when, as of stabilab when.")] = None,
        component: Component = None, energy: Energy = None, tilt: TiltBy = None, until: Until = None,
        below: Below = None, nutation: NutationBy = None, nutation_below: NutationBy = None,
        follow: Follow = None,
        csv: Annotated[bool, flag("--csv", "CSV on stdout: a line for each point.")] = False,
        json: Json = False, strict: StrictFate = False):
    """Answer a case over ranges of its numbers.

    Outcomes, margins, extremes or equilibria at every point. Names of numbers may be shortened where they
    stay unique.

    Example: stabilab sweep cases/minor-axis-100.toml --vary "x[1]=-4:4:101" --vary "x[3]=-3:3:101" --out
    map.nc
    """


@commands.command()
@opens("maps.atlas")
def atlas(
        case: CaseFile,
        torque: Annotated[str | None, option(
            "SIZE", 'Size of the torque: "1 N m". Default: that of the case.')] = None,
        wheel: Annotated[str | None, option("[AXIS=]VALUES",
            'Wheel momenta for each of which all directions are mapped: "0:2:5" along the wheel '
            'of the case, "z=-2:2:5" (x, y, z of the file, or 1, 2, 3). Default: as in the case.')] = None,
        level: Annotated[int, option("N", "8 times 4^N cells of equal area at first.")] = 3,
        refine: Annotated[int, option("N", "How often cells along a boundary are divided into four.")] = 2,
        rate: Annotated[str | None, option(
            "RATE", "Limit for the time, as for stabilab when; default: that of [limits].")] = None,
        component: Component = None, energy: Energy = None, tilt: TiltBy = None, until: Until = None,
        below: Below = None, nutation: NutationBy = None, nutation_below: NutationBy = None,
        no_time: Annotated[bool, flag(
            "--no-time", "Leave out the time to a limit, which takes most of the work.")] = False,
        certify: Annotated[bool, flag(
            "--certify", "Prove outcomes and times where possible, however long it takes.")] = False,
        out: Annotated[list[Path] | None, option("FILE.nc|.png|.svg|.pdf|.html",
            "Write the cells, a picture, or a page that describes the cell under the pointer; may be "
            "repeated. Finished parts remain after an interrupted run.")] = None,
        workers: Workers = None, scheduler: Scheduler = None, follow: Follow = None,
        units: UnitsOption = None, csv: CsvOfCells = False, json: Json = False, strict: StrictFate = False):
    """Map all directions of a torque: outcomes, axes, times.

    The sphere of directions in cells of equal area, with smaller ones along the boundaries; the directions of
    the principal axes and of the thrusters are answered as points.

    Example: stabilab atlas cases/cubesat-3u.toml --out atlas.png
    """


@commands.command()
@opens("maps.basin")
def basin(
        case: CaseFile,
        vary: Annotated[list[str] | None, option("KEY=FROM:TO[:N]",
            'A rate of the initial state and its range: "x[1]=-4:4", '
            '"angular_velocity[3]=-30:30:33 deg/s" for 33 points of the coarse grid. Two of them.')] = None,
        depth: Annotated[int, option(
            "K", "How often a cell is halved whose corners have different outcomes.")] = 5,
        out: Annotated[list[Path] | None, option("FILE.png|.svg|.pdf|.nc",
            "Draw, or write NetCDF; may be repeated. Finished parts remain after an interrupted "
            "run.")] = None,
        workers: Workers = None, scheduler: Scheduler = None, follow: Follow = None, csv: CsvOfCells = False,
        json: Json = False, strict: StrictFate = False):
    """Find which initial states spin up, and their boundary.

    A plane of states in cells that get smaller towards the boundary between outcomes; the share of each
    outcome, the exact separatrix, the box dimension of the boundary.

    Example: stabilab basin cases/minor-axis-100.toml --vary "x[1]=-4:4" --vary "x[3]=-3:3" --out basin.png
    """


@commands.command()
@opens("maps.bifurcation")
def bifurcation(
        case: CaseFile,
        vary: Annotated[list[str] | None, option("KEY=FROM:TO",
            'A number that varies: "torque[3]=0:0.5", "wheels.pitch.speed=-3000:3000 rpm". One or '
            "two; of a symmetric top its spin, its weight or the momentum of a wheel.")] = None,
        curve: Annotated[bool, flag("--curve",
            "For a torque on a principal axis: find where stability changes along the whole curve of "
            "equilibria, independent of the motion.")] = False,
        momentum: Annotated[str | None, option("MOMENTUM",
            'All rotations of a free body at this angular momentum instead, over a wheel: "100 N m s".'
            )] = None,
        spin: Annotated[str | None, option("RATE",
            'The rotation at this rate about the axis of the wheels instead: "60 rpm".')] = None,
        out: Annotated[Path | None, option("FILE.png", "Draw the diagram: .png, .svg or .pdf.")] = None,
        certify: Annotated[Path | None, option("FILE.json",
            "For one number: write a certificate of all values and counts, which `stabilab verify` "
            "checks by other algebra.")] = None,
        csv: Annotated[bool, flag("--csv", "CSV on stdout: points of all branches.")] = False,
        json: Json = False):
    """Find where equilibria appear and vanish.

    Exactly, over the range of one number or two: the values at which the number of equilibria changes are
    roots of discriminants, and none is missed.

    Example: stabilab bifurcation cases/wheel-and-thruster.toml --vary "torque[3]=0:2000"
    """
