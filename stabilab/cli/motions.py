"""Answers about a motion: what becomes of it, its extremes and period, when it reaches a limit."""
from __future__ import annotations

from pathlib import Path
from typing import Annotated  # typer reads the annotations at run time

import typer

from .options import (
    CaseFile,
    CaseFiles,
    Csv,
    Digits,
    Follow,
    Json,
    Prove,
    Si,
    Strict,
    StrictFate,
    Tilt,
    UnitsOption,
    Why,
    flag,
    opens,
    option,
)

commands = typer.Typer()


@commands.command()
@opens("classify.classify")
def classify(
        cases: CaseFiles, json: Json = False,
        strict: Annotated[bool, flag("--strict",
            "Exit with 3 where a verdict or a fate is undecided or an approximate law does not "
            "hold.")] = False,
        certify: Annotated[bool, flag("--certify",
            "Prove the answer in exact numbers and ball arithmetic, and write it as a certificate "
            "that `stabilab verify` checks.")] = False,
        out: Annotated[Path, option("FILE.json", "Where the certificate goes.")] = Path("certificate.json"),
        follow: Follow = None, tilt: Tilt = None, units: UnitsOption = None, why: Why = False):
    """Find equilibria, their stability, and the fate of the motion.

    Example: stabilab classify cases/minor-axis-100.toml --json
    """


@commands.command()
@opens("classify.answer", question="fate")
def fate(
        cases: CaseFiles, json: Json = False, digits: Digits = None, strict: Strict = False,
        follow: Follow = None, tilt: Tilt = None, certify: Prove = False, units: UnitsOption = None,
        why: Why = False):
    """Say whether each motion stays bounded or spins up.

    And how far it is from the separatrix. Digits are those of that distance in energy; the outcome itself is
    certain.

    Example: stabilab fate cases/minor-axis-100.toml --digits 30
    """


@commands.command()
@opens("classify.answer", question="extremes")
def extremes(
        cases: CaseFiles, json: Json = False, csv: Csv = False, digits: Digits = None, strict: Strict = False,
        follow: Follow = None, units: UnitsOption = None, why: Why = False):
    """Find the least and greatest rates of each motion.

    Example: stabilab extremes cases/minor-axis-*.toml --csv
    """


@commands.command()
@opens("classify.answer", question="period")
def period(
        cases: CaseFiles, json: Json = False, digits: Digits = None, strict: Strict = False,
        units: UnitsOption = None, why: Why = False):
    """Find the period of each motion that repeats.

    Example: stabilab period cases/minor-axis-100.toml --digits 30
    """


@commands.command()
@opens("classify.attitude")
def attitude(
        cases: CaseFiles, json: Json = False,
        digits: Annotated[int | None, option(
            "N", "Write the periods to N digits (1 to 50); exit 5 where they are not reached.")] = None,
        strict: StrictFate = False, units: UnitsOption = None):
    """Find rotation and precession periods, and the turn in space.

    Example: stabilab attitude cases/torque-free-body.toml
    """


@commands.command()
@opens("stuck.when")
def when(
        cases: CaseFiles,
        rate: Annotated[str | None, option(
            "RATE", 'Of |ω|: "30 deg/s". Default: the limit of [limits].')] = None,
        component: Annotated[str | None, option("AXIS=RATE",
            "Of one component's size: \"z = 30 deg/s\"; x, y, z of the file, 1, 2, 3 for principal "
            "axes.")] = None,
        energy: Annotated[str | None, option("ENERGY", 'Of the kinetic energy: "5 J".')] = None,
        tilt: Annotated[str | None, option("AXIS=ANGLE",
            'Of the angle between a body axis and its direction at the start: "z = 20 deg".')] = None,
        until: Annotated[str | None, option("TIME", 'Search no further than this: "10 min".')] = None,
        units: UnitsOption = None, si: Si = False, json: Json = False, csv: Csv = False,
        strict: Annotated[bool, flag("--strict",
            "Exit with 3 where the time is not known or an approximate law does not hold.")] = False):
    """Say when each motion first reaches a limit.

    Enclosed between two times, by roots and not by sampling, or never.

    Example: stabilab when cases/cubesat-3u.toml --rate "30 deg/s"
    """


@commands.command()
@opens("stuck.stuck")
def stuck(
        case: CaseFile,
        all_thrusters: Annotated[bool, flag("--all-thrusters",
            "Each thruster alone, stuck or not; the one that reaches the limit first in front.")] = False,
        units: UnitsOption = None, si: Si = False, why: Why = False,
        out: Annotated[Path | None, option("FILE.png|.svg|.pdf", "Draw the rates against time.")] = None,
        json: Json = False, csv: Csv = False, strict: StrictFate = False):
    """Say what a thruster stuck open does, how soon, what helps.

    Outcome, axis, time to the limit of [limits], the least change that brings another outcome; wheel momenta
    that keep the motion bounded, thrusters that help.

    Example: stabilab stuck cases/upper-stage.toml
    """


@commands.command()
@opens("stuck.burn")
def burn(
        case: CaseFile,
        stop: Annotated[str | None, option(
            "TIME", 'Close all thrusters then: "12 s". Default: as the file says.')] = None,
        below: Annotated[str | None, option(
            "RATE", 'Find the latest closing time that keeps |ω| below this for ever: "30 deg/s".')] = None,
        units: UnitsOption = None, json: Json = False, strict: StrictFate = False):
    """Say what a burn leaves, and by when it must be closed.

    Of thrusters with start, stop, pulses or propellant in the file: rates at closing, the free motion after
    it, its largest rate.

    Example: stabilab burn cases/burns/stage.toml --stop "12 s" --below "20 deg/s"
    """


@commands.command(name="flat-spin")
@opens("stuck.flat_spin")
def flat_spin(
        case: CaseFile,
        within: Annotated[str, option(
            "ANGLE", "Nutation angle from which the tumble counts, and to which it settles.")] = "5 deg",
        units: UnitsOption = None, json: Json = False,
        strict: Annotated[bool, flag("--strict", "Exit with 3 where the outcome is undecided.")] = False):
    """Say when a spin that loses energy tumbles, and how it ends.

    Of a free body with a damper or a liquid: the direction of the major axis, the time at the separatrix, the
    final rate, and by how much the start decides.

    Example: stabilab flat-spin cases/explorer-1-damped.toml
    """


@commands.command()
@opens("stuck.orbit")
def orbit(
        case: CaseFile,
        up_to: Annotated[str | None, option("MOMENTUM",
            'Also count equilibria as the momentum of the wheels grows to this: "2 N m s".')] = None,
        out: Annotated[Path | None, option(
            "FILE.png|.svg|.pdf", "With --up-to: draw them over that momentum.")] = None,
        units: UnitsOption = None, json: Json = False, strict: StrictFate = False):
    """Find all equilibria of a satellite on a circular orbit.

    Of a file with [circular_orbit]: attitudes at rest in the orbital frame under the gravity gradient, with
    their stability and librations.

    Example: stabilab orbit cases/orbits/boom.toml --up-to "12 N m s"
    """


@commands.command()
@opens("pictures.chaos")
def chaos(
        cases: CaseFiles,
        until: Annotated[str | None, option(
            "TIME", "How long each motion is followed; default: a thousand turns.")] = None,
        out: Annotated[Path | None, option(
            "FILE.png|.svg|.pdf", "Draw the Poincaré section and MEGNO over its plane.")] = None,
        csv: Annotated[bool, flag("--csv", "CSV on stdout: MEGNO over time.")] = False,
        json: Json = False,
        strict: Annotated[bool, flag("--strict", "Exit with 3 where it stays undecided.")] = False):
    """Say whether each motion is regular or chaotic.

    By how a small change of the start grows (MEGNO), from variational equations of the case's own; seen up to
    a time, not proved.

    Example: stabilab chaos cases/minor-axis-100.toml
    """
