"""What a text seems to be that is no case file: named by how it begins, so that an error can say it; and the
files of other programs that `stabilab import` reads."""
from __future__ import annotations

import csv
import re
from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from pathlib import Path


_ROOT = re.compile(r"\s*(?:<\?.*?\?>\s*|<!--.*?-->\s*|<!DOCTYPE[^>\[]*(?:\[.*?\])?\s*>\s*)*"
                   r"<([A-Za-z_][\w.:-]*)", re.S)
_APM = re.compile(r"\s*(?:COMMENT.*\n\s*)*CCSDS_APM_VERS")


class Importer(NamedTuple):
    """Files of another program. name: with its article; holds: whether a text is one; module: of `programs`,
    loaded where one is read, with a function `read(text, path, body)` -> a `Craft`, or the text of a case;
    files: how they are named; bodies: whether one body of several can be asked for."""

    name: str
    holds: Callable[[str], bool]
    module: str
    files: str = ""
    bodies: bool = False

    def read(self, text: str, path: Path, body: str | None = None) -> Any:
        """What the file says of its spacecraft. Raises InputError where that makes no case."""
        return import_module(f".programs.{self.module}", __package__).read(text, path, body)


def is_42(text: str) -> bool:
    """Whether a text is a file of NASA's simulator 42."""
    return "42:" in text[:200] and "!" in text


def root_of(text: str) -> str:
    """The tag of the first element of an XML text, without its namespace; "" of any other text."""
    match = _ROOT.match(text.lstrip("\ufeff"))
    return match[1].rpartition(":")[2] if match else ""


def with_root(tag: str) -> Callable[[str], bool]:
    """Whether a text is XML whose root has this tag."""
    return lambda text: root_of(text) == tag


def is_apm(text: str) -> bool:
    """Whether a text is a CCSDS attitude parameter message (in XML alone, or among others)."""
    return bool(_APM.match(text.lstrip("\ufeff"))) or root_of(text) == "apm" or (
        root_of(text) == "ndm" and "<apm" in text)


# of a head of a table: a moment or a product of inertia
TABLE_HEAD = r"(?:moment )?[ij]_?(xx|yy|zz|xy|xz|yz|yx|zx|zy|11|22|33|12|13|23|21|31|32|[xyz123])"


def split_head(cell: str) -> tuple[str, str]:
    """(name, unit) of the head of a column, such as "Ixx [kg m^2]"; the unit "" where there is none."""
    match = re.fullmatch(r"\s*(.*?)\s*(?:\[(.*)\]|\((.*)\))?\s*", cell, re.S)
    return (match[1], (match[2] or match[3] or "").strip()) if match else (cell.strip(), "")


def cells_of(text: str) -> list[tuple[int, list[str]]]:
    """(line, cells) of the lines of a table that are neither empty nor comments, by the mark that its head
    has most often."""
    lines = [(n, line) for n, line in enumerate(text.lstrip("\ufeff").splitlines(), 1)
             if line.strip(" ,;\t") and not line.lstrip().startswith("#")]
    mark = max(",;\t", key=lines[0][1].count) if lines else ","
    return [(n, next(csv.reader([line], delimiter=mark))) for n, line in lines]


def is_table(text: str) -> bool:
    """Whether a text is a table of which a column is a moment of inertia."""
    lines = [line for line in text[:4000].splitlines() if line.strip() and not line.lstrip().startswith("#")]
    heads = re.split(r"[,;\t]", lines[0]) if lines else []
    return len(heads) > 2 and "=" not in lines[0] and "{" not in lines[0] and any(
        re.fullmatch(TABLE_HEAD, split_head(head.strip("\" "))[0], re.IGNORECASE) for head in heads)


# The first row that holds a text reads it: a new importer is a file and a row above the last, which takes all
# others.
IMPORTERS = (
    Importer("a NASA 42 spacecraft file", is_42, "import_42", " (SC_*.txt)", bodies=True),
    Importer("a CCSDS attitude parameter message", is_apm, "import_apm", " (APM, KVN or XML)"),
    Importer("a robot description", with_root("robot"), "import_urdf", " (URDF)", bodies=True),
    Importer("a simulation description", with_root("sdf"), "import_sdf", " (SDFormat)", bodies=True),
    Importer("a model of MuJoCo", with_root("mujoco"), "import_mjcf", " (MJCF)", bodies=True),
    Importer("a table of bodies", is_table, "import_table", " (CSV)"),
    Importer("JSON or a Python dictionary with Basilisk's names or with the tables of a case",
             lambda text: True, "import_basilisk"))
FORMATS = ", and ".join(importer.name + importer.files for importer in IMPORTERS)
READ = f"`stabilab import` reads {FORMATS}"


def importer_of(text: str) -> Importer:
    """The first that holds a text."""
    return next(importer for importer in IMPORTERS if importer.holds(text))


# Of which the numbers go over by hand: what they are called there, and where they go.
BY_HAND = ("write its moments as [body] inertia = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]] in kg m^2, "
           "about the centre of mass, and its rates as [motion] angular_velocity = [x, y, z]")
XML = {"ndm": "a CCSDS navigation data message (XML)",
       "gazebo": "a simulation description older than SDFormat 1.3, which `gz sdf -p FILE` writes anew",
       "aem": "a CCSDS attitude ephemeris (AEM, XML)",
       "html": "a page (HTML)", "svg": "a picture (SVG)", "collada": "a mesh (COLLADA, XML)"}
CCSDS = {"APM": "attitude parameter message", "AEM": "attitude ephemeris message",
         "ACM": "attitude comprehensive message", "OPM": "orbit parameter message",
         "OEM": "orbit ephemeris message", "OMM": "orbit mean-elements message",
         "OCM": "orbit comprehensive message", "TDM": "tracking data message"}
FIRST = (("ISO-10303-21", "a CAD model (STEP)"), ("solid ", "a mesh (STL)"), ("#usda", "a scene (USD)"),
         ("%PDF", "a document (PDF)"), ("%YAML", "YAML"), ("---", "YAML"), ("import ", "Python"),
         ("from ", "Python"), ("def ", "Python"), ("#!/usr/bin/env python", "Python"),
         ("function ", "MATLAB"), ("clear", "MATLAB"), ("#include", "C"), ("begin_", "a text of keywords"))
_YAML = re.compile(r"\s*(?:- +)?[\w .\"'/-]+:(?:\s.*)?")
_PAIR = re.compile(r"\s*[\w .\"'-]+=")
# a dictionary over several lines, of which each looks like a key of YAML
_DICTIONARY = re.compile(r"^\w+\s*=\s*\{\s*(?:#.*\n\s*)*[\"'][^\"'\n]*[\"']\s*:", re.M)


def seems(text: str) -> str:
    """What the text seems to be, in words; "" where nothing speaks for anything."""
    head = text.lstrip("\ufeff \t\r\n")
    if (item := importer_of(text)) is not IMPORTERS[-1]:
        return item.name
    if head.startswith("<"):
        tags = re.findall(r"<([A-Za-z][\w.-]*)", head[:4000])
        return next((XML[tag.lower()] for tag in tags if tag.lower() in XML), "XML")
    ccsds = re.match(r"(?:COMMENT.*\n\s*)*CCSDS_([A-Z]{3})_VERS", head)
    if ccsds:
        return f"a CCSDS {CCSDS.get(ccsds[1], 'message')} ({ccsds[1]})"
    if re.match(r"\{\s*[\"}]|\[\s*\{", head):
        return "JSON"
    if _DICTIONARY.search(head):
        return "Python"
    resolved = next((name for phrase, name in FIRST if head.startswith(phrase)), "")
    if resolved:
        return resolved
    lines = [line for line in head.splitlines() if line.strip() and not line.lstrip().startswith(("#", "//"))]
    if _columns(lines):
        return "a table of values (CSV)"
    pairs = sum(bool(_PAIR.match(line)) for line in lines)
    yaml = sum(bool(_YAML.fullmatch(line)) and not _PAIR.match(line) for line in lines)
    titles = any(line.rstrip().endswith(":") for line in lines)
    return "YAML" if yaml > 1 - titles and yaml > pairs and yaml >= 0.3 * len(lines) else ""


def _columns(lines: list[str]) -> bool:
    """Whether the first lines have the same number of columns, two at least, and none is a key with its
    value."""
    if len(lines) < 2 or any("=" in line or "[" in line or "{" in line for line in lines[:5]):
        return False
    counts = [{line.count(mark) for line in lines[:5]} for mark in (",", ";", "\t")]
    return any(len(count) == 1 and min(count) > 1 for count in counts)
