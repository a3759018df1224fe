"""Records are the data classes of the standard library, in every respect that a caller sees."""
import copy
import pickle
from dataclasses import FrozenInstanceError, asdict, dataclass, field, fields, is_dataclass, replace

import pytest

from stabilab.record import record


class _Fields:
    """Two of its fields have defaults, one is not compared, one not shown."""

    a: int
    b: tuple
    c: dict = field(default_factory=dict, compare=False)
    d: str = field(default="d", repr=False)


def _made(decorator):
    """The class above, made by a decorator, under one name."""
    return decorator(type("Made", (), {"__annotations__": dict(_Fields.__annotations__), "__doc__": "x",
                                       "c": field(default_factory=dict, compare=False),
                                       "d": field(default="d", repr=False), "__module__": __name__,
                                       "__qualname__": "Made"}))


# expected throughout: what the standard library's own class does
Made, Standard = _made(record), _made(dataclass(frozen=True))


@record
class One:
    """One field."""

    a: int


@record
class Two(One):
    """A record below another, with a check."""

    b: int = 2

    def __post_init__(self):
        object.__setattr__(self, "b", 2 * self.b)


def test_a_frozen_data_class_may_stand_below_a_record():
    @dataclass(frozen=True)
    class Below(One):
        b: int = 3

    one = replace(Below(1), b=5)
    # as one data class below another
    assert one == Below(1, 5) and hash(one) == hash(Below(1, 5)) and asdict(one) == {"a": 1, "b": 5}
    for name in ("a", "b", "c"):
        with pytest.raises(FrozenInstanceError):
            setattr(one, name, 0)
    with pytest.raises(TypeError, match="frozen"):
        dataclass(type("Loose", (One,), {}))  # as the standard library refuses it


def test_a_record_says_what_the_standard_class_says():
    for arguments in ((1, (2, 3)), (1, (2,), {"k": 1}), (1, (), {}, "other")):
        assert repr(Made(*arguments)) == repr(Standard(*arguments))
        assert asdict(Made(*arguments)) == asdict(Standard(*arguments))
        assert hash(Made(*arguments)) == hash(Standard(*arguments))
    assert [f.name for f in fields(Made)] == [f.name for f in fields(Standard)] and is_dataclass(Made)


def test_records_are_equal_as_the_standard_ones():
    pairs = [((1, ()), (1, ())), ((1, ()), (2, ())), ((1, (), {"k": 1}), (1, ())),
             ((1, (), {}, "e"), (1, ()))]
    assert [Made(*a) == Made(*b) for a,
            b in pairs] == [Standard(*a) == Standard(*b) for a, b in pairs] == [True, False, True, False]
    assert One(1) != (1,) and One(1) != Two(1, 0) and One(1) == One(1) and hash(One(1)) == hash((1,))


def test_a_record_is_frozen():
    one = Made(1, ())
    for act in (lambda: setattr(one, "a", 2), lambda: setattr(one, "other", 2), lambda: delattr(one, "a")):
        with pytest.raises(FrozenInstanceError):
            act()
    assert one.a == 1


def test_what_is_wrong_with_arguments_is_what_python_says():
    for arguments, named in (((), {}), ((1, 2, 3, 4, 5), {}), ((1,), {"e": 2})):
        words = []
        for cls in (Made, Standard):
            with pytest.raises(TypeError) as refused:
                cls(*arguments, **named)
            words.append(str(refused.value))
        assert words[0] == words[1]


def test_records_are_replaced_copied_and_sent():
    two = Two(1, 3)
    assert (two.a, two.b) == (1, 6) and replace(two, a=5) == Two(5, 6)
    assert copy.copy(two) == copy.deepcopy(two) == pickle.loads(pickle.dumps(two)) == two
    assert Made(1, ()).c is not Made(1, ()).c


def test_the_hash_of_a_record_is_formed_once_and_stays_in_its_process():
    class Counted:
        asked = 0

        def __hash__(self):
            Counted.asked += 1
            return 5

    counted = Counted()
    one = One(counted)
    # once for the record, once for the tuple
    assert hash(one) == hash(one) == hash((counted,)) and Counted.asked == 2
    copied = copy.copy(one)
    assert hash(copied) == hash(one) and Counted.asked == 3  # a copy forms its own
    assert pickle.dumps(Two(1,
                            3)) == pickle.dumps(_hashed(Two(1, 3))) and asdict(_hashed(Two(1, 3))) == {
                                "a": 1, "b": 6}


def _hashed(one):
    hash(one)
    return one
