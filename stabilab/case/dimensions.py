"""What each number of a case file measures: dotted key -> dimension; a key that is not here is a number without a unit."""
from __future__ import annotations

from . import units as u

DIMENSIONS = {
    "body.inertia": u.INERTIA, "body.products.xy": u.INERTIA, "body.products.xz": u.INERTIA, "body.products.yz": u.INERTIA,
    "body.mass": u.MASS, "body.centre_of_mass": u.LENGTH,
    "thrusters.position": u.LENGTH, "thrusters.force": u.FORCE, "thrusters.force_tolerance": u.FORCE, "thrusters.misalignment": u.ANGLE,
    "wheels.momentum": u.MOMENTUM, "wheels.inertia": u.INERTIA, "wheels.speed": u.RATE,
    "limits.rate": u.RATE, "motion.angular_velocity": u.RATE, "motion.span": u.TIME, "motion.attitude": u.ANGLE,
    "motion.velocity": u.VELOCITY, "motion.position": u.LENGTH, "expect.period": u.TIME,
    "effects.gyrostat.momentum": u.MOMENTUM, "effects.constant_torque.torque": u.TORQUE, "effects.body_force.force": u.FORCE,
    "effects.gravity.weight": u.FORCE, "effects.gravity.centre_of_mass": u.LENGTH, "effects.resistance.coefficient": u.PER_SECOND,
    "effects.newtonian_field.strength": u.PER_SECOND_2, "effects.newtonian_field.lambda": u.ATTRACTION, "effects.newtonian_field.R": u.LENGTH,
    "effects.charge.charge": u.CHARGE, "effects.charge.field": u.FLUX, "effects.charge.arm": u.LENGTH, "effects.charge.angle": u.ANGLE,
    "effects.liquid_cavity.density": u.DENSITY, "effects.liquid_cavity.viscosity": u.VISCOSITY, "effects.liquid_cavity.P0": u.LENGTH_7,
    "effects.liquid_cavity.radius": u.LENGTH,
}


def dimension_of(path: tuple) -> u.Dimension:
    """The dimension of the number at this path (list indices do not count)."""
    return DIMENSIONS.get(".".join(key for key in path if isinstance(key, str)), u.NONE)
