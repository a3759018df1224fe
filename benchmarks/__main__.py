"""Measure, and write what was measured where it is read.

python -m benchmarks: every row, into results.json; RESULTS.md and the numbers of README.md and docs/ are then
written from that file. --only TOPIC ...: these topics alone, the other rows keep their runs. --small: the
same in tiny sizes into a folder (--into FOLDER), which only shows that it runs. python -m benchmarks docs:
measures nothing, and writes RESULTS.md and the pages from results.json.
"""
from __future__ import annotations

import argparse
import datetime
import os
import sys
from pathlib import Path

from . import pages, record, suite


def main(arguments: list[str] | None = None) -> int:
    """The exit code: 1 where something failed."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("do", nargs="?", choices=("measure", "docs"), default="measure")
    parser.add_argument("--only", nargs="+", choices=list(record.TOPICS), metavar="TOPIC",
                        help=f"of {', '.join(record.TOPICS)}")
    parser.add_argument("--small", action="store_true", help="tiny sizes, into the folder of --into alone")
    parser.add_argument("--into", type=Path,
                        help="a folder for results.json and RESULTS.md; no page is written")
    asked = parser.parse_args(arguments)
    if asked.small and not asked.into:
        parser.error("--small: its numbers say nothing; expected --into FOLDER, so that they replace none")
    if asked.into:
        asked.into.mkdir(parents=True, exist_ok=True)
    data = asked.into / record.DATA.name if asked.into else record.DATA
    results = record.read(data)
    if asked.do == "measure":
        load = round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else None
        words = " ".join(["python -m benchmarks", *(["--only", *asked.only] if asked.only else [])])
        run = record.Run(datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC"),
                         suite.commit(), suite.machine(), load, words)
        try:
            suite.measure(results, asked.only or list(record.TOPICS), run, asked.small, data)
        except KeyboardInterrupt:
            print("\nended by Ctrl-C: the rows that were not reached are those of before", file=sys.stderr)
    if asked.into:
        data.with_name("RESULTS.md").write_text(pages.text(results), encoding="utf-8")
    else:
        for path in pages.write(results):
            print(f"written: {path.relative_to(record.ROOT)}", file=sys.stderr)
    for topic in results.failed.values():
        print("\n".join(topic), file=sys.stderr)
    return int(bool(results.failed))


if __name__ == "__main__":
    sys.exit(main())
