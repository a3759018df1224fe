"""[circular_orbit] of a case file: what it means, and what is wrong in it."""
from math import pi

import pytest

import stabilab

BODY = 'body.inertia = [3, 2, "1.5 kg m^2"]\n'
ORBIT = BODY + "[circular_orbit]\n{}\n"


@pytest.mark.parametrize("key, rate", [
    ('rate = "0.0011 rad/s"', 0.0011), ('period = "100 min"', 2 * pi / 6000),
    # Kepler's third law with 398600.4418 km^3/s^2
    ('altitude = "621.863 km"', (398600.4418 / 7000**3) ** 0.5),
    ('radius = "7000 km"', (398600.4418 / 7000**3) ** 0.5)])
def test_the_orbit_is_given_by_rate_period_height_or_radius(key, rate):
    found = stabilab.load_orbiting(ORBIT.format(key))
    assert float(found.rate_squared) ** 0.5 == pytest.approx(rate, rel=1e-15)
    assert found.craft.physical.body.inertia == (3.0, 2.0, 1.5)


@pytest.mark.parametrize("text, line, key, words", [
    (ORBIT.format("rate = -1"), 3, "circular_orbit.rate", "is positive"),
    (ORBIT.format("period = 0"), 3, "circular_orbit.period", "takes a positive time"),
    (ORBIT.format("altitude = 0"), 3, "circular_orbit.altitude", "is positive"),
    (ORBIT.format("radius = 0"), 3, "circular_orbit.radius", "exceeds its equatorial radius"),
    (ORBIT.format('radius = "6300 km"'), 3, "circular_orbit.radius", "give the rate or the period"),
    (ORBIT.format('rate = "3 km"'), 3, "circular_orbit.rate", "got length"),
    (ORBIT.format("rate = 1\nperiod = 2"), 4, "circular_orbit.period", "keep one of them"),
    (ORBIT.format(""), 2, "circular_orbit", "expected one of rate, period, altitude or radius"),
    (ORBIT.format("hight = 700"), 3, "circular_orbit.hight", "unknown key"),
    (BODY + "[motion]\n", None, "", "expected a table"),
    (ORBIT.format("rate = 1\n[effects.constant_torque]\ntorque = [1, 0, 0]"), 4, "effects.constant_torque",
     "only wheels are known"),
    (ORBIT.format("rate = 1") + '[[thrusters]]\nposition = [1, 0, 0]\ndirection = [0, 1, 0]\nforce = 1\n'
                                'stuck = true\n', 4, "thrusters", "only wheels are known"),
    ("[scaled]\na = 1\nb = 2\nmu = [0, 0, 0]\n[circular_orbit]\nrate = 1\n", 1, "scaled", "take away [scaled]"),
])
def test_a_fault_has_line_key_and_cure(text, line, key, words):
    with pytest.raises(stabilab.InputError) as raised:
        stabilab.load_orbiting(text)
    said = str(raised.value)
    assert words in said and f"text:{line}: {key}: " in said if line else words in said


@pytest.mark.parametrize("question", ("load", "load_burning"))
def test_questions_without_an_orbit_refuse_it_and_name_the_command(question):
    with pytest.raises(stabilab.InputError, match="text:2: circular_orbit: .*stabilab orbit"):
        getattr(stabilab, question)(ORBIT.format("rate = 1"))


@pytest.mark.parametrize("command", ("classify", "fate", "simulate", "attitude", "stuck", "show", "explore"))
def test_commands_without_an_orbit_refuse_it(stabilab, case_file, command):
    path = case_file(ORBIT.format("rate = 1"), "orbit")
    code, out, said = stabilab(command, path)
    assert code == 2 and not out and "2: circular_orbit: " in said and "stabilab orbit" in said
