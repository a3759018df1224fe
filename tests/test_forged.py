"""Forged certificates: each claim of a proved one changed in turn is refuted, or left unproved, or refused; never proved."""
import copy
import json
import subprocess
import sys
from fractions import Fraction as F
from functools import cache
from pathlib import Path

import pytest

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, load
from stabilab.analysis.certificate import certificate
from stabilab.verify import verify
from stabilab.verify.numbers import Malformed


def physical(D, lam=(0, 0, 0), M=(0, 0, 0)):
    return Scene(Body(D), Gyrostat(lam), ConstantTorque(M))


SCENES = {
    "two points": ScaledGyrostat(0, 0, (1, 2, 1)), "a double root": ScaledGyrostat(0, 2, (-3, 3, 1)),
    "a triple zero eigenvalue": ScaledGyrostat(0, 2, (F(-15, 16), F(5, 4), F(3, 4))),
    "a hyperbola": ScaledGyrostat("0.2", "0.4", (0, 0, 1)), "crossing lines, a minimum": physical((5, 4, 5), (2, 3, 0), (0, 0, -6)),
    "crossing lines, no minimum": physical((3, 4, 5), (2, 3, 0), (0, 0, 6)), "a single line": physical((1, 2, 2), (0, 1, 1), (1, 0, 0)),
    "a torque oblique among equal moments": physical((2, 2, 1), (1, -1, 1), (1, 1, 0)),
    "an oblique line that is left slowly": physical((4, 3, 2), (1, 5, 14), (0, 7, -5)),
    "an oblique line of a symmetric body": physical((2, 2, 1), (1, 0, 1), (0, 1, 1)),
    "a free gyrostat": physical((5, 4, 2), (0, 2, 3)), "a free gyrostat, one wheel": physical((5, 4, 2), (0, 2, 0)),
    "free, three axes": physical((5, 4, 2)), "a plane": physical((2, 2, 1), (0, 0, 1)), "a plane through rest": physical((1, 2, 2)),
    "free, scaled": ScaledGyrostat(1, 2, (0, 0, 0)), "free, scaled, no wheel": ScaledGyrostat(1, 1, (0, 0, 0)),
    "none, contradictory": physical((3, 2, 1), (1, 0, 0), (1, 0, 0)), "none, a constant": physical((3, 2, 2), (0, 0, 0), (1, 0, 0)),
    "none, no real root": ScaledGyrostat(0, 0, (-1, 1, 1)), "all": physical((2, 2, 2))}
OTHER = {"stable": "unstable", "unstable": "stable", "degenerate": "stable"}


def proved(scene, state=None):
    """The certificate of a scene as read from its file; proved."""
    claims = json.loads(json.dumps(certificate(scene, state)))
    found = verify(claims)
    assert found.status == "proved", found.findings
    return claims


def status_of(claims):
    try:
        return verify(claims).status
    except Malformed:
        return "refused"


def moved(ends, share=F(1, 7)):
    """A bracket beside the right one."""
    low, high = map(F, ends)
    step = 3 * (high - low) + share * (abs(low) + 1)
    return [str(low + step), str(high + step)]


def forgeries(claims):
    """(what was forged, the certificate) for every claim on the equilibria."""
    def changed(*path, to):
        forged = copy.deepcopy(claims)
        place = forged["equilibria"]
        for key in path[:-1]:
            place = place[key]
        if to is None:
            del place[path[-1]]
        else:
            place[path[-1]] = to
        return path, forged
    found = claims["equilibria"]
    yield changed("kind", to="points" if found["kind"] != "points" else "curves")
    for part in ("points", "curves", "planes"):
        for n, entry in enumerate(found[part]):
            yield changed(part, n, to=None)
            for word in ("linear", "verdict"):
                if word in entry:
                    yield changed(part, n, word, to=OTHER[entry[word]])
    for n, point in enumerate(found["points"]):
        yield changed("points", to=[*found["points"], point])
        yield from (changed("points", n, "box", i, to=moved(point["box"][i])) for i in range(3))
    for n, curve in enumerate(found["curves"]):
        line = len(curve["denominator"]) == 1 and all(len(row) < 3 for row in curve["numerators"])
        for i, row in enumerate(curve["numerators"]):
            if not (line and len(row) == 2):  # along a line itself a change is another parametrisation
                yield from (changed("curves", n, "numerators", i, k, to=str(F(c) + 1)) for k, c in enumerate(row))
        for part in ("segments", "folds"):
            for k, piece in enumerate(curve[part]):
                yield changed("curves", n, part, k, to=None)
                yield from (changed("curves", n, part, k, word, to=OTHER[piece[word]]) for word in ("linear", "verdict"))
        for k, fold in enumerate(curve["folds"]):
            yield changed("curves", n, "folds", k, "t", to=moved(fold["t"]))
        for k, piece in enumerate(curve["segments"]):
            for side in (0, 1):
                end = piece["t"][side]
                yield changed("curves", n, "segments", k, "t", side, to=["0", "0"] if end is None else moved(end))
    for n, plane in enumerate(found["planes"]):
        across = next(i for i in range(3) if not any(F(row[i]) for row in plane["directions"]))
        yield changed("planes", n, "base", across, to=str(F(plane["base"][across]) + 1))
        yield changed("planes", n, "directions", 1, to=["1", "1", "1"])
        yield from (changed("planes", n, "centre", "at", i, to=str(F(v) + 1)) for i, v in enumerate(plane["centre"]["at"]))
        yield changed("planes", n, "centre", "verdict", to="unstable")


@pytest.mark.parametrize("name", SCENES)
def test_a_forged_claim_on_the_equilibria_is_never_proved(name):
    claims = proved(SCENES[name])
    for path, forged in forgeries(claims):
        status = status_of(forged)
        assert status == "refuted", (path, status, verify(forged).findings)


@pytest.mark.parametrize("name", SCENES)
def test_equilibria_that_are_not_there_are_refuted(name):
    claims = proved(SCENES[name])
    others = {"points": {"box": [["3", "3"], ["5", "5"], ["7", "7"]], "linear": "unstable", "verdict": "unstable"},
              "curves": {"numerators": [["3", "1"], ["5"], ["7"]], "denominator": ["1"], "segments": [], "folds": []},
              "planes": {"base": ["3", "5", "7"], "directions": [["1", "0", "0"], ["0", "1", "1"]], "linear": "degenerate", "verdict": "unstable",
                         "centre": {"at": ["3", "5", "7"], "verdict": "stable"}}}
    for part, entry in others.items():
        forged = copy.deepcopy(claims)
        forged["equilibria"][part].append(entry)
        assert status_of(forged) == "refuted" or claims["equilibria"]["kind"] == "all", part


@pytest.mark.parametrize("name", [name for name in SCENES if name != "all"])
def test_the_same_claimed_twice_is_refuted(name):
    claims = proved(SCENES[name])
    for part in ("points", "curves", "planes"):
        for entry in claims["equilibria"][part]:
            forged = copy.deepcopy(claims)
            forged["equilibria"][part].append(entry)
            assert status_of(forged) == "refuted", part
    for curve in claims["equilibria"]["curves"]:
        if len(curve["denominator"]) == 1 and not curve["folds"]:  # the same line the other way round
            turned = curve | {"numerators": [[("-" + c).replace("--", "") if k else c for k, c in enumerate(row)] for row in curve["numerators"]],
                              "segments": curve["segments"][::-1]}
            assert status_of(claims | {"equilibria": claims["equilibria"] | {"curves": [*claims["equilibria"]["curves"], turned]}}) == "refuted"


CASES = Path(__file__).parent.parent / "cases"


def case_proved(name):
    return json.loads(_case_text(name))


@cache
def _case_text(name):
    case = load(CASES / f"{name}.toml")
    return json.dumps(proved(case.scene, case.exact_state))


def test_boxes_without_a_zero_are_refuted():
    claims = case_proved("off-axis-two")
    for point, box in zip(claims["equilibria"]["points"], (["100", "101"], ["200", "201"])):
        point |= {"box": [box] * 3, "verdict": "stable"}
        assert status_of(claims) == "refuted"
    first, second = case_proved("off-axis-two")["equilibria"]["points"]
    claims["equilibria"]["points"] = [first, first | {"box": [[str(2 * F(low) - F(high)), high] for low, high in first["box"]]}]  # one zero in two boxes
    assert status_of(claims) == "refuted"
    claims["equilibria"]["points"] = [second, first]  # their order says nothing
    assert status_of(claims) == "proved"


@pytest.mark.parametrize("change", [{"extremes": [[["5", "6"], ["5", "6"]]] * 3}, {"period": ["1", "2"]}, {"axis": 3}, {"sense": -1}, {"fate": "bounded"},
                                    {"extremes": [[None, None]] * 3}], ids=str)
def test_false_numbers_beside_an_equilibrium_are_refuted(change):
    claims = case_proved("off-axis-fold")
    assert claims["motion"]["fate"] == "equilibrium"
    assert status_of(claims | {"motion": claims["motion"] | change}) == "refuted"


@pytest.mark.parametrize("bad", [True, float("nan"), "1/0", [], [[]], "\u0661", 1.0, "1e1000000000"], ids=ascii)
@pytest.mark.parametrize("key", ["state", "fate", "axis", "sense", "extremes", "period"])
@pytest.mark.parametrize("name", ["off-axis-fold", "off-axis-none", "minor-axis-100"])
def test_junk_in_a_motion_is_refused_whatever_its_fate(name, key, bad):
    # at an equilibrium, without a reduction, and with one
    claims = case_proved("minor-axis-100") | {"scene": case_proved(name)["scene"]}
    claims["motion"] |= {key: bad}
    assert status_of(claims) == "refused"


def test_an_equilibrium_is_its_own_extremes():
    claims = case_proved("off-axis-fold")
    claims["motion"]["extremes"] = [[[x, x], [x, x]] for x in claims["motion"]["state"]]
    assert status_of(claims) == "proved"


def test_a_fate_left_open_still_has_its_numbers_checked():
    claims = case_proved("minor-axis-100")
    claims["motion"]["fate"] = "undecided"
    assert status_of(claims) == "partly"
    claims["motion"]["period"] = moved(claims["motion"]["period"])
    assert status_of(claims) == "refuted"


def malformed(claims, where=()):
    """Every string of the mathematics replaced by what is no number, and every list and object by a string."""
    place = claims
    for key in where:
        place = place[key]
    for key in list(place) if isinstance(place, dict) else range(len(place)):
        if key in ("program", "uncertified"):
            continue
        here, kept = (*where, key), place[key]
        wrong = [5, "x"] if isinstance(kept, (str, list, dict)) else []
        for bad in wrong:
            if isinstance(kept, str) and bad == "x" and key in ("linear", "verdict", "fate", "kind"):
                continue
            place[key] = bad
            yield here, bad
        place[key] = kept
        if isinstance(kept, (list, dict)):
            yield from malformed(claims, here)


@pytest.mark.parametrize("name", ["two points", "a hyperbola", "a plane"])
def test_what_is_no_number_or_no_list_is_refused(name):
    claims = proved(SCENES[name])
    for where, bad in malformed(claims):
        with pytest.raises(Malformed):
            verify(claims)
            pytest.fail(f"{where}: {bad!r} was taken")


MOTIONS = {
    "bounded in a well": (ScaledGyrostat("0.2", "0.4", (0, 0, 1)), (3, F(-3, 2), F(3, 10))),
    "spin-up": (ScaledGyrostat("0.2", "0.4", (0, 0, 1)), (1, 1, 1)), "spin-up after turning": (ScaledGyrostat(0, 0, (0, 0, 1)), (1, 1, -3)),
    "free, round": (physical((3, 2, 1), (0, 1, 0)), (1, 1, 3)), "free, in a well": (physical((3, 2, 1), (1, 0, 0)), (3, 1, 1)),
    "free, steady rate": (physical((3, 3, 1)), (1, 1, 1)), "on a hyperbola": (ScaledGyrostat("0.5", 1, (0, 1, 0)), (1, -1, 2)),
    "on a decaying plane": (ScaledGyrostat("0.5", 1, (0, 1, 0)), (F(1, 2), -1, F(-3, 2))),
    "pure spin": (physical((3, 2, 1), (0, 0, 0), (0, 1, 0)), (0, 1, 0)),
    "on a parabola": (physical((2, 2, 1), (0, 1, 1), (1, 0, 0)), (1, 1, 2)),
    "released at rest": (ScaledGyrostat("0.2", "0.4", (0, 0, 1)), (3, F(-3, 2), 0)),
    "released, free": (physical((3, 2, 1), (1, 0, 0)), (0, 1, 3)),
    "released to spin": (ScaledGyrostat(0, 0, (0, 0, 1)), (F(1, 2), F(1, 2), 0)),
    "released on a plane": (ScaledGyrostat("0.5", 1, (0, 1, 0)), (F(1, 2), 0, F(-3, 2))),
    "at rest": (ScaledGyrostat(0, 0, (0, 0, 1)), (-3, F(1, 3), 0))}


@pytest.mark.parametrize("name", MOTIONS)
def test_a_forged_claim_on_the_motion_is_refuted(name):
    claims = proved(*MOTIONS[name])
    claims["equilibria"] = None
    true = claims["motion"]
    changes = [{"fate": word} for word in ("bounded", "spin-up", "equilibrium") if word != true["fate"]] + [{"state": ["3", "5", "7"]}]
    if true["fate"] == "spin-up":
        changes += [{"axis": true["axis"] % 3 + 1}, {"sense": -true["sense"]}, {"period": ["1", "2"]}]
    elif true["period"]:
        changes += [{"period": moved(true["period"])}, {"axis": 1}]
    for i, pair in enumerate(true["extremes"] or []):
        for side, ends in enumerate(pair):
            forged = copy.deepcopy(true["extremes"])
            forged[i][side] = ["0", "1"] if ends is None else moved(ends, F(1, 10**6))
            changes.append({"extremes": forged, "period": None})
            forged = copy.deepcopy(true["extremes"])
            if ends is not None:
                forged[i][side] = None
                changes.append({"extremes": forged, "period": None})
    for change in changes:
        status = status_of(claims | {"motion": true | change})
        assert status == "refuted", (change, verify(claims | {"motion": true | change}).findings)
