"""The page of the case file names every table, key and effect that the reader knows, and no other."""
import re
from pathlib import Path

from stabilab.case import body, hardware, motion, read, table
from stabilab.physics.effects import REGISTRY, effect_class

PAGE = (Path(__file__).parents[2] / "docs/case-file.md").read_text(encoding="utf-8")


def test_every_table_key_and_effect_stands_on_the_page():
    named = set(re.findall(r"`\[*([\w.]+)\]*`", PAGE)) | set(re.findall(r"\w+", " ".join(
        re.findall(r"`\{(.*?)\}`", PAGE))))
    keys = {*read.TABLES, *body.KEYS, *hardware.THRUSTER, *hardware.WHEEL, *motion.STATES, *motion.SPANS, *motion.BLOCKS, *table.OBSERVED,
            *table.KEYS, *(f"effects.{name}" for name in REGISTRY),
            *(key for name in REGISTRY for key in effect_class(name).keys), "rate", "units", "a", "b", "mu"}
    assert keys - named == {"effects"}
    assert {name.removeprefix("effects.") for name in named if name.startswith("effects.")} == {*REGISTRY, "NAME"}
    assert all(f'"{name}"' in PAGE for name in read.SYSTEMS)
