"""One table of a case file, and the table of what a case expects.

Values are read by key, each with its line, its unit and its uncertainty; every fault is noted with its
line.

Written by hand rather than with pydantic, whose import alone takes longer than the whole of `stabilab
classify`."""
from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from datetime import date, time
from fractions import Fraction
from unicodedata import category

from ..errors import InputError, Problem, printable
from ..numbers.exact import exact
from ..numbers.units import dimension_of, quantity, unit_of_key
from ..numbers.vectors import Exact3
from ..physics.effects import effect_class
from .aliases import cure_of_key, misnamed, shown
from .cures import cure_of_number, cure_of_numbers, cure_of_title, cure_of_truth
from .lines import KeyLines
from .uncertain import Uncertain, states_uncertainty, uncertain_number

# Unicode's categories of control, format (such as right-to-left override) and surrogate characters
UNSEEN = ("Cc", "Cf", "Cs")


class Written(str):
    """A number with a point or an exponent as it stands in the file, so that 0.1 means one tenth exactly."""


# The keys whose numbers may be uncertain, by their tables; those of effects are `Effect.keys`, but for
# `Effect.certain`. Directions and what is chosen, as a span or a limit, are none of them; the force of a
# thruster is read with its tolerance.
UNCERTAIN_KEYS = {
    ("body",): ("inertia", "mass"), ("body", "products"): ("xy", "xz", "yz"), ("scaled",): ("a", "b", "mu"),
    ("wheels",): ("momentum", "inertia", "speed"),
    ("motion",): ("angular_velocity", "x", "rotation_period", "precession_period", "amplitude", "spin",
                  "nutation", "lean"),
    ("circular_orbit",): ("rate", "period", "altitude", "radius")}


def may_be_uncertain(table: tuple[str, ...], key: str | int) -> bool:
    """Whether the numbers of a key may be uncertain, or one number of it. table: its path, without numbers of
    tables in a list; of one number with the key, and key its place."""
    if not isinstance(key, str):
        table, key = table[:-1], table[-1]
    if table[:1] == ("effects",):
        cls = effect_class(table[-1])
        return key in cls.keys and key not in cls.certain
    return key in UNCERTAIN_KEYS.get(table, ())


# Keys of [motion] by which a start is stated as it is observed (`observed`): of a tumbling body, of a spin,
# of a top that precesses steadily
TUMBLING = ("rotation_period", "precession_period", "amplitude", "mode")
SPINNING = ("spin", "axis", "nutation", "towards")
LEANING = ("lean", "precession")
OBSERVED = TUMBLING + SPINNING + LEANING


HOMES = {word: home for home, value in {
    "[motion]": ("angular_velocity", "omega", "span", "vertical", "attitude", "start", "initial", "state",
                 "x",
                 "tau", "velocity", "damper"),
    "[body]": ("inertia", "moments", "products", "mass", "centre_of_mass"),
    "[limits]": ("rate", "limit"),
    "[circular_orbit]": ("altitude", "radius", "period", "orbit"),
    "[output]": ("units",),
    "[[wheels]], or as [effects.gyrostat]": ("momentum", "wheel", "gyrostat"),
    "[effects.constant_torque]": ("torque", "constant_torque"),
    "[[thrusters]]": ("force", "position", "direction", "thruster", "stuck", "misalignment",
                      "force_tolerance", "stop", "duty", "on_time", "propellant", "mass_flow",
                      "profile"),
    "[[wheels]]": ("axis", "speed"),
    "[effects.gravity]": ("weight",),
    "[effects] of its own, such as [effects.resistance]": ("coefficient",),
    "[effects.liquid_cavity]": ("density", "viscosity"),
}.items() for word in value}  # where the words stand that a reader most often writes in another place


class Faults:
    """The faults found so far, each at the line of its key; moved: path -> path of the key that stands for
    it. uncertain: path -> the number with an uncertainty that was read there; inexact: paths of the numbers
    whose unit holds pi."""

    def __init__(self, lines: KeyLines, moved: dict | None = None):
        self.lines, self.moved = lines, moved or {}
        self.problems: list[Problem] = []
        self.uncertain: dict[tuple, Uncertain] = {}
        self.inexact: set[tuple] = set()
        self.unknown: set[tuple] = set()
        self.missing: dict[Problem, set[tuple]] = {}

    def add(self, path: tuple, message: str, unless: Iterable[tuple] = ()):
        """unless: paths of keys that may be meant by what this fault misses; where one of these is a fault as
        an unknown key, that one says it all."""
        source = next((there for here, there in self.moved.items() if path[:len(here)] == here), path)
        note = message if source is path else f"{message} (a value of [sweep])"
        self.problems.append(Problem(dotted(path), note, self.lines.of(source)))
        if unless:
            self.missing[self.problems[-1]] = set(unless)

    def ordered(self) -> list[Problem]:
        """All that is to be said, in the order of the file."""
        return sorted((item for item in self.problems if not self.missing.get(item, set()) & self.unknown),
                      key=lambda problem: problem.line or 0)


class Table:
    """A view on the table at `path`; every reader returns None where the key is absent or wrong (and notes
    why)."""

    def __init__(self, path: tuple, data: dict, faults: Faults):
        self.path, self.data, self.faults = path, data, faults

    def __contains__(self, key: str) -> bool:
        return key in self.data

    def fault(self, message: str, *keys, instead_of: tuple[str, ...] = ()):
        """Note a fault of this table, or of the key (and list index) below it. instead_of: keys that it
        misses, for which another name may stand in the table."""
        meant = [self.path + (key,) for key in self.data if misnamed(self.path, key, self.data, *instead_of)
                 ] if instead_of else []
        self.faults.add(self.path + keys, message, meant)

    def known(self, allowed: Sequence[str], what: str = "key"):
        """Note every key that is not in `allowed`."""
        said: set[str] = set()
        for key in self.data:
            if key not in allowed:
                cure = cure_of_key(self.path, key, self.data, allowed)
                if cure in said:  # of several keys that are one here, such as Ixx, Iyy, Izz
                    continue
                said |= {cure} if cure else set()
                self.faults.unknown.add(self.path + (key,))
                self.fault(f"unknown {what}{_then(cure) or did_you_mean(key, allowed)}", key)

    def one_of(self, *keys: str) -> str | None:
        """The one key of `keys` that is present; a fault where two are."""
        present = [key for key in self.data if key in keys]
        if len(present) > 1:
            self.fault(f"{' and '.join(present)} say the same thing in two ways: keep one of them",
                       present[1])
            return None
        return present[0] if present else None

    def table(self, key: str) -> Table | None:
        value = self.data.get(key)
        if value is None:
            return None
        if not isinstance(value, dict):
            self.fault(f"expected a table [{dotted(self.path + (key,))}], got {described(value)}"
                       f"{_then(cure_of_title(self.path, key, value))}", key)
            return None
        return Table(self.path + (key,), value, self.faults)

    def tables(self, key: str) -> list[Table]:
        """The tables [[key]], each with its index in its path."""
        value = self.data.get(key, [])
        if isinstance(value, list) and all(isinstance(item, dict) for item in value):
            return [Table(self.path + (key, index), item, self.faults) for index, item in enumerate(value)]
        self.fault(f"expected tables [[{key}]], one for each, got {described(value)}; write the title "
                   f"[[{key}]] "
                   f"in double brackets, and its keys below it", key)
        return []

    def truth(self, key: str) -> bool:
        """true or false; false where the key is absent."""
        value = self.data.get(key, False)
        if not isinstance(value, bool):
            self.fault(f"expected true or false, got {described(value)}; {cure_of_truth(key, value)}", key)
        return value is True

    def text(self, key: str, default: str = "") -> str:
        value = self.data.get(key, default)
        if not isinstance(value, str) or isinstance(value, Written):
            cure = f'write {key} = "{shown(value)}"' if isinstance(value, (str, int)) else ""
            self.fault(f"expected a text in quotes, got {described(value)}{_then(cure)}", key)
            return default
        strange = next((c for c in value if c not in "\n\t" and category(c) in UNSEEN), None)
        if strange:  # these texts go to terminals and pages
            self.fault(f"character U+{ord(strange):04X} cannot be shown: remove it", key)
        return value

    def texts(self, key: str) -> list[str]:
        """A list of texts, or one; those without a fault."""
        value = self.data.get(key, [])
        listed = value if isinstance(value, list) else [value]
        tables = [Table(self.path, {key: item}, self.faults) for item in listed]
        return [text for table in tables if (text := table.text(key))]

    def number(self, key: str) -> Fraction | None:
        """One exact number."""
        if key not in self.data:
            return None
        cure = cure_of_number(self.path, key, self.data[key])
        return self._exact(self.data[key], key, cure=cure)

    def positive(self, key: str, zero: bool = False) -> Fraction | None:
        """One exact number above zero (or zero, where that is allowed)."""
        value = self.number(key)
        if value is None or value > 0 or (zero and value == 0):
            return value
        wanted = "a number that is not negative" if zero else "a positive number"
        self.fault(f"expected {wanted}, got {float(value)!r}", key)
        return None

    def numbers(self, key: str, count: int) -> tuple[Fraction, ...] | None:
        """`count` exact numbers, all of their faults noted; one may stand without brackets."""
        value = self.data.get(key)
        if value is None:
            return None
        text = {1: "one number", 2: "two numbers", 3: "three numbers"}[count]
        if count == 1 and not isinstance(value, list):
            single = self.number(key)
            return None if single is None else (single,)
        if not isinstance(value, list):
            self.fault(
                f"expected {text} in square brackets, got "
                f"{described(value)}"
                f"{_in_brackets(value, count) or _then(cure_of_numbers(self.path, key, value, count))}", key)
            return None
        if len(value) != count or all(isinstance(item, list) for item in value):
            cure = cure_of_numbers(self.path, key, value, count)
            self.fault(f"expected {text}, got {_counted(value)}{_then(cure)}", key)
            return None
        cure = (cure_of_numbers(self.path, key, value, count)
                if any(isinstance(item, list) for item in value) else "")
        read = [self._exact(item, key, index, cure=cure) for index, item in enumerate(value)]
        return None if None in read else tuple(read)

    def matrix(self, key: str) -> tuple[tuple[Fraction, ...], ...] | None:
        """Three rows of three exact numbers, all of their faults noted."""
        value = self.data[key]
        if len(value) != 3 or not all(isinstance(row, list) and len(row) == 3 for row in value):
            cure = cure_of_numbers(self.path, key, value, 3)
            self.fault(f"expected three numbers, or three rows of three numbers, got {_counted(value)}"
                       f"{_then(cure)}", key)
            return None
        read = [[self._exact(item, key, i, j) for j, item in enumerate(row)] for i, row in enumerate(value)]
        return None if any(None in row for row in read) else tuple(map(tuple, read))

    def entry(self, key: str, row: int, place: int, share: bool = False) -> Fraction | None:
        """One exact number of the rows of a list. share: of a whole, without a unit or in per cent."""
        value = self.data[key][row][place]
        if not share:
            return self._exact(value, key, row, place)
        try:
            if isinstance(value, str) and not isinstance(value, Written) and value.strip().endswith("%"):
                return exact(value.strip()[:-1].strip()) / 100
            text = isinstance(value, str) and not isinstance(value, Written)
            return exact(value) if text else _number(value)
        except InputError as error:
            self.fault(f"row {row + 1}, number {place + 1}: {error}", key)
            return None

    def vector(self, key: str) -> Exact3 | None:
        """Three exact numbers."""
        return self.numbers(key, 3)

    def required(self, *keys: str, **cures: str) -> bool:
        """Note every key that is missing, with what to add where `cures` tells; True where none is."""
        missing = [key for key in keys if key not in self.data]
        for key in missing:
            unit = unit_of_key(self.path + (key,))
            self.fault(f"{key} is missing: {cures.get(key) or ('add it, in ' + unit if unit else 'add it')}",
                       instead_of=(key,))
        return not missing

    def _exact(self, value: float | str | Written, *keys, cure: str = "") -> Fraction | None:
        try:
            if isinstance(value, str) and not isinstance(value, Written) and states_uncertainty(value):
                return self._middle(value, keys)
            return self._number(value, keys)
        except InputError as error:
            row = f"row {keys[1] + 1}, " if len(keys) > 2 else ""
            number = f"number {keys[-1] + 1}: " if len(keys) > 1 else ""
            self.fault(row + number + str(error) + _then(cure), *keys)
            return None

    def _middle(self, text: str, keys: tuple[str, int]) -> Fraction:
        """The middle of an uncertain number, which is noted."""
        tables = tuple(part for part in self.path if isinstance(part, str))
        if len(keys) > 2:
            raise InputError(f"takes no uncertainty in a row of a tensor, got {described(text)}: write the "
                             "three moments as inertia, and the products of inertia as [body] products")
        if not may_be_uncertain(tables, keys[0]):
            raise InputError(f"takes no uncertainty, got {described(text)}; one may stand in moments and "
                             "products of inertia, mass, momentum, torque and speed, in the numbers of "
                             "effects, in what [motion] says of rates and periods, in a, b, mu and in the "
                             "force of a thruster")
        path = self.path + keys
        number = uncertain_number(text, dimension_of(path))
        if number.half:
            self.faults.uncertain[path] = Uncertain(path, number.middle, number.half, self._named(keys[0]),
                                                    number.law, number.sigma)
        if not number.sharp:
            self.faults.inexact.add(path)
        return number.middle

    def _named(self, key: str) -> str:
        """The key with the name of its table, where that is one of several; "" of any other."""
        *tables, last = self.path
        if isinstance(last, str):
            return ""
        supplied = self.data.get("name")
        return ".".join([*tables, supplied if isinstance(supplied, str) else str(last + 1), key])

    def _number(self, value, keys) -> Fraction:
        if isinstance(value, Written) or not isinstance(value, str):
            return _number(value)
        number, sharp = quantity(value, dimension_of(self.path + keys))
        if not sharp:
            self.faults.inexact.add(self.path + keys)
        return number


def _then(cure: str) -> str:
    return f"; {cure}" if cure else ""


def _counted(value: list) -> str:
    """How many a list has, with the length of its rows where it has rows."""
    rows = [len(row) for row in value if isinstance(row, list)]
    if not rows:
        return str(len(value))
    lengths = " and ".join(map(str, sorted(set(rows))))
    return f"{len(value)} row{'s' * (len(value) > 1)} of {lengths}"


def _number(value) -> Fraction:
    """What TOML gives for a number: SI units."""
    if isinstance(value, Written):
        bare = value.lstrip("+-")
        if bare in ("inf", "nan"):
            raise InputError(f"expected a finite number, got {value}")
        return exact(str(value))
    if isinstance(value, bool) or not isinstance(value, int):
        raise InputError(f"expected a number, got {described(value)}")
    if value.bit_length() > 1100:
        raise InputError("the number is larger than the largest double (about 1.8e308)")
    return exact(value)


def dotted(path: tuple) -> str:
    """The path as one would write it; keys that need quotes get them, list items are left to the message."""
    plain = [key for key in path if isinstance(key, str)]
    return ".".join(key if key.replace("-", "").replace("_", "").isalnum() and key.isascii() else _quoted(key)
                    for key in plain)


def _quoted(key: str) -> str:
    return '"' + printable(key[:60]).replace('"', '\\"') + '"'


def described(value) -> str:
    """What came, in words."""
    if isinstance(value, bool):
        return f"the truth value {str(value).lower()}"
    if isinstance(value, Written):
        return f"the number {value[:40]}"
    if isinstance(value, int):
        return f"the number {value}" if value.bit_length() < 100 else "a very long number"
    if isinstance(value, str):
        return f"the text {_quoted(value)}"
    if isinstance(value, list):
        return f"a list of {len(value)}"
    if isinstance(value, (date, time)):
        return "a date or time"
    return "a table"


def _in_brackets(value, count: int) -> str:
    """"; write ..." where a text holds the numbers of a list, perhaps with one unit behind the last of them;
    of a span the end alone."""
    if not isinstance(value, str) or isinstance(value, Written) or len(value) > 200:
        return ""
    parts = [re.fullmatch(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([^\d\s].*)?", part.strip())
             for part in re.split(r"[,;]" if re.search("[,;]", value) else r"\s+(?=[-+.\d])",
                                  re.sub(r"[()\[\]{}]", " ", value).strip())]
    if None in parts or len(parts) != count and (len(parts), count) != (1, 2):
        return ""
    units = [part[2] for part in parts]
    if any(units[:-1]) and not all(units):
        return ""
    full = [f'"{part[1]} {unit or units[-1]}"' if units[-1] else part[1] for part, unit in zip(parts, units)]
    return f"; write [{', '.join(map(printable, ['0'] * (count - len(full)) + full))}]"


def did_you_mean(word: str, allowed: Iterable[str]) -> str:
    """"; did you mean ...?" where a known word is near, else in which table it stands, and the list of what
    may stand here."""
    from difflib import get_close_matches
    home = (f"; it is written in {HOMES[word.lower()]}" if word.lower() in HOMES
            and word.lower() not in allowed else "")
    nearby = not home and get_close_matches(word.lower()[:60], list(allowed), n=1, cutoff=0.6)
    return f"; did you mean {nearby[0]}?" if nearby else f"{home}; here may stand {', '.join(allowed)}"


# --- The facts that a case's test asserts: equilibria, verdicts, fate and extremes, each known before the
# program ran
KINDS = ("none", "points", "curves", "all")
FATES = ("bounded", "spin-up", "separatrix", "equilibrium", "undecided")
VERDICTS = ("stable", "unstable", "undecided")
KEYS = ("kind", "points", "fate", "axis", "verdicts", "extremes", "period")


def expected(table: Table | None) -> dict:
    """[expect] with its numbers as floats; faults are kept by the table.

    kind, points (how many), verdicts (one per point), fate, axis (1, 2, 3), period, extremes: three pairs
    [min, max] (inf where unbounded).
    """
    if table is None:
        return {}
    table.known(KEYS)
    return {key: READERS[key](table, key) for key in table.data if key in KEYS}


def _word(text: Sequence[str]):
    def read(table: Table, key: str):
        value = table.data[key]
        if value not in text or isinstance(value, Written):
            table.fault(f"expected one of {', '.join(text)}; got {described(value)}", key)
        return value
    return read


def _whole(lowest: int, highest: int):
    def read(table: Table, key: str):
        value = table.data[key]
        if isinstance(value, bool) or not isinstance(value, int) or not lowest <= value <= highest:
            table.fault(f"expected a whole number from {lowest} to {highest}, got {described(value)}", key)
        return value
    return read


def _verdicts(table: Table, key: str):
    value = table.data[key]
    if not isinstance(value, list) or not all(isinstance(v, str) and v in VERDICTS for v in value):
        table.fault(f"expected a list of the words {', '.join(VERDICTS)}; got {described(value)}", key)
    return value


def _extremes(table: Table, key: str):
    value = table.data[key]
    if not isinstance(value,
                      list) or len(value) != 3 or not all(isinstance(p, list) and len(p) == 2 for p in value):
        table.fault(f"expected three pairs [min, max], got {described(value)}", key)
        return None
    return [[_float(table, v, key) for v in pair] for pair in value]


def _float(table: Table, value: Written, key: str) -> float | None:
    """A number, or inf; a string is read as an exact number."""
    if isinstance(value, Written) and value.lstrip("+-") == "inf":
        return float(value)
    number = Table(table.path, {key: value}, table.faults).number(key)
    return None if number is None else float(number)


READERS = {"kind": _word(KINDS), "points": _whole(0, 10**6), "fate": _word(FATES), "axis": _whole(1, 3),
           "verdicts": _verdicts, "extremes": _extremes,
           "period": lambda table, key: _float(table, table.data[key], key)}
