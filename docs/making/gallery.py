"""The gallery: every case of the repository with its picture, its answer in one line, its file and the
commands that give these.

The page `gallery.md` begins with questions, then has all pictures by outcome; a page an outcome has the
rest. Pictures and answers take half a minute, so they are kept beside a hash of the case and of the whole
program, and made again when either has changed.
"""
from __future__ import annotations

import hashlib
import json
from pathlib import Path

from . import cards
from .written import page

ROOT = Path(__file__).parents[2]
FOLDER = "gallery"
QUESTION = "question-"  # the name of the picture of a question begins so
SHARP = 75  # dots an inch: a picture as wide as the text, some 20 kB
HEAD = """# Cases

## By question

"""
# question, the page that answers it, the case of whose picture its card has
QUESTIONS = (("My thruster is stuck open: what happens, how soon, how large?", "stuck", "geostationary-22n"),
             ("How far is the motion from the separatrix?", "distance", "minor-axis-100"),
             ("What does accuracy cost in time?", "cost", "minor-axis-100"),
             ("Where do formulas that are right on paper lose their digits?", "hard-cases", "top-fast"),
             ("What do the five papers say, and what is so?", "audit", "charged-body"))
ABOUT = """Each card below is a case file of the folder `cases/`: a body, what acts on it, and one motion; its
picture has the size of the rates over time, and the limit where there is one. A click leads to the answer,
the file and the commands.

"""
LEAD = (
    "What becomes of each of these cases, in bold; its picture, the commands that give both, and its "
    "file.\n\n")


def write(docs: Path, cases: list[Path] | None = None) -> list[str]:
    """Write gallery.md, gallery/<group>.md and the pictures of the cases; the names of all cases, in the
    order of the pages. cases: None for all."""
    from stabilab.papers.report import LOOKS
    (docs / FOLDER / cards.FOLDER).mkdir(parents=True, exist_ok=True)
    entries = [entry(path, docs / FOLDER) for path in cases or sorted((ROOT / "cases").glob("*.toml"))]
    grouped = {title: sorted((one for one in entries if one["group"] == title), key=lambda one: one["scene"])
               for title in LOOKS.values()}
    grouped = {title: rows for title, rows in grouped.items() if rows}
    page(docs / "gallery.md", overview(grouped, questions(entries, docs / FOLDER)))
    known = ({f"{slug(title)}.md" for title in grouped}
             | {f"{one['name']}.json" for one in entries})
    drawn = {file for one in entries
             for file in (one["card"], one["picture"]["file"], one["picture"]["narrow"]["file"])}
    for path in (docs / FOLDER / cards.FOLDER).glob("*.png"):
        if path.name not in drawn and not path.name.startswith(QUESTION):
            path.unlink()
    for path in (docs / FOLDER).iterdir():
        if path.is_file() and path.name not in known:  # of a case or a group that is gone
            path.unlink()
    for title, rows in grouped.items():
        page(docs / FOLDER / f"{slug(title)}.md", f"# {title}\n\n{LEAD}" + "\n".join(map(section, rows)))
    return [one["name"] for rows in grouped.values() for one in rows]


def entry(path: Path, folder: Path) -> dict:
    """What the pages say of one case; its picture is in the folder then."""
    text = path.read_text(encoding="utf-8")
    key, kept = hashlib.sha256((program() + text).encode()).hexdigest(), folder / f"{path.stem}.json"
    if kept.exists() and (folder / cards.FOLDER / f"{path.stem}.png").exists():
        known = json.loads(kept.read_text(encoding="utf-8"))
        if known["key"] == key:
            return known
    known = {"key": key, "name": path.stem, "text": text} | made(path, folder)
    kept.write_text(json.dumps(known, ensure_ascii=False), encoding="utf-8")
    return known


def made(path: Path, folder: Path) -> dict:
    """Title, source, outcome, number of its kind of scene, answer and kind of picture of a case, which is
    drawn, with what its card says. Of a sweep the first combination is drawn; its card has all."""
    from stabilab.case.read import load_all
    from stabilab.papers.report import GROUPS, LOOKS, group
    from stabilab.show import narrow
    from stabilab.show.plot import subject as which
    from stabilab.show.plot.subject import subject
    from stabilab.show.plot.to_file import write
    from stabilab.show.report import html
    from stabilab.show.report.one_case import card_of
    from stabilab.show.terminal import written
    from stabilab.show.text.headline import headline, look
    case, *others = load_all(path)
    one = subject(case)
    drawn = folder / cards.FOLDER / f"{path.stem}.png"
    drawn.parent.mkdir(parents=True, exist_ok=True)
    write(one, drawn, dpi=SHARP, narrow=narrow.beside(drawn))
    first = f"The first of {1 + len(others)} combinations is drawn: " if others else ""
    return {"title": written(case.title), "source": written(case.source or ""),
            "scene": [title for title, _ in GROUPS].index(group(case)),
            **card_of([case, *others], folder / cards.FOLDER),
            "group": LOOKS["" if others or case.state is None else look(one.motion)],
            "kind": which.default(one), "picture": html.picture(drawn, narrow.beside(drawn)),
            "answer": first + headline(case, one.motion)}


def program() -> str:
    """A hash of everything that a picture or an answer may depend on."""
    seen = hashlib.sha256(Path(__file__).read_bytes() + Path(cards.__file__).read_bytes())
    for path in sorted((ROOT / "stabilab").rglob("*.py")):
        seen.update(path.read_bytes())
    return seen.hexdigest()


def questions(entries: list[dict], folder: Path) -> list[str]:
    """The cards of the questions whose cases are among the entries; their pictures are kept beside a hash of
    the program."""
    from stabilab.case.read import load_all
    held, kept, built = {one["name"] for one in entries}, folder / cards.FOLDER / "questions.txt", []
    same = kept.exists() and kept.read_text(encoding="utf-8") == program()
    for question, about, name in QUESTIONS:
        file = folder / cards.FOLDER / f"{QUESTION}{about}.png"
        if name in held:
            if not (same and file.exists()):
                cards.draw(about, load_all(ROOT / "cases" / f"{name}.toml")[0], file)
            built.append(cards.of_question(f"{about}.html", question, file.name if file.exists() else ""))
    kept.write_text(program(), encoding="utf-8")
    return built


def overview(grouped: dict[str, list[dict]], asked: list[str]) -> str:
    """The page of all pictures."""
    parts = [HEAD, cards.colours(), *cards.cards(asked), ABOUT]
    for title, rows in grouped.items():
        parts.append(f"## [{title}]({FOLDER}/{slug(title)}.md)\n")
        where = f"{FOLDER}/{slug(title)}.html#"
        parts += cards.cards([cards.of_case(where + one["name"].replace("_", "-"), one) for one in rows])
    pages = "\n".join(f"{FOLDER}/{slug(title)}" for title in grouped)
    return "\n".join(parts) + f"\n```{{toctree}}\n:hidden:\n\n{pages}\n```\n"


def section(one: dict) -> str:
    """One case on the page of its group."""
    source = f"\n\n*Source: {plain(one['source'])}.*" if one["source"] else ""
    name = f"cases/{one['name']}.toml"
    return (f"## {one['name']}\n\n{plain(one['title'])}. "
            f"**{plain(one['answer'])}.**{source}\n\n{cards.wide(one['picture'], one['title'])}\n"
            f"```sh\nstabilab classify {name}\nstabilab plot {name} --kind {one['kind']} --out "
            f"{one['name']}.png\n```\n\n```toml\n{one['text']}```\n")


def plain(text: str) -> str:
    """The text with what Markdown takes for markup as letters."""
    return "".join(f"\\{letter}" if letter in "*_[]<>`|$" else letter for letter in text)


def slug(title: str) -> str:
    """A file name of a title."""
    return "-".join("".join(letter if letter.isalnum() else " " for letter in title.lower()).split())
