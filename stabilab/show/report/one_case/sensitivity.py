"""What little change of state, wheel, torque or its direction gives the motion another fate."""
from __future__ import annotations

import math

from ....answers.stuck.ask import stuck
from ....case.limit_options import stated_limit
from ....errors import InputError
from ....orbit.potential import potential
from ....orbit.reduction import reduce
from ....physics.coefficients import effective
from ... import limiting
from ...text.stuck import holds_for, merged
from ...text.when import asked
from .measures import spoken, told, vector

UNITS = {"wheel": "N m s", "torque": "N m"}
ROUNDING = 1e-12  # of a unit vector from the difference of two states of doubles that are no nearer than a thousandth of their size
OF = {"rate": "rates at the start", "wheel": "wheel momentum", "torque": "torque"}


def sensitivity(case, motion, measures) -> dict:
    """Rows (what changes, by how much, in which direction, what is to be said) and sentences on wheels, thrusters and a tilt of the torque.

    A tilt is that which the motion has been asked with; where it has not, the command that does so is named. An empty table comes with the reason.
    """
    found: dict = {"rows": [], "words": [], "reason": ""}
    try:
        answer = stuck(case)
    except InputError as error:
        found["rows"] = _of_motion(case.scene, motion, measures)
        found["reason"] = f"No margin of wheel or torque: {measures.reason(str(error))}."
        return found
    row = answer.rows[0]
    known = {name: margin for name, margin in row.margins.items() if margin.size is not None}
    found["rows"] = [_margin(name, margin, measures) for name, margin in known.items()]
    why: dict[str, list] = {}
    for name, margin in row.margins.items():
        if name not in known:
            why.setdefault(margin.because, []).append(OF[name])
    found["reason"] = " ".join(f"No margin in {_any_of(names)}: {measures.reason(because)}." for because, names in why.items())
    found["words"] = [_wheel(wheel) for wheel in row.wheels] + [_helper(helper, measures) for helper in row.helpers]
    if row.time_to_limit:
        limit = spoken(asked(stated_limit(case), measures.units))
        found["words"].insert(0, f"The limit of the case, {limit}, is reached after {_between_times(row.time_to_limit, measures)} ({row.time_level}).")
    found["words"] += _tilt(motion if motion.tilt else row, measures)
    return found


def _between_times(pair, measures):
    low, high = map(measures.time, pair)
    return low if low == high else f"{low} to {high}"


def _any_of(names) -> str:
    """a, b or c."""
    return " or ".join(filter(None, [", ".join(names[:-1]), names[-1]]))


def _beyond(scene) -> str:
    """What is to be said of the margin of a motion where the other side of every separatrix is bounded as well."""
    reduced = reduce(effective(scene))
    if reduced is None or not reduced.geometry.centred or not (reduced.sense == 0 or potential(reduced).walled):
        return ""
    return "this does not change the fate: beyond the separatrix motions are bounded too, about other centres or round the axis"


def _of_motion(scene, motion, measures):
    """The margin that the motion itself has, where nothing more can be asked."""
    if motion.margin_velocity is None or motion.velocity_witness is None:
        return []
    change = [b - a for a, b in zip(motion.at[:3], motion.velocity_witness)]
    size = math.hypot(*change)
    return [{"what": OF["rate"], "size": measures.rate(motion.margin_velocity), "direction": _direction([v / size for v in change]) if size else "",
             "because": "; ".join(filter(None, [measures.reason(motion.velocity_because), _beyond(scene)]))}]


def _margin(name, margin, measures):
    size = "" if margin.size is None else measures.rate(margin.size) if name == "rate" else told(margin.size, UNITS[name])
    return {"what": OF[name], "size": size, "direction": _direction(margin.direction) if margin.direction else "",
            "because": spoken(holds_for(name, margin, measures.units))}


def _direction(unit_vector):
    """A direction; what the difference of two states leaves of a component that is zero, by rounding, is told as zero."""
    return vector([0.0 if abs(v) < ROUNDING else v for v in unit_vector])


def _wheel(wheel):
    now = f"Wheel {wheel.wheel} has {told(wheel.now, 'N m s')}"
    if not wheel.keeps_bounded:
        return f"{now}: no momentum of it is known to keep the motion bounded ({wheel.because})."
    momenta = " or ".join(map(_between, merged(wheel.keeps_bounded)))
    return f"{now}; the motion is bounded for a momentum {momenta} ({wheel.because})."


def _between(part):
    low, high, without = part
    return _range(low, high) + "".join(f" but {told(s, 'N m s')}" for s in without)


def _range(low, high):
    if math.isinf(low) and math.isinf(high):
        return "of any size"
    if math.isinf(low) or math.isinf(high):
        return f"up to {told(high, 'N m s')}" if math.isinf(low) else f"from {told(low, 'N m s')} on"
    return f"of {told(low)} to {told(high, 'N m s')}"


def _helper(helper, measures):
    share = " and ".join(f"{name} for {told(100 * duty, digits=3)} % of the time" for name, duty in zip(helper.thrusters, helper.duty))
    left = "no torque" if helper.effect == "zero" else told(helper.torque_left, "N m")
    time = f"; the limit then comes at {measures.time(helper.time_to_limit[0])}" if helper.time_to_limit else ""
    return f"With {share}, {left} is left in the mean: {helper.fate}{time}{'. That does not help' if helper.effect == 'none' else ''}."


def _tilt(answer, measures):
    """What a tilt of the torque does; answer: what was asked with it."""
    found, words = answer.tilt, [f"{spoken(limiting.words(one, measures.units))}." for one in answer.caveats if one.kind == "tilt"]
    told = [("This " if one.startswith("holds") else "") + one for one in words]
    if found is None:
        return [f"{one} `stabilab fate CASE --tilt \"1 deg\"` says what a tilt does." for one in told]
    return told if found.ranges else [*told, f"No torque tilted by up to {found.angle * 180 / math.pi:.4g}° reaches {measures.rate(found.limit)} before "
                                             f"{measures.time(found.not_before)} (proved)."]
