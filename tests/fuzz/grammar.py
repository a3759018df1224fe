"""Case files by grammar: tables, keys and values as they should be, now and then one that should not; and
mutated real ones."""
from pathlib import Path

from hypothesis import strategies as st

from stabilab.physics.effects import REGISTRY, effect_class

CASES = sorted((Path(__file__).parents[2] / "cases").glob("*.toml"))
SEEDS = tuple(path.read_text(encoding="utf-8") for path in CASES)
HARD = ["0", "-0.0", "1", "-1", "3", "1e-308", "4.9e-324", "1e-320", "2e-324", "1.7976931348623157e308",
        "1.8e308", "1e400", "-1e400", "1e-400",
        "nan", "-nan", "inf", "-inf", "+1", "1_0", "0x1F", "0o7", "0b1", "9007199254740993", "9" * 400,
        "1e9999", '"2/3"', '"1/0"', '"-1/3"',
        '"0.1"', '""', '"1e"', '"nan"', '"0x1"', '"١"', '"1 2"', '"2 +- 1"', '"__import__(\'os\')"',
        '"9**9**9"', '"1e99999"', "true", "1979-05-27", "07:32:00"]
SCALARS = (st.sampled_from(HARD) | st.floats(allow_nan=False, allow_infinity=False, width=64).map(repr)
           | st.integers(-10**20, 10**20).map(str))
GOOD = st.sampled_from(["1", "2.0", "0.5", "3", "-1", "0", "0.25", '"1/3"', "1e3"])
VECTORS = st.lists(SCALARS, max_size=4).map(lambda v: f"[{', '.join(v)}]")
GOOD_VECTORS = st.lists(GOOD, min_size=3, max_size=3).map(lambda v: f"[{', '.join(v)}]")
STRANGE = st.sampled_from(['"attitude"', "[[]]", "{}", "{a = 1}", "[[1, 2, 3]]", '"\\u001b[31m"', "'''\n'''",
                           "[" * 200 + "]" * 200,
                           '"\\uD7FF\\U0010FFFF"']) | \
    st.text(max_size=8).map(lambda s: "'" + s.replace("'", "").replace("\n", "").replace("\r", "") + "'")
VALUES = st.one_of(GOOD_VECTORS, GOOD_VECTORS, GOOD, GOOD, VECTORS, SCALARS, STRANGE)
BODIES = st.sampled_from(["[2000.0, 1500.0, 1000.0]", "[3, 2, 1]", "[1, 1, 1]", "[1, 1, 2]",
                          '["1e-300", "1e-300", "1e-300"]', "[1e308, 1e308, 1e308]",
                          "[2, 1, 1e-320]"]) | VECTORS
ODD_KEYS = st.sampled_from(['""', '"é"', '"a.b"', "'\\u001b'", '"\\u202e"', '"\\n"', "a.b.c", "A", "-", "1",
                            ".".join("a" * 60)]) | \
    st.text(max_size=5).map(lambda s: "'" + s.replace("'", "").replace("\n", "").replace("\r", "") + "'")
TABLES = {"scaled": ("a", "b", "mu"),
          "motion": ("angular_velocity", "x", "span", "tau", "vertical", "attitude", "velocity", "position"),
          "expect": ("kind", "points", "fate", "axis", "verdicts", "extremes", "period"),
          "sweep": ('"effects.gyrostat.momentum"', '"body.inertia"', '"motion.x"', '"scaled.a"', '"body"',
                    '"..."'),
          **{f"effects.{name}": effect_class(name).keys for name in REGISTRY}, "effects": tuple(REGISTRY)}
TOKENS = ["[", "]", "[[", "]]", "{", "}", "=", ",", ".", '"', "'", '"""', "'''", "\\", "#", "\n", "\r\n",
          "\r", "\0", "\x1b[2J", "\ufeff", "é", "\u2028",
          *HARD[:-7], "body", "scaled", "effects", "mu", "torque", "x", "tau", "span", "inertia", "[body]",
          "[motion]", "[sweep]", "[[body]]",
          "x = [0, 0, 0]", "9" * 5000, "[" * 3000, "a." * 3000]


@st.composite
def _table(draw, name):
    keys = draw(st.lists(st.sampled_from(TABLES[name]), max_size=4, unique=draw(st.integers(0, 9)) > 0))
    rows = [f"{key} = {draw(VALUES)}" for key in keys]
    if not draw(st.integers(0, 15)):
        rows.append(f"{draw(ODD_KEYS)} = {draw(VALUES)}")
    return f"[{name}]\n" + "\n".join(rows) + "\n"


@st.composite
def written_cases(draw) -> bytes:
    """A case file by grammar."""
    parts = ([] if draw(st.integers(0, 4)) == 0
             else [f"[body]\ninertia = {draw(BODIES)}\n" + draw(st.sampled_from(["", "mass = 10\n"]))])
    names = draw(st.lists(st.sampled_from(tuple(TABLES)), max_size=5, unique=draw(st.integers(0, 9)) > 0))
    parts += [draw(_table(name)) for name in names]
    head = draw(st.sampled_from(["", 'title = "t"\n', "title = 3\n", '"title" = """\n"""\n']))
    end = draw(st.sampled_from(["\n", "\n", "\r\n"]))
    return (head + "".join(draw(st.permutations(parts)))).replace("\n", end).encode("utf-8", "surrogatepass")


@st.composite
def mutated_cases(draw, seeds=SEEDS) -> bytes:
    """A real case file with up to six stretches replaced."""
    text = draw(st.sampled_from(seeds))
    for _ in range(draw(st.integers(1, 6))):
        at, length = draw(st.integers(0, len(text))), draw(st.integers(0, 30))
        text = text[:at] + draw(st.sampled_from(TOKENS) | st.text(max_size=4)) + text[at + length:]
    return text.encode("utf-8", "surrogatepass")
