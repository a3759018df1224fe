"""What each effect of a scene costs: states, symbols, operations and the time of a rate, as effects are added
one at a time.

The counts are of the equations that run: the compiled form of the rates, with common subexpressions formed
once.
"""
from __future__ import annotations

import subprocess
import sys
import time
from dataclasses import dataclass

import numpy as np

from ...answers.equilibria import equilibria
from ...answers.motion import motion
from ...answers.simulate import trajectory
from ...integrate.to_heyoka import borrowed_taylor, heyoka_available
from ...physics.effects import REGISTRY, effect_class
from ...physics.equations import derive
from ...physics.scene import Body, Scene
from ...physics.to_numpy import Form, form, to_numpy

BODY = Body((3, 2, "1.5"), 10)  # kg m^2, kg: three different moments, so that no term vanishes
# effect -> (arguments of a generic one, arguments of one of zero strength), in the order in which `ladder`
# adds them:
# those that leave the state alone first
EXAMPLES = {
    "constant_torque": ((("0.1", "0.2", "0.1"),), ((0, 0, 0),)),
    "gyrostat": ((("0.3", "-0.2", "0.5"),), ((0, 0, 0),)),
    "charge": (("0.003", 100, "1.02", "0.37"), (0, 100, "1.02", "0.37")),
    "resistance": (("0.01",), (0,)),
    "liquid_cavity": ((1000, 1, "1e-6"), (1000, 1, 0)),
    "newtonian_field": (("0.3",), (0,)),
    "gravity": (("9.81", ("0.01", "0.02", "0.05")), (0, ("0.01", "0.02", "0.05"))),
    "body_force": (((1, 2, 3),), ((0, 0, 0),))}
NOTHING = "body alone"
# states of a batch; Taylor steps, or rates of one state, in a round; rounds
MANY, STEPS, REPEATS = 1000, 200, 15


@dataclass(frozen=True)
class Cost:
    """What the equations of a scene consist of.

    added: the effect that came last; states: components of the state, in `blocks`; parameters: their symbols;
    coefficients: the numbers they make in the compiled rates; operations: additions, multiplications and
    powers there, common subexpressions once; branches: cases that the rates distinguish.
    """

    added: str
    blocks: tuple[str, ...]
    states: int
    parameters: tuple[str, ...]
    coefficients: int
    operations: int
    branches: int


@dataclass(frozen=True)
class Seconds:
    """Least processor times, s: of the rates of one state given as floats, of one among MANY states in an
    array, and of a Taylor step (None without heyoka)."""

    one: float
    among_many: float
    taylor_step: float | None


def example(name: str, zero: bool = False):
    """A generic effect of this name, or one of zero strength."""
    return effect_class(name)(*EXAMPLES[name][zero])


def ladder(names=tuple(EXAMPLES)) -> list[tuple[str, Scene]]:
    """(what was added, scene) from the body alone on, each scene with one effect more."""
    effects = [example(name) for name in names]
    return [(names[n - 1] if n else NOTHING, Scene(BODY, *effects[:n])) for n in range(len(effects) + 1)]


def alone() -> list[tuple[str, Scene]]:
    """(effect, scene with no other one)."""
    return [(name, Scene(BODY, example(name))) for name in EXAMPLES]


def counted(added: str, scene) -> Cost:
    """The counts of a scene's equations."""
    from sympy import Piecewise
    equations = derive(scene)
    rates = form(equations, equations.rhs)
    return Cost(added, equations.blocks, len(equations.state), tuple(equations.parameters),
                len(rates.symbols), operations(rates),
                sum(len(rate.atoms(Piecewise)) for rate in rates.expressions))


def operations(rates: Form) -> int:
    """Additions, multiplications and powers of compiled expressions, common subexpressions formed once. A
    factor -1 of a term counts as the subtraction that it is."""
    from sympy import count_ops, cse
    shared, rest = cse(rates.expressions)
    return int(sum(count_ops(e) for e in (*(e for _, e in shared), *rest)))


def timed(scene) -> Seconds:
    """The least times of REPEATS rounds."""
    equations = derive(scene)
    system, state = to_numpy(equations), np.linspace(0.1, 0.4, len(equations.state))
    many, one = np.tile(state, (MANY, 1)), state.tolist()
    step = None
    if heyoka_available():
        with borrowed_taylor(form(equations, equations.rhs)) as integrator:
            step = _least(lambda: _stepped(integrator, state), STEPS)
    return Seconds(_least(lambda: [system.rate(one) for _ in range(STEPS)], STEPS),
                   _least(lambda: system(many), MANY), step)


def _stepped(integrator, state):
    integrator.time = 0.0
    integrator.state[:] = state
    integrator.propagate_until(1e9, max_steps=STEPS)


def _least(call, items) -> float:
    call()
    found = []
    for _ in range(REPEATS):
        start = time.thread_time()  # of this thread alone: what else the machine does is not counted
        call()
        found.append(time.thread_time() - start)
    return min(found) / items


def imported(*names: str) -> tuple[str, ...]:
    """Modules of effects that a fresh interpreter has loaded after it built the scene of these effects and
    its equations."""
    unknown = set(names) - set(REGISTRY)
    if unknown:
        raise KeyError(*unknown)
    code = ("import sys\nfrom stabilab.papers.cost.effects import BODY, derive, example, Scene\n"
            "derive(Scene(BODY, *map(example, sys.argv[1:])))\n"
            "print(*sorted(m.rsplit('.')[-1] for m in sys.modules if "
            "m.startswith('stabilab.physics.effects.')))\n")
    run = subprocess.run([sys.executable, "-c", code, *names], capture_output=True, text=True, check=True)
    return tuple(name for name in run.stdout.split() if name != "base")


# -- an effect of zero strength

STATE, TIMES = (0.3, 0.2, -0.4), (-2.0, 1.0, 5.0, 10.0)


def without(name: str) -> Scene:
    """The scene to which an effect of zero strength is added: a wheel along axis 1 and a torque about axis 3,
    less `name`."""
    kept = {"gyrostat": ("0.4", 0, 0), "constant_torque": (0, 0, "0.2")}
    return Scene(BODY, *(effect_class(other)(vector) for other, vector in kept.items() if other != name))


def answers(scene) -> dict[str, object]:
    """Question -> the answer to its last bit, as something that compares equal only to the same bits."""
    runs = {method: trajectory(scene, STATE, TIMES, method) for method in ("taylor", "DOP853")}
    return {"equations": tuple(map(str,
                                   (*derive(scene).state, *derive(scene).parameters, *derive(scene).rhs))),
            **{f"states, {method}": (run.states.tobytes(), tuple(run.invariant_drift.items()),
                                     tuple(run.counters.items()))
               for method, run in runs.items()},
            "equilibria": repr(equilibria(scene)), "fate, extremes, period": repr(motion(scene, STATE))}


def zero_is_absent(name: str) -> dict[str, bool]:
    """Question -> whether a scene with this effect at zero strength answers as the scene without it, bit for
    bit."""
    base = without(name)
    plain, named = answers(base), answers(Scene(BODY, *base.effects, example(name, zero=True)))
    return {question: plain[question] == named[question] for question in plain}
