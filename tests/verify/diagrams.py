"""Random diagrams, generic and degenerate, and forgeries of their certificates."""
from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from fractions import Fraction as F

import numpy as np

from stabilab.errors import InputError
from stabilab.maps.bifurcation.ask import family_of
from stabilab.maps.bifurcation.diagram import diagram, diagram_certificate
from tests.maps.bifurcation.test_line import case_text


def certified(path, vary, curve=False):
    """The certificate of a case's diagram as read from its file."""
    return json.loads(json.dumps(diagram_certificate(diagram(family_of(path, vary), curve))))


def drawn(folder, seed, degenerate):
    """The certificate of a random scene's diagram; None where the scene has none. Degenerate ones have small
    rationals: equal moments, aligned vectors."""
    rng = np.random.default_rng(seed)
    path, scaled = folder / f"{seed}.toml", rng.random() < 0.25
    vary = _scaled(rng, path) if scaled else _body(rng, path, degenerate)
    try:
        return certified(path, vary, rng.random() < 0.3)
    except InputError as error:
        # curves of equilibria for every value have no certificate
        told = ("positive", "proves them at one value")
        assert any(words in str(error) for words in told), error
        return None


def _body(rng, path, degenerate):
    size = 2 if degenerate else 8
    numbers = lambda share: [F(int(v), size) if rng.random() < share else F(0)
                             for v in rng.integers(-2 * size, 2 * size + 1, 3)]
    rows = {"inertia": [F(int(v), 2) for v in rng.integers(2, 5, 3)] if degenerate
            else [F(int(v), 32) for v in rng.integers(36, 60, 3)],
            "momentum": numbers(0.7), "torque": numbers(0.7), "angular_velocity": numbers(1)}
    if rng.random() < 0.6:
        i = int(rng.integers(3))
        rows["torque"] = [F(0)] * 3
        rows["torque"][i], rows["momentum"][i] = F(int(rng.integers(1, 9)),
                                                   16), F(0) if rng.random() < 0.8 else rows["momentum"][i]
    path.write_text(case_text(*rows.values()))
    name, n = list(rows)[int(rng.integers(4))], int(rng.integers(3))
    width = 3 if name != "inertia" else F(1, 2) if degenerate else F(1, 16)
    return {f"{name}[{n + 1}]": (rows[name][n] - width, rows[name][n] + width)}


def _scaled(rng, path):
    draw = lambda count, share: [F(int(v), 4) if rng.random() < share else F(0)
                                 for v in rng.integers(-8, 9, count)]
    a, b = draw(2, 0.8)
    mu = draw(3, 0.8)
    if rng.random() < 0.6:
        i = int(rng.integers(3))
        mu = [F(0) if n != i else F(1) for n in range(3)]
        b = a if i == 0 else b
    x = draw(3, 1)
    row = lambda v: "[" + ", ".join(f'"{c}"' for c in v) + "]"
    path.write_text(f'[scaled]\na = "{a}"\nb = "{b}"\nmu = {row(mu)}\n[motion]\nx = {row(x)}\ntau = [0, 1]\n')
    name, value = [("a", a), ("b", b), ("mu[3]", mu[2]), ("mu[1]", mu[0]),
                   ("x[2]", x[1])][int(rng.integers(5))]
    return {name: (value - 2, value + 2)}


def forgeries(claims, rng) -> Iterator[tuple[str, dict]]:
    """(what was changed, the certificate): each says what is false, given that the one it is made from is
    true."""
    def forged(words, change):
        made = copy.deepcopy(claims)
        change(made)
        return words, made
    for n, piece in enumerate(claims["pieces"]):
        for key in ("equilibria", "stable"):
            if piece[key] is not None:
                for step in (1, 2, -1):
                    yield forged(f"{key} of piece {n}", lambda c, n=n, key=key,
                                 step=step: c["pieces"][n].update({key: abs(c["pieces"][n][key] + step)}))
        yield forged(f"piece {n} endless", lambda c,
                     n=n: c["pieces"][n].update(equilibria=None,
                                                stable=None)) if piece["equilibria"] is not None else \
            forged(f"piece {n} of three", lambda c,
                   n=n: c["pieces"][n].update(equilibria=3,
                                              stable=None if claims["counted"] == "borders" else 1))
        yield forged(f"piece {n} twice", lambda c, n=n: c["pieces"].insert(n, c["pieces"][n]))
    low, high = map(F, claims["range"])
    # an event at the lower end has a piece above it alone
    shift = any(F(event["t"][1]) == low for event in claims["events"])
    for n, event in enumerate(claims["events"]):
        a, b = map(F, event["t"])
        if low < a and b < high:
            yield forged(f"event {n} left out", lambda c,
                         n=n: (c["events"].pop(n), c["pieces"].pop(n - shift)))
            yield forged(f"event {n} left out, and the piece after it", lambda c,
                         n=n: (c["events"].pop(n), c["pieces"].pop(n - shift + 1)))
        yield forged(f"count of event {n}", lambda c,
                     n=n: c["events"][n].update(equilibria=(c["events"][n]["equilibria"] or 0) + 1))
        yield forged(f"event {n} endless or not", lambda c,
                     n=n: c["events"][n].update(equilibria=0 if c["events"][n]["equilibria"] is None
                                                else None))
        for share in (F(1, 10**30), F(1, 1000)):
            step = 2 * (b - a) + (high - low) * share * int(rng.choice([-1, 1]))
            yield forged(f"event {n} beside its value", lambda c, n=n, a=a, b=b,
                         step=step: c["events"][n].update(t=[str(a + step), str(b + step)]))
    places = [low, *(F(t) for event in claims["events"] for t in event["t"]), high]
    for n in range(len(claims["pieces"])):
        gaps = [(a, b) for a, b in zip(places[::2], places[1::2]) if a < b]
        a, b = gaps[n]
        at = a + (b - a) * F(int(rng.integers(1, 100)), 100)
        count = claims["pieces"][n]["equilibria"]
        yield forged("an event where there is none", lambda c, at=at, n=n, count=count: (
            c["events"].append({"t": [str(at), str(at)], "equilibria": None if count is None else count + 1}),
            c["pieces"].insert(n, c["pieces"][n]),
            c["events"].sort(key=lambda event: F(event["t"][0]))))
    # another scene: irrational values of it lie elsewhere
    if any(F(event["t"][0]) != F(event["t"][1]) for event in claims["events"]):
        for name, rows in claims["scene"].items():
            for k in (k for k, row in enumerate(rows) if name != "variables" and F(row[0])):
                yield forged(f"{name}[{k}]", lambda c, name=name, k=k: _larger(c["scene"][name][k]))


def _larger(coefficients):
    coefficients[0] = str(F(coefficients[0]) * F(1025, 1024))
