"""The linear motion of the charged axisymmetric body in arbitrary precision, straight from its differential
equations.

Euler's equations (1) of the paper with r = r0, kinematics (15), Newton's law (37) with the first-order
rotation: written as one linear system z' = A z of fourteen complex unknowns (products with E = e^(i theta)
are unknowns of their own) and solved by the matrix exponential of python-flint in ball arithmetic. No
frequency, no divided difference, no closed form.
"""
from __future__ import annotations

import math

INPUTS = ("D1", "D2", "D3", "r0", "lambda3", "k", "M1", "M2", "p0", "q0", "psi0", "phi0", "theta0",
          "f1", "f2", "f3", "m", "v1", "v2", "v3", "x1", "x2", "x3", "t")
OUTPUTS = ("p", "q", "psi", "phi", "G1", "G2", "v1", "v2", "v3", "x1", "x2", "x3")
ONE, E, PI, PIC, GAMMA, GAMMAC, V, W, U, VEL, POS, VEL3, POS3, POSC = range(14)
BITS = 520
STEP = -170  # binary exponent of the relative step of the difference quotients
def outputs(values: dict):
    """The twelve outputs as flint balls for inputs given as floats or balls."""
    from flint import acb, acb_mat, arb, ctx
    with ctx.workprec(BITS):
        x = {name: arb(values[name]) for name in INPUTS}
        i, half = acb(0, 1), acb(0.5)
        a_row = (((x["D3"] - x["D2"]) * x["r0"] + x["lambda3"] - x["k"]) / x["D1"])  # p' = M1/D1 - a_row q
        b_row = (((x["D3"] - x["D1"]) * x["r0"] + x["lambda3"] - x["k"]) / x["D2"])  # q' = M2/D2 + b_row p
        A, z = acb_mat(14, 14), acb_mat(14, 1)
        p_of, q_of = {PI: half, PIC: half}, {PI: -i / 2, PIC: i / 2}

        def set_row(row, entries):
            for column, value in entries:
                A[row, column] = A[row, column] + value

        def rates(row, sign, source, pi, pic):
            """p' + sign i q' with the unknowns pi, pic standing for p + iq, p - iq and `source` for 1."""
            names = {PI: pi, PIC: pic}
            set_row(row, [(source, x["M1"] / x["D1"] + sign * i * x["M2"] / x["D2"])])
            set_row(row, [(names[n], -a_row * c) for n, c in q_of.items()])
            set_row(row, [(names[n], sign * i * b_row * c) for n, c in p_of.items()])

        turn = i * x["r0"]
        rates(PI, 1, ONE, PI, PIC)
        rates(PIC, -1, ONE, PI, PIC)
        rates(V, 1, E, V, W)
        rates(W, -1, E, V, W)
        set_row(E, [(E, turn)])
        set_row(V, [(V, turn)])
        set_row(W, [(W, turn)])
        set_row(U, [(V, acb(1))])
        set_row(GAMMA, [(PI, acb(1)), (GAMMA, -turn)])
        set_row(GAMMAC, [(PIC, acb(1)), (GAMMAC, turn)])
        force = x["f1"] + i * x["f2"]
        set_row(VEL, [(E, force / x["m"]), (U, -i * x["f3"] / x["m"])])
        set_row(POS, [(VEL, acb(1))])
        psi, phi = {GAMMA: half, GAMMAC: half}, {GAMMA: -i / 2, GAMMAC: i / 2}
        set_row(VEL3, [(ONE, x["f3"] / x["m"])] + [(n, x["f2"] * c / x["m"]) for n, c in psi.items()]
                + [(n, -x["f1"] * c / x["m"]) for n, c in phi.items()])
        set_row(POS3, [(VEL3, acb(1))])
        start = {ONE: acb(1), E: acb(x["theta0"].cos(), x["theta0"].sin()), PI: x["p0"] + i * x["q0"],
                 PIC: x["p0"] - i * x["q0"],
                 GAMMA: x["psi0"] + i * x["phi0"], GAMMAC: x["psi0"] - i * x["phi0"],
                 VEL: x["v1"] + i * x["v2"],
                 POS: x["x1"] + i * x["x2"], VEL3: acb(x["v3"]), POS3: acb(x["x3"])}
        start |= {V: start[E] * start[PI], W: start[E] * start[PIC], U: start[E] * start[GAMMA]}
        for n, value in start.items():
            z[n, 0] = value
        y = (A * x["t"]).exp() * z
        total, difference = (x["D1"] + x["D2"]) / 2, (x["D1"] - x["D2"]) / 2
        G = total * y[V, 0] + difference * y[W, 0] - i * y[U, 0] * (x["D3"] * x["r0"] + x["lambda3"])
        result = []
        for value in (y[PI, 0], y[GAMMA, 0], G, y[VEL, 0]):
            result += [value.real, value.imag]
        return result + [y[VEL3, 0].real, y[POS, 0].real, y[POS, 0].imag, y[POS3, 0].real]


def conditioned(values: dict):
    """(exact, effect): the outputs, and for each the sum of the changes that half a unit in the last place of
    every input makes (difference quotients with a step of 2^-170)."""
    from flint import arb, ctx
    exact = outputs(values)
    with ctx.workprec(BITS):
        effect = [arb(0)] * len(exact)
        for name in INPUTS:
            if values[name]:
                step = arb(values[name]) * arb(2) ** STEP
                moved = outputs(values | {name: arb(values[name]) + step})
                half = math.ulp(values[name]) / 2
                effect = [e + abs((new - old) / step) * half for e, new, old in zip(effect, moved, exact)]
        for value, size in zip(exact, effect):
            assert float(value.rad()) <= 1e-12 * float(
                size.mid()) + 1e-300, "the balls are too wide: raise BITS"
    return exact, [float(size.mid()) for size in effect]
