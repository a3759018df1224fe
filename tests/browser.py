"""A real browser for tests: headless Chromium through its DevTools protocol, over a pair of pipes and without
any package."""
from __future__ import annotations

import base64
import json
import os
import select
import shutil
import subprocess
import time
from pathlib import Path

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FLAGS = ("--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", "--disable-gpu-vsync", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--disable-extensions", "--mute-audio", "--hide-scrollbars")


class Browser:
    """One page. `console`: what it wrote there and every error; `requests`: every address that it asked for.
    """

    def __init__(self, profile: Path, width: int = 1300, height: int = 1000, flags=()):
        down, self._up = os.pipe()
        self._out, up = os.pipe()
        self.console, self.requests, self._number, self._rest = [], [], 0, b""
        # the protocol is spoken over the descriptors 3 and 4, whatever their numbers are here
        script = f'exec "$0" "$@" 3<&{down} 4>&{up}'
        self._process = subprocess.Popen(
            ["bash", "-c", script, CHROMIUM, *FLAGS, *flags, f"--window-size={width},{height}",
             f"--user-data-dir={profile}", "--remote-debugging-pipe",
             "about:blank"],
            pass_fds=(down, up), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(down), os.close(up)
        (page,) = [one for one in self.ask("Target.getTargets", session=None)["targetInfos"]
                   if one["type"] == "page"]
        self._session = self.ask("Target.attachToTarget", session=None, targetId=page["targetId"],
                                 flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.ask(f"{domain}.enable")
        self.size(width, height)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()
        os.close(self._up), os.close(self._out)

    def ask(self, method: str, session: str | None = "", patience: float = 60.0, **parameters):
        """The result of a command of the protocol."""
        self._number += 1
        number = self._number
        to = {} if session is None else {"sessionId": self._session}
        os.write(self._up,
                 json.dumps({"id": number, "method": method, "params": parameters, **to}).encode() + b"\0")
        end = time.monotonic() + patience
        while True:
            message = self._next(end)
            if message.get("id") == number:
                assert "error" not in message, f"{method}: {message['error']}"
                return message["result"]

    def _next(self, end: float) -> dict:
        while b"\0" not in self._rest:
            ready, _, _ = select.select([self._out], [], [], max(0.0, end - time.monotonic()))
            assert ready, "the browser does not answer"
            part = os.read(self._out, 1 << 20)
            assert part, "the browser ended"
            self._rest += part
        raw, _, self._rest = self._rest.partition(b"\0")
        message = json.loads(raw)
        self._note(message.get("method"), message.get("params", {}))
        return message

    def _note(self, method, told):
        if method == "Runtime.consoleAPICalled":
            self.console.append(" ".join(str(one.get("value", one.get("description", "")))
                                         for one in told["args"]))
        elif method == "Runtime.exceptionThrown":
            self.console.append(str(told["exceptionDetails"].get("exception",
                                                                 told["exceptionDetails"]).get("description",
                                                                                               told)))
        elif method == "Log.entryAdded":
            self.console.append(f"{told['entry']['text']} {told['entry'].get('url', '')}")
        elif method == "Network.requestWillBeSent":
            self.requests.append(told["request"]["url"])

    def size(self, width: int, height: int):
        """The size of the window's inside."""
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                 mobile=False)

    def open(self, address: str):
        """Go to an address; its status is not judged."""
        self.ask("Page.navigate", url=address)

    def run(self, expression: str):
        """The value of an expression of JavaScript in the page."""
        found = self.ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in found, found["exceptionDetails"].get("exception", found)
        return found["result"].get("value")

    def until(self, expression: str, patience: float = 30.0):
        """The value of an expression once it is true; an error with the page's text where it never is."""
        end = time.monotonic() + patience
        while time.monotonic() < end:
            try:
                if value := self.run(expression):
                    return value
            except AssertionError:  # the page is not there yet
                pass
            time.sleep(0.03)
        raise AssertionError(
            f"never true: {expression}; console {self.console}; page "
            f"{self.run('document.body && document.body.innerText')!r:.2000}")

    def click(self, selector: str, x: float = 0.5, y: float = 0.5):
        """A real click at a share of the width and height of an element."""
        across, down = self.run(f"(() => {{ const one = document.querySelector({selector!r}); "
                                f"one.scrollIntoView({{block: 'center'}}); "
                                f"const r = one.getBoundingClientRect(); return [r.x + r.width * {x}, r.y + "
                                f"r.height * {y}]; }})()")
        self._mouse("mousePressed", across, down)
        self._mouse("mouseReleased", across, down)

    def drag(self, selector: str, shares):
        """Press at the first share of an element's width, and go on to the others with the button held."""
        places = self.run(f"(() => {{ const one = document.querySelector({selector!r}); "
                          f"one.scrollIntoView({{block: 'center'}}); "
                          f"const r = one.getBoundingClientRect(); return [r.x, r.width, r.y + r.height / "
                          f"2]; }})()")
        left, width, down = places
        for n, share in enumerate(shares):
            self._mouse("mouseMoved" if n else "mousePressed", left + share * width, down)
            yield share
        self._mouse("mouseReleased", left + share * width, down)

    def _mouse(self, kind, x, y):
        self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left",
                 buttons=int(kind != "mouseReleased"), clickCount=1)

    def key(self, name: str):
        """Press and release a key."""
        codes = {"ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40, "Enter": 13, "Tab": 9}
        for kind in ("keyDown", "keyUp"):
            self.ask("Input.dispatchKeyEvent", type=kind, key=name, code=name,
                     windowsVirtualKeyCode=codes[name])

    def picture(self, path: Path) -> Path:
        """A screenshot of the whole page."""
        shot = self.ask("Page.captureScreenshot", format="png", captureBeyondViewport=True)
        path.write_bytes(base64.b64decode(shot["data"]))
        return path
