"""The explorer as a local server on the loopback address, by the standard library, or as a folder for any
static web server.

The local server answers a page that knows the random token in the address, from this machine, under the
address that was printed. A name that some other server lets point here is refused by the header Host, a
page of another origin by the header Origin.

In the folder's page Python runs in the browser (Pyodide), and answers there.

The folder holds the page, a worker, and the package without papers, cases and commands. Python itself and
python-flint come from the address of the Pyodide project and from the index of Python packages, or, with a
folder of theirs given, from this folder alone."""
from __future__ import annotations

import hmac
import io
import itertools
import json
import secrets
import shutil
import sys
import threading
import zipfile
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from ...case.read import Case
from ...errors import InputError
from ...files import whole_file
from ...version import __version__
from .. import endings
from ..report.html import TEMPLATES, render
from . import pictures
from .session import Session, Stopped, checked

WAITING = "Working out the first answer ..."


def page(about: dict[str, Any], backend: str, how: str, policy: str = "", **more: Any) -> str:
    """The HTML. about: of `Session.about`; backend: the template that defines how a question is asked; how:
    words on it; policy: what the page may load."""
    return render("explore.html", setup=about | more, backend=backend, how=how, policy=policy,
                  waiting=WAITING)


HOST = "127.0.0.1"
LONGEST = 1 << 23  # bytes of a question: a certificate has at most half
IDLE_SECONDS = 60.0  # s without a word from a page that keeps its line open
POLICY = ("default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
          "connect-src 'self'; base-uri 'none'; form-action 'none'; "
          "frame-ancestors 'none'")
HEADERS = {"Cache-Control": "no-store", "Referrer-Policy": "no-referrer", "X-Content-Type-Options": "nosniff",
           "Content-Security-Policy": POLICY,
           "Cross-Origin-Resource-Policy": "same-origin"}
HOW = "The program that opened this page answers it; nothing leaves this machine."


class Explorer(ThreadingHTTPServer):
    """Serves one case until it is closed. `address` is what a browser opens."""

    daemon_threads = True

    def __init__(self, case: Case, port: int = 0) -> None:
        self.session, self.token = Session(case), secrets.token_urlsafe(24)
        self.newest, self._numbers = 0, itertools.count(1)
        self.html = page(self.session.about(), "explore-server.js", HOW).encode()
        try:
            super().__init__((HOST, port), _Handler)
        except (OSError, OverflowError) as error:
            why = getattr(error, "strerror", None) or error
            raise InputError(f"--port: {port} cannot be had: {why}; leave it out, and a free one is taken"
                             ) from None

    @property
    def hosts(self) -> tuple[str, str]:
        """What a browser that followed the address says it asked."""
        return f"{HOST}:{self.server_port}", f"localhost:{self.server_port}"

    @property
    def address(self) -> str:
        """With the token."""
        return f"http://{HOST}:{self.server_port}/{self.token}/"

    def answer(self, asked: dict[str, Any]) -> bytes | None:
        """The session's answer; None where a newer question made it useless."""
        number = self.newest = next(self._numbers)
        try:
            return self.session.answer(asked, lambda: self.newest != number)
        except Stopped:
            return None

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A page that went away is no fault; anything else, outside of any request, is told."""
        error = sys.exception() if hasattr(sys, "exception") else sys.exc_info()[1]
        if not isinstance(error, (ConnectionError, TimeoutError)):
            super().handle_error(request, client_address)


class _Handler(BaseHTTPRequestHandler):
    server: Explorer
    protocol_version = "HTTP/1.1"
    timeout = IDLE_SECONDS
    server_version, sys_version = "stabilab", ""

    def do_GET(self) -> None:
        """The page."""
        if not self._allowed():
            return
        if self._path() == "":
            self._send(200, self.server.html, "text/html; charset=utf-8")
        else:
            self._refuse(404, "there is nothing here")

    def do_POST(self) -> None:
        """A question."""
        answers: dict[str, Callable[[dict[str, Any]],
                                    bytes | None]] = {"answer": self.server.answer, "verify": checked}
        if not self._allowed():
            return
        route = answers.get(self._path() or "")
        request = self._asked() if route else None
        if route is None:
            self._refuse(404, "there is nothing here")
        elif request is not None:
            try:
                result = route(request)
            except Exception as error:  # of any kind: whoever asked is told, and the terminal stays as it is
                self._refuse(500, f"stabilab failed unexpectedly: {type(error).__name__}: {error!s:.200}")
                return
            self._send(204 if result is None else 200, result or b"", "application/octet-stream")

    def _allowed(self) -> bool:
        """Whether the question comes from the page itself; refuses it otherwise."""
        host, origin = self.headers.get("Host", ""), self.headers.get("Origin")
        if host not in self.server.hosts:
            self._refuse(403, "this host is not served here")
        elif origin is not None and origin not in [f"http://{name}" for name in self.server.hosts]:
            self._refuse(403, "pages of another origin are not served here")
        elif self._path() is None:
            self._refuse(403, "the address lacks the token that stabilab explore printed")
        else:
            return True
        return False

    def _path(self) -> str | None:
        """What stands behind the token; None without the token."""
        token, _, rest = self.path.split("?")[0].removeprefix("/").partition("/")
        return rest if hmac.compare_digest(token.encode(), self.server.token.encode()) else None

    def _asked(self) -> dict[str, Any] | None:
        """The question in the body; refuses what is none."""
        printed = self.headers.get("Content-Length", "")
        length = int(printed) if printed.isascii() and printed.isdigit() and len(printed) < 10 else -1
        if self.headers.get_content_type() != "application/json" or not 0 <= length <= LONGEST:
            self._refuse(400, f"expected JSON of at most {LONGEST} bytes with its length")
            return None
        try:
            body = self.rfile.read(length)
            request = json.loads(body) if len(body) == length else None
        except TimeoutError:
            self._refuse(408, "the body is shorter than its length")
            return None
        except (ValueError, RecursionError):
            request = None
        if not isinstance(request, dict):
            self._refuse(400, "expected a JSON object")
            return None
        return request

    def _refuse(self, status: int, text: str) -> None:
        self.close_connection = True  # what it may still send is not read
        self._send(status, f"{text}\n".encode(errors="backslashreplace"), "text/plain; charset=utf-8")

    def _send(self, status: int, body: bytes, kind: str) -> None:
        self.send_response(status)
        for name, value in {**HEADERS, "Content-Type": kind, "Content-Length": str(len(body))}.items():
            self.send_header(name, value)
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: Any) -> None:
        """Nothing is logged: stderr is for people."""


def serve(case: Case, port: int = 0, browser: bool = True, tell: Callable[[str], None] = print) -> None:
    """Serve a case until the program is interrupted. tell: is given the address once it can be opened."""
    with Explorer(case, port) as server:
        # loads what the first answer needs
        threading.Thread(target=server.session.answer, args=({},), daemon=True).start()
        tell(server.address)
        if browser:
            import webbrowser
            threading.Thread(target=webbrowser.open, args=(server.address,), daemon=True).start()
        server.serve_forever()


# --- The page as a folder
PYODIDE, FLINT = "314.0.7", "0.9.0"  # what the tests load
ADDRESS = f"https://cdn.jsdelivr.net/pyodide/v{PYODIDE}/full/"
NEEDED = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")
LEFT_OUT = ("cases/", "cli/", "commands/", "papers/", "show/templates/")
STATIC_POLICY = ("default-src 'none'; script-src 'unsafe-inline' 'self'; style-src 'unsafe-inline'; "
                 "img-src data:; worker-src 'self'; base-uri 'none'; "
          "form-action 'none'")
CURE = (f'get them by "npm pack pyodide@{PYODIDE}" (unpack it) and "pip download --no-deps '
        f'--only-binary=:all: --python-version 3.14 '
        f'--platform pyemscripten_2026_0_wasm32 python-flint=={FLINT}", all into one folder')
DAY = (1980, 1, 1, 0, 0, 0)  # of files in the archive: the same package gives the same bytes


def write(case: Case, out: Path, pyodide: Path | None = None) -> Path:
    """Write the folder, and return its index.html. pyodide: a folder with Pyodide and a wheel of
    python-flint, which are copied in; None: the page loads both from where they are published. Raises
    InputError where the case has no such page or files of that folder are missing."""
    if pictures.needed(case.scene):
        raise InputError(f"{case.place}: a page without a server has no SciPy, by which the motion of such a "
                         f"body is followed; stabilab explore without "
                         "--static shows it")
    about = Session(case).about()
    out = endings.folder(out)
    wheels = None
    if pyodide is not None:
        wheels = _wheels(pyodide)
        for name in (*NEEDED, *wheels):
            with whole_file(out / "pyodide" / name) as waiting:
                shutil.copyfile(pyodide / name, waiting)
    text = f"Pyodide {PYODIDE} from {ADDRESS}" if wheels is None else "Pyodide from the folder of this page"
    flint = ("python-flint and NumPy from where Pyodide finds them" if wheels is None
             else f"{' and '.join(wheels)} too")
    how = (f"Python runs in this browser and answers here: {text}, {flint}, and stabilab {__version__} from "
           f"stabilab.zip beside this page. "
           + ("" if wheels is None or len(wheels) > 1
              else "Without NumPy a motion that no law decides is not followed."))
    python = {"pyodide": ADDRESS if wheels is None else "pyodide/", "wheels": wheels,
              "arrays": wheels is None, "words": text, "name": Path(case.path).name,
              "text": case.text}
    _written(out / "stabilab.zip", archive())
    _written(out / "worker.js", (TEMPLATES / "explore-worker.js").read_bytes())
    index = out / "index.html"
    _written(index, page(about, "explore-browser.js", how, STATIC_POLICY, python=python).encode())
    return index


def archive() -> bytes:
    """The package as a zip, without what the page does not ask."""
    package, buffer = Path(__file__).parents[2], io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as packed:
        for path in sorted(package.rglob("*.py")):
            location = path.relative_to(package).as_posix()
            if not location.startswith(LEFT_OUT):
                packed.writestr(zipfile.ZipInfo(f"stabilab/{location}", DAY), path.read_bytes(),
                                zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def _wheels(folder: Path) -> list[str]:
    """The wheels in a folder of Pyodide's, python-flint first; InputError with what is missing."""
    missing = [name for name in NEEDED if not (folder / name).is_file()]
    if missing:
        raise InputError(f"--pyodide: {folder} has no {', '.join(missing)}: {CURE}")
    try:
        info = json.loads((folder / "pyodide-lock.json").read_text(encoding="utf-8"))["info"]
        tag = f"cp{''.join(info['python'].split('.')[:2])}-*_{info['abi_version']}_wasm32.whl"
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(f"--pyodide: {folder / 'pyodide-lock.json'} is not Pyodide's: {error}") from None
    entries = {name: sorted(path.name for path in folder.glob(f"{name}-*-cp*-{tag}"))
             for name in ("python_flint", "numpy")}
    if not entries["python_flint"]:
        raise InputError(f"--pyodide: {folder} has no wheel python_flint-*-{tag}: {CURE}")
    return [names[-1] for names in entries.values() if names]


def _written(path: Path, content: bytes) -> None:
    with whole_file(path) as waiting:
        waiting.write_bytes(content)
