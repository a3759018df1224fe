"""Certificates of closed solutions: no torque, spheres, bodies of revolution. Against runs of SciPy, and
against forgeries made by machine."""
from __future__ import annotations

import copy
import random
from fractions import Fraction as F

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from stabilab.verify import verify
from stabilab.verify.numbers import Malformed
from tests.oracles.rigid import euler
from tests.shared import written

KINDS = {  # moments, wheel, torque, state; fate, axis, sense: by hand
    "free with three wheels": ((9, 8, 4), ("0.3", "0.2", "-0.5"), (0, 0, 0), ("0.4", "0.7", "0.3"), "bounded",
                               0, 0),
    "sphere": ((4, 4, 4), (0, 0, 0), ("0.1", "-0.2", "0.3"), ("0.4", "0.7", "0.3"), "spin-up", 0, 1),
    "sphere, torque on an axis": ((4, 4, 4), (0, "0.3", "0.2"), (0, 0, "-0.5"), ("0.4", "0.7", "0.3"),
                                  "spin-up", 0, 1),
    "sphere, wheel across": ((4, 4, 4), ("0.3", "0.3", 0), ("0.1", "-0.1", "0.3"), ("0.4", "0.7", "0.3"),
                             "bounded", 0, 0),
    "sphere, wheel on an axis": ((4, 4, 4), (0, "0.3", 0), ("0.1", "-0.1", "0.3"), ("0.4", "0.7", "0.3"),
                                 "spin-up", 2, -1),
    "rod": ((5, 5, 2), (0, 0, 0), ("0.1", "-0.2", "-0.3"), ("0.4", "0.7", "0.3"), "spin-up", 3, -1),
    "disc with a wheel": ((7, 4, 4), ("0.9", 0, 0), ("0.1", "-0.2", "0.3"), ("-0.4", "0.7", "0.3"), "spin-up",
                          1, 1),
    "rod, torque across": ((5, 5, 2), (0, 0, "0.3"), ("0.1", "-0.2", 0), ("0.4", "0.7", "0.3"), "bounded", 0,
                           0),
    "rod that does not turn": ((5, 5, 2), (0, 0, "0.9"), ("0.1", "-0.2", 0), ("0.4", "0.7", "0.3"), "spin-up",
                               0, 1),
}


def made(kind):
    """(scene, state, its certificate)."""
    D, l, M, state = KINDS[kind][:4]
    scene = stabilab.Scene(stabilab.Body(D), stabilab.Gyrostat(l), stabilab.ConstantTorque(M))
    return scene, state, written(scene, tuple(map(F, state)))


@pytest.mark.parametrize("kind", KINDS)
def test_a_closed_solution_is_certified_and_proved_anew(kind):
    *_, found = made(kind)
    motion = found["motion"]
    assert (motion["fate"], motion["axis"], motion["sense"]) == KINDS[kind][4:] and found["uncertified"] == []
    assert verify(found).status == "proved"


@pytest.mark.one_in(3)
@pytest.mark.parametrize("kind", KINDS)
def test_a_run_keeps_what_the_closed_solution_says(kind):
    """DOP853 on Euler's equations: growth along the direction, sizes below the bound."""
    D, l, M, state = (np.array(list(map(F, v)), float) for v in KINDS[kind][:4])
    closed = made(kind)[2]["motion"]["closed"]
    run = solve_ivp(euler(D, l, M), (0, 150), state, "DOP853", rtol=1e-10,
                    atol=1e-12).y.T
    most = float(F(closed["most"]))
    if closed["direction"] is None:
        assert np.linalg.norm(run, axis=1).max() < most * (1 + 1e-7)
        return
    along = np.array(list(map(F, closed["direction"])), float)
    along /= np.linalg.norm(along)
    spin = run @ along
    assert spin[-1] - spin[0] >= 150 * float(F(closed["gain"])) * (1 - 1e-7) > 0
    assert np.linalg.norm(run - spin[:, None] * along, axis=1).max() < most * (1 + 1e-7)


def forgeries(found, rng):
    """(certificate, name of what is false in it) without end: each says something that is not so, or has no
    form."""
    state = [F(v) for v in found["motion"]["state"]]
    while True:
        out = copy.deepcopy(found)
        motion, closed = out["motion"], out["motion"]["closed"]
        name = rng.choice(("fate", "axis", "sense", "law", "direction", "gain", "most", "scene", "junk"))
        little = F(rng.randrange(1, 1000), 10 ** rng.randrange(3, 12))
        if name == "fate":
            motion["fate"] = rng.choice([w for w in ("bounded", "spin-up", "equilibrium", "separatrix")
                                         if w != motion["fate"]])
        elif name in ("axis", "sense"):
            motion[name] = rng.choice([n for n in ((0, 1, 2, 3) if name == "axis" else (-1, 0, 1))
                                       if n != motion[name]])
        elif name == "law":
            closed["law"] = rng.choice([w for w in ("free", "sphere", "axis of symmetry", "symmetry")
                                        if w != closed["law"]])
        elif name == "direction":
            vector = [F(v) for v in closed["direction"] or ("1", "0", "0")]
            n = rng.randrange(3)
            other = [v + little * rng.choice((-1, 1)) * (m == n) for m, v in enumerate(vector)]
            if closed["direction"] and not any(vector[m] for m in range(3) if m != n):
                other = [-v for v in vector]  # along one axis a change there leaves the direction as it is
            closed["direction"] = list(map(str, rng.choice([other, [-v for v in vector]])
                                           if closed["direction"] else vector))
        elif name == "gain":
            closed["gain"] = str(F(closed["gain"] or 1)
                                 * rng.choice((1 + 2 * F(1, 10**9) + little, -1, 0, -little)))
        elif name == "most":  # below what the start itself has
            along = [F(v) for v in closed["direction"]] if closed["direction"] else None
            size = (sum(v * v for v in state)
                    - (sum(a * b for a, b in zip(state, along)) ** 2 / sum(a * a for a in along) if along
                       else 0))
            closed["most"] = str(F(float(size) ** 0.5) * rng.choice((1 - little / 2, -1, F(1, 2))))
        elif name == "scene":  # none of these has a closed solution of this law from this state
            n = rng.randrange(3)
            if closed["law"] == "free":
                out["scene"]["torque"][n] = str(little)
            else:
                out["scene"]["inertia"] = [str(F(v) + little * (m + 1)) for m,
                                           v in enumerate(out["scene"]["inertia"])]
        else:
            key = rng.choice(("law", "direction", "gain", "most"))
            closed[key] = rng.choice((True, 5, 1.5, [], {}, [["1"]], "x", "1/0", "nan", ["1", "2"],
                                      ["1", "2", "x"], "\u0661", "1e99999"))
        yield out, name


@pytest.mark.one_in(3)
@pytest.mark.parametrize("kind", KINDS)
def test_no_forged_closed_solution_passes(kind):
    found, rng, seen = made(kind)[2], random.Random(kind), set()
    source = forgeries(found, rng)
    for _ in range(200):
        out, name = next(source)
        out["equilibria"] = None  # it is the motion that is forged
        try:
            status = verify(out).status
        except Malformed:
            status = "malformed"
        assert status != "proved", (name, out["motion"], out["scene"])
        seen.add((name, status))
    assert {name for name, _ in seen} == {"fate", "axis", "sense", "law", "direction", "gain", "most",
                                          "scene", "junk"}


def test_a_state_that_rests_is_told_by_no_closed_solution():
    found = written(stabilab.Scene(stabilab.Body((4, 4, 4))), (F(1), F(2), F(3)))
    assert "closed" not in found["motion"] and verify(found).status == "proved"
    found["motion"]["closed"] = {"law": "free", "direction": None, "gain": None, "most": "9"}
    assert verify(found).status == "refuted"
