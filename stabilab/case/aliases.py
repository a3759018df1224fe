"""Names that people give to the tables and keys of a case, and what stands for each."""
from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from typing import Any

LISTS = ("thrusters", "wheels")  # tables that come several times
LONGEST = 90  # letters of a value that is written out in a cure

# title of a table in other programs, without blanks and in small letters: its title here
SECTIONS = {
    **dict.fromkeys(("body", "rigidbody", "spacecraft", "satellite", "hub", "craft", "bus", "vehicle",
                     "massproperties",
                     "mass", "bodies", "inertia", "tensor"), "body"),
    **dict.fromkeys(("thruster", "thrusters", "jets", "jet", "engines", "engine", "rcs"), "thrusters"),
    **dict.fromkeys(("wheel", "wheels", "reactionwheels", "reactionwheel", "rw", "rws", "momentumwheel",
                     "flywheel",
                     "rotor", "rotors"), "wheels"),
    **dict.fromkeys(("motion", "initial", "initialconditions", "initialstate", "ic", "ics", "state", "start",
                     "initialrates", "rates", "attitude", "simulation", "sim", "time", "integration", "run"),
                    "motion"),
    **dict.fromkeys(("limit", "limits", "constraints", "constraint", "bounds"), "limits"),
    **dict.fromkeys(("orbit", "circularorbit", "orbits"), "circular_orbit"),
    **dict.fromkeys(("units", "output", "print", "display"), "output"),
    **dict.fromkeys(("effect", "effects", "torques", "disturbances", "perturbations", "environment"),
                    "effects"),
    "scaled": "scaled", "sweep": "sweep", "expect": "expect"}

# An effect's name elsewhere: its name here, or in words what stands for it.
EFFECTS = {
    **dict.fromkeys(("torque", "constanttorque", "externaltorque", "disturbancetorque", "bodytorque",
                     "moment",
                     "bodyfixedtorque"), "constant_torque"),
    **dict.fromkeys(("gyro", "gyrostat", "rotor", "gyrostaticmoment", "wheelmomentum", "internalmomentum",
                     "momentumbias"), "gyrostat"),
    **dict.fromkeys(("wheelmotor", "motor", "wheeltorque", "spinup"), "wheel_motor"),
    **dict.fromkeys(("weight", "gravitation", "heavytop", "top"), "gravity"),
    **dict.fromkeys(("drag", "friction", "airresistance", "medium", "viscousfriction", "lineardrag"),
                    "resistance"),
    **dict.fromkeys(("damper", "nutationdamper", "viscousdamper", "ballinfluid", "kane"), "viscous_damper"),
    **dict.fromkeys(("damping", "bdot", "ratedamping", "ratedamper", "detumble", "controller"),
                    "rate_damper"),
    **dict.fromkeys(("eddy", "eddycurrent", "eddycurrents", "magneticdamping", "magneticdamper",
                     "magneticfield"),
                    "eddy_currents"),
    **dict.fromkeys(("liquid", "fluid", "fuel", "slosh", "cavity", "tank", "propellant", "liquidcavity"),
                    "liquid_cavity"),
    **dict.fromkeys(("newtonian", "newtonianfield", "centralfield", "newtonfield"), "newtonian_field"),
    **dict.fromkeys(("force", "bodyforce", "externalforce", "thrust"), "body_force"),
    **dict.fromkeys(("charge", "electriccharge", "lorentz", "lorentzforce", "magnetic"), "charge"),
    **dict.fromkeys(("gravitygradient", "orbit", "circularorbit"),
                    "a gravity gradient is that of [circular_orbit], or [effects.newtonian_field]"),
    **dict.fromkeys(("thruster", "thrusters"), "a thruster is a table [[thrusters]] of its own"),
    **dict.fromkeys(("wheel", "wheels", "reactionwheel", "reactionwheels", "flywheel"),
                    "a wheel is a table [[wheels]] of its own, or the momentum of all is [effects.gyrostat] "
                    "momentum")}

_RATE = ("omega", "w", "w0", "omega0", "ω", "ω0", "rate", "rates", "angularrate", "angularrates", "bodyrates",
         "bodyrate", "angvel", "angularvel", "angularvelocities", "spin", "spinrate", "initialrate",
         "initialrates",
         "initialomega", "omegabn", "omegabnb", "rotation", "initialangularvelocity", "velocityangular",
         "state",
         "initial", "start", "p", "x0", "angularspeed", "rotationrate")
_TIME = ("time", "times", "duration", "tspan", "t", "tend", "tf", "tmax", "until", "length", "end", "stop",
         "simulationtime", "interval", "timespan", "stoptime", "endtime", "finaltime", "period")
_INERTIA = ("i", "j", "moi", "moments", "momentofinertia", "momentsofinertia", "inertiatensor",
            "inertiamatrix",
            "tensor", "principalmoments", "inertias", "ihubpntbcb", "tensorofinertia", "d", "ixxiyyizz")
_CENTRE = ("cm", "cg", "com", "cog", "centerofmass", "centreofgravity", "centerofgravity", "masscenter",
           "masscentre", "centre", "center", "rbcbb")

# table: {name elsewhere, without blanks: key here}
KEYS: dict[str, dict[str, str]] = {
    "body": dict.fromkeys(_INERTIA, "inertia") | dict.fromkeys(_CENTRE, "centre_of_mass")
    | dict.fromkeys(("m", "weight", "mhub", "bodymass", "totalmass", "drymass"), "mass"),
    "motion": dict.fromkeys(_RATE, "angular_velocity") | dict.fromkeys(_TIME, "span")
    | dict.fromkeys(("up", "down", "gamma", "nadir", "field", "gravity", "direction"), "vertical")
    | dict.fromkeys(("eulerangles", "angles", "euler", "rpy", "angle"), "attitude")
    | dict.fromkeys(("v", "v0", "linearvelocity"), "velocity")
    | dict.fromkeys(("r", "r0", "pos", "place"), "position"),
    "thrusters": dict.fromkeys(("pos", "location", "r", "place", "at", "point", "thrlocb", "arm"), "position")
    | dict.fromkeys(("dir", "axis", "vector", "orientation", "thrdirb", "unit", "forcedirection"),
                    "direction")
    | dict.fromkeys(("thrust", "f", "magnitude", "maxthrust", "strength", "size"), "force")
    | dict.fromkeys(("cone", "angle", "tilt", "pointingerror", "misalign", "alignment"), "misalignment")
    | dict.fromkeys(("tolerance", "uncertainty", "forceuncertainty", "error"), "force_tolerance")
    | dict.fromkeys(("label", "id"), "name")
    | dict.fromkeys(("on", "firing", "fires", "alwayson", "stuckon", "failed", "stuckopen", "open", "active",
                     "isstuck",
                     "enabled", "fails"), "stuck")
    | dict.fromkeys(("ton", "opens", "begin", "starttime"), "start")
    | dict.fromkeys(("toff", "closes", "end", "stoptime", "close"), "stop")
    | dict.fromkeys(("dutycycle", "dutyratio", "pwm"), "duty")
    | dict.fromkeys(("pulse", "pulsewidth", "ontime", "width"), "on_time")
    | dict.fromkeys(("thrustprofile", "thrustcurve", "levels", "throttle"), "profile")
    | dict.fromkeys(("fuel", "fuelmass", "propellantmass"), "propellant")
    | dict.fromkeys(("mdot", "flow", "massflow", "massflowrate"), "mass_flow"),
    "wheels": dict.fromkeys(("direction", "dir", "spinaxis", "gshatb", "vector", "orientation"), "axis")
    | dict.fromkeys(("h", "angularmomentum", "storedmomentum", "bias"), "momentum")
    | dict.fromkeys(("i", "j", "js", "moi", "momentofinertia", "rotorinertia"), "inertia")
    | dict.fromkeys(("rpm", "rate", "omega", "spin", "spinrate", "w", "angularvelocity", "wheelspeed"),
                    "speed")
    | dict.fromkeys(("label", "id"), "name"),
    "limits": dict.fromkeys(("omega", "maxomega", "omegamax", "max", "limit", "spin", "maxspin",
                             "angularvelocity",
                             "maxangularvelocity", "component", "components", "speed", "w", "ratemax"),
                            "rate"),
    "circular_orbit": dict.fromkeys(("height", "h", "alt"), "altitude")
    | dict.fromkeys(("semimajoraxis", "a", "sma", "r", "distance"), "radius")
    | dict.fromkeys(("n", "meanmotion", "omega", "orbitalrate", "w0", "angularvelocity"), "rate")
    | dict.fromkeys(("t", "orbitalperiod"), "period"),
    "output": dict.fromkeys(("unit", "system", "angles", "rates"), "units"),
    "effects.gyrostat": dict.fromkeys(("h", "wheel", "vector", "value", "angularmomentum", "gyrostaticmoment",
                                       "hw", "rotor"), "momentum"),
    "effects.constant_torque": dict.fromkeys(("value", "vector", "moment", "m", "t", "tau", "torquevector"),
                                             "torque"),
    "effects.body_force": dict.fromkeys(("value", "vector", "f", "thrust"), "force"),
    "effects.gravity": dict.fromkeys(_CENTRE, "centre_of_mass") | dict.fromkeys(("force", "w", "mg"),
                                                                                "weight"),
    "effects.resistance": dict.fromkeys(("c", "k", "value", "damping", "drag"), "coefficient"),
    "effects.rate_damper": dict.fromkeys(("c", "k", "gain", "value", "damping", "matrix"), "coefficient"),
    "effects.viscous_damper": dict.fromkeys(("c", "k", "mu", "damping", "viscosity"), "coefficient")
    | dict.fromkeys(("i", "j", "moi", "moment", "sphere"), "inertia"),
    "effects.eddy_currents": dict.fromkeys(("k", "c", "conductivity"), "coefficient") | dict.fromkeys(("b",),
                                                                                                      "field"),
    "effects.wheel_motor": dict.fromkeys(("u", "motor", "value", "vector"), "torque")
    | dict.fromkeys(("time", "t", "for"), "duration"),
    "effects.liquid_cavity": dict.fromkeys(("rho",), "density") | dict.fromkeys(("nu", "kinematicviscosity"),
                                                                                "viscosity")
    | dict.fromkeys(("r", "a"), "radius") | dict.fromkeys(("law", "model"), "torque"),
    "effects.newtonian_field": dict.fromkeys(("n", "value"), "strength") | dict.fromkeys(("mu", "gm"),
                                                                                         "lambda")
    | dict.fromkeys(("r", "distance", "radius"), "R"),
    "effects.charge": dict.fromkeys(("q",), "charge") | dict.fromkeys(("b",), "field")
    | dict.fromkeys(("l", "length", "distance"), "arm")}

ROTATIONS = ("quaternion", "quat", "q", "q0", "q_bn", "dcm", "rotationmatrix", "mrp", "sigma", "sigmabn",
             "attitudequaternion",
             "qbn", "initialquaternion", "orientation")
ATTITUDE = ("take it away where no torque depends on the attitude; else write attitude = [psi, phi, theta], "
            "the angles of "
            'the 3-1-2 sequence, such as attitude = ["10 deg", 0, 0], and vertical = [x, y, z], the '
            'direction of '
            "inertial axis 3 in the body")
SAY_ELSE = {  # (table, name without blanks): in words what to write
    ("wheels", "torque"): "write [effects.wheel_motor] torque = [x, y, z] in N m, with its duration",
    ("thrusters",
     "torque"): "write [effects.constant_torque] torque = [x, y, z] in N m in place of the thruster",
    ("thrusters", "duration"): 'write start = 0 and stop = "12 s"',
    ("thrusters", "burntime"): 'write start = 0 and stop = "12 s"',
    ("thrusters",
     "isp"): 'write mass_flow, which is the force over Isp times 9.80665 m/s^2, such as "0.5 g/s"',
    ("thrusters", "mass"): "the mass is that of the whole craft, [body] mass",
    ("limits", "energy"): 'no key of a file: ask `stabilab when --energy "5 J"`',
    ("limits", "tilt"): 'no key of a file: ask `stabilab when --tilt "z = 20 deg"`',
    ("limits", "angle"): 'no key of a file: ask `stabilab when --tilt "z = 20 deg"`',
    ("limits", "time"): 'no key of a file: ask `stabilab when --until "10 min"`',
    ("motion", "energy"): "write angular_velocity = [x, y, z], which has it",
    ("motion", "momentum"): "write angular_velocity = [x, y, z] of the body, and the wheels in [[wheels]]",
    ("motion", "angularmomentum"): "write angular_velocity = [x, y, z], from which it follows",
    ("motion", "dt"): "take it away: steps are chosen by the error",
    ("motion", "step"): "take it away: steps are chosen by the error",
    ("motion", "timestep"): "take it away: steps are chosen by the error",
    ("motion", "tolerance"): "take it away: steps are chosen by the error",
    ("circular_orbit", "eccentricity"): "take it away: orbits here are circular",
    ("circular_orbit", "e"): "take it away: orbits here are circular",
    ("circular_orbit", "inclination"): "take it away: the answer does not depend on it",
    ("body", "density"): "write inertia and mass",
    ("body",
     "dimensions"): "write inertia = [x, y, z], which has them: of a box m/12 times the sums of two squared "
                    "edges",
    ("body",
     "units"): 'write the unit with each number, such as "412 kg m^2"; [output] units is that of answers',
    ("effects.gravity", "g"): "write weight, the mass times g, in N",
    ("effects.gravity", "mass"): "write weight, the mass times g, in N",
    ("effects.gyrostat", "axis"): "write momentum = [x, y, z], or [[wheels]] with axis and momentum",
    ("effects.gyrostat", "speed"): "write momentum = [x, y, z], or [[wheels]] with axis, inertia and speed",
    ("effects.gyrostat", "inertia"): "write momentum = [x, y, z], or [[wheels]] with axis, inertia and speed",
    ("effects.constant_torque", "axis"): "write torque = [x, y, z] in N m",
    ("effects.constant_torque", "direction"): "write torque = [x, y, z] in N m",
    ("effects.constant_torque",
     "duration"): "a torque acts for ever; one that ends is that of [[thrusters]] with stop",
    ("effects.eddy_currents", "direction"): "the direction of the field is [motion] vertical",
}
ENTRIES = {f"{a}{b}{c}": b + c for a in ("i", "j", "") for b in "xyz" for c in "xyz"} | {
    f"i{n}{m}": "xyz"[n - 1] + "xyz"[m - 1] for n in (1, 2, 3) for m in (1, 2, 3)} | {
    f"i{n}": "xyz"[n - 1] * 2 for n in (1, 2, 3)} | {f"d{n}": "xyz"[n - 1] * 2 for n in (1, 2, 3)} | {
    f"j{n}": "xyz"[n - 1] * 2 for n in (1, 2, 3)} | {"ix": "xx", "iy": "yy", "iz": "zz", "a": "xx", "b": "yy",
                                                     "c": "zz"}
PARTS = {f"{word}{n}": (word, "xyz".index(n)) for word in ("omega", "w", "ω", "rate", "") for n in "xyz"} | {
    f"{word}{n + 1}": (word, n) for word in ("omega", "w", "ω", "rate") for n in range(3)} | {
    "p": ("", 0), "q": ("", 1), "r": ("", 2)}
UNITS = {"deg": "deg", "degs": "deg/s", "dps": "deg/s", "degps": "deg/s", "degpers": "deg/s", "rads": "rad/s",
         "radps": "rad/s",
         "rpm": "rpm", "kg": "kg", "kgm2": "kg m^2", "n": "N", "nm": "N m", "nms": "N m s", "mm": "mm",
         "km": "km", "m": "m",
         "s": "s", "sec": "s", "min": "min", "h": "h", "g": "g", "percent": "%", "pct": "%", "mn": "mN",
         "mnm": "mN m",
         "mnms": "mN m s", "rad": "rad", "gmm2": "g mm^2", "kgmm2": "kg mm^2", "lbf": "lbf", "cm": "cm"}
UNIFORM = {"omega": "angular_velocity", "ω": "angular_velocity", "angularvelocity": "angular_velocity",
           "centreofmass": "centre_of_mass", "centerofmass": "centre_of_mass", "massflow": "mass_flow",
           "ontime": "on_time", "forcetolerance": "force_tolerance", "circularorbit": "circular_orbit"}


LETTERS = str.maketrans("Ω₁₂₃", "ω123")


RATES = ("rate", "angular_velocity", "speed", "damper")  # keys of angular velocities


def bare(name: str) -> str:
    """A name in small letters, without blanks, underscores and signs."""
    return re.sub(r"[^a-z0-9ω]", "", name.lower().translate(LETTERS))


def named(key: str) -> str:
    """The key of a case that is written with blanks, hyphens or a Greek letter; any other as it is."""
    key = key.strip(" \"'")
    return UNIFORM.get(bare(key), key) if not re.fullmatch(r"[A-Za-z0-9_.]+", key) else key


def cure_of_key(path: tuple[Any, ...], key: str, data: dict[str, Any],
                allowed: Sequence[str] | Mapping[str, tuple[str, str]]) -> str:
    """What to write in place of a key that is not known, with its value; "" where nothing is known. path: of
    its table; data: that table."""
    table, name, value = ".".join(p for p in path if isinstance(p, str)), bare(key), data[key]
    if not table:
        return _cure_of_table(key, name, value)
    if table == "effects":
        settled = EFFECTS.get(name)
        return "" if not settled else settled if " " in settled else f"it is written in [effects.{settled}]"
    if (table, name) in SAY_ELSE:
        return SAY_ELSE[table, name]
    if table == "body" and name in ENTRIES and not isinstance(value, (list, dict)):
        return cure_of_tensor(data)
    if table == "body" and name in ("products", "productsofinertia", "poi"):
        return 'write products = {xy = .., xz = .., yz = .., convention = "positive"}, or "negative"'
    if table == "motion" and name in ROTATIONS:
        return ATTITUDE
    if table == "motion" and name in PARTS and not isinstance(value, (list, dict)):
        return _rates(data)
    result = _key(table, name, allowed)
    if result:
        return _line(result, value, "rpm" if name == "rpm" else "")
    for suffix, unit in sorted(UNITS.items(), key=lambda pair: -len(pair[0])):
        result = _key(table, name.removesuffix(suffix),
                     allowed) if name.endswith(suffix) and name != suffix else ""
        if result:
            return _line(result, value, f"{unit}/s" if result in RATES and unit in ("deg", "rad") else unit)
    return ""


def misnamed(path: tuple[Any, ...], key: str, data: dict[str, Any], *wanted: str) -> bool:
    """Whether a key that is not known stands for one of these, which are missing."""
    name, table = bare(key), ".".join(p for p in path if isinstance(p, str))
    wanted = tuple(item for item in wanted if item not in data)
    if not wanted or key in wanted:
        return False
    if not table:
        titled = isinstance(data[key], dict) or of_rows(data[key])
        return (titled and SECTIONS.get(name) in wanted and key not in SECTIONS.values()
                or not titled and "body" in wanted and name in ("inertia", *_INERTIA))
    if table == "body" and "inertia" in wanted and name in ENTRIES and not isinstance(data[key], (list,
                                                                                                  dict)):
        return True
    if table == "limits" and (table, name) in SAY_ELSE:
        return True
    from difflib import get_close_matches
    if get_close_matches(key.lower()[:60], wanted, n=1, cutoff=0.6):
        return True
    return cure_of_key(path, key, data, wanted).startswith(tuple(f"write {item} =" for item in wanted))


def _key(table: str, name: str, allowed: Sequence[str] | Mapping[str, tuple[str, str]]) -> str:
    same = next((item for item in allowed if bare(item) == name), "")
    result = same or KEYS.get(table, {}).get(name, "")
    return result if result in allowed else ""


def _cure_of_table(key: str, name: str, value: Any) -> str:
    """Of a table or key at the top of a file."""
    titled = isinstance(value, dict) or of_rows(value)
    if titled and name in SECTIONS:
        came, title = f"[[{key}]]" if of_rows(value) else f"[{key}]", f"[{SECTIONS[name]}]"
        title = f"[{title}]" if SECTIONS[name] in LISTS else title
        return f"it is written in {title}: write that in place of {came}"
    if name in EFFECTS and " " not in EFFECTS[name] and isinstance(value, dict):
        first = next(iter(value.values()), None)
        inside = (f": torque = {shown(first)}" if EFFECTS[name] == "constant_torque" and isinstance(first,
                                                                                                    list)
                  else "")
        return f"it is written in [effects.{EFFECTS[name]}]{inside}"
    for table in ("motion", "body"):
        result = KEYS[table].get(name) if len(name) > 1 else None
        if result or name in ("angularvelocity", "span", "inertia", "mass"):
            home = "motion" if name in ("angularvelocity", "span") else "body" if not result else table
            return f"it is written in [{home}]: {_line(result or key.lower(), value, '')}"
    return ""


def of_rows(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value)


def _line(key: str, value: Any, unit: str) -> str:
    """A key with the value that came, in its unit."""
    if key == "span" and not isinstance(value, list):
        return f"write span = [0, {shown(value, unit)}]"
    if key == "stuck" and not isinstance(value, bool):
        return "write stuck = true"
    if key in ("angular_velocity", "torque", "axis", "direction", "position") and not isinstance(value, list):
        return f"write {key} = [x, y, z]"
    return f"write {key} = {shown(value, unit)}"


def shown(value: Any, unit: str = "") -> str:
    """A value as TOML has it, with a unit where it came without; ".." for a long one and for a table."""
    text = _written(value, unit)
    return text if len(text) <= LONGEST else "[..]" if isinstance(value, list) else ".."


def _written(value: Any, unit: str) -> str:
    if isinstance(value, list):
        return f"[{', '.join(_written(item, unit) for item in value)}]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{..}"
    number = type(value) is not str  # of a case, digits with a point come as a class of their own
    if number:
        return f'"{value} {unit}"' if unit else str(value)
    return json.dumps(value, ensure_ascii=False)


def cure_of_tensor(data: dict[str, Any]) -> str:
    """The tensor whose entries stand as keys of their own."""
    entries = {ENTRIES[bare(key)]: value for key, value in data.items() if bare(key) in ENTRIES}
    moments = [shown(entries.get(name, "..")).replace('".."', "..") for name in ("xx", "yy", "zz")]
    products = [name for name in ("xy", "xz", "yz") if name in entries]
    line = f"write inertia = [{', '.join(moments)}]"
    if not products:
        return line
    pairs = ", ".join(f"{name} = {shown(entries[name])}" for name in products)
    return (f'{line} and products = {{{pairs}, convention = "negative"}}, or "positive" where they are the '
            f"integrals of x y dm")


def _rates(data: dict[str, Any]) -> str:
    """The rates that stand as keys of their own."""
    parts = {PARTS[bare(key)][1]: value for key, value in data.items() if bare(key) in PARTS}
    return ("write angular_velocity = "
            f"[{', '.join(shown(parts[n]) if n in parts else '..' for n in range(3))}]")


