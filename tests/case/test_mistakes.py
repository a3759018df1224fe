"""Plausible mistakes in a case file: each answer's first line says file, line and key, and what to write
instead. The words are by hand, from what the mistake is."""
import re

import pytest

from stabilab.case.read import read_text
from stabilab.errors import CaseError

BASE = '''# A 640 kg Earth-observation satellite; numbers as in a mass-properties report
title = "EO satellite"

[body]
inertia = [[412.0, -6.3, 11.8], [-6.3, 297.5, 4.4], [11.8, 4.4, 351.2]]
mass = 640
centre_of_mass = [0.92, 0.013, -0.008]

[[wheels]]
name = "MW"
axis = [0.0, -1.0, 0.02]
momentum = "14 N m s"

[[thrusters]]
name = "T3"
position = [0.05, 0.55, -0.48]
direction = [0.94, 0.0, -0.34]
force = "1 N +- 6 %"
misalignment = "0.5 deg"
stuck = true

[limits]
rate = "6 deg/s"

[motion]
angular_velocity = ["0.02 deg/s", "-0.061 deg/s", "0.004 deg/s"]
span = [0, "20 min"]
'''
TENSOR = "[[412.0, -6.3, 11.8], [-6.3, 297.5, 4.4], [11.8, 4.4, 351.2]]"
RATES = '["0.02 deg/s", "-0.061 deg/s", "0.004 deg/s"]'
FORCE, SPAN, COM, RATE, WHEEL = ('force = "1 N +- 6 %"', 'span = [0, "20 min"]',
                                 "centre_of_mass = [0.92, 0.013, -0.008]", 'rate = "6 deg/s"',
                                 'momentum = "14 N m s"')
READ = "read"
# what is replaced, by what, line and key of the fault, words of the cure; READ: what stands there is clear
FIFTY_FIVE = [
    (RATES, "[0.02, -0.061, 0.004]", READ), (RATES, "[2.5, -4.0, 0.5]", 23, "limits.rate",
                                             'a number alone in angular_velocity is in rad/s, of degrees write "2.5 deg/s"'),
    (TENSOR, "[[412000000.0, -6300000, 11800000], [-6300000, 297500000, 4400000], [11800000, 4400000, "
     "351200000]]", READ),
    (TENSOR, '[["4.12e8 kg mm^2", "-6.3e6 kg mm^2", "1.18e7 kg mm^2"], ["-6.3e6 kg mm^2", "2.975e8 kg mm^2", '
     '"4.4e6 kg mm^2"], ["1.18e7 kg mm^2", "4.4e6 kg mm^2", "3.512e8 kg mm^2"]]', READ),
    ("297.5", "-297.5", 5, "body.inertia", "are the products too large"),
    ("[-6.3, 297.5", "[6.3, 297.5", 5, "body.inertia", "write the same number in both places"),
    ("412.0", "812.0", READ),
    (TENSOR, "[[412.0, -6.3], [-6.3, 297.5]]", 5, "body.inertia", "write three rows of three"),
    ("inertia = ", "moment_of_inertia = ", 5, "body.moment_of_inertia", f"write inertia = {TENSOR}"),
    ("inertia = ", "Inertia = ", 5, "body.Inertia", f"write inertia = {TENSOR}"),
    (BASE[BASE.index("[body]"):BASE.index("[[wheels]]")], "", None, "",
     "expected a table [body] with inertia"),
    (BASE[BASE.index("[motion]"):], "", READ), (f"[limits]\n{RATE}\n", "", READ),
    ("[[wheels]]", "[wheels]", 9, "wheels", "write the title [[wheels]] in double brackets"),
    ("[[wheels]]", "[[wheel]]", 9, "wheel", "write that in place of [[wheel]]"),
    ("[[thrusters]]", "[[thruster]]", 14, "thruster", "[[thrusters]]: write that in place of [[thruster]]"),
    ('"14 N m s"', '"14,5 N m s"', 12, "wheels.momentum", 'write "14.5 N m s" with a point'),
    ("[0.92, 0.013, -0.008]", "[0,92, 0,013, -0,008]", 7, "body.centre_of_mass", f"write: {COM}"),
    ("\n", "\r\n", READ), (" = ", ": ", 2, "title", 'seems to be YAML'),
    (BASE, "body:\n  inertia: [1,2,3]\n", 1, "body", "write: [body]"),
    ("axis = [0.0, -1.0, 0.02]", "axis = [0, 0, 0]", 11, "wheels.axis", "give a vector of any length"),
    (BASE, f"\ufeff{BASE}", READ), ("stuck = true", "stuck = yes", 20, "thrusters.stuck",
                                    "write: stuck = true"),
    ("stuck = true", "stuck = True", 20, "thrusters.stuck", "write: stuck = true"), ("stuck = true\n", "",
                                                                                     READ),
    ('"14 N m s"', '"6000 rpm"', 12, "wheels.momentum", "write inertia and speed in place of momentum"),
    ('"1 N +- 6 %"', "1 N", 18, "thrusters.force", 'write: force = "1 N"'),
    ('"20 min"', "20 min", 27, "motion.span", f"write: {SPAN}"),
    ('"-0.061 deg/s"', '"−0.061 deg/s"', READ), ('"0.02 deg/s"', '"0.02 °/s"', READ),
    ('"0.02 deg/s"', '"0.02 dps"', READ), ('"14 N m s"', '"14 Nms"', READ), ('"14 N m s"', '"14 N·m·s"',
                                                                             READ),
    ("[[412.0", '[["412 kgm2"', READ), ("[[412.0", '[["412 kg*m^2"', READ), ("[[412.0", '[["412 kg·m²"',
                                                                             READ),
    ("angular_velocity", "omega", 26, "motion.omega", f"write angular_velocity = {RATES}"),
    ("angular_velocity", "rate", 26, "motion.rate", f"write angular_velocity = {RATES}"),
    ('[0, "20 min"]', '"20 min"', 27, "motion.span", 'write [0, "20 min"]'), (SPAN, "", READ),
    ('"0.5 deg"', "2", 19, "thrusters.misalignment", 'write "1 deg"'), (RATE, "rate = 6", READ),
    ("rate =", "max_rate =", 23, "limits.max_rate", "did you mean rate?"),
    ('"14 N m s"', "[0, -14, 0]", 12, "wheels.momentum", "and axis = [0, -14, 0]"),
    ("span =", "quaternion = [0,0,0,1]\nspan =", 27, "motion.quaternion",
     "write attitude = [psi, phi, theta]"),
    ('"1 N +- 6 %"', "[0.94, 0, -0.34]", 18, "thrusters.force", "and direction = [0.94, 0, -0.34]"),
    ("mass = 640", "mass = 640\nmass = 650", 7, "body.mass", "written a second time; the first is in line 6"),
    (TENSOR, "[412, 297.5, 351.2]\nproducts = [6.3, -11.8, -4.4]", 6, "body.products",
     'write products = {xy = 6.3, xz = -11.8, yz = -4.4, convention = "positive"}'),
    (TENSOR, "[412, 297.5, 351.2]\nproducts = {xy=6.3, xz=-11.8, yz=-4.4}", 6, "body.products",
     'add convention = "positive"'),
    (f"inertia = {TENSOR}", "Ixx = 412\nIyy = 297.5\nIzz = 351.2", 5, "body.Ixx",
     "write inertia = [412, 297.5, 351.2]"),
    (TENSOR, "[412, 297.5, 351.2, -6.3, 11.8, 4.4]", 5, "body.inertia",
     "write inertia = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]"),
    (BASE, f"{BASE}\n[torque]\nvalue=[0,0,1]\n", 29, "torque",
     "[effects.constant_torque]: torque = [0, 0, 1]"),
    (BASE, f"{BASE}\n[effects.torque]\ntorque=[0,0,1]\n", 29, "effects.torque",
     "it is written in [effects.constant_torque]"),
]
MORE = [
    (RATES, "[0.0, -4.0, 0.5]", 23, "limits.rate", 'of degrees write "-4.0 deg/s"'),
    # units and numbers
    ("1 N +- 6 %", "0.1 kgf", 18, "thrusters.force", "write 9.80665 N for each"),
    ("1 N +- 6 %", "0.1 kg", 18, "thrusters.force", "a force is in N"),
    ("1 N +- 6 %", "1 N m", 18, "thrusters.force", "[effects.constant_torque] torque"),
    ("1 N +- 6 %", "1 N +/- 6 %", READ), ("1 N +- 6 %", "1000 mN", READ), ("1 N +- 6 %", "1 newton", READ),
    ("1 N +- 6 %", "6 %", 18, "thrusters.force", "stand behind +-"),
    ("1 N +- 6 %", "1x10^0 N", 18, "thrusters.force", 'write "1e0 N"'),
    ("1 N +- 6 %", "N 1", 18, "thrusters.force", 'write "1 N"'), ("1 N +- 6 %", "~1 N", 18, "thrusters.force",
                                                                  '"1 N"'),
    ("1 N +- 6 %", "0.9-1.1 N", 18, "thrusters.force", '"1 +- 0.1 N"'),
    ("1 N +- 6 %", "1 [N]", 18, "thrusters.force", 'write "1 N"'),
    ("1 N +- 6 %", "1,000 N", 18, "thrusters.force", '"1000 N" where the comma parts thousands'),
    ("1 N +- 6 %", "1 000 N", 18, "thrusters.force", 'write "1000 N"'),
    ("6 deg/s", "6 deg", 23, "limits.rate", "an angular velocity is in deg/s or rad/s"),
    ("6 deg/s", "6 degrees per second", READ), ("6 deg/s", "6°/s", READ), ("6 deg/s", "6 deg s⁻¹", READ),
    ("6 deg/s", "0.02 Hz", 23, "limits.rate", "write rad/s, rev/s or 1/s"),
    ("6 deg/s", "6 degps", 23, "limits.rate", "write deg/s"),
    ("6 deg/s", "< 6 deg/s", 23, "limits.rate", 'write the number alone, "6 deg/s"'),
    ("6 deg/s", "–6 deg/s", 23, "limits.rate", 'write "-6 deg/s" with the minus of a keyboard'),
    ("6 deg/s", "π/30", 23, "limits.rate", "write the decimals"),
    ("20 min", "20 m", 27, "motion.span", "min is a minute, m a metre"),
    ("20 min", "00:20:00", 27, "motion.span", "write one number and its unit"),
    ("20 min", "1h30m", 27, "motion.span", "write one number and its unit"),
    ("14 N m s", "14 N m", 12, "wheels.momentum", "an angular momentum is in N m s"),
    ("14 N m s", "14 N ms", 12, "wheels.momentum", "write N m s"), ("14 N m s", "14 kgm2/s", READ),
    ("0.5 deg", "0 deg 30'", 19, "thrusters.misalignment", "write decimals of a degree"),
    (TENSOR, '["412 kg m", 297.5, 351.2]', 5, "body.inertia", "a moment of inertia is in kg m^2"),
    (TENSOR, '["4.12e8 kgmm2", "2.975e8 kg-mm^2", "3.512e8 kg.mm2"]', READ),
    # the TOML itself
    ("mass = 640", "mass: 640", 6, "body.mass", "write: mass = 640"),
    ("mass = 640", "mass = 640;", 6, "body.mass", "write: mass = 640"),
    ("mass = 640", "mass = 640,", 6, "body.mass", "write: mass = 640"),
    ("mass = 640", '"mass": 640,', 6, "body.mass", "write: mass = 640"),
    ("mass = 640", "mass = 640 // kg", 6, "body.mass", "write: mass = 640  # kg"),
    ("mass = 640", "mass = 640 ; kg", 6, "body.mass", "write: mass = 640  # kg"),
    ("mass = 640", "mass = 640 % kg", 6, "body.mass", "write: mass = 640  # kg"),
    ("mass = 640", "// kg\nmass = 640", 6, "", "write: # kg"), ("mass = 640", "let mass = 640;", 6,
                                                                "body.mass", "write: mass = 640"),
    ("mass = 640", "mass = 640 kg", 6, "body.mass", 'write: mass = "640 kg"'),
    ("mass = 640", "mass = 640,5", 6, "body.mass", "write: mass = 640.5"),
    ("mass = 640", "mass 640", 6, "body.mass", "write: mass = 640"), ("mass = 640", "mass := 640", 6,
                                                                      "body.mass", "write: mass = 640"),
    ("mass = 640", "mass = 640.", 6, "body.mass", "write: mass = 640.0"),
    ("mass = 640", "mass = .64e3", 6, "body.mass", "write: mass = 0.64e3"),
    ("mass = 640", "mass = 0640", 6, "body.mass", "write: mass = 640"),
    ("mass = 640", "mass = 6.4d2", 6, "body.mass", "write: mass = 6.4e2"),
    ("mass = 640", "mass = 2*320", 6, "body.mass", "write the number itself"),
    ("mass = 640", "mass = None", 6, "body.mass", "leave the key out"), ("mass = 640", "mass =", 6,
                                                                         "body.mass",
                                                                         "value of mass is missing"),
    ("mass = 640", "mass = 640, x = 3", 6, "body.mass", "write: mass = 640; on a line of its own x = 3"),
    (FORCE, "force = “1 N”", 18, "thrusters.force", 'write: force = "1 N"'),
    (FORCE, 'force = "1 N', 18, "thrusters.force", 'write: force = "1 N"'),
    (FORCE, "force = '1 N\"", 18, "thrusters.force", 'write: force = "1 N"'),
    (FORCE, "force = 1 N +- 6 %", 18, "thrusters.force", f"write: {FORCE}"),
    (COM, "centre_of_mass = (0.92, 0.013, -0.008)", 7, "body.centre_of_mass", f"write: {COM}"),
    (COM, "centre_of_mass = {0.92, 0.013, -0.008}", 7, "body.centre_of_mass", f"write: {COM}"),
    (COM, "centre_of_mass = [0.92 0.013 -0.008]", 7, "body.centre_of_mass", f"write: {COM}"),
    (COM, "centre_of_mass = [0.92; 0.013; -0.008]", 7, "body.centre_of_mass", f"write: {COM}"),
    (COM, "centre_of_mass = np.array([0.92, 0.013, -0.008])", 7, "body.centre_of_mass", f"write: {COM}"),
    (COM, "centre_of_mass = [.92, .013, -.008]", 7, "body.centre_of_mass", f"write: {COM}"),
    (COM, "centre_of_mass = [0.92,, 0.013, -0.008]", 7, "body.centre_of_mass", f"write: {COM}"),
    (COM, "centre_of_mass = [0.92, 0.013, −0.008]", 7, "body.centre_of_mass", f"write: {COM}"),
    (COM, "centre_of_mass = [0.92, 0.013, -0.008", 7, "body.centre_of_mass", f"write: {COM}"),
    (COM, "centre_of_mass = 0.92, 0.013, -0.008", 7, "body.centre_of_mass", f"write: {COM}"),
    (COM, "centre of mass = [0.92, 0.013, -0.008]", 7, "body.centre_of_mass", f"write: {COM}"),
    (COM, "centre_of_mass\u00a0= [0.92, 0.013, -0.008]", 7, "body.centre_of_mass", f"write: {COM}"),
    (TENSOR, "[[412. -6.3 11.8]\n [-6.3 297.5 4.4]\n [11.8 4.4 351.2]]", 5, "body.inertia",
     f"write: inertia = {TENSOR}"),
    (TENSOR, "[412.0, -6.3, 11.8; -6.3, 297.5, 4.4; 11.8, 4.4, 351.2]", 5, "body.inertia",
     f"write: inertia = {TENSOR}"),
    (TENSOR, "diag(412, 297.5, 351.2)", 5, "body.inertia", "write: inertia = [412, 297.5, 351.2]"),
    (RATES, "[0.02, -0.061, 0.004] deg/s", 26, "motion.angular_velocity",
     f"write: angular_velocity = {RATES}"),
    (RATES, "[0.02 deg/s, -0.061 deg/s, 0.004 deg/s]", 26, "motion.angular_velocity",
     f"write: angular_velocity = {RATES}"),
    ("angular_velocity", "ω", 26, "motion.angular_velocity", f"write: angular_velocity = {RATES}"),
    (SPAN, "span = 0:1200", 27, "motion.span", "write: span = [0, 1200]"), ("axis = [0.0, -1.0, 0.02]",
                                                                            "axis = -y", 11, "wheels.axis",
                                                                            "write: axis = [0, -1, 0]"),
    ("[body]", "body:", 4, "body", "write: [body]"), ("[body]", "[body", 4, "body", "write: [body]"),
    ("[body]", "<body>", 4, "body", "write: [body]"),
    ("[[wheels]]", "[[wheels]", 9, "wheels", "write: [[wheels]]"),
    # tables and keys
    ("[body]", "[Body]", 4, "Body", "write that in place of [Body]"), ("[body]", "[[body]]", 4, "body",
                                                                       "write [body] in single brackets"),
    ("[body]", "[spacecraft]", 4, "spacecraft", "it is written in [body]"), ("[motion]",
                                                                             "[initial_conditions]", 25,
                                                                             "initial_conditions",
                                                                             "[motion]"),
    ("mass = 640", "MASS = 640", 6, "body.MASS", "write mass = 640"), ("mass = 640", "mass_kg = 640", 6,
                                                                       "body.mass_kg",
                                                                       'write mass = "640 kg"'),
    ("mass = 640", "mass = [640]", 6, "body.mass", "write mass = 640"), ("mass = 640", "mass = true", 6,
                                                                         "body.mass", "take mass away"),
    ("centre_of_mass", "cg", 7, "body.cg", f"write {COM}"), (COM, "centre_of_mass = {x = 0.92, y = 0.013, z = -0.008}", 7, "body.centre_of_mass", f"write {COM}"),
    (COM, "centre_of_mass = [[0.92], [0.013], [-0.008]]", 7, "body.centre_of_mass", f"write {COM}"),
    (COM, 'centre_of_mass = "0.92 0.013 -0.008"', 7, "body.centre_of_mass", "write [0.92, 0.013, -0.008]"),
    (COM, "centre_of_mass = [0,92, 1,13, 2,18]", 7, "body.centre_of_mass",
     "write centre_of_mass = [0.92, 1.13, 2.18]"),
    (TENSOR, "412", 5, "body.inertia", "write inertia = [412, 412, 412]"), (TENSOR,
                                                                            "{Ixx = 412, Iyy = 297.5, Izz = 351.2}", 5, "body.inertia", "write inertia = [412, 297.5, 351.2]"),
    (TENSOR, "[412.0, -6.3, 11.8, -6.3, 297.5, 4.4, 11.8, 4.4, 351.2]", 5, "body.inertia",
     f"write three rows, inertia = {TENSOR}"),
    (FORCE, 'force = {value = 1, unit = "N"}', 18, "thrusters.force", 'write force = "1 N"'),
    ("stuck = true", 'stuck = "yes"', 20, "thrusters.stuck", "write stuck = true"), ("stuck = true",
                                                                                     "stuck = 1", 20,
                                                                                     "thrusters.stuck",
                                                                                     "write stuck = true"),
    ("stuck = true", "stuck_open = true", 20, "thrusters.stuck_open", "write stuck = true"), ("stuck = true",
                                                                                              "stuck", 20,
                                                                                              "thrusters.stuck", "write: stuck = true"),
    (RATE, "rate_deg = 6", 23, "limits.rate_deg", f"write {RATE}"), (RATE, 'energy = "6 J"', 23,
                                                                     "limits.energy",
                                                                     "stabilab when --energy"),
    (SPAN, "span = 1200", 27, "motion.span", "write span = [0, 1200]"), (SPAN, 'duration = "20 min"', 27,
                                                                         "motion.duration", f"write {SPAN}"),
    (SPAN, "span = [1200, 0]", 27, "motion.span", "write the start of the motion first"),
    (f"angular_velocity = {RATES}", "wx = 0.1\nwy = 0.2\nwz = 0.3", 26, "motion.wx",
     "write angular_velocity = [0.1, 0.2, 0.3]"),
    (WHEEL, "rpm = 6000\ninertia = 0.02", 12, "wheels.rpm", 'write speed = "6000 rpm"'), (WHEEL, "h = 14", 12,
                                                                                          "wheels.h",
                                                                                          "write momentum = 14"),
    ("axis = [0.0, -1.0, 0.02]", 'axis = "-y"', 11, "wheels.axis", "write axis = [0, -1, 0]"),
    (BASE, f"{BASE}[effects]\ngyrostat = [0, 0, 1]\n", 29, "effects.gyrostat",
     "write [effects.gyrostat] and below it momentum = [0, 0, 1]"),
    (BASE, f"{BASE}[effects.constant_torque]\ntorque = 1\n", 29, "effects.constant_torque.torque",
     "torque = [0, 0, 1]"),
    (BASE, f"{BASE}[effects.drag]\ncoefficient = 1\n", 28, "effects.drag", "[effects.resistance]"),
    (BASE, f"{BASE}[effects.gravity_gradient]\n", 28, "effects.gravity_gradient", "[circular_orbit]"),
    (BASE, f"{BASE}[[effects.gyrostat]]\nmomentum = [0, 0, 1]\n", 28, "effects.gyrostat",
     "in single brackets"),
    (BASE, f"{BASE}[effects.eddy_currents]\nk = 1\nB = 1\n", 29, "effects.eddy_currents.k",
     "write coefficient = 1"),
    (BASE, f"{BASE}[effects.wheel_motor]\nu = [0, 0, 1]\n", 29, "effects.wheel_motor.u",
     "write torque = [0, 0, 1]"),
    (BASE, f"{BASE}[effects.liquid_cavity]\nrho = 1\nviscosity = 1\nradius = 1\n", 29,
     "effects.liquid_cavity.rho", "write density = 1"),
    (BASE, f"{BASE}[effects.viscous_damper]\ninertia = 0.1\nc = 0.1\n", 30, "effects.viscous_damper.c",
     "write coefficient = 0.1"),
    (BASE, f"{BASE}[effects.gravity]\nmass = 1\ncentre_of_mass = [0, 0, 1]\n", 28, "effects.gravity",
     "weight is missing"),
    (BASE, f"{BASE}[effects.charge]\nq = 1\nB = 1\nl = 1\nangle = 0\n", 29, "effects.charge.q",
     "write charge = 1"),
    (BASE, f"{BASE}[effects.gyrostat]\n", 28, "effects.gyrostat", "momentum is missing: add it, in N m s"),
    (BASE, f"{BASE}[output]\nunits = 'degrees'\n", 29, "output.units", 'write units = "deg"'),
    (BASE, f"omega = [0, 0, 1]\n{BASE}", 1, "omega",
     "it is written in [motion]: write angular_velocity = [0, 0, 1]"),
    (BASE, f"{BASE}mass = 3\n", 28, "motion.mass", "it is written in [body]"),
    (BASE, '{"body": {"inertia": [3, 2, 1]}}', 1, "", "stabilab import FILE"),
    (BASE, '<?xml version="1.0"?>\n<robot name="sat"></robot>\n', 1, "",
     "this seems to be a robot description; `stabilab import FILE"),
    (BASE, "CCSDS_APM_VERS = 2.0\nCREATION_DATE = 2026-01-01T00:00:00\nORIGINATOR = TEST\n", 3, "",
     "CCSDS attitude parameter message"),
    (BASE, "name,Ixx,Iyy,Izz\nsat,100,120,180\n", 1, "", "a table of bodies; `stabilab import FILE"),
]


def mistaken(old, new):
    assert old in BASE
    return BASE.replace(old, new) if old in ("\n", " = ") else BASE.replace(old, new, 1)


@pytest.mark.parametrize("old, new, line, key, words", [
    pytest.param(*row, id=row[1][-40:]) for row in FIFTY_FIVE + MORE if row[2] != READ])
def test_the_first_line_of_the_answer_says_where_and_what_to_write(old, new, line, key, words):
    with pytest.raises(CaseError) as caught:
        read_text("my.toml", mistaken(old, new))
    first = str(caught.value).split("\n")[0]
    where = f"my.toml{'' if line is None else f':{line}'}: {key and f'{key}: '}"
    assert first.startswith(where) and words in first, first


@pytest.mark.parametrize("old, new", [pytest.param(*row[:2], id=row[1][-40:]) for row in FIFTY_FIVE + MORE
                                      if row[2] == READ])
def test_what_has_one_meaning_is_read(old, new):
    assert read_text("my.toml", mistaken(old, new)).scene


def test_letters_of_another_code_are_refused_with_their_line(tmp_path, case):
    with pytest.raises(CaseError, match="my.toml:2: byte 0xfc is not UTF-8; save the file as UTF-8"):
        case(BASE.replace("EO satellite", "Satellit für").encode("latin-1"))


@pytest.mark.parametrize("old, new, line", [pytest.param(*row[:3],
                                                         id=row[1][-40:]) for row in FIFTY_FIVE + MORE
                                            if "write: " in row[-1] and "\n" not in row[0]])
def test_the_line_that_is_offered_makes_the_case_that_was_meant(old, new, line):
    """Put in place of the wrong line it is read; and where it is the line of the case, it is that case."""
    text = mistaken(old, new)
    with pytest.raises(CaseError) as caught:
        read_text("my.toml", text)
    offered = re.search(r"; write: (.*) \(", caught.value.problems[0].message)[1]
    rows, count = text.split("\n"), 1 + new.count("\n") - new.startswith("// kg")
    rows[line - 1:line - 1 + count] = offered.split("; on a line of its own ")
    if "x = 3" in new:
        rows.remove("x = 3")
    assert read_text("my.toml", "\n".join(rows)).scene.body.mass
    if offered in BASE.split("\n"):
        assert "\n".join(rows).replace("# kg\n", "") == BASE


@pytest.mark.parametrize("option, text, words", [
    ("--component", "y = 0 deg/s", 'when(events=["omega2"], until="10 min")'),
    ("--component", "y = -3 deg/s", 'write "y = 3 deg/s"'), ("--rate", "-6 deg/s", 'write "6 deg/s"'),
    ("--component", "x 30 deg/s", 'write "x = 30 deg/s"'), ("--component", "|wz| < 3 deg/s",
                                                            'write "z = 3 deg/s"'),
    ("--component", "30 deg/s", 'write "x = 30 deg/s" or "y = 30 deg/s" or "z = 30 deg/s"'),
    ("--tilt", "20deg", 'as in "z = 20 deg"'), ("--rate", "10 deg",
                                                "an angular velocity is in deg/s or rad/s"),
    ("--rate", "10,5 deg/s", 'write "10.5 deg/s"'), ("--until", "10 m", "min is a minute")])
def test_a_limit_on_the_command_line_that_is_none_names_what_to_write(stabilab, case_file, option, text,
                                                                      words):
    code, out, err = stabilab("when", case_file(BASE, "my"), option, text)
    assert code == 2 and not out and err.startswith(f"{option}: ") and words in err
