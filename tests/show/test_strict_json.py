"""JSON by its standard alone (RFC 8259): no NaN and no Infinity, and no number beyond the doubles but where
one without end is documented (docs/stuck.md)."""
import json
import math
import typing
from pathlib import Path

import pytest

from stabilab import cli
from stabilab.cli import options
from tests.shared import craft_file

BODY = (
    "[body]\ninertia = [12, 9, 5]\n[effects.gyrostat]\nmomentum = {wheel}\n[effects.constant_torque]\ntorque "
    "= {torque}\n")
MOTION = "[motion]\nangular_velocity = {rates}\nspan = [0, 3]\n"
# intervals of the wheel's momentum without an end
CRAFT = craft_file([12, 9, 5], ([1, 0, 0], [0, 1, 0], "20 mN"), [([1, 0, 0], "0.8 N m s")], [0.1, 0.05, 0.9])
CRAFT += '[limits]\nrate = "60 deg/s"\n'
CASES = {
    "bounded": BODY.format(wheel=[0.8, 0, 0], torque=[0, 0, 0.02]) + MOTION.format(rates=[0.1, 0.05, 0.02]),
    # rates without bound, no period
    "spin-up": BODY.format(wheel=[0.8, 0, 0], torque=[0, 0, 0.02]) + MOTION.format(rates=[0.1, 0.05, 4]),
    # infinite distance
    "no saddle": BODY.format(wheel=[0.8, 0, 0], torque=[0.02, 0, 0]) + MOTION.format(rates=[0.1, 0.05, 0.02]),
    "off the axes": BODY.format(wheel=[0.8, 0, 0], torque=[0.01, 0.3, 0.02])
    + MOTION.format(rates=[0.1, 0.05, 0.02]),
    "at rest": BODY.format(wheel=[0, 0, 0], torque=[0, 0, 0]) + MOTION.format(rates=[0, 0, 0]),
    # its energy is no double
    "beyond doubles": BODY.format(wheel=[0, 0, 0], torque=[0, 0, 0.02])
    + MOTION.format(rates=["1e160", 0, 0]),
    "liquid": "[body]\ninertia = [12, 9, 5]\n[effects.liquid_cavity]\ndensity = 1\nviscosity = 1\nradius "
              "= 0.1\n" + MOTION.format(rates=[0.1, 0, 0.2])}
for name, rates in (("damped", "[0.3, 0, 1]"), ("damped at rest", "[0, 0, 1]")):
    CASES[name] = ("[body]\ninertia = [3, 2, 1]\n[effects.viscous_damper]\ninertia = 0.1\ncoefficient = 0.1\n"
                   f"[motion]\nangular_velocity = {rates}\nspan = [0, 5]\n")
CASES["burn"] = CRAFT.split("[[wheels]]")[0].replace("stuck = true", 'stop = "90 s"') + MOTION.format(
    rates=[0.1, 0.05, 0.02])
CASES["orbit"] = BODY.split("[effects")[0].format() + "[circular_orbit]\naltitude = '700 km'\n"
CASES["charged"] = (Path(__file__).parents[2]
                    / "cases" / "charged-body-small-torque.toml").read_text(encoding="utf-8")
MANY = ["bounded", "spin-up", "no saddle", "off the axes", "at rest", "beyond doubles"]
SLOW = "beyond doubles"
# command -> (options, cases)
ASKED = {"classify": ([], [*MANY, "liquid"]),
         "fate": ([], MANY), "extremes": ([], MANY), "period": ([], MANY),
         "when": (["--rate", "0.3 rad/s"], MANY),
         "simulate": (["--at", "0,1"], MANY), "compare": ([], ["charged"]),
         "precision": (["--quick"], ["bounded"]),
         "sweep": (["--vary", "motion.angular_velocity[3]=0:4:3", "--answer",
                    "fate,margin,distance,extremes,period"], ["bounded", "no saddle"]),
         "basin": (["--vary", "motion.angular_velocity[1]=-1:1:3", "--vary",
                    "motion.angular_velocity[3]=-1:1:3", "--depth", "1"], ["bounded"]),
         "atlas": (["--level", "0", "--refine", "0"], ["bounded"]), "chaos": (["--until", "5"], ["bounded"]),
         "bifurcation": (["--vary", "torque[3]=-1:1"], ["bounded", "off the axes"]),
         "flat-spin": ([], ["damped", "damped at rest"]),
         "burn": (["--below", "0.3 rad/s"], ["burn"]), "orbit": ([], ["orbit"]), "attitude": ([], MANY), "reference": (["--at", "0,1", "--digits", "12"], ["bounded"]), "stuck": ([], ["craft"]),
         "verify": ([], ["certificate"]),
         "audit": (["constant-torque-gyrostat", "--equation", "17"], [None]), "validate": ([], [None]),
         "papers": (["liquid-cavity"], [None])}


def strictly(text, endless=False):
    """The data, by a reader that takes nothing but the standard's numbers, and of these only doubles (and the
    number without end)."""
    def no_constant(word):
        pytest.fail(f"{word} is no JSON")

    def double(digits):
        assert math.isfinite(float(digits)) or endless and digits.lstrip(
            "-") == "1e999", f"{digits} is beyond the doubles"
        return float(digits)
    return json.loads(text, parse_constant=no_constant, parse_float=double)


def test_the_reader_here_refuses_what_is_no_number():
    for text in ("[NaN]", "[-Infinity]", "[1e999]"):
        with pytest.raises((pytest.fail.Exception, AssertionError)):
            strictly(text)
    assert strictly("[1e308, -1e308]") == [1e308,
                                           -1e308] and strictly("[-1e999]", endless=True) == [-math.inf]


def with_json():
    """The commands that answer in JSON, by the options they declare."""
    for command in cli.whole().registered_commands:
        if any(note is options.Json
               for note in typing.get_type_hints(command.callback, include_extras=True).values()):
            yield command.name or command.callback.__name__


def test_every_command_that_answers_in_json_is_asked_here():
    assert set(with_json()) == {*ASKED, "surface"}  # which needs a folder, and is asked below


def source(name, folder, stabilab):
    """What a command is asked about: a case file, a certificate, or nothing."""
    if name is None:
        return []
    path = folder / "case.toml"
    if name == "certificate":
        path.write_text(CASES["spin-up"])
        code, _, said = stabilab("classify", path, "--certify", "--out", folder / "made.json")
        assert code == 0, said
        strictly((folder / "made.json").read_text())
        return [folder / "made.json"]
    path.write_text(CRAFT if name == "craft" else CASES[name])
    return [path]


def slow(command, name):
    """Whether it takes seconds."""
    return command == "precision" or name == SLOW and command not in ("fate", "simulate")


@pytest.mark.one_in(10)
@pytest.mark.parametrize("command, name",
                         [pytest.param(command, name, marks=pytest.mark.slow if slow(command, name) else [])
                                           for command, (_, names) in ASKED.items() for name in names])
def test_what_a_command_says_in_json_is_read_by_strict_readers(stabilab, tmp_path, command, name):
    code, out, said = stabilab(command, *source(name, tmp_path, stabilab), *ASKED[command][0], "--json")
    if code == 0 or out:
        assert strictly(out, endless=command in ("stuck", "sweep"))
    assert code in (0, 3, 5) or (name, code) == (SLOW, 2), said


@pytest.mark.slow  # a renderer of its own starts, for seconds
def test_what_surface_writes_and_the_manifest_are_read_by_strict_readers(stabilab, tmp_path):
    code, out, said = stabilab("surface", *source("bounded", tmp_path, stabilab), "--out", tmp_path / "made",
                               "--json")
    assert code in (0, 4), said
    assert strictly(out)
    for path in (tmp_path / "made").glob("*.json"):
        assert strictly(path.read_text())
