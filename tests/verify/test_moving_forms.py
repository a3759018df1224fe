"""The checker's forms about the moving centre and along the equator: against the rates, against runs in 50
digits, and what the analysis finds in doubles."""
import json
import random
from fractions import Fraction as F

import mpmath
import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.certificate import certificate
from stabilab.unreduced.spin_up.centres import moving_centre
from stabilab.unreduced.spin_up.certificate import Certifier, equatorial
from stabilab.unreduced.spin_up.form import forms_of
from stabilab.verify import verify
from stabilab.verify.inequality import MovingInequality
from stabilab.verify.normal_form import equator, moving_form
from stabilab.verify.numbers import Rates, ball, working
from stabilab.verify.spin_up import FORMS
from tests.oracles.taylor import integrate
from tests.unreduced.spin_up.scenes import random_scene, sphere
from tests.verify.test_forged_certificates import forge_all
from tests.verify.trapped import says_what_happens


def rates_of(scene):
    return Rates.of("physical", *map(list, (scene.body.exact, scene.vector("gyrostat"),
                                            scene.vector("constant_torque"))))


def of_revolution(rng):
    """A body with two equal moments, whichever they are, and a wheel and a torque of any direction."""
    a, b, i = F(rng.uniform(.3, 1)), F(rng.uniform(.05, 1)), rng.randrange(3)
    D = [a + b, a + b, 2 * a]
    return Scene(Body(tuple(D[(n + i) % 3] for n in range(3))), Gyrostat(sphere(rng, rng.choice((.3, 1, 3)))),
                 ConstantTorque(sphere(rng)))


def forms(seed):
    """(rates, form, whether it is that of the equator) of random scenes, without end."""
    rng = random.Random(seed)
    while True:
        scene = of_revolution(rng) if rng.random() < .5 else random_scene(rng, rng.choice((0, 1, 5)))
        rates = rates_of(scene)
        with working(420):
            made = [(equator(rates), True),
                    *((moving_form(rates, axis, rng.choice((-1, 1))), False) for axis in range(3))]
        yield from ((rates, form, round_) for form, round_ in made if form)


def moving_at(form, x):
    """A state at a spin of the form, with the transverse rates beside the centre."""
    x = ball(x)
    P, Q = form.at(x)
    here = [x, (form.N2[0] * x + form.N2[1]) / Q + ball(F(1, 3)),
            (form.N3[0] * x + form.N3[1]) / P - ball(F(1, 5))]
    return [sum((row[n] * v for row, v in zip(form.rows, here)), ball(0)) for n in range(3)]


def test_the_forms_say_what_the_rates_say():
    """The derivative of x and zeta along the rates by differences in 400 bits, against the right sides as
    printed."""
    seen = {True: 0, False: 0}
    for rates, form, round_ in forms(1):
        with working(400):
            state, h = moving_at(form, F(40)), ball(F(1, 2**130))
            fast = rates.at(state)
            (x, zeta), (x1, zeta1), (x0, zeta0) = (form.place([v + s * h * r for v, r in zip(state, fast)])
                                                   for s in (0, 1, -1))
            star = lambda z: type(z)(z.real, -z.imag)
            P, Q = form.at(x)
            terms = lambda table: sum((c * P.root(4) ** -a * Q.root(4) ** -b for (a, b), c in table.items()),
                                      zeta * 0)
            rate = (x1 - x0) / (2 * h)
            assert abs(rate - (terms(form.G).real + form.g * (zeta * zeta).imag
                               + (star(terms(form.k)) * zeta).real)) < 1e-60
            expected = (type(zeta)(0, 1) * (P * Q).sqrt() * zeta
                        + rate * (form.r / (P * Q) * star(zeta) + terms(form.f)))
            assert abs((zeta1 - zeta0) / (2 * h) - expected) < 1e-60
        seen[round_] += 1
        if min(seen.values()) >= 6:
            break


@pytest.mark.parametrize("orders", [(0, 1), (2, 4)])
def test_corrected_energy_and_amplitude_change_at_the_rates_that_are_written_down(orders):
    """Differences along a run in 50 digits against the ledger: the mean drift that is left out of the
    amplitude's does vanish."""
    kinds, h = set(), F(1, 10**9)
    for rates, form, round_ in forms(2):
        if not form.M > 0 or (round_, form.quotient is None) in kinds:
            continue
        kinds.add((round_, form.quotient is None))
        with working(200):
            made = MovingInequality(form, orders)
            start = [F(float(v.mid())) for v in moving_at(form, F(40))]
            states = [start, *integrate(rates, start, [h, 2 * h])]
            states = [[ball(v if isinstance(v, F) else F(*mpmath.libmp.to_rational(v._mpf_))) for v in state]
                      for state in states]

            def values(state):
                x, zeta = form.place(state)
                P, Q = form.at(x)
                value = lambda terms: made._value(terms, x, zeta)
                size = (zeta.real**2 + zeta.imag**2) * value(made.G) / form.M
                sums = (value(made.energy.added), size + value(made.amplitude.added), value(made.energy.left),
                        value(made.amplitude.left))
                return *sums, x, (P * Q).sqrt(), value(made.G)
            before, middle, after = map(values, states)
            turned = (after[4] - before[4]) * middle[5]  # D int Om dx, to second order in h
            assert abs((after[0] - before[0] + turned) / (2 * ball(h)) - middle[5] * middle[6]
                       - middle[2]) < 1e-13
            assert abs((after[1] - before[1]) / (2 * ball(h)) - middle[3]) < 1e-13
        if len(kinds) == 3:
            break


def found_by(scene, field, state, orders):
    """(about, axis, sense, cone, least, gain) that the analysis' test in doubles finds for a state; None
    where it does not hold."""
    found = Certifier(field, orders).constants(state)
    if found is None:
        return None
    cone, least, gain = map(F, found[:3])
    about, axis, sense = ("equator", 0,
                          1) if field.axis is None else ("moving centre", field.axis + 1, field.sense)
    return about, axis, sense, cone / F(float(np.sqrt(np.prod(field.roots)))), least, gain / F(field.D1) * (
        1 - F(1, 10**9))


def held(rng, orders):
    """A random scene and state in the reach of the test, and what it finds there."""
    while True:
        scene = of_revolution(rng) if rng.random() < .6 else random_scene(rng, rng.choice((.1, 1, 10)))
        fields = [field for field in (equatorial(scene),
                                      *(moving_centre(form, scene) for form in forms_of(scene))) if field]
        for field in fields:
            state = np.round(np.array(sphere(rng, 1)) + field.basis[0] * rng.choice((3, 10, 40)), 3)
            if found := found_by(scene, field, state, orders):
                return scene, state, found


@pytest.mark.one_in(2)
@pytest.mark.parametrize("orders", [(1, 2), (2, 4), (4, 6)])
def test_what_the_test_in_doubles_finds_holds_in_balls(orders):
    """Cone, least spin and gain, put into the checker's inequality, whose terms come from the rates alone."""
    rng, seen = random.Random(50), {"equator": 0, "moving centre": 0}
    while min(seen.values()) < 3:
        scene, state, (about, axis, sense, cone, least, gain) = held(rng, orders)
        seen[about] += 1
        make, inequality = FORMS[about]
        with working(128):
            faults, true = inequality(make(rates_of(scene), axis - 1, sense),
                                      orders).faults([ball(F(v)) for v in state.tolist()], cone, least)
            assert not faults and true >= ball(gain)


def a_certificate(seed, about, orders=(2, 4)):
    """A certificate of a start in the trap about a form, with one place on the way."""
    rng = random.Random(seed)
    while True:
        scene, state, (found, axis, sense, cone, least, gain) = held(rng, orders)
        if found == about:
            break
    made = json.loads(json.dumps(certificate(scene, [F(str(v)) for v in state.tolist()])))
    t = F(1, 64)
    (place,) = integrate(rates_of(scene), [F(str(v)) for v in state.tolist()], [t])
    box = [[str(F(*mpmath.libmp.to_rational(v._mpf_)) + s * F(1, 10**12)) for s in (-1, 1)] for v in place]
    said = {"about": about, "axis": axis, "sense": sense, "orders": list(orders), "t": "0", "cone": str(cone),
            "least": str(least), "gain": str(gain),
            "way": [{"t": str(t), "box": box}]}
    return made | {"equilibria": None, "uncertified": [],
                   "motion": {"state": [str(F(str(v))) for v in state.tolist()], "fate": "spin-up",
                              "axis": axis, "sense": sense, "spin_up": said}}


@pytest.mark.one_in(2)
@pytest.mark.parametrize("about", ["moving centre", "equator"])
@pytest.mark.parametrize("count, least", [(1, 200), pytest.param(8, 1000, marks=pytest.mark.slow)])
def test_what_a_machine_forges_of_a_spin_up_is_never_proved(about, count, least):
    """`tests.verify.forge` says what is known of each change; SciPy judges those that are proved and say
    something of their own."""
    claims = a_certificate(8, about)
    assert verify(claims).status == "proved" and says_what_happens(claims)
    made, wrong = forge_all(claims, about, count, paths=5 if count == 1 else None)
    assert made > least and not wrong, wrong[:3]


@pytest.mark.parametrize("paths, least", [(20, 1000), pytest.param(None, 6000, marks=pytest.mark.slow)])
def test_what_a_machine_forges_of_a_second_fate_and_its_way_is_never_proved(paths, least):
    """As the program writes it, with an enclosed way into the equator (`tests.verify.forge` and SciPy judge).
    """
    scene = Scene(Body(("1.3", "1.3", "0.7")), Gyrostat(("0.9", "-0.4", "0.2")),
                  ConstantTorque(("0.25", "-0.3", "0.1")))
    claims = (json.loads(json.dumps(certificate(scene, [F("0.1"), F("0.2"), F("0.05")])))
              | {"equilibria": None, "uncertified": []})
    said = claims["motion"]["spin_up"]
    assert said["about"] == "equator" and F(said["t"]) > 1 and said["way"]
    assert verify(claims).status == "proved" and says_what_happens(claims)
    made, wrong = forge_all(claims, "equator", 1, paths)
    assert made > least and not wrong, wrong[:3]


@pytest.mark.parametrize("count", [6, pytest.param(40, marks=pytest.mark.slow),
                                   pytest.param(150, marks=[pytest.mark.slow, pytest.mark.long])])
def test_certificates_of_random_motions_are_checked(count):
    """Each is proved or says why there is none; SciPy agrees with what is proved."""
    rng, seen = random.Random(6), []
    for n in range(count):
        scene = of_revolution(rng) if n % 2 else random_scene(rng, rng.choice((0, .1, 3)))
        state = [F(v) for v in sphere(rng, rng.choice((.3, 3)))]
        made = json.loads(json.dumps(certificate(scene, state)))
        if not made["motion"]:
            assert made["uncertified"]
            continue
        if F(made["motion"]["spin_up"]["t"]) > 30:
            continue  # its check takes long
        seen.append(made["motion"]["spin_up"]["about"])
        found = verify(made | {"equilibria": None})
        assert found.status == "proved" and any("trap at t" in one.claim for one in found.findings)
        assert says_what_happens(made)
    assert {"equator", "fixed centre"} <= set(seen)
