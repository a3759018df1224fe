"""What each effect of a scene costs, and its page: states, symbols, operations and the time of a rate, as
effects are added one at a time. The counts are of the equations that run: the compiled form of the rates,
with common subexpressions formed once.
"""
from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..answers.equilibria import equilibria
from ..answers.motion import motion
from ..answers.simulate import trajectory
from ..integrate.to_heyoka import borrowed_taylor, heyoka_available
from ..physics.body import Body
from ..physics.effects import REGISTRY, effect_class
from ..physics.equations import derive
from ..physics.scene import Scene
from ..physics.to_numpy import Form, form, to_numpy
from ..show import narrow, style
from ..show.report import html
from ..show.text.cost import caption, duration

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
    "body_force": (((1, 2, 3),), ((0, 0, 0),)),
    "rate_damper": (((("0.03", "0.01", "0.01"), ("0.01", "0.02", "0.01"), ("0.01", "0.01", "0.03")),), (0,)),
    "eddy_currents": (("0.01", "2"), (0, 2)),
    "wheel_motor": ((("0.02", "0.01", "0.03"),), ((0, 0, 0),)),
    # a damper without strength is refused; the mass comes last, as what is solved beside it compiles for long
    "damper_wheel": (("0.1", "0.05", (1, 2, 2)), None), "viscous_damper": (("0.1", "0.05"), None),
    "damper_mass": (("0.1", ("0.2", "0.1", "0.05"), (1, 1, 2), 2, "0.3", 10), None)}
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


def ladder(names: Sequence[str] = tuple(EXAMPLES)) -> list[tuple[str, Scene]]:
    """(what was added, scene) from the body alone on, each scene with one effect more."""
    effects = [example(name) for name in names]
    return [(names[n - 1] if n else NOTHING, Scene(BODY, *effects[:n])) for n in range(len(effects) + 1)]


def alone() -> list[tuple[str, Scene]]:
    """(effect, scene with no other one)."""
    return [(name, Scene(BODY, example(name))) for name in EXAMPLES]


def counted(added: str, scene: Scene) -> Cost:
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


def timed(scene: Scene) -> Seconds:
    """The least times of REPEATS rounds."""
    equations = derive(scene)
    system, state = to_numpy(equations), np.linspace(0.1, 0.4, len(equations.state))
    many, item = np.tile(state, (MANY, 1)), state.tolist()
    step = None
    if heyoka_available():
        with borrowed_taylor(form(equations, equations.rhs)) as integrator:
            step = _least(lambda: _stepped(integrator, state), STEPS)
    return Seconds(_least(lambda: [system.rate(item) for _ in range(STEPS)], STEPS),
                   _least(lambda: system(many), MANY), step)


def _stepped(integrator, state):
    integrator.time = 0.0
    integrator.state[:] = state
    integrator.propagate_until(1e9, max_steps=STEPS)


def _least(call, items) -> float:
    call()
    rows = []
    for _ in range(REPEATS):
        start = time.thread_time()  # of this thread alone: what else the machine does is not counted
        call()
        rows.append(time.thread_time() - start)
    return min(rows) / items


IMPORTED = """
import os, sys, sympy
from stabilab.papers.cost_effects import BODY, Scene, derive, example
for names in sys.argv[1:]:
    copy = os.fork() if hasattr(os, "fork") else 0
    if not copy:
        derive(Scene(BODY, *map(example, names.split())))
        print(*sorted(m.rsplit(".")[-1] for m in sys.modules if m.startswith("stabilab.physics.effects.")),
              flush=True)
        os._exit(0)
    if os.waitpid(copy, 0)[1]:
        sys.exit(1)
"""


def imported(*scenes: Sequence[str]) -> list[tuple[str, ...]]:
    """For each scene, given by the names of its effects: the modules of effects that a fresh interpreter has
    loaded after it built the scene and its equations. One interpreter loads the program, and a copy of it
    builds each scene, where the system can copy a process; elsewhere each has its own."""
    unknown = {name for names in scenes for name in names} - set(REGISTRY)
    if unknown:
        raise KeyError(*unknown)
    words = [" ".join(names) for names in scenes]
    text = "".join(subprocess.run([sys.executable, "-c", IMPORTED, *each], capture_output=True, text=True,
                                  check=True).stdout
                   for each in ([words] if hasattr(os, "fork") else [[word] for word in words]))
    return [tuple(name for name in line.split() if name != "base") for line in text.splitlines()]


# -- an effect of zero strength

STATE, TIMES = (0.3, 0.2, -0.4), (-2.0, 1.0, 5.0, 10.0)


def without(name: str) -> Scene:
    """The scene to which an effect of zero strength is added: a wheel along axis 1 and a torque about axis 3,
    less `name`."""
    retained = {"gyrostat": ("0.4", 0, 0), "constant_torque": (0, 0, "0.2")}
    return Scene(BODY, *(effect_class(other)(vector) for other, vector in retained.items() if other != name))


def answers(scene: Scene) -> dict[str, object]:
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


PICTURE, BAR = "effects.png", "effects-bar.png"


def page(folder, tell=None, **around) -> Path:
    """Count, time and check every effect, and write effects.html with its picture into the folder; returns
    its path.

    tell: called with a line of words before each part of the work (some twenty seconds in all); around: of
    the pages beside it (`html.render`).
    """
    folder, tell = Path(folder), tell or (lambda text: None)
    tell("what each effect costs, one added to the other")
    steps = [(counted(added, scene), timed(scene)) for added, scene in ladder()]
    tell("what each effect costs by itself")
    loaded = imported(*([added] for added, _ in alone()))
    singles = [(counted(added, scene), timed(scene), modules)
               for (added, scene), modules in zip(alone(), loaded)]
    tell("effects of zero strength")
    zero = {name: zero_is_absent(name) for name, (_, none) in EXAMPLES.items() if none}
    with style.drawing() as plt:
        drawn = html.picture(*narrow.save_both(picture(plt, steps), folder / PICTURE))
        narrow.save_both(bar(plt, steps), folder / BAR)
    return html.write(
        folder / "effects.html", "effects.html", picture=drawn, many=MANY, machine=caption(),
        words=words(steps, singles, zero),
        ladder=[_row(cost, seconds) for cost, seconds in steps],
        alone=[_row(cost, seconds) | {"modules": ", ".join(modules)} for cost, seconds, modules in singles],
        questions=list(next(iter(zero.values()))), **around,
        zero=[{"name": spoken(name), "same": list(same.values())} for name, same in zero.items()])


def spoken(name: str) -> str:
    """An effect's name as words."""
    return name.replace("_", " ").replace("newtonian", "Newtonian")


def _row(cost, seconds) -> dict:
    return {"added": spoken(cost.added), "states": cost.states, "blocks": ", ".join(cost.blocks),
            "parameters": len(cost.parameters),
            "coefficients": cost.coefficients, "operations": cost.operations, "branches": cost.branches,
            "one": duration(seconds.one), "many": duration(seconds.among_many),
            "step": "" if seconds.taylor_step is None else duration(seconds.taylor_step)}


def words(steps, singles, zero) -> list[str]:
    """What the numbers say, in sentences."""
    (first, quick), (last, slow) = steps[0], steps[-1]
    dearest = max(singles, key=lambda single: single[0].operations)[0]
    lines = [f"The body alone has {first.states} states and {first.operations} operations a rate; all "
             f"{len(steps) - 1} effects together have {last.states} states and {last.operations} operations. "
             f"By itself {spoken(dearest.added)} adds most: {dearest.operations - first.operations} "
             "operations."]
    if quick.taylor_step:
        lines.append(
            f"A Taylor step takes {duration(quick.taylor_step)} for the body alone and "
            f"{duration(slow.taylor_step)} with all effects.")
    free = [spoken(b.added) for (a, _), (b, _) in zip(steps, steps[1:]) if b.operations == a.operations]
    if free:
        lines.append(
            f"Added to what stands before it, {' and '.join(free)} costs no operation: its numbers merge "
            f"into coefficients that are there.")
    failed = [f"{spoken(name)} ({question})" for name, same in zero.items()
              for question, equal in same.items() if not equal]
    lines.append("An effect of zero strength changes no bit of any answer below." if not failed else
                 f"An effect of zero strength is not like an absent one: {', '.join(failed)}.")
    return lines


def picture(plt, steps):
    """States and operations, and the time of a rate, against what was added last."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 4.4), layout="constrained", sharey=True)
    names = [spoken(NOTHING) if cost.added == NOTHING else f"+ {spoken(cost.added)}" for cost, _ in steps]
    places = range(len(steps))
    left.barh([p - 0.19 for p in places], [cost.operations for cost, _ in steps], 0.38, color=style.SKY,
              label="operations in the rates")
    left.barh([p + 0.19 for p in places], [cost.states for cost, _ in steps], 0.38, color=style.ORANGE,
              label="states")
    left.set(yticks=list(places), yticklabels=names, xlabel="number", title="what the equations hold")
    left.invert_yaxis()
    left.legend(loc="upper right")
    series = [("rates of one state, floats", style.BLUE, "o", [s.one for _, s in steps]),
              (f"rates of one of {MANY} states, NumPy", style.GREEN, "s", [s.among_many for _, s in steps])]
    if steps[0][1].taylor_step is not None:
        series.append(("one Taylor step, heyoka", style.VERMILION, "D", [s.taylor_step for _, s in steps]))
    looks = [(label, {"color": colour, "marker": marker, "markersize": 5, "linewidth": 1.3})
             for label, colour, marker, _ in series]
    for (_, look), (*_, values) in zip(looks, series):
        right.plot([v * 1e6 for v in values], places, **look)
    right.set(xscale="log", xlabel="least processor time (microseconds)", title="what they cost")
    right.tick_params(labelleft=False)
    style.legend(figure, looks, columns=3)
    figure.suptitle("Only the effects a scene calls for: one added after the other", fontsize=11)
    return figure


def bar(plt, steps):
    """A bar a step of the ladder: the time of a Taylor step, or without heyoka that of the rates."""
    figure, ax = plt.subplots(figsize=(5.6, 5.0), layout="constrained")
    taylor = steps[0][1].taylor_step is not None
    times = [(seconds.taylor_step if taylor else seconds.one) * 1e6 for _, seconds in steps]
    names = ["body alone" if cost.added == NOTHING else f"+ {spoken(cost.added)}" for cost, _ in steps]
    ax.barh(range(len(steps)), times, 0.7, color=style.SKY)
    for place, microseconds in enumerate(times):
        ax.annotate(f"{microseconds:.3g}", (microseconds, place), (4, 0),
                    textcoords="offset points", va="center", fontsize=9 * style.share())
    ax.set(yticks=range(len(steps)), yticklabels=names, xlim=(0, 1.18 * max(times)),
           xlabel="processor time (microseconds)",
           title="one Taylor step, effect after effect" if taylor else "one evaluation, effect after effect")
    ax.invert_yaxis()
    return figure
