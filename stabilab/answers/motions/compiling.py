"""All loops that are compiled once per computer, each called with little work: for an installation, so that
nobody waits for it later.

Two processes share them where there are two cores. What one compiles the other does not: numba's index on
disk, of each function by itself, is no place for two to write at once."""
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from ...errors import InputError
from ...numbers.numba_door import Kernel, installed
from ...orbit.barriers_arrays import BARRIERS
from ...orbit.extremes_arrays import KERNELS, settle_rows
from ...orbit.fate_arrays import MARGINS
from ...orbit.landscape import landscape
from ...orbit.rows_kernel import BOX, PERIOD
from ...physics.body import Body
from ...physics.effects.constant_torque import ConstantTorque
from ...physics.effects.gyrostat import Gyrostat
from ...physics.own_unit import natural
from ...physics.scene import Scene
from ...tasks import Task, done
from ...unreduced import enclosure
from ...unreduced.spin_up import certificate
from ...unreduced.spin_up.certificate import tests_of
from ...unreduced.spin_up.drift import Runs
from ...unreduced.spin_up.elimination import ELIMINATE
from ...unreduced.spin_up.follow import spin_up_many

STATES = np.random.default_rng(6).normal(size=(40, 3))
BODY, WHEEL = Body((3, 2, 1)), Gyrostat((0.3, -0.1, 0.2))
SCENE = Scene(Body((12, 9, 5)), Gyrostat((0.8, 0, 0)), ConstantTorque((0, 0, 0.02)))


def rows() -> None:
    """Of extremes and periods of many states, between turning points and all round a circle, and of margins,
    those too that doubles leave open."""
    land = landscape(SCENE)
    for kind in KERNELS:
        settle_rows(land, STATES, np.empty((len(STATES), 3, 2)), np.empty(len(STATES)),
                    np.full(len(STATES), BOX + PERIOD, np.uint8), True, kind)
    BARRIERS.functions(True)["margins"](*STATES.T.copy(), land.orbits, np.empty(len(STATES)),
                                        np.empty(len(STATES), np.int8))
    MARGINS.functions(True)["margins"](STATES, np.arange(len(STATES)), *land.kernel_input,
                                       np.empty(len(STATES)), np.zeros(len(STATES), bool))


def spin_ups() -> None:
    """Of spin-up: steps of many motions and returns, and the tests about fixed and moving centres."""
    for effects in ((), (WHEEL,)):
        scene = Scene(BODY, *effects, ConstantTorque((0.3, 0.5, 0.4)))
        spin_up_many(scene, STATES * 3, 100, 3000, fast=True)
        Runs(natural(scene)[0], STATES, fast=True).carried(STATES, np.ones(len(STATES)), 10)
        tests = tests_of(scene)
        for field in tests.fixed + tests.moving:
            tests.certifier(field, (2, 4), fast=True).constants(STATES[0], 1e-9, fast=True)


def enclosures() -> None:
    """Of validated steps."""
    scene = Scene(BODY, WHEEL, ConstantTorque((0.3, 0.5, 0.4)))
    enclosure.ADVANCE.functions(True)
    enclosure.Course(scene, (1, 2, 3), 1.0).advance(0.1, 2, band=True)


def off_the_axes() -> None:
    """Of motions without a reduction."""
    spin_ups()
    enclosures()


TASKS: tuple[Callable[[], None], ...] = rows, off_the_axes


def kernels() -> tuple[Kernel, ...]:
    """All that is compiled."""
    return (*KERNELS.values(), BARRIERS, MARGINS, certificate.DECIDE, certificate.ADVANCE,
            ELIMINATE, enclosure.ADVANCE)


def compile_all() -> str:
    """Compile what is not on disk yet; the folder of it. InputError without numba, and where numba has no
    folder that it may write to: then every process compiles anew."""
    if not installed():
        raise InputError("compiling needs numba, which is not installed: pip install numba")
    with TemporaryDirectory() as folder:
        done([Task("compiling", f"answers.motions.compiling:{task.__name__}", ()) for task in TASKS],
             Path(folder), lambda label: None)
    if not all(kernel.on_disk() for kernel in kernels()):
        raise InputError("compiling: numba has no folder that it may write to; name one in the environment "
                         "variable NUMBA_CACHE_DIR")
    return str(Path(enclosure.ADVANCE.folder()).parent)
