"""The pages that a user reads and the help of the commands use the field's words, none of our own."""
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# words that stood for: reported, page or part, the user's pointer, exactly as written, compared with
OURS = re.compile(r"\b(told|houses?|doors?|your hand|the hand|(?:moving|resting) hand|at its word|"
                  r"held against|holds against)\b", re.IGNORECASE)
MADE = ("changelog.md", "readme.md", "contributing.md", "results.md")  # of other files
PAGES = [ROOT / "README.md", *(page for page in sorted((ROOT / "docs").glob("*.md")) if page.name not in MADE)]


def prose(text):
    """A page without its blocks of code, code in lines, and addresses of links."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"`[^`\n]*`", "", re.sub(r"\]\([^)]*\)", "]", text))


@pytest.mark.parametrize("page", PAGES, ids=[page.stem for page in PAGES])
def test_a_page_has_none_of_our_own_words(page):
    assert OURS.findall(prose(page.read_text(encoding="utf-8"))) == []


def test_the_help_of_every_command_has_none_of_our_own_words(stabilab):
    from stabilab.show.terminal.groups import GROUPS
    for _, names in GROUPS.values():
        for name in names:
            assert OURS.findall(stabilab(name, "--help")[1]) == [], name
