"""Forged certificates: each claim of a proved one changed in turn is refuted, or left unproved, or refused;
never proved."""
import copy
import itertools
import json
import math
import random
import subprocess
import sys
from fractions import Fraction as F
from functools import cache, lru_cache
from pathlib import Path
from types import SimpleNamespace

import pytest

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, load
from stabilab.answers.certificate import certificate
from stabilab.errors import InputError
from stabilab.show import certification
from stabilab.verify import verify, verify_file
from stabilab.verify.numbers import Malformed
from tests.equilibrium.test_random_scenes import disagreements
from tests.oracles import elimination as by_hand
from tests.verify import forge
from tests.verify.trapped import says_what_happens
from tests.verify.true_values import TrueValues


def physical(D, lam=(0, 0, 0), M=(0, 0, 0)):
    return Scene(Body(D), Gyrostat(lam), ConstantTorque(M))


SCENES = {
    "two points": ScaledGyrostat(0, 0, (1, 2, 1)), "a double root": ScaledGyrostat(0, 2, (-3, 3, 1)),
    "a triple zero eigenvalue": ScaledGyrostat(0, 2, (F(-15, 16), F(5, 4), F(3, 4))),
    "a hyperbola": ScaledGyrostat("0.2", "0.4", (0, 0, 1)),
    "crossing lines, a minimum": physical((5, 4, 5), (2, 3, 0), (0, 0, -6)),
    "crossing lines, no minimum": physical((3, 4, 5), (2, 3, 0), (0, 0, 6)),
    "a single line": physical((1, 2, 2), (0, 1, 1), (1, 0, 0)),
    "a torque oblique among equal moments": physical((2, 2, 1), (1, -1, 1), (1, 1, 0)),
    "an oblique line that is left slowly": physical((4, 3, 2), (1, 5, 14), (0, 7, -5)),
    "an oblique line of a symmetric body": physical((2, 2, 1), (1, 0, 1), (0, 1, 1)),
    "a free gyrostat": physical((5, 4, 2), (0, 2, 3)),
    "a free gyrostat, one wheel": physical((5, 4, 2), (0, 2, 0)),
    "free, three axes": physical((5, 4, 2)), "a plane": physical((2, 2, 1), (0, 0, 1)),
    "a plane through rest": physical((1, 2, 2)),
    "free, scaled": ScaledGyrostat(1, 2, (0, 0, 0)),
    "free, scaled, no wheel": ScaledGyrostat(1, 1, (0, 0, 0)),
    "none, contradictory": physical((3, 2, 1), (1, 0, 0), (1, 0, 0)),
    "none, a constant": physical((3, 2, 2), (0, 0, 0), (1, 0, 0)),
    "none, no real root": ScaledGyrostat(0, 0, (-1, 1, 1)), "all": physical((2, 2, 2))}


def proved(scene, state=None):
    """The certificate of a scene as read from its file; proved."""
    return json.loads(_text_of(scene, state))


@cache
def _text_of(scene, state):
    """Made and proved once for all tests, each of which reads, and changes, its own."""
    text = json.dumps(certificate(scene, state))
    found = verify(json.loads(text))
    assert found.status == "proved", found.findings
    return text


def status_of(claims):
    try:
        return verify(claims).status
    except Malformed:
        return "refused"


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name", SCENES)
def test_equilibria_that_are_not_there_are_refuted(name):
    claims = proved(SCENES[name])
    others = {"points": {"box": [["3", "3"], ["5", "5"], ["7", "7"]], "linear": "unstable",
                         "verdict": "unstable"},
              "curves": {"numerators": [["3", "1"], ["5"], ["7"]], "denominator": ["1"], "segments": [],
                         "folds": []},
              "planes": {"base": ["3", "5", "7"], "directions": [["1", "0", "0"], ["0", "1", "1"]],
                         "linear": "degenerate", "verdict": "unstable",
                         "centre": {"at": ["3", "5", "7"], "verdict": "stable"}}}
    for part, entry in others.items():
        forged = copy.deepcopy(claims)
        forged["equilibria"][part].append(entry)
        assert status_of(forged) == "refuted" or claims["equilibria"]["kind"] == "all", part


CASES = Path(__file__).parents[2] / "cases"


def case_proved(name):
    case = load(CASES / f"{name}.toml")
    return proved(case.scene, case.exact_state)


@pytest.mark.parametrize("change", [{"extremes": [[["5", "6"], ["5", "6"]]] * 3}, {"period": ["1", "2"]},
                                    {"axis": 3}, {"sense": -1}, {"fate": "bounded"},
                                    {"extremes": [[None, None]] * 3}], ids=str)
def test_false_numbers_beside_an_equilibrium_are_refuted(change):
    claims = case_proved("off-axis-fold")
    assert claims["motion"]["fate"] == "equilibrium"
    assert status_of(claims | {"motion": claims["motion"] | change}) == "refuted"


def test_an_equilibrium_is_its_own_extremes():
    claims = case_proved("off-axis-fold")
    claims["motion"]["extremes"] = [[[x, x], [x, x]] for x in claims["motion"]["state"]]
    assert status_of(claims) == "proved"


def test_a_fate_left_open_still_has_its_numbers_checked():
    claims = case_proved("minor-axis-100")
    claims["motion"]["fate"] = "undecided"
    assert status_of(claims) == "partly"
    claims["motion"]["period"] = [str(2 * F(end)) for end in claims["motion"]["period"]]
    assert status_of(claims) == "refuted"


MOTIONS = {
    "bounded in a well": (ScaledGyrostat("0.2", "0.4", (0, 0, 1)), (3, F(-3, 2), F(3, 10))),
    "spin-up": (ScaledGyrostat("0.2", "0.4", (0, 0, 1)), (1, 1, 1)),
    "spin-up after turning": (ScaledGyrostat(0, 0, (0, 0, 1)), (1, 1, -3)),
    "free, round": (physical((3, 2, 1), (0, 1, 0)), (1, 1, 3)),
    "free, in a well": (physical((3, 2, 1), (1, 0, 0)), (3, 1, 1)),
    "free, steady rate": (physical((3, 3, 1)), (1, 1, 1)),
    "on a hyperbola": (ScaledGyrostat("0.5", 1, (0, 1, 0)), (1, -1, 2)),
    "on a decaying plane": (ScaledGyrostat("0.5", 1, (0, 1, 0)), (F(1, 2), -1, F(-3, 2))),
    # force that vanishes to third order on the circle at (0, -1), and to second at (1, 2): there F = x2 (x1 +
    # 3) - 8 and F' = x2^2 - x1 (x1 + 3) do
    "past a cusp": (physical((3, 1, 2), (-1, 0, 0)), (0, 1, 0)),
    "past a fold": (ScaledGyrostat(0, 3, (0, 0, -8)), (2, 1, F(3, 2))),
    "held past a fold": (ScaledGyrostat(0, 3, (0, 0, -8)), (2, 1, F(1, 10))),
    "pure spin": (physical((3, 2, 1), (0, 0, 0), (0, 1, 0)), (0, 1, 0)),
    "on a parabola": (physical((2, 2, 1), (0, 1, 1), (1, 0, 0)), (1, 1, 2)),
    "released at rest": (ScaledGyrostat("0.2", "0.4", (0, 0, 1)), (3, F(-3, 2), 0)),
    "released, free": (physical((3, 2, 1), (1, 0, 0)), (0, 1, 3)),
    "released to spin": (ScaledGyrostat(0, 0, (0, 0, 1)), (F(1, 2), F(1, 2), 0)),
    "released on a plane": (ScaledGyrostat("0.5", 1, (0, 1, 0)), (F(1, 2), 0, F(-3, 2))),
    "at rest": (ScaledGyrostat(0, 0, (0, 0, 1)), (-3, F(1, 3), 0)),
    "torque in no axis": (physical((F(7, 5), 1, F(3, 5)), (F(1, 5), F(1, 10), F(-3, 10)),
                                   (F(1, 2), F(3, 5), F(31, 50))), (F(1, 10), 1, 2)),
    "torque in no axis, scaled": (ScaledGyrostat("0.2", "0.4", (-1, "0.5", "0.75")), (-2, 1, F(1, 2)))}


# -- by machine: tests/verify/forge.py says what is known of each change without the checker,
# tests/verify/true_values.py whether a narrowed
# bracket holds its value: where it does it is a true claim, proved or left open; where it does not it is
# refuted

ALLOWED = {"false": {"refuted", "refused"}, "true": {"proved"}, "same": {"proved"}, "junk": {"refused"},
           "extra": {"partly", "refuted", "refused"},
           "weaker": {"partly", "refuted"}, "narrow": {"partly", "refuted"}, "holds": {"proved", "partly"},
           "open": {"proved", "partly", "refuted", "refused"}}
KINDS = {name: (scene, None) for name, scene in SCENES.items()} | MOTIONS
FILES = ("middle-axis-double-well", "middle-axis-spin-up", "off-axis-fold", "off-axis-none", "off-axis-one",
         "off-axis-two", "sphere-wheel", "symmetric-body",
         "symmetric-spin-up", "thruster-negative-minor-axis", "torque-free-body", "torque-free-gyrostat",
         "wheel-and-thruster")


def part_of(claims, path):
    """The certificate without the other part, which has nothing to do with a claim: it need not be proved
    again."""
    other = {"equilibria": "motion", "motion": "equilibria"}.get(path[0])
    return ({key: value for key, value in claims.items() if key != other} if len(path) > 1
            and claims.get(path[0]) else claims)


def says_what_is_true(claims):
    """Whether a certificate of a scene of its own agrees with elimination in fractions, and its motion with
    the analysis."""
    numbers = claims["scene"]
    if numbers["variables"] == "scaled":
        arguments = F(numbers["a"]), F(numbers["b"]), tuple(map(F, numbers["mu"]))
        model, answer = by_hand.of_scaled(*arguments)
        scene = ScaledGyrostat(*arguments)
    else:
        arguments = tuple(tuple(map(F, numbers[key])) for key in ("inertia", "momentum", "torque"))
        model, answer = by_hand.of_body(*arguments)
        scene = None
    found = claims.get("equilibria")
    if found and disagreements({part: found.get(part) or [] for part in ("points", "curves", "planes")}
                               | {"kind": found["kind"]}, model, answer):
        return False
    motion = claims.get("motion")
    if not motion:
        return True
    try:
        true = true_motion(scene or physical(*arguments), tuple(map(F, motion["state"])))
    except InputError:  # a moment that is not positive, or beyond doubles: the analysis does not speak of it
        return True
    return true is None or (meets(motion, true) and (not motion.get("spin_up") or says_what_happens(claims)))


@lru_cache(64)  # many forgeries leave scene and state as they are
def true_motion(scene, state):
    return certificate(scene, state)["motion"]


def meets(motion, true):
    """Whether claims on a motion agree with another's: the same words, brackets that have a number in common.
    """
    if any(motion.get(key) not in (None, true[key]) for key in ("fate", "axis", "sense")):
        return False
    pairs = (list(zip(sum(motion["extremes"], []), sum(true["extremes"], []))) if motion.get("extremes")
             and true["extremes"] else [])
    pairs += [(motion["period"], true["period"])] if motion.get("period") and true["period"] else []
    return all((one is None) == (two is None)
               and (one is None or max(F(one[0]), F(two[0])) <= min(F(one[1]), F(two[1]))) for one,
               two in pairs)


def forge_all(claims, seed, count, paths=None, each=None):
    """Forge a certificate by machine; the number of changes, and what was found of those that went wrong.

    each: how many changes of a claim are drawn of those that say something, and of those that are junk; all
    by default.
    """
    rng, made, wrong, values = random.Random(seed), 0, [], TrueValues(claims)
    everything = list(forge.claims_of(claims))
    for path in everything if paths is None else rng.sample(everything, min(paths, len(everything))):
        whole = part_of(claims, path)
        changes = forge.changes(whole, path, rng, count)
        if each is not None:
            junk = [change for change in changes if change[0] == "junk"]
            said = [change for change in changes if change[0] != "junk"]
            changes = [*rng.sample(said, min(each, len(said))), *rng.sample(junk, min(each, len(junk)))]
        for known, to in changes:
            changed = forge.forged(whole, path, to)
            status = status_of(changed)
            made += 1
            if known == "narrow":
                known = {True: "holds", False: "false", None: known}[values.holds(path, *to)]
            if known == "true" and not any(changed.get(part) for part in ("equilibria", "motion")):
                known = "open"  # nothing is claimed any more
            fine = status in ALLOWED[known]
            if fine and known == "open" and status == "proved" and path[0] not in ("program", "uncertified",
                                                                                   "schema"):
                fine = says_what_is_true(changed)
            if not fine:
                wrong.append((known, status, path, ascii(to)[:200]))
    return made, wrong


SOME, EVERY, MANY = {"count": 2, "paths": 2}, {"count": 4, "each": 2}, {"count": 200}


@pytest.mark.one_in(16)
@pytest.mark.parametrize("limits, least", [
    pytest.param(SOME, 150, id="some claims"), pytest.param(EVERY, 30, id="every claim"),
    pytest.param(MANY, 3000, id="many times", marks=[pytest.mark.slow, pytest.mark.long])])
@pytest.mark.parametrize("name", [*KINDS, *FILES])
def test_what_a_machine_forges_is_never_proved(name, limits, least):
    claims = case_proved(name) if name in FILES else proved(*KINDS[name])
    if (claims["motion"] or {}).get("spin_up") and limits is not SOME:
        pytest.skip("minutes: below")
    made, wrong = forge_all(claims, name, **limits)
    assert made > least and not wrong, wrong[:3]


OF_EACH_SORT = ("two points", "an oblique line that is left slowly", "spin-up after turning",
                "free, steady rate", "on a decaying plane", "past a fold",
                "on a parabola")


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name",
                         [pytest.param(name, marks=() if name in OF_EACH_SORT else pytest.mark.slow)
                          for name in (*KINDS, *FILES)])
def test_every_bracket_holds_the_value_that_the_equations_give_in_fifty_digits(name):
    claims = case_proved(name) if name in FILES else proved(*KINDS[name])
    values = TrueValues(claims)
    for path in forge.claims_of(claims):
        ends = forge.place_of(claims, path)[path[-1]]
        if forge.has_width(path, ends):
            assert values.holds(path, *ends) is True, path


def test_a_narrowed_bracket_is_true_where_it_holds_the_value_and_false_where_it_does_not():
    claims = proved(*MOTIONS["spin-up after turning"])
    # sqrt 2, the circle's radius (a = b = 0: x1^2 + x2^2 = 2)
    path, values = ("motion", "extremes", 0, 1), TrueValues(claims)
    low, high = map(F, claims["motion"]["extremes"][0][1])
    for n, below in ((1, True), (2, False)):  # 1e-3 of the bracket's width beside sqrt 2, in integers
        end = F(math.isqrt(2 * 10**80), 10**40) + (-1)**n * (high - low) / 1000
        narrowed = [str(low), str(end)]
        assert values.holds(path, *narrowed) is not below
        assert status_of(forge.forged(claims, path, narrowed)) == ("refuted" if below else "proved")


def test_other_orders_are_proved_only_where_the_run_shows_what_they_claim():
    claims = proved(*MOTIONS["torque in no axis"]) | {"equilibria": None, "uncertified": []}
    status = {orders: status_of(forge.forged(claims, ("motion", "spin_up", "orders"), list(orders)))
              for orders in ((0, 5), (3, 2), (0, 0))}
    assert status == {(0, 5): "proved", (3, 2): "refuted", (0, 0): "partly"} and says_what_happens(claims)
    weaker = forge.forged(claims, ("motion", "spin_up", "cone"),
                          str(F(claims["motion"]["spin_up"]["cone"]) / 9))
    assert status_of(forge.forged(weaker, ("motion", "spin_up", "orders"),
                                  [0, 5])) != "proved" and not says_what_happens(weaker)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["torque in no axis, scaled", pytest.param("torque in no axis", marks=pytest.mark.long)])
def test_every_claim_on_a_spin_up_is_forged_in_many_ways(name):
    claims = proved(*MOTIONS[name]) | {"equilibria": None, "uncertified": []}
    made, wrong = forge_all(claims, name, 2)  # two hundred each are long
    assert made > 1000 and not wrong, wrong[:3]


@pytest.mark.parametrize("count", [40, pytest.param(468, marks=pytest.mark.slow)])
def test_parts_of_two_certificates_exchanged_are_never_proved(count):
    made = {name: case_proved(name) for name in FILES}
    swaps = [(one, two, part) for one,
             two in itertools.permutations(made, 2) for part in ("scene", "equilibria", "motion")]
    for one, two, part in random.Random(1).sample(swaps, count):
        if made[one][part] and made[two][part] and made[one][part] != made[two][part]:
            mixed = part_of(made[one] | {part: made[two][part]}, (part, ""))
            status = status_of(mixed)
            assert status in ("refuted",
                              "partly") or (status == "proved" and says_what_is_true(mixed)), (one, two, part)


@pytest.mark.parametrize("spoil, words", [
    (lambda text: text.replace('"kind"', '"kind": "none", "kind"'), "stands twice"),
    (lambda text: text.replace('"motion"', '"motion": null, "motion"'), "stands twice"),
    (lambda text: text.replace('"program"', '"x": ' + "[" * 5000 + "]" * 5000 + ', "program"'), "JSON"),
    (lambda text: text.replace('"axis": 0', '"axis": NaN'), "NaN"),
    (lambda text: text.replace('"axis": 0', '"axis": ' + "1" * 5000), "JSON|axis"),
    (lambda text: text + " " * 5_000_000, "bytes"), (lambda text: text[:-3], "JSON"),
    (lambda text: text.replace('"fate": "', '"fate": "\ud800'), "JSON"),
    (lambda text: "\ufeff" + text, "JSON"),
    (lambda text: text.replace('"axis": 0', '"axis": 1e400'), "axis"),
    (lambda text: text.replace('"period": [', '"period": [' + "[" * 600 + "]" * 600 + ","), "period")])
def test_a_file_that_is_spoilt_as_text_is_refused(spoil, words, tmp_path):
    path = tmp_path / "certificate.json"
    path.write_bytes(spoil(json.dumps(case_proved("minor-axis-100"))).encode("utf-8", "surrogatepass"))
    with pytest.raises(Malformed, match=words):
        verify_file(path)


def test_a_key_without_a_meaning_is_not_checked_and_shown_without_control_characters():
    claims = case_proved("minor-axis-100")
    claims["equilibria"]["curves"][0]["\x1b[2Jname\nproved"] = "all"
    found = verify(claims)
    assert found.status == "partly" and all(f.claim.isprintable() for f in found.findings)


def test_an_extreme_of_a_body_is_said_of_a_rate_and_of_scaled_variables_of_a_component():
    """By hand: x1 of a certificate is the body's rate ω1; no other word is changed."""
    finding = SimpleNamespace(status="proved", claim="least x1", reason="an orbit")
    found = SimpleNamespace(findings=[finding], silent=(), status="proved")
    told = [certification.text(found, "about: ...", physical=one).splitlines()[-1] for one in (True, False)]
    assert told == ["proved       least ω1: an orbit", "proved       least x1: an orbit"]
    assert certification.as_dict(found, {})["findings"][0]["claim"] == "least x1"


def test_a_dropped_part_is_named_as_not_claimed():
    claims = case_proved("minor-axis-100")
    del claims["motion"]
    found = verify(claims)
    assert found.silent == ("motion",) and not any("fate" in f.claim for f in found.findings)
    assert "nothing is claimed of: motion" in certification.text(found, "about: ...")


def test_a_fate_of_monstrous_numbers_is_proved():
    # by hand: about axis 3 U = (1 - x1^2)/2 - alpha with x1 > 0, so U <= 1/2 ahead, below E = 9/2, while it
    # rises by 2 pi with each turn behind
    claims = {"schema": "stabilab.certificate/1",
              "scene": {"variables": "scaled", "a": "-720124e193", "b": "0", "mu": ["0", "0", "1"]},
              "motion": {"state": ["1", "1", "-3"], "fate": "spin-up", "axis": 3, "sense": 1}}
    assert status_of(claims) == "proved"


def test_forgeries_are_refuted_without_asserts_too(tmp_path):
    # python -O leaves asserts out
    rng, lines, expected = random.Random(8), [], []
    for name in ("two points", "a triple zero eigenvalue", "a plane", "a free gyrostat", "at rest",
                 "spin-up"):
        claims = proved(*KINDS[name])
        for path in rng.sample(list(forge.claims_of(claims)), 8):
            for _, to in rng.sample(forge.changes(claims, path, rng, 3), 4):
                text = json.dumps(forge.forged(claims, path, to))
                lines.append(text)
                expected.append(status_of(json.loads(text)))
    (tmp_path / "forged").write_text("\n".join(lines), encoding="utf-8")
    program = """
import json, sys
from stabilab.verify import verify
from stabilab.verify.numbers import Malformed
for line in open(sys.argv[1], encoding="utf-8"):
    try:
        print(verify(json.loads(line)).status)
    except Malformed:
        print("refused")
"""
    child = subprocess.run([sys.executable, "-O", "-c", program, str(tmp_path / "forged")],
                           capture_output=True, text=True, check=True)
    assert child.stdout.split() == expected and {"refuted", "refused"} <= set(expected)
