"""A scene in its natural unit as the validated steps want it."""
from __future__ import annotations

import math
from fractions import Fraction

import numpy as np


def twofold(values):
    """Exact numbers, nested lists of them, as two arrays of doubles whose sum they are to 105 bits."""
    values = np.array(values, dtype=object)
    high = np.array([float(v) for v in values.ravel()])
    low = np.array([float(v - Fraction(h)) for v, h in zip(values.ravel(), high.tolist())])
    return high.reshape(values.shape), low.reshape(values.shape)


def rows_of(own):
    """(4, 3) exact numbers: kappa, rho, sigma, m of the rates."""
    form = own.quadratic()
    return [form.kappa, form.rho, form.sigma, form.m]


def energy_of(own):
    """(4,) roots of the moments, and the greatest rate at which the root of the sum of D omega^2 grows; zeros for scaled variables."""
    if own.variables == "scaled":
        return np.zeros(4)
    D, M = (np.array([float(v) for v in vector]) for vector in (own.body.exact, own.vector("constant_torque")))
    return np.append(np.sqrt(D), math.sqrt(float((M * M / D).sum())))
