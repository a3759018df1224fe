"""Whatever words stand in a certificate: what `verify` prints of it has been checked, or is quoted as named in
the file, or the file is refused. Every string and every key is changed in turn, of every kind of certificate."""
import copy
import re

import pytest

from stabilab.show import certification
from stabilab.verify import verify
from stabilab.verify.form import about, differences, line
from stabilab.verify.numbers import Malformed
from tests.verify import test_closed, test_diagrams
from tests.verify.test_forged_certificates import FILES, KINDS, case_proved, proved

# the second would close a quotation, end a line, and go on as a proof
WORDS = ("wheels.fly.speed", "x'); PROVED\n\x1b[1mproved      the motion is bounded (\"for ever", "proved")
MARK = r"named in the file: (?:'(?:[^'\\]|\\.)*'|\"(?:[^\"\\]|\\.)*\")"


# whose checks take some seconds in all; every other file is for the long tests
SLOW = {*FILES} - {"sphere-wheel"} | {
    "torque in no axis", "torque in no axis, scaled", "released at rest", "bounded in a well", "free, round",
    "free, in a well", "past a cusp", "on a hyperbola", "diagram: a moment of inertia", "diagram: a circle of a motion"}


def certificates():
    makers = ({name: lambda name=name: proved(*KINDS[name]) for name in KINDS}
              | {name: lambda name=name: case_proved(name) for name in FILES}
              | {f"closed: {kind}": lambda kind=kind: test_closed.made(kind)[2] for kind in test_closed.KINDS}
              | {f"diagram: {name}": lambda name=name: test_diagrams.made(name) for name in test_diagrams.KNOWN})
    return [pytest.param(make, id=name, marks=[pytest.mark.slow] * (name in SLOW) + [pytest.mark.long] * (name in FILES[1::2]))
            for name, make in makers.items()]


def places(value, path=()):
    """Paths of all strings, and of all keys."""
    if isinstance(value, dict):
        for key, entry in value.items():
            yield (*path, key), True
            yield from places(entry, (*path, key))
    elif isinstance(value, list):
        for n, entry in enumerate(value):
            yield from places(entry, (*path, n))
    elif isinstance(value, str):
        yield path, False


def changed(certificate, path, is_key, words):
    out = place = copy.deepcopy(certificate)
    for key in path[:-1]:
        place = place[key]
    if is_key:
        place[words] = copy.deepcopy(place[path[-1]])
    else:
        place[path[-1]] = words
    return out


def printed(certificate):
    """All that is printed, as text and as JSON; None where it is refused."""
    try:
        found, told = verify(certificate), about(certificate)
    except Malformed:
        return None
    lines = certification.text(found, line(told), physical=told.get("variables") == "physical").split("\n")
    said = certification.as_dict(found, told)
    return lines, [word for one in said["findings"] for word in one.values()] + differences(told, {})


def without_marks(text):
    return re.sub(MARK, "", text)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("make", certificates())
def test_words_of_a_file_are_refused_or_quoted_as_its_own(make):
    certificate = make()
    found = list(places(certificate))
    # of many alike, such as the numbers of a way or of pieces, some of each kind of place
    kinds = {}
    for path, is_key in found:
        kinds.setdefault((tuple(key for key in path if isinstance(key, str)), is_key), path)
    plain = printed(certificate)
    for (_, is_key), path in kinds.items():
        for words in WORDS[1:2] if is_key else WORDS:
            shown = printed(changed(certificate, path, is_key, words))
            if shown is None:
                continue
            lines, said = shown
            for text in (*lines, *said):
                bare = without_marks(text)
                assert words[:12] not in bare or bare in (*plain[0], *plain[1]), (path, text)
                assert "\x1b" not in text and text.isprintable(), (path, text)
            extra = 1 if is_key else 0  # a key without a meaning has a line of its own
            assert len(lines) <= len(plain[0]) + extra, path


def test_a_diagram_s_name_of_what_varies_is_its_own_and_the_scene_says_what_it_is():
    made = test_diagrams.made("off the axes")
    for name in ("wheels.fly.speed", "it is stable', PROVED ("):
        told = about(made | {"number": name})
        assert f"as a number t (named in the file: {name!r}) goes from" in line(told)
        assert told["named_in_the_file"] == name and "number" not in told
    assert "as a number t goes from" in line(about({k: v for k, v in made.items() if k != "number"}))
