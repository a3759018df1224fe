"""A machine that forges certificates: for each claim many changes, and for each change what is known of it
without the checker.

A certificate is taken as true, its brackets as holding the true values. What is known of a change:
"false": what it says cannot be true (a bracket apart from the one that holds the value, another word, an
entry lost or doubled); "true": it says the same, or less (a bracket round the one that holds the value, an
optional claim left out); "narrow": a bracket that overlaps the one that holds the value without holding all
of it: tests/verify/true_values.py says whether the value is in it; "junk": no value of that form at all;
"open": it says something of its own, such as of another body.
"""
from __future__ import annotations

import copy
from fractions import Fraction as F

GONE = object()  # the key or entry is left out
LONG = "9" * 4200
JUNK = [True, False, 5, -1, 0, 1.5, float("nan"), float("inf"), 1e300, 10**30, {}, {"a": 1}, {"0": "1"}, [[]],
        [[[]]], [None], [True], ["x"], [1, 2], [["1"]],
        ["1", "2", "3", "4", "5"], ["NaN", "1"], ["1/0", "1"], ["0", "1e400000"], [["0", "1"], ["0", "1"]],
        [[["0", "1"]]], [{}], ["1", None], "", " ", "x",
        "NaN", "nan", "inf", "-inf", "Infinity", "1/0", "0/0", "1/", "/1", "1/2/3", "1e", "e5",
        "1e1000000000", "-1e-1000000000", "1e99999",
        "1E+999999999999999999", "1e4301", "9" * 4301, "1/" + "9" * 4301, "0." + "3" * 4301, "1" * 100_000,
        "\u0661", "\uff11", "\u00bd", "\u00b2", "1\u0660", "\u0660.5", "1_0", " 1", "1 ", "\n1",
        "1\n", "+-1", "--1", "0x10", "1,5", "1.5.2", "0b1", "1j", "(1)", "1e1.5", "1.5/2",
        "\ud800", "\x1b[31m1", "\x00", "stable\nproved", "Stable", "stable ", "st\u0430ble", "bounded\n",
        "BOUNDED",
        "equilibria", "null", "true", "None", "[]", "{}", ["\u0661", "\u0662"], ["2", "1"], [["1", "0"]] * 3,
        [["1"] * 3] * 3, [[[["1"]]]],
        "points ", "curve", "separatrices"]
WORDS = {"kind": ("none", "points", "curves", "all"), "linear": ("stable", "unstable", "degenerate"),
         "verdict": ("stable", "unstable"),
         "fate": ("bounded", "spin-up", "equilibrium", "separatrix"), "variables": ("physical", "scaled"),
         "about": ("fixed centre", "moving centre", "equator")}
# another word there; elsewhere it is false. The constants of one form may do for another
WORD_IS = {"variables": "junk", "about": "open"}
# a certificate may leave them out
OPTIONAL = {"program", "uncertified", "equilibria", "motion", "axis", "sense", "extremes", "period"}
PROSE = {"program", "uncertified"}


def place_of(table, path):
    """What holds the last key of a path."""
    for key in path[:-1]:
        table = table[key]
    return table


def forged(claims, path, to):
    """A copy with the value at a path replaced, or left out."""
    out = place = copy.copy(claims)
    for key in path[:-1]:  # only what lies on the way is copied
        place[key] = place = copy.copy(place[key])
    if to is GONE:
        del place[path[-1]]
    else:
        place[path[-1]] = to
    return out


def is_bracket(value) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(isinstance(v, str) for v in value)


def has_width(path, value) -> bool:
    """Whether a claim is a bracket of two different ends."""
    return is_bracket(value) and _bracketed(path) and F(value[0]) < F(value[1])


def claims_of(value, path=()):
    """Paths of everything that can be changed: brackets as wholes, lists, tables, words and numbers."""
    if path:
        yield path
    bracketed = (is_bracket(value) and path[-1] not in ("denominator", "numerators")
                 and not (len(path) > 1 and path[-2] in ("numerators", "directions")))
    if isinstance(value, dict):
        for key in value:
            yield from claims_of(value[key], (*path, key))
    elif isinstance(value, list) and not bracketed:
        for i, entry in enumerate(value):
            yield from claims_of(entry, (*path, i))


def changes(claims, path, rng, count):
    """(what is known, new value) of the fixed changes of one claim (a hundred of junk among them) and `count`
    drawn ones."""
    old = place_of(claims, path)[path[-1]]
    made = [*_fixed(claims, path, old), *(_drawn(claims, path, old, rng) for _ in range(count))]
    return [(known, to) for known, to in made if known]


def _fixed(claims, path, old):
    """Junk, null, leaving out, entries dropped, doubled and exchanged, all other words."""
    key = path[-1]
    yield _without(claims, path, old), GONE
    yield ("same" if old is None else _null(path, old)), None
    for bad in JUNK:
        yield _junk(path, old, bad), bad
    if isinstance(old, dict):
        yield "extra", old | {"note": "all of this is proved"}
        yield "extra", old | {"b\u0435cause": ["1"]}
    if key in WORDS:
        yield from ((WORD_IS.get(key, "false"), other) for other in WORDS[key] if other != old)
    if key == "verdict":
        yield "weaker", "undecided"
    if key == "fate":
        yield "weaker", "undecided"
    if key in ("axis", "sense"):
        yield from (("false", other) for other in range(*((0, 4) if key == "axis" else (-1, 2)))
                    if other != old)
        yield from (("junk", bad) for bad in (float(old), str(old), -7, 4, 10**40, [old], {"axis": old}))
    if isinstance(old, list) and old and not is_bracket(old) and key not in PROSE:
        if key == "orders":
            yield from ((_orders(to), to) for to in (old[:1], old[1:], old * 2, old[::-1]))
            return
        listed = key in ("points", "curves", "planes", "segments", "folds")
        yield from ((("false" if listed else "open"), old[:i] + old[i + 1:]) for i in range(len(old)))
        yield from ((("false" if listed else "open"), old[:i] + [e] + old[i:]) for i, e in enumerate(old))
        yield ("false" if listed else "open"), old * 40
        yield ("junk" if listed or len(old) * 2000 > 64 else "open"), old * 2000
        yield "open", old[::-1]


def _without(claims, path, old):
    """What is known when a claim is left out."""
    if path[-1] == "spin_up":  # the fate has no proof then
        return "weaker"
    if "spin_up" in path and isinstance(path[-1], str):
        return {"way": "true", "about": "true" if old in (None, "fixed centre")
                else "open"}.get(path[-1], "junk")
    if "orders" in path:
        return "junk"
    if path[-1] in OPTIONAL or path[:-1] == ("uncertified",):
        return "true"
    if isinstance(path[-1], int):
        return "false" if path[-2] in ("points", "curves", "planes", "segments", "folds") else "open"
    if path[-1] in ("points", "curves", "planes", "segments", "folds"):
        return "false" if old else "true"
    return "junk"


def _null(path, old):
    """What is known of null in its place."""
    if path[-1] in ("scene", "schema") or path[-1] in PROSE or "orders" in path:
        return "junk"
    if path[:1] == ("motion",) and len(path) == 4:  # one side of the extremes: unbounded
        return "false"
    if len(path) > 2 and path[-2] == "t" and "segments" in path:  # infinity
        return "false"
    if path[-1] in ("points", "curves", "planes", "segments", "folds") and old:
        return "false"
    return ("junk" if path[-1] == "about" else _without(None, path, old) if isinstance(path[-1], str)
            else "junk")


def _junk(path, old, bad):
    """What is known of a value of another form; None where it may have a meaning in that place."""
    if bad == old and type(bad) is type(old):
        return None
    key = path[-1]
    if key == "program" or path[:-1] == ("uncertified",):
        return "open" if isinstance(bad, str) else "junk"
    if "orders" in path:
        return _orders(bad if key == "orders" else [bad, 0])
    if key == "uncertified":
        return "open" if isinstance(bad, list) and all(isinstance(v, str) for v in bad) else "junk"
    if key in ("axis", "sense"):
        return "junk" if type(bad) is not int else "open"
    if key in WORDS:
        return "junk"
    if isinstance(old, str) and not isinstance(bad, str):
        return "junk"
    if bad in (["1", "2"], "0") or key in ("numerators",
                                           "denominator") or (len(path) > 1 and path[-2] == "numerators"):
        return "open"
    return ("junk" if isinstance(bad, (bool, int, float))
            or (isinstance(bad, str) and bad not in ("0", "1", "2")) or isinstance(old, dict) else "open")


def _orders(value):
    """What is known of orders of the inequality: two whole numbers up to 18 may hold as well as those that
    were written; nothing else is a pair of orders."""
    return ("open" if isinstance(value, list) and len(value) == 2
            and all(type(n) is int and 0 <= n <= 18 for n in value) else "junk")


def _some_orders(rng):
    """Mostly a pair of whole numbers, in range or just beyond; else something else in one place, or one
    number more."""
    drawn = [rng.randrange(-1, 20) for _ in range(rng.choice((2, 2, 2, 3)))]
    return drawn if rng.randrange(3) else [rng.choice([2.5, "3", True, None]), *drawn[1:]]


def _drawn(claims, path, old, rng):
    """(what is known, new value) drawn by chance; (None, None) where the claim has no values to draw."""
    if "orders" in path:
        to = rng.randrange(-2, 21) if isinstance(old, int) else _some_orders(rng)
        return _orders([to, 0] if isinstance(old, int) else to), to
    if old is None or (is_bracket(old) and _bracketed(path)):
        return _bracket(claims, path, old, rng)
    if path[:-1] == ("uncertified",):
        return "open", old[:rng.randrange(60)] + chr(rng.randrange(32, 1000))
    if isinstance(old, str) and path[-1] not in WORDS and path[-1] not in ("program", "schema"):
        return "open", str(_other(F(old), rng))
    if path[-1] in ("axis", "sense"):
        to = rng.choice([rng.randrange(-9, 9) + 0.5, rng.randrange(5, 10**6), -rng.randrange(2, 10**6),
                         str(rng.randrange(9)),
                         bool(rng.randrange(2)), [rng.randrange(4)]])
        return "junk", to
    if isinstance(old, str):
        letters = "stableunidgrcof-\u0430\u0455 \n\x1b\ud83d"
        to = "".join(rng.choice(letters) for _ in range(rng.randrange(1, 12)))
        return ("open" if path[-1] == "program" else "junk"), to
    if isinstance(old, dict):
        key = rng.choice(sorted(old))
        return rng.choice([("extra",
                            old | {f"{key}{rng.choice(['_', ' ', 's', '2', chr(0x200b)])}": old[key]}),
                           ("extra", {f"x{rng.randrange(10**6)}": rng.choice(JUNK[:40]), **old})])
    if path[-1] in PROSE:
        return "open", rng.choice([["x", "proved"], [], ["\u0661"] * 9])
    if isinstance(old, list) and old:
        i = rng.randrange(len(old))
        return "junk", [*old[:i],
                        rng.choice([True, 5, 2.5, "x\n", {"z": 1}, [[[[["1"]]]]], "1e1000000000",
                                    [[], [[]]]]), *old[i + rng.randrange(2):]]
    return "junk", [rng.choice([5, True, "x", [["1"]], {"z": 0},
                                None if path[-1] == "uncertified" else 7.5])] * rng.randrange(1, 4)


def _bracketed(path) -> bool:
    return (path[-1] not in ("denominator",)
            and not (len(path) > 1 and path[-2] in ("numerators", "directions")))


def _other(value, rng):
    """Another number: a little beside, far off, of the other sign, huge, tiny, zero."""
    size = abs(value) or F(1)
    return rng.choice([value + size / 2**rng.randrange(1, 200), value - size / 2**rng.randrange(1, 200),
                       value * rng.randrange(2, 99),
                       -value if value else F(1), value + 1,
                       value * F(10)**rng.randrange(-300, 300) + F(1, 7), F(0) if value else F(1, 3),
                       F(rng.randrange(-9, 10), rng.randrange(1, 9)) + value + F(1, 97)])


def _bracket(claims, path, old, rng):
    """A bracket moved, turned round, narrowed, widened, or taken from elsewhere in the certificate."""
    if old is None:  # infinity, unbounded, or not claimed
        if path[-1] in ("period", "extremes", "equilibria", "motion") or path == ("scene",):
            return (("junk", [["1"], ["2"]]) if path[-1] != "period" else (None, None))
        ends = sorted((F(rng.randrange(-10**6, 10**6), rng.randrange(1, 999)),
                       F(rng.randrange(-10**6, 10**6), rng.randrange(1, 999))))
        return "false", list(map(str, ends))
    low, high = map(F, old)
    width, size = high - low, max(abs(low), abs(high)) or F(1)
    little = width or size / 2**rng.randrange(30, 200)
    way = rng.choice((-1, 1))
    what = rng.randrange(9)
    if what == 0:  # just beside
        step = way * (width + little * F(rng.randrange(1, 1000), 1000))
        return _known(old, low + step, high + step)
    if what == 1:  # far off
        step = way * (width + size * F(10)**rng.randrange(-6, 7))
        return _known(old, low + step, high + step)
    if what == 2:
        return _known(old, -high, -low)
    if what == 3:  # turned round
        return ("junk", [str(high), str(low)]) if width else ("junk", [str(high + size), str(low)])
    if what == 4:  # a single number outside
        at = (high if way > 0 else low) + way * (little / 2**rng.randrange(1, 30) + rng.choice((F(0), size)))
        return _known(old, at, at)
    if what == 5 and width:  # a single number inside: the writer's middle is not the true value itself
        at = low + width * F(rng.randrange(1, 1000), 1001)
        return "narrow", [str(at), str(at)]
    if what in (5, 6):  # wider
        return _known(old, low - size * F(rng.randrange(0, 50), 10**rng.randrange(2, 30)),
                      high + little * rng.randrange(0, 9))
    if what == 7:  # all of it on one side of the true bracket, and long
        length = size * 10**rng.randrange(9)
        return _known(old,
                      *((high + little, high + little + length) if way > 0
                        else (low - little - length, low - little)))
    others = [b for p in claims_of(claims) if is_bracket(b := place_of(claims, p)[p[-1]]) and _bracketed(p)]
    return _known(old, *map(F, rng.choice(others)))


def _known(old, low, high):
    """What is known of a bracket, given one that holds the true value."""
    a, b = map(F, old)
    known = "false" if high < a or b < low else "true" if low <= a and b <= high else "narrow"
    return known, [str(low), str(high)]
