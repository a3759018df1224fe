"""The true motion that a claim is held against: the program's own equations of motion, in the paper's
letters.

A system is either derived (`effects`: the equations that the program integrates, renamed by `names`), or
stated by its rates in other variables (`follows`, `meaning`, `pace`) and then proved to follow from its
parent before anything is held against it, or a parent with some symbols set (`set`).
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module

from ...errors import InputError
from ...physics.equations import derive
from ...physics.scene import Body, Scene
from ...theories.printed.claims import FormulaError, Paper, parse

# effect -> (module, class, arguments that leave no parameter zero)
EFFECTS = {
    "gyrostat": ("gyrostat", "Gyrostat", ((2, 3, 5),)),
    "constant_torque": ("constant_torque", "ConstantTorque", ((2, 3, 5),)),
    "charge": ("charge", "Charge", (2, 3, 5, "1/2")),
    "gravity": ("gravity", "Gravity", (7, (2, 3, 5))),
    "newtonian_field": ("newtonian_field", "NewtonianField", (3,)),
    "liquid_cavity": ("liquid_cavity", "LiquidCavity", (2, 3, 5)),
    "resistance": ("resistance", "Resistance", (2,)),
}


@dataclass(frozen=True)
class System:
    """state: SymPy symbols; rates: their rates by the system's own time; set: symbols with a value in it;
    time: unit of that time, words."""

    name: str
    state: tuple
    rates: tuple
    set: dict
    time: str

    def rate(self, expression):
        """Rate of an expression along the motion."""
        return sum((expression.diff(x) * r for x, r in zip(self.state, self.rates)), 0 * expression)


def system_of(paper: Paper, name: str | None, place: str = "") -> System | None:
    """The system of a name; None for None. InputError where it is not described or does not follow from its
    parent."""
    if name is None:
        return None
    if name not in paper.systems:
        raise InputError(
            f"{place or paper.name}: unknown system {name!r}; described are "
            f"{', '.join(paper.systems) or 'none'}")
    data, place = paper.systems[name], f"{paper.name}, systems.{name}"
    unknown = (set(data) - {"effects", "names", "blocks", "state", "rates", "follows", "meaning", "pace",
                            "set", "time", "scene"})
    if unknown:
        raise InputError(f"{place}: unknown keys {', '.join(sorted(unknown))}")
    values = {symbol: _read(paper, place, text) for symbol, text in data.get("set", {}).items()}
    if "effects" in data or "scene" in data:
        return _derived(paper, name, data, values, place)
    if "rates" in data:
        state = tuple(_symbol(paper, place, s) for s in data["state"])
        return System(name, state, tuple(_put(_read(paper, place, r), values) for r in data["rates"]), values,
                      data.get("time", "s"))
    if "follows" not in data:
        raise InputError(f"{place}: give effects (derived), rates (stated) or follows with set")
    parent = system_of(paper, data["follows"], place)
    return System(name, parent.state, tuple(_put(r, values) for r in parent.rates), parent.set | values,
                  parent.time)


def stated(paper: Paper):
    """(system's name, parent, pairs that vanish if its stated rates follow from the parent's) for every
    system stated by rates."""
    for name, data in paper.systems.items():
        if "rates" not in data or "follows" not in data:
            continue
        place = f"{paper.name}, systems.{name}"
        parent, own = system_of(paper, data["follows"], place), system_of(paper, name)
        meaning = {_symbol(paper, place, s): _read(paper, place, text) for s, text in data["meaning"].items()}
        pace = _read(paper, place, data.get("pace", "1"))
        yield name, parent, [(parent.rate(meaning[x]) / pace, rate.xreplace(meaning)) for x,
                             rate in zip(own.state, own.rates)]


def _derived(paper, name, data, values, place):

    equations = derive(_scene(data, place), tuple(data.get("blocks", ())))
    import sympy as sp

    renamed = {}
    for theirs in (*equations.state, *equations.symbols.values()):
        text = data.get("names", {}).get(theirs.name, theirs.name)
        renamed[theirs] = sp.Integer(0) if text == "0" else _read(paper, place, text)
    state = tuple(renamed[s] for s in equations.state)
    if not all(s.is_Symbol for s in state):
        raise InputError(f"{place}: names of the state are to be plain symbols")
    return System(name, state, tuple(_put(r.xreplace(renamed), values) for r in equations.rhs), values,
                  data.get("time", "s"))


def _scene(data, place):

    if "scene" in data:
        module, _, function = data["scene"].partition(":")
        return getattr(import_module(f".special.{module}", __package__), function)()
    effects = []
    for effect in data["effects"]:
        if effect not in EFFECTS:
            raise InputError(f"{place}: unknown effect {effect!r}; known are {', '.join(EFFECTS)}")
        module, kind, arguments = EFFECTS[effect]
        effects.append(getattr(import_module(f"...physics.effects.{module}", __package__), kind)(*arguments))
    return Scene(Body((7, 6, 4)), *effects)


def _put(expression, values):
    return (expression.subs({s: v for s, v in expression_symbols(expression, values)}) if values
            else expression)


def expression_symbols(expression, values):
    """(symbol, value) of those of the named symbols that stand in the expression."""
    return [(s, values[s.name]) for s in expression.free_symbols if s.name in values]


def _read(paper, place, text):
    try:
        return parse(text, paper.symbols)
    except FormulaError as error:
        raise FormulaError(f"{place}: {error}") from None


def _symbol(paper, place, name):
    if name not in paper.symbols:
        raise InputError(f"{place}: unknown symbol {name!r}; declare it under [symbols]")
    return paper.symbols[name]
