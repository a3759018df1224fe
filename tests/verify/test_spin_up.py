"""The checker's own way, normal form and inequality, each against another code; certificates of spin-up that
it proves and leaves open."""
import json
import random
from fractions import Fraction as F
from pathlib import Path

import mpmath
import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, load
from stabilab.answers.certificate import certificate
from stabilab.unreduced.spin_up.centres import FixedCentre
from stabilab.unreduced.spin_up.certificate import Certifier
from stabilab.unreduced.spin_up.form import forms_of
from stabilab.verify import verify
from stabilab.verify.inequality import Inequality
from stabilab.verify.normal_form import form_about
from stabilab.verify.numbers import Rates, above, ball, below, working
from stabilab.verify.spin_up import Lost, Way
from tests.oracles.taylor import integrate
from tests.unreduced.spin_up.scenes import EXAMPLE, random_scene, sphere
from tests.verify.inequality_in_digits import holds
from tests.verify.true_values import DIGITS, number, state_at

STATE = (F(1, 10), F(1), F(2))


def rates_of(scene):
    if scene.variables == "scaled":
        return Rates.of("scaled", *([v] for v in scene.exact_ab), list(scene.exact_mu))
    return Rates.of("physical", *map(list, (scene.body.exact, scene.vector("gyrostat"),
                                            scene.vector("constant_torque"))))


def drawn(rng):
    """A random scene, scaled or not, and its rates."""
    scene = (ScaledGyrostat(F(rng.uniform(-1, 1)), F(rng.uniform(-1, 1)), tuple(map(F, sphere(rng))))
             if rng.random() < .3 else random_scene(rng))
    return scene, rates_of(scene)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("n", range(6))
def test_the_way_holds_the_motion(n):
    rng = random.Random(n)
    _, rates = drawn(rng)
    start, end = [F(v) for v in sphere(rng, rng.choice((.1, 1, 4)))], F(3, 2)
    way = Way(rates, start, 96, 500)
    for t in (end / 3, end):
        state, true = way.to(t), integrate(rates, start, [t])[0]  # a run in 50 digits
        with mpmath.workdps(50):
            for v, x in zip(state, true):
                low, high = (mpmath.mpf(e.numerator) / e.denominator for e in (below(v), above(v)))
                assert low <= x <= high and high - low < 1e-20


def test_a_way_without_enough_bits_gets_lost_or_wide():
    way = Way(rates_of(EXAMPLE), STATE, 20, 2000)
    with pytest.raises(Lost):
        way.to(F(60))


def test_the_worked_example_holds_with_its_printed_constants():
    """off-axis torque D = (1.4, 1, 0.6), M = (0.5, 0.6, 0.62), l = (0.2, 0.1, -0.3): A = 1.193, z = 6.276 and
    a gain of 0.468/1.4 were worked out by hand."""
    rates = rates_of(EXAMPLE)
    with working(128):
        faults, gain = Inequality(form_about(rates, 0, 1),
                                  (0, 2)).faults([ball(F(v)) for v in (6, 1, -1)], F("1.193") / F(0.4**.5),
                                                 F("6.276"))
        assert not faults and gain > ball(F(468, 1400))
        for state, A, z in (((6, 1, -1), F(1), F("6.276")), ((6, 1, -1), F("1.9"), F("6.4")),
                            ((-6, 1, -1), F("1.9"), F(6)), ((2, 1, -1), F("1.9"), F("1.5"))):
            faults, _ = Inequality(form_about(rates, 0, 1), (0, 2)).faults([ball(F(v)) for v in state], A, z)
            assert faults and any(surely for _, surely in faults)


def certified(scene, state):
    made = json.loads(json.dumps(certificate(scene, state)))
    return made, verify(made)


def test_a_start_that_is_trapped_needs_no_way():
    made, found = certified(EXAMPLE, (F(6), F(1), F(-1)))
    assert found.status == "proved" and made["motion"]["spin_up"]["t"] == "0" and made["motion"]["spin_up"][
        "way"] == []


def test_a_motion_that_is_not_decided_has_no_certificate_and_says_why():
    # it lies near the middle axis for long
    made, found = certified(Scene(Body((3, 2, 1)), ConstantTorque((0, 1, F(1, 10**9)))), (0, -1, 0))
    assert made["motion"] is None and "undecided" in made["uncertified"][0] and found.status == "proved"


@pytest.mark.parametrize("name", ["geostationary-22n", "upper-stage"])
def test_a_spacecraft_in_a_frame_that_is_not_principal_is_certified_and_checked(name):
    """Its numbers along principal axes are irrational: the certificate is of their 240 bits, which it states.
    """
    case = load(Path(__file__).parents[2] / "cases" / f"{name}.toml")
    made, found = certified(case.scene, case.exact_state)
    assert found.status == "proved" and made["motion"]["fate"] == "spin-up"


def changed(made, **to):
    return (made | {"equilibria": None, "uncertified": [],
                    "motion": made["motion"] | {"spin_up": made["motion"]["spin_up"] | to}})


def test_a_way_too_long_to_follow_is_not_checked(monkeypatch):
    made, _ = certified(EXAMPLE, STATE)
    monkeypatch.setattr("stabilab.verify.spin_up.MOST_STEPS", 5)
    found = verify(changed(made))
    assert found.status == "partly" and all("not followed beyond 5 steps" in f.reason for f in found.findings)
    monkeypatch.undo()
    far = verify(changed(made, t="1e9", way=[]))
    assert far.status == "partly" and all("at this pace" in f.reason for f in far.findings)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("orders", [(4, 6), (12, 14), (16, 18)])
def test_what_the_test_in_doubles_finds_holds_in_balls(orders):
    """Constants found by the analysis' test, whose rounding is bounded beforehand, put into the checker's
    inequality, in balls."""
    rng, seen = random.Random(50), 0
    while seen < 6:
        scene = random_scene(rng, rng.choice((0, .1, 1)))
        for form in forms_of(scene):
            state = np.array(sphere(rng, 2))
            state[form.axis] = form.sense * rng.choice((3, 6, 12))
            found = Certifier(FixedCentre(form), orders).constants(state)
            if found is None:
                continue
            seen += 1
            with working(128):
                made = Inequality(form_about(rates_of(scene), form.axis, form.sense), orders)
                cone, least, gain = map(F, found[:3])
                faults, true = made.faults([ball(F(v)) for v in state.tolist()], cone / abs(F(form.scale[0])),
                                           least)
                assert not faults and true >= ball(gain / F(form.D1) * (1 - F(1, 10**12)))


# the number, and how many times it is surely too much or too little
EDGES = (("cone", 0), ("cone", 100), ("least", 100), ("gain", 10), ("t", 0))
EDGED = {"trapped from the start": (EXAMPLE, (F(6), F(1), F(-1))), "trapped on the way": (EXAMPLE, STATE),
         "in the other sense": (Scene(Body((3, 2, 1)), Gyrostat((0, 0, "0.1")),
                                      ConstantTorque(("-0.5", "0.2", -1))), (F(-1, 3), F(1), F(-5, 2))),
         "no wheel": (Scene(Body((3, 2, 1)), ConstantTorque(("0.5", "0.2", -1))), (F(1, 3), F(-1), F(1, 2))),
         "scaled": (ScaledGyrostat("0.2", "0.4", (-1, "0.5", "0.75")), (F(-2), F(1), F(1, 2)))}


@pytest.mark.parametrize("name", ["trapped from the start",
                                  pytest.param("trapped on the way", marks=pytest.mark.slow),
                                  *(pytest.param(n, marks=[pytest.mark.slow, pytest.mark.long])
                                    for n in list(EDGED)[2:])])
def test_what_is_accepted_ends_where_the_inequality_does(name):
    """Each number of the claim on its own, halved in to the edge of what is proved: on the one side of it the
    inequality holds, on the other it fails, by 60 digits of another code (`inequality_in_digits`) at the
    state of a run in 55 digits (`true_values`)."""
    made, _ = certified(*EDGED[name])
    said = made["motion"]["spin_up"]
    for key, factor in EDGES:
        good, bad = F(said[key]), F(said[key]) * factor
        if good == bad:
            continue  # trapped at t = 0
        claim = lambda value, key=key: changed(made, **{key: str(value), "way": []})
        assert verify(claim(good)).status == "proved" != verify(claim(bad)).status
        while abs(good - bad) > abs(good) / 10**15:
            middle = (good + bad) / 2
            good, bad = (middle, bad) if verify(claim(middle)).status == "proved" else (good, middle)
        with mpmath.workdps(DIGITS):
            there = [holds(claim(value), state_at(made, number(value if key == "t" else said["t"])))
                     for value in (good, bad)]
        assert there == [True, False], key
