"""Random scenes, half of them degenerate: no equilibrium missed or invented, no wrong verdict, what is not
proved is counted; and wild ones, whose fates, extremes and periods are the same by every way to them."""
import collections
import json
import os
import time
from fractions import Fraction
from importlib.util import find_spec

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, equilibria
from stabilab.answers.certificate import certificate
from stabilab.verify import verify
from tests.hunt.wild import disagreements as wild_disagreements
from tests.hunt.wild import tidy_scene, tidy_state, wild_scene, wild_state
from tests.oracles import elimination as by_hand


def small(rng):
    """A small rational: degenerate scenes (equal moments, aligned vectors, folds) come up often."""
    return Fraction(int(rng.integers(-3, 4)), int(rng.choice([1, 2, 4])))


def generic(rng):
    """A double of no special form."""
    return Fraction(float(rng.normal()))


def random_scene(rng, degenerate):
    """(the scene, the oracle's arguments): small rationals, or doubles over six decades; zero components in
    both."""
    pick = small if degenerate else generic
    size = Fraction(1) if degenerate else Fraction(float(10 ** rng.uniform(-3, 3)))
    if rng.random() < 0.3:
        a, b, mu = pick(rng), pick(rng), [pick(rng) * size if rng.random() < 0.8 else Fraction(0)
                                          for _ in range(3)]
        # the two isolated equilibria in one (c^2 + 4 mu2 mu3/mu1 = 0, by hand)
        if degenerate and a != b and rng.random() < 0.1:
            mu[0] = -4 * mu[1] * mu[2] / (b - a) ** 2
        return ScaledGyrostat(a, b, mu), (by_hand.of_scaled, (a, b, mu))
    D = ([Fraction(int(v)) for v in rng.integers(2, 5, 3)] if degenerate
         else [Fraction(float(v)) for v in rng.uniform(1, 2, 3)])
    lam, M = ([pick(rng) if rng.random() < 0.6 else Fraction(0) for _ in range(3)] for _ in range(2))
    lam = [v * size for v in lam]
    if degenerate and rng.random() < 0.05:
        lam = whole_line(rng, D, M) or lam
    return Scene(Body(D), Gyrostat(lam), ConstantTorque(M)), (by_hand.of_body, (D, lam, M))


def whole_line(rng, D, M):
    """The gyrostatic moment with which an oblique torque has a whole line of equilibria along an axis v:
    lambda = (D_v - D) y0 + l v, M = l y0 x v (by hand: then D y + lambda = D_v y + l v for y = y0 + t v)."""
    v = int(rng.integers(3))
    j, k = (v + 1) % 3, (v + 2) % 3
    M[v] = Fraction(0)
    if not (M[j] or M[k]):
        return None
    l = small(rng) or Fraction(1)
    y0 = [Fraction(0)] * 3
    y0[k], y0[j] = M[j] / l, -M[k] / l  # M_j = l y0_k, M_k = -l y0_j
    lam = [(D[v] - D[i]) * y0[i] for i in range(3)]
    lam[v] = l
    return lam


def numbers(row):
    return [Fraction(v) for v in row]


def disagreements(claims, model, answer) -> list[str]:
    """A certificate's equilibria against the elimination: kind, counts, places, and the words by the signs of
    m and n."""
    points, curves, planes = claims["points"], claims["curves"], claims["planes"]
    said = claims["kind"], len(points), len(curves), len(planes)
    true = answer.kind, len(answer.roots), answer.curves, answer.planes
    if said != true:
        return [f"kind and counts: {said} for {true}"]
    wrong = []
    for root, start, v in answer.roots:
        m, n = (root.sign_of(p) for p in by_hand.m_and_n_on_line(model, start, v))
        here = [p for p in points if all(within(root, c, d, numbers(ends)) for c, d,
                                         ends in zip(start, v, p["box"]))]
        word = "unstable" if n or m < 0 else "stable" if m else "degenerate"
        if len(here) != 1 or here[0]["linear"] != word or here[0]["verdict"] != "unstable":
            wrong.append(f"point: {here} for {word}")
    rows = [([numbers(p) for p in c["numerators"]], numbers(c["denominator"])) for c in curves]
    for x in answer.samples:
        if any(model.rate(x)) or not (any(by_hand.on_curve(x, *row) for row in rows)
                                      or any(in_plane(p, x) for p in planes)):
            wrong.append(f"missed: {x}")
    for c, row in zip(curves, rows):
        wrong += [w for s in c["segments"] for w in piece_disagrees(s, model, *row)]
    return wrong


def within(root, c, d, ends) -> bool:
    """Whether c + d t lies in a bracket at the root t."""
    if not d:
        return ends[0] <= c <= ends[1]
    first, last = (root.versus((e - c) / d) for e in (ends if d > 0 else ends[::-1]))
    return first >= 0 >= last


def in_plane(plane, x) -> bool:
    (a, b, c), (d, e, f) = (numbers(v) for v in plane["directions"])
    normal = (b * f - c * e, c * d - a * f, a * e - b * d)
    return sum(n * (v - o) for n, v, o in zip(normal, x, numbers(plane["base"]))) == 0


def piece_disagrees(piece, model, tops, bottom):
    """At three places of a piece: at rest, n = 0, and m < 0 unstable, m > 0 a centre. A piece whose ends'
    brackets overlap names no place for sure."""
    low, high = (None if end is None else numbers(end) for end in piece["t"])
    if low and high and not low[1] < high[0]:
        return
    steps = [Fraction(2)**k for k in (-8, 0, 8)]
    shares = [Fraction(n, 7) for n in (1, 3, 6)]
    places = ([low[1] + (high[0] - low[1]) * f for f in shares] if low and high
              else [low[1] + s for s in steps] if low else
              [high[0] - s for s in steps] if high else [Fraction(k) for k in (-5, 0, 5)])
    for t in places:
        below = by_hand.value(bottom, t)
        x = [by_hand.value(top, t) / below for top in tops]
        m, n = by_hand.m_and_n(model, x)
        linear, verdict = piece["linear"], piece["verdict"]
        if any(model.rate(x)) or n or linear != ("unstable" if m < 0
                                                 else "stable") or (m < 0 and verdict != "unstable"):
            yield (
                f"piece at t = {float(t)}: rates {model.rate(x)}, m = {m}, n = {n}, said {linear}, {verdict}")


def examined(count, seed, degenerate, answers=True):
    """Counts over random scenes; asserts that nothing is refuted and that elimination agrees."""
    rng = np.random.default_rng(seed)
    tally = collections.Counter()
    for _ in range(count):
        scene, (oracle, arguments) = random_scene(rng, degenerate)
        begin = time.process_time()
        claims = certificate(scene)
        made = time.process_time()
        found = verify(json.loads(json.dumps(claims)))
        tally["making s"] += made - begin
        tally["checking s"] += time.process_time() - made
        assert found.status != "refuted", (scene, [f for f in found.findings if f.status == "refuted"])
        model, answer = oracle(*arguments)
        wrong = disagreements(claims["equilibria"], model, answer)
        assert not wrong, (scene, wrong)
        if answers:
            same_answer(equilibria(scene), claims["equilibria"])
        tally["scenes"] += 1
        tally["entries"] += sum(len(claims["equilibria"][part]) for part in ("points", "curves", "planes"))
        tally["kind " + answer.kind + " planes" * bool(answer.planes)] += 1
        open_ones = {f.reason for f in found.findings if f.status != "proved"}
        tally["undecided"] += bool(open_ones)
        for reason in open_ones:
            tally["undecided: " + reason] += 1
    return tally


def same_answer(found, claims):
    """The answer in doubles has the certificate's counts, places and words."""
    assert found.kind == claims["kind"]
    assert len(found.points) == len(claims["points"]) and len(found.curves) == len(claims["curves"]) + len(
        claims["planes"])
    for p in found.points:
        assert any((p.linear, p.verdict) == (c["linear"], c["verdict"])
                   and all(map(rounded_into, p.at, map(numbers, c["box"])))
                   for c in claims["points"]), p


def rounded_into(double, ends) -> bool:
    """Whether the bracket holds a number that rounds to the double, or its neighbour."""
    value, room = Fraction(double), abs(Fraction(double)) / 2**52
    return ends[0] - room <= value <= ends[1] + room


def test_the_elimination_sees_what_is_missed_or_wrong():
    rng, seen = np.random.default_rng(3), collections.Counter()
    symmetric = (2, 2, 1), (0, 0, 1), (0, 0, 0)  # has a plane
    scenes = [(Scene(Body(symmetric[0]), Gyrostat(symmetric[1])), (by_hand.of_body, symmetric))]
    for scene, (oracle, arguments) in [*scenes, *(random_scene(rng, True) for _ in range(100))]:
        model, answer = oracle(*arguments)
        claims = certificate(scene)["equilibria"]
        assert not disagreements(claims, model, answer)
        for part in ("points", "curves", "planes"):
            if claims[part]:
                seen[part] += 1
                assert disagreements(claims | {part: claims[part][1:]}, model, answer)
        if claims["points"]:
            assert disagreements(claims | {"points": [p | {"verdict": "stable"} for p in claims["points"]]},
                                 model, answer)
        if claims["curves"]:
            turn = {"stable": "unstable", "unstable": "stable"}
            turned = [c | {"segments": [s | {"linear": turn[s["linear"]]} for s in c["segments"]]}
                      for c in claims["curves"]]
            assert disagreements(claims | {"curves": turned}, model, answer)
    assert min(seen[part] for part in ("points", "curves", "planes")) > 0, seen


@pytest.mark.one_in(2)
@pytest.mark.parametrize("degenerate", [False, True], ids=["generic", "degenerate"])
@pytest.mark.parametrize("count, seed", [(150, 1), pytest.param(1000, 2, marks=pytest.mark.slow)])
def test_no_verdict_is_wrong_and_no_equilibrium_missed_or_invented(degenerate, count, seed):
    # exact rational elimination in Fractions (tests/oracles/elimination.py) and the separate checker; nothing
    # is left undecided
    tally = examined(count, [seed, degenerate], degenerate)
    assert tally["scenes"] == count and tally["undecided"] == 0, tally


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("degenerate", [False, True], ids=["generic", "degenerate"])
@pytest.mark.parametrize("piece", range(20))
def test_a_hundred_thousand_scenes(piece, degenerate, capsys):
    count = int(os.environ.get("STABILAB_SCENES", 2500))
    tally = examined(count, [100 + piece, degenerate], degenerate, answers=False)
    with capsys.disabled():
        print(f"\n{'degenerate' if degenerate else 'generic'} {piece}: {dict(tally)}")
    assert tally["undecided"] <= (0.01 if degenerate else 0.001) * count, tally


def one_wild_scene(seed, number, states, digits, scene_of=wild_scene, state_of=wild_state):
    """What is said otherwise by two ways in a scene that (seed, number) repeats: [] where all agree."""
    rng = np.random.default_rng([seed, number])
    scene = scene_of(rng)
    rows = [state_of(rng, scene) for _ in range(states)]
    try:
        found = list(wild_disagreements(scene, rows, WAYS, digits))
    except Exception as error:
        found = [([[v.hex() for v in row] for row in rows], repr(error))]
    return [(seed, number, scene, *one) for one in found]


WAYS = (False,) if find_spec("numba") is None else (False, True)  # NumPy, and compiled


@pytest.mark.parametrize("scenes", [(3, 4), pytest.param([0, 1, 2, *range(5, 15)], marks=pytest.mark.slow),
                                    pytest.param(range(15, 100), marks=[pytest.mark.slow, pytest.mark.long])],
                         ids=["two", "thirteen", "the others of a hundred"])
def test_wild_scenes_have_one_answer_by_every_way_to_it(scenes):
    """One state, arrays (NumPy and compiled) and thirty digits, each within what it promises."""
    found = [wrong for n in scenes for wrong in one_wild_scene(1, n, 1, n % 50 == 4)]
    assert not found, f"{len(found)}, the first: {found[0]}"


@pytest.mark.slow
@pytest.mark.parametrize("scenes", [
    [*range(20), 95, 104, 114, 122, 1145], range(20, 120),
    pytest.param(range(120, 1500), marks=pytest.mark.long)],
                         ids=["twenty and what once failed", "to 120", "the others"])
def test_scenes_of_small_numbers_have_one_answer_by_every_way_to_it(scenes):
    """Turning points, centres and places at rest are doubles there: roots whose balls have no width, and
    wells without depth."""
    found = [wrong for n in scenes
             for wrong in one_wild_scene(3, n, 3, n // 4 + 1 if n % 4 == 1 else 0, tidy_scene,
                                         tidy_state)]
    assert not found, f"{len(found)}, the first ten: {found[:10]}"


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("piece", range(20))
def test_ten_thousand_wild_scenes_have_one_answer_by_every_way_to_it(piece):
    count = int(os.environ.get("STABILAB_SCENES", 500))
    found = [wrong for n in range(count)
             for wrong in one_wild_scene(100 + piece, n, 3, n // 10 + 1 if n % 10 == 1 else 0)]
    assert not found, f"{len(found)}, the first ten: {found[:10]}"
