"""Several threads that ask different questions at once get the answers of one thread, to the bit.

What only one thread may have at a time is named here: the working precision of python-flint and that of
mpmath belong to the process, and so do the names that SymPy gives to compiled functions.
"""
import ast
import json
import random
import sys
import threading
import time
from fractions import Fraction
from functools import cache
from pathlib import Path

import flint
import numpy as np
import pytest

import stabilab
from stabilab import Body, Gyrostat, Scene
from stabilab.answers.certificate import certificate
from stabilab.answers.digits import ask
from stabilab.answers.digits_run import best_reached
from stabilab.numbers import balls
from stabilab.numbers.exact import precise
from stabilab.physics import to_numpy as compiled
from stabilab.physics.effects.gravity import Gravity
from stabilab.verify import numbers as precision
from stabilab.verify import verify
from tests.house.rooms import tree_of
from tests.shared import case

ROOT = Path(__file__).parents[2]
SWITCH = 1e-6  # s after which Python lets another thread run: five thousand times as often as by itself
# both conics, a parabola, a free body, a spin-up
ORBITS = ("minor-axis-100", "middle-axis-double-well", "sphere-wheel", "torque-free-body",
          "wheel-and-thruster")
OTHERS = ("off-axis-one", "off-axis-fold", "liquid-base", "charged-body-attitude", "symmetric-spin-up")
FREE = Scene(Body((5, 4, 2)), Gyrostat(("0.3", "0.2", "0.4")))  # no axis without a wheel: no reduction
HEAVY = Scene(Body((5, 6, 7)), Gravity(20, (0, 0, "0.1")), Gyrostat((0, 0, 1)))
STATE, STATES = (0.1, 1.5, 0.2), np.random.default_rng(4).normal(0, 2, (20, 3))


def plain(answer):
    """An answer as values that compare bit by bit: arrays by their bytes, functions and scenes left out."""
    if isinstance(answer, np.ndarray):
        return answer.dtype.str, answer.shape, repr(
            answer.tolist()) if answer.dtype == object else answer.tobytes()
    if isinstance(answer, dict):
        return {name: plain(v) for name, v in answer.items()}
    if isinstance(answer, (list, tuple)):
        return [plain(v) for v in answer]
    if hasattr(answer, "__dataclass_fields__"):
        return {name: plain(getattr(answer, name)) for name in answer.__dataclass_fields__
                if name not in ("scene", "point")}
    return repr(answer)


def certified(scene, state):
    made = certificate(scene, state)
    return made, verify(json.loads(json.dumps(made)))


def asked_of(name, scene, state):
    """Name -> question about an orbit: in doubles, in arrays, to many digits, certified and checked."""
    return {
        f"motion, {name}": lambda: stabilab.motion(scene, state),
        f"margin to 30 digits, {name}": lambda: ask("fate", scene, state, 30),
        f"extremes to 8 digits, {name}": lambda: ask("extremes", scene, state, 8),
        f"extremes to 20 digits, {name}": lambda: ask("extremes", scene, state, 20),
        f"period, {name}": lambda: ask("period", scene, state, 12),
        f"certificate, {name}": lambda: certified(scene, state),
        f"fates, {name}": lambda: stabilab.fate(scene, STATES),
        f"equilibria, {name}": lambda: stabilab.equilibria(scene)}


def all_questions():
    """Name -> question, of every kind of scene."""
    some, asked = case("minor-axis-100"), {}
    for name in ORBITS:
        asked |= asked_of(name, case(name).scene, case(name).state)
    for name, scene in (*((name, case(name).scene) for name in OTHERS), ("heavy", HEAVY)):
        asked[f"equilibria, {name}"] = lambda scene=scene: stabilab.equilibria(scene)
    asked["motion, free"] = lambda: stabilab.motion(FREE, STATE)
    asked["margin to 30 digits, free"] = lambda: ask("fate", FREE, STATE, 30)
    asked["period to 20 digits, free"] = lambda: ask("period", FREE, STATE, 20)
    asked["simulation to 12 digits"] = lambda: best_reached(some, [0.0, 1.0], 12)
    asked["trajectory"] = lambda: stabilab.trajectory(some.scene, some.state, np.linspace(0, 2, 5)).states
    return {name: lambda question=question: plain(question()) for name, question in asked.items()}


QUESTIONS = all_questions()


@pytest.fixture(scope="module")
def alone():
    """Name -> answer of one thread."""
    return {name: question() for name, question in QUESTIONS.items()}


@pytest.fixture
def restless():
    """Python lets another thread run as often as it can."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(SWITCH)
    yield
    sys.setswitchinterval(before)


def wrong(count, each, alone):
    """Questions that some of `count` threads, each asking `each` of them in an order of its own, answered
    otherwise than one."""
    told, start = [], threading.Barrier(count)

    def run(seed):
        chosen = random.Random(seed)
        start.wait()
        for name in (name for _ in range(-(-each // len(alone)))
                     for name in chosen.sample(sorted(alone), min(each, len(alone)))):
            try:
                if QUESTIONS[name]() != alone[name]:
                    told.append(f"{name}: another answer")
            except Exception as error:  # whatever it is: one thread had an answer
                told.append(f"{name}: {error!r}")
    threads = [threading.Thread(target=run, args=(seed,)) for seed in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return told


@pytest.mark.one_in(2)
@pytest.mark.parametrize("count, each", [(2, len(QUESTIONS) // 2), (8, len(QUESTIONS) // 5),
                                         pytest.param(2, len(QUESTIONS), marks=pytest.mark.slow),
                                         *(pytest.param(n, 3000 // n, marks=[pytest.mark.slow, pytest.mark.long])
                                           for n in (2, 8))])
def test_threads_have_the_answers_of_one_to_the_bit(count, each, alone, restless):
    assert wrong(count, each, alone) == []


@pytest.mark.one_in(2)
@pytest.mark.parametrize("bits", [10, 2000])
def test_no_answer_depends_on_the_precision_that_flint_happens_to_have(bits, alone):
    """What a thread finds outside the lock may be any other's."""
    with flint.ctx.workprec(bits):
        assert [name for name, question in QUESTIONS.items() if question() != alone[name]] == []


def test_analysis_and_checker_hold_one_lock_while_flint_has_their_precision():
    with balls.working(200):
        entered = threading.Event()

        def check():
            with precision.working(64):
                entered.set()
        other = threading.Thread(target=check)
        other.start()
        assert not entered.wait(0.05)
        with precision.working(300), balls.working(100):  # the same thread may go deeper
            assert flint.ctx.prec == 100
        assert flint.ctx.prec == 200
    other.join(5)
    assert entered.is_set() and flint.ctx.prec == 53


def test_exact_cosines_of_two_threads_keep_their_own_bits(restless):
    cosine = lambda bits: [precise("cos", Fraction(n, 7), bits=bits) for n in range(20)]
    alone, found = {bits: cosine(bits) for bits in (900, 240)}, {}
    threads = [threading.Thread(target=lambda bits=bits: found.update({bits: cosine(bits)}))
               for bits in alone]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == alone


def test_functions_of_symbols_are_made_by_one_thread_at_a_time(monkeypatch):
    """SymPy collects NumPy's names for the first function; a second one made meanwhile would miss some of
    them."""
    import sympy
    x, busy, most = sympy.Symbol("x"), [], []
    make = sympy.lambdify

    def watched(*args, **options):
        busy.append(1)
        most.append(len(busy))
        time.sleep(0.01)
        busy.pop()
        return make(*args, **options)
    monkeypatch.setattr(sympy, "lambdify", watched)
    threads = [threading.Thread(target=compiled.lambdified, args=((x,), [sympy.sin(k * x)]))
               for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most == [1] * 4


def sources(*words):
    """The files of the package in which one of the words stands: the others need no reading by the syntax."""
    texts = ((path, path.read_text(encoding="utf-8")) for path in (ROOT / "stabilab").rglob("*.py"))
    return [path for path, text in texts if any(word in text for word in words)]


@cache
def nodes(path):
    return list(ast.walk(tree_of(path)))


def test_only_gates_that_hold_a_lock_set_a_precision():
    """Another place that set it would do so while some thread computes."""
    gates = {"numbers/balls.py": "flint", "verify/numbers.py": "flint", "theories/top_expansion.py": "mpmath"}
    words = ("workprec", "extraprec", "workdps", "extradps")
    found = {path.relative_to(ROOT / "stabilab").as_posix(): ast.unparse(node.value).split(".")[0]
             for path in sources(*words)
             for node in nodes(path) if isinstance(node, ast.Attribute) and node.attr in words}
    assert found == gates


def test_no_module_rebinds_a_name_at_run_time():
    """What a module knows is the same for every thread: a kind of number, a precision, a count is passed."""
    found = [f"{path}: {', '.join(node.names)}" for path in sources("global ")
             for node in nodes(path) if isinstance(node, ast.Global)]
    assert found == []
