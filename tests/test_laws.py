"""Laws that hold for every scene, over the whole registry of effects, by SymPy and along motions."""
from itertools import combinations

import numpy as np
import pytest
import sympy as sp

from stabilab import Body, Scene, ScaledGyrostat
from stabilab.compiled import to_numpy
from stabilab.effects import REGISTRY, effect_class
from stabilab.equations import derive, invariants

BODY = Body((2000, 1500, "1000.25"))


def example(name, numbers=(3, "-1/7", "2.5")):
    """An effect of the registry with some numbers in it; a new effect with other fields gets its own line here."""
    return effect_class(name)(numbers)


SUBSETS = [names for n in range(len(REGISTRY) + 1) for names in combinations(REGISTRY, n)]
SCENES = [Scene(BODY, *map(example, names)) for names in SUBSETS] + [ScaledGyrostat("0.3", "-2/7", (1, -2, "0.7"))]
IDS = ["+".join(names) or "free" for names in SUBSETS] + ["scaled"]
SPECIAL = [Scene(BODY, *(effect_class(name)(v) for name in REGISTRY)) for v in ((0, 0, 3), (2, 0, 0), (0, 1, 0), (1, 0, 2))] + [
    Scene(Body(D), *(effect_class(name)(v) for name in REGISTRY)) for D in ((2, 2, 1), (2, 2, 2), (1, 2, 2))
    for v in ((0, 0, 3), (1, 1, 0), (1, 2, 3))] + [
    ScaledGyrostat(a, b, mu) for a, b in ((1, 2), (1, 1), (0, 0)) for mu in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 2, 1), (1, 0, -1))]


@pytest.mark.parametrize("scene", SCENES, ids=IDS)
def test_balance_laws_hold_identically(scene):
    """Work and energy, momentum (circle, hyperbola when scaled): in all states and parameters."""
    equations = derive(scene)
    assert len(equations.balances) >= 2
    for law in equations.balances:
        assert sp.expand(equations.derivative(law.quantity) - law.rate) == 0, law.name


@pytest.mark.parametrize("scene", SCENES, ids=IDS)
def test_flow_preserves_volume(scene):
    assert sp.expand(derive(scene).jacobian.trace()) == 0


@pytest.mark.parametrize("scene", SCENES, ids=IDS)
def test_parts_of_the_torque_add_up(scene):
    equations = derive(scene)
    for i in range(3):
        assert sp.expand(equations.inertia[i] * equations.rhs[i] - sum(t[i] for t in equations.torques.values())) == 0


@pytest.mark.parametrize("name", REGISTRY)
def test_effects_that_promise_no_work_do_none(name):
    equations = derive(Scene(BODY, example(name)))
    power = sp.expand(sum(w * t for w, t in zip(equations.state, equations.torques[name])))
    assert (power == 0) or effect_class(name).works
    assert power != 0 or not effect_class(name).works  # the promise is given where it can be


@pytest.mark.parametrize("scene", SPECIAL + SCENES)
def test_every_stated_invariant_is_one(scene):
    """Identically in the state, this scene's numbers put in; turn angles differentiate to the rates they integrate."""
    equations = derive(scene)
    for law in invariants(scene):
        assert sp.expand(equations.numeric(equations.derivative(law.quantity)) - equations.numeric(law.rate)) == 0, law.words


def test_scaled_work_and_energy_is_the_combination_of_its_two_laws():
    equations = derive(SCENES[-1])
    circle, hyperbola, energy = equations.balances
    a, b = equations.symbols["a"], equations.symbols["b"]
    assert sp.expand((b * circle.rate - a * hyperbola.rate) / 2 - energy.rate) == 0
    assert not sp.expand((b * circle.quantity - a * hyperbola.quantity) / 2 - energy.quantity).free_symbols & set(equations.state)


@pytest.mark.parametrize("scene", SCENES, ids=IDS)
def test_compiled_law_rates_are_gradients_along_the_motion(scene):
    """Complex step of the compiled quantity along the compiled rates."""
    system = to_numpy(derive(scene))
    x = np.random.default_rng(8).normal(size=(6, 3))
    moved = system.invariants(x + 1e-200j * system(x))
    for name, rate in system.law_rates(x).items():
        rounding = 1e-14 * system.law_sizes(x)[name].max() * np.abs(system(x)).max()
        assert moved[name].imag / 1e-200 == pytest.approx(rate, abs=rounding)
