"""Nutation and precession that `compare` tells are those of the motion asked for, not of the expansion's
periodic motion."""
from __future__ import annotations

import json

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab.case.read import load
from stabilab.integrate import events as extrema
from stabilab.theories.theory import theory
from tests.shared import CASES

A, C, WHEEL, WEIGHT, ARM = 0.9, 0.5, 0.3, 40.0, 0.2
# (omega, gamma) along the weight: across, with the weight up and down, on the way down, slow, upright but for
# a little
STARTS = [((0, 0, 20 * np.pi), (0.28, 0, -0.96)), ((0, 0, 20 * np.pi), (0.6, 0, 0.8)),
          ((1.5, -2, 40), (0, 0.8, -0.6)), ((-3, 1, 70), (0.8, 0.6, 0)),
          ((0, 2, 25), (-0.48, 0.6, 0.64)), ((0.1, 0.2, 90), (0.1, 0, -(0.99**0.5)))]
SPAN = 3.0


def top_file(folder, omega, gamma):
    path = folder / "case.toml"
    path.write_text(f"[body]\ninertia = [{A}, {A}, {C}]\n[effects.gyrostat]\nmomentum = [0, 0, "
                    f"{WHEEL}]\n[effects.gravity]\nweight = {WEIGHT}\n"
                    f"centre_of_mass = [0, 0, {ARM}]\n[motion]\nangular_velocity = "
                    f"{list(map(float, omega))}\nvertical = {list(map(float, gamma))}\n"
                    f"span = [0, {SPAN}]\n")
    return path


def by_the_cubic(omega, gamma):
    """(least, greatest) theta of Lagrange's top: u = gamma3 between the roots about its start of the cubic
    that energy, area integral and r give, A^2 u'^2 = 2 A (E + W h u) (1 - u^2) - (k - (C r + l) u)^2, by
    mpmath in 40 digits; none of the program's equations."""
    with mp.workdps(40):
        (p, q, r), g = map(mp.mpf, omega), [mp.mpf(float(v)) for v in gamma]
        a, weight, spin = mp.mpf(A), mp.mpf(WEIGHT) * mp.mpf(ARM), mp.mpf(C) * r + mp.mpf(WHEEL)
        E, k = a * (p * p + q * q) / 2 - weight * g[2], a * (p * g[0] + q * g[1]) + spin * g[2]
        roots = sorted(mp.re(u)
                       for u in mp.polyroots([-2 * a * weight, -2 * a * E - spin**2,
                                              2 * a * weight + 2 * k * spin, 2 * a * E - k * k],
                                                      maxsteps=500, extraprec=200)
                       if abs(mp.im(u)) < mp.mpf(10)**-15)
        low, high = ([u for u in roots if u <= g[2] + mp.mpf(10)**-15][-1],
                     [u for u in roots if u >= g[2] - mp.mpf(10)**-15][0])
        if low == high:  # a start at a turning point: the other one is the neighbour towards which u'' points
            n, slope = roots.index(low), mp.diff(lambda u: 2 * a * (E + weight * u) * (1 - u * u)
                                                 - (k - spin * u) ** 2, low)
            low, high = (low, roots[n + 1]) if slope > 0 else (roots[n - 1], low)
        return float(mp.acos(high)), float(mp.acos(low))


def by_a_run(omega, gamma):
    """The same and the mean of psi' by Euler-Poisson equations written here, psi' riding along, DOP853,
    20,000 samples."""
    def rates(_, y):
        p, q, r, x, y, z, _ = y.tolist()
        return [((A - C) * q * r - WHEEL * q - WEIGHT * ARM * y) / A,
                ((C - A) * p * r + WHEEL * p + WEIGHT * ARM * x) / A, 0.0,
                y * r - z * q, z * p - x * r, x * q - y * p, (p * x + q * y) / (1 - z * z)]
    run = solve_ivp(rates, (0, SPAN), [*omega, *gamma, 0.0], "DOP853", t_eval=np.linspace(0, SPAN, 20_001),
                    rtol=1e-11, atol=1e-12)
    theta = np.arctan2(np.hypot(*run.y[3:5]), run.y[5])
    return theta.min(), theta.max(), run.y[6, -1] / SPAN


@pytest.mark.parametrize("omega, gamma", STARTS)
def test_nutation_and_precession_are_those_of_the_motion(tmp_path, omega, gamma):
    rows = {row["about"]: row for row in theory(load(top_file(tmp_path, omega, gamma)))}
    least, greatest, mean = by_a_run(omega, gamma)
    told = rows["nutation"]["values"]
    assert (told["least"], told["greatest"]) == pytest.approx(by_the_cubic(omega, gamma), abs=1e-8)
    # a sample next to a turning point
    assert (told["least"], told["greatest"]) == pytest.approx((least, greatest), abs=2e-6)
    assert rows["mean precession"]["values"]["rate"] == pytest.approx(mean, rel=1e-5, abs=1e-6)
    assert all("of the exact motion over s in [0, 3]" in rows[name]["words"]
               for name in ("nutation", "mean precession"))


def test_a_top_that_starts_without_p_and_q_nutates(stabilab, tmp_path):
    path = top_file(tmp_path, *STARTS[0])
    out, low = stabilab("compare", path)[1], np.degrees(by_the_cubic(*STARTS[0])[0])
    assert f"between {low:.5g} deg and 163.74 deg" in out and low < 163.6
    row = next(row for row in json.loads(stabilab("compare", path, "--json")[1])["theory"]
               if row["about"] == "periodic motion")
    assert "through r and γ of the start" in out and "off it" in row["words"] and row["values"][
        "departure"] != [0, 0]


def test_without_a_compiler_the_turning_points_are_the_same(tmp_path, monkeypatch):
    case = load(top_file(tmp_path, *STARTS[2]))
    monkeypatch.setattr(extrema, "heyoka_available", lambda: False)
    told = {row["about"]: row for row in theory(case)}["nutation"]["values"]
    assert (told["least"], told["greatest"]) == pytest.approx(by_the_cubic(*STARTS[2]), abs=1e-8)


@pytest.mark.parametrize("name, of", [("charged-body", "in the linear model"),
                                      ("liquid-base", "of the averaged equations")])
def test_what_a_model_says_is_called_the_models(name, of):
    rows = [row for row in theory(load(CASES / f"{name}.toml")) if row["values"]]
    assert rows and all(of in row["words"] for row in rows)
    if name == "charged-body":  # its tilt outgrows small angles by far
        assert all("not of the exact motion" in row["words"] for row in rows
                   if row["about"] in ("mean pointing", "velocity", "spin drift"))


def test_a_small_tilt_is_not_said_to_be_left():
    words = " ".join(row["words"] for row in theory(load(CASES / "charged-body-small-torque.toml")))
    assert "not of the exact motion" not in words


def test_without_a_span_nothing_is_said_of_the_motion_itself(stabilab, tmp_path):
    path = top_file(tmp_path, *STARTS[1])
    path.write_text(path.read_text().replace(f"span = [0, {SPAN}]\n", ""))
    assert "nutation" not in {row["about"] for row in theory(load(path))}
    told = stabilab("simulate", path, "--model", "lindstedt", "--at", "0.5")[1]
    assert "θ of the exact motion over 0 to 0.5 s between" in told
