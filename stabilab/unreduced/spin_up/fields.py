"""The forms in which a scene's spin-up can be certified, and the scene in its natural units."""
from __future__ import annotations

import math
from functools import cached_property, lru_cache

import numpy as np

from ...integrate.motion_units import in_unit
from .certificate import HIGH_ORDERS, HIGHEST_ORDERS, ORDERS, Certifier
from .compiled.door import fast_certifier
from .fixed_centre import FixedCentre
from .form import forms_of
from .moving_centre import moving_centre
from .symmetric import equatorial

MOVING_ORDERS = ((4, 6),)
LAST_ORDERS = (8, 10)  # about the moving centre, asked last and seldom: making it takes a tenth of a second
EQUATORIAL_ORDERS = ((2, 4), (4, 6))


@lru_cache(maxsize=32)
def natural(scene):
    """(scene in natural units, unit of rates): powers of two near the mean moment and near the root of torque over moment. Kept, for
    a certificate and its proof ask for it in turn."""
    if scene.variables == "scaled":
        torque, mass = max(map(abs, scene.exact_mu)), 1
    else:
        torque, mass = max(map(abs, scene.vector("constant_torque"))), sum(scene.body.exact) / 3
    if not torque:
        return scene, 1.0
    weight = 2.0 ** round(_log2(mass))
    unit = 2.0 ** round((_log2(torque) - _log2(mass)) / 2)
    return scene if unit == weight == 1 else in_unit(scene, unit, weight), unit


def _log2(value):
    return math.log2(value.numerator) - math.log2(value.denominator) if hasattr(value, "numerator") else math.log2(value)


class Tests:
    """The certificates of a scene (in natural units), each made when it is first asked for.

    often: those of low order; high: with high orders about the fixed centre; all: with the highest, and the moving centre where a wheel takes
    it elsewhere; last: with those that take long to make. Each is a prefix of the next. asked: those that were.
    """

    def __init__(self, scene):
        self.scene, self.forms, round_ = scene, forms_of(scene), equatorial(scene)
        self.fixed = [FixedCentre(form) for form in self.forms]
        self.equatorial = [round_] if round_ else []
        self.made, self.asked = {}, []
        low = [(field, orders) for field in self.fixed for orders in ORDERS]
        self.often = low + [(field, EQUATORIAL_ORDERS[0]) for field in self.equatorial]
        self.high = self.often + [(field, orders) for field in self.fixed for orders in HIGH_ORDERS]

    @cached_property
    def moving(self):
        found = (moving_centre(form, self.scene) for form in self.forms)
        return [moving for moving in found if moving]

    @cached_property
    def all(self):
        wheeled = [field for field in self.moving if field.wheeled]  # the centre moves far where there is a wheel
        return (self.high + [(field, orders) for fields, all_ in ((self.fixed, HIGHEST_ORDERS), (wheeled, MOVING_ORDERS))
                             for field in fields for orders in all_] +
                [(field, EQUATORIAL_ORDERS[1]) for field in self.equatorial])

    @cached_property
    def last(self):
        still = [(field, orders) for field in self.moving if not field.wheeled for orders in MOVING_ORDERS]
        return self.all + still + [(field, LAST_ORDERS) for field in self.moving]

    def __bool__(self):
        return bool(self.often)

    def certifier(self, field, orders, fast: bool = False):
        """The test itself; fast: by compiled loops."""
        key = id(field), orders, fast
        if key not in self.made:
            if (field, orders) not in self.asked:  # before it is made: another thread that finds it made looks for its number
                self.asked.append((field, orders))
            with np.errstate(all="ignore"):  # what overflows is not finite, and certifies nothing
                self.made[key] = (fast_certifier if fast else Certifier)(field, orders)
        return self.made[key]


@lru_cache(maxsize=32)
def tests_of(scene) -> Tests:
    """The tests of a scene, kept for the next state of the same one."""
    return Tests(scene)
