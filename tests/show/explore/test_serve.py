"""Who is answered: a page that knows the token, from this machine, under the address that was printed."""
import http.client
import json
import os
import signal
import subprocess
import sys
import threading

import pytest

from stabilab import load, motion
from stabilab.answers.certificate import certificate
from stabilab.errors import InputError
from stabilab.show.explore.bag import unframed
from stabilab.show.explore.serve import LONGEST, Explorer

CASE = "cases/thruster-stuck-major-axis.toml"


@pytest.fixture(scope="module")
def server():
    with Explorer(load(CASE)) as one:
        thread = threading.Thread(target=one.serve_forever, daemon=True)
        thread.start()
        yield one
        one.shutdown()


def ask(server, method, path, body=None, **headers):
    """(status, headers, body) of one question; {token} in the path is the server's."""
    line = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=30)
    line.request(method, path.format(token=server.token), body, {"Content-Type": "application/json", **{k.replace("_", "-"): v for k, v in headers.items()}})
    reply = line.getresponse()
    found = reply.status, dict(reply.getheaders()), reply.read()
    line.close()
    return found


def test_the_page_loads_nothing_from_elsewhere(server):
    status, headers, body = ask(server, "GET", "/{token}/")
    assert status == 200 and b"Small satellite" in body and b"http://" not in body and b"https://" not in body
    assert "connect-src 'self'" in headers["Content-Security-Policy"] and headers["Cache-Control"] == "no-store" and headers["Referrer-Policy"] == "no-referrer"


def test_it_listens_on_the_loopback_address_alone(server):
    assert server.server_address[0] == "127.0.0.1" and server.address.startswith(f"http://127.0.0.1:{server.server_port}/{server.token}")
    assert len(server.token) >= 32


@pytest.mark.parametrize("path", ["/", "/x/", "/{token}x/", "/answer", "/{token}/../etc", "/{token}/nothing"])
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_without_the_token_nothing_is_told(server, method, path):
    status, _, body = ask(server, method, path, "{}" if method == "POST" else None)
    assert status in (403, 404) and b"satellite" not in body


@pytest.mark.parametrize("headers", [{"Host": "evil.example"}, {"Host": "evil.example:80"}, {"Host": ""}, {"Origin": "http://evil.example"}, {"Origin": "null"},
                                     {"Origin": "http://127.0.0.1:1"}])
def test_another_host_or_origin_is_refused(server, headers):
    for method, path, body in (("GET", "/{token}/", None), ("POST", "/{token}/answer", "{}")):
        status, _, told = ask(server, method, path, body, **headers)
        assert status == 403 and b"not served here" in told


def test_the_page_itself_is_answered(server):
    status, _, body = ask(server, "POST", "/{token}/answer", "{}", Origin=f"http://127.0.0.1:{server.server_port}")
    case = load(CASE)
    assert status == 200 and unframed(body)[0]["fate"] == motion(case.scene, case.state).fate.word


@pytest.mark.parametrize("body, headers", [
    ("", {}), ("[]", {}), ("{", {}), ("{}", {"Content_Type": "text/plain"}), (None, {"Content_Length": str(LONGEST + 1)}),
                                           (None, {"Content_Length": "-1"}), ("[" * 9000, {})])
def test_what_is_no_question_is_refused(server, body, headers):
    status, _, told = ask(server, "POST", "/{token}/answer", body, **headers)
    assert status == 400 and b"expected" in told


def test_other_methods_are_not_known(server):
    assert ask(server, "DELETE", "/{token}/")[0] == 501


def test_a_certificate_is_checked_and_a_false_one_is_seen(server):
    case = load(CASE)
    made = certificate(case.scene, case.exact_state)
    told = unframed(ask(server, "POST", "/{token}/verify", json.dumps({"text": json.dumps(made)}))[2])[0]
    assert told["status"] == "proved" and told["findings"]
    made["motion"]["fate"] = "spin-up"
    assert unframed(ask(server, "POST", "/{token}/verify", json.dumps({"text": json.dumps(made)}))[2])[0]["status"] == "refuted"
    for text in ("{}", "no JSON", 3, "\ud800"):
        assert "no certificate" in unframed(ask(server, "POST", "/{token}/verify", json.dumps({"text": text}))[2])[0]["error"]


def test_an_older_question_gives_way_to_a_newer_one(server):
    """The first is followed off the axes; while it is, the second comes."""
    tilted = {"torque": {"axis": 1, "size": "0.02", "tilt": "2", "azimuth": "0"}}
    plain, asked = server.session.answer, threading.Event()

    def overtaken(question, stopped):
        if question is tilted and not asked.is_set():
            asked.set()
            server.answer({"moving": True})
        return plain(question, stopped)
    server.session.answer = overtaken
    try:
        assert server.answer(tilted) is None and server.answer({"moving": True}) is not None
    finally:
        server.session.answer = plain


def test_a_port_that_is_taken_is_told(server):
    with pytest.raises(InputError, match=f"--port: {server.server_port} cannot be had"):
        Explorer(load(CASE), server.server_port)


def test_the_command_prints_its_address_and_ends_at_an_interrupt():
    run = subprocess.Popen([sys.executable, "-m", "stabilab", "explore", CASE, "--no-browser"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                           env={**os.environ, "PYTHONUNBUFFERED": "1"},
                           preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))  # a test run in the background may hand down an ignored one
    try:
        assert run.stdout.readline().startswith("http://127.0.0.1:")
        run.send_signal(signal.SIGINT)
        assert run.wait(20) == 130 and run.stderr.read() == "Ctrl-C ends it.\n"
    finally:
        run.kill()
        run.wait()
