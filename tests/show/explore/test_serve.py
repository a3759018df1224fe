"""Who is answered: a page that knows the token, from this machine, under the address that was printed."""
import http.client
import json
import math
import os
import signal
import socket
import subprocess
import sys
import threading

import pytest

from stabilab import load, motion
from stabilab.answers.certificate import certificate
from stabilab.errors import InputError
from stabilab.show.explore.pictures import unframed
from stabilab.show.explore.serve import LONGEST, Explorer, _Handler

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
    line.request(method, path.format(token=server.token), body,
                 {"Content-Type": "application/json", **{k.replace("_", "-"): v for k, v in headers.items()}})
    reply = line.getresponse()
    found = reply.status, dict(reply.getheaders()), reply.read()
    line.close()
    return found


def test_the_page_loads_nothing_from_elsewhere(server):
    status, headers, body = ask(server, "GET", "/{token}/")
    assert status == 200 and b"Small satellite" in body and b"http://" not in body and b"https://" not in body
    assert "connect-src 'self'" in headers["Content-Security-Policy"] and headers[
        "Cache-Control"] == "no-store" and headers["Referrer-Policy"] == "no-referrer"


def test_it_listens_on_the_loopback_address_alone(server):
    assert server.server_address[0] == "127.0.0.1" and server.address.startswith(
        f"http://127.0.0.1:{server.server_port}/{server.token}")
    assert len(server.token) >= 32


@pytest.mark.parametrize("path", ["/", "/x/", "/{token}x/", "/answer", "/{token}/../etc", "/{token}/nothing"])
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_without_the_token_nothing_is_told(server, method, path):
    status, _, body = ask(server, method, path, "{}" if method == "POST" else None)
    assert status in (403, 404) and b"satellite" not in body


@pytest.mark.parametrize("headers", [{"Host": "evil.example"}, {"Host": "evil.example:80"}, {"Host": ""},
                                     {"Origin": "http://evil.example"}, {"Origin": "null"},
                                     {"Origin": "http://127.0.0.1:1"}])
def test_another_host_or_origin_is_refused(server, headers):
    for method, path, body in (("GET", "/{token}/", None), ("POST", "/{token}/answer", "{}")):
        status, _, told = ask(server, method, path, body, **headers)
        assert status == 403 and b"not served here" in told


def test_the_page_itself_is_answered(server):
    status, _, body = ask(server, "POST", "/{token}/answer", "{}",
                          Origin=f"http://127.0.0.1:{server.server_port}")
    case = load(CASE)
    assert status == 200 and unframed(body)[0]["fate"] == motion(case.scene, case.state).fate.word


@pytest.mark.parametrize("body, headers", [
    ("", {}), ("[]", {}), ("{", {}), ("{}", {"Content_Type": "text/plain"}),
    (None, {"Content_Length": str(LONGEST + 1)}),
                                           (None, {"Content_Length": "-1"}), ("[" * 9000, {})])
def test_what_is_no_question_is_refused(server, body, headers):
    status, _, told = ask(server, "POST", "/{token}/answer", body, **headers)
    assert status == 400 and b"expected" in told


TORQUE = {"axis": 1, "size": "0.02", "tilt": "0", "azimuth": "0"}
WRONG = [True, 1.0, -1, 4, 10**400, math.nan, math.inf, "", "x", "1e400", "9" * 60, "\ud800", "1e-300", [],
         [1], [[[]]], {}, {"a": {}},
         json.loads("[" * 900 + "]" * 900)]


def wrong_bodies():
    """Questions of the right form with one value of a wrong kind, or one that is missing."""
    yield from ({name: value} for name in ("torque", "wheel", "start", "box", "click") for value in WRONG)
    yield from ({"torque": {**TORQUE, name: value}} for name in TORQUE for value in WRONG)
    yield from ({"torque": {key: value for key, value in TORQUE.items() if key != name}} for name in TORQUE)
    yield from ({name: [None, value, None]} for name in ("wheel", "start") for value in WRONG)
    yield from ({"box": {"middle": [0, value, 0], "half": 1}} for value in WRONG)
    yield from ({"box": {"middle": [0, 0, 0], "half": value}} for value in WRONG)
    yield from ({"click": {"turn": value, "rate": 0.1}} for value in WRONG)


def test_every_question_of_a_wrong_kind_gets_a_reply_in_words(server, capfd):
    shown, fine = 0, 0
    for body in [*wrong_bodies()][::2]:
        status, _, told = ask(server, "POST", "/{token}/answer", json.dumps({**body, "moving": True}))
        assert status == 200, (status, told, str(body)[:80])
        error = unframed(told)[0].get("error")
        shown, fine = shown + (error is not None and "expected" in error), fine + (error is None)
        assert error is None or "expected" in error or "phase plane" in error, error
    assert shown > 75 and fine < 15  # no torque, an empty list of clicks and the like are questions
    assert capfd.readouterr() == ("", "")


def test_a_fault_of_the_program_is_told_to_the_page_and_not_to_the_terminal(server, capfd, monkeypatch):
    def fails(question, stopped):
        raise ZeroDivisionError("by \ud800")
    monkeypatch.setattr(server.session, "answer", fails)
    status, headers, told = ask(server, "POST", "/{token}/answer", "{}")
    assert status == 500 and told.startswith(
        b"stabilab failed unexpectedly: ZeroDivisionError: by") and headers["Connection"] == "close"
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("sent, expected", [
    (b"GARBAGE\r\n\r\n", b"400"),
    (b"POST /{token}/answer HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\nContent-Length: "
     b"9\r\n\r\n{}", b"400"),
    (b"POST /{token}/answer HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\nContent-Length: "
     b"1_0\r\n\r\n{}", b"400"),
    (b"POST /{token}/answer HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\nContent-Length: "
     b"1\r\n\r\n{}", b"400"),
    (b"POST /{token}/answer HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\nTransfer-Encoding: "
     b"chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n", b"400"),
    (b"PATCH /{token}/answer HTTP/1.1\r\nHost: {host}\r\n\r\n", b"501"),
    (b"GET /{token}/" + b"x" * 70000 + b" HTTP/1.1\r\n\r\n", b"414")])
def test_what_is_no_request_gets_a_reply_too(server, capfd, sent, expected):
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=20) as line:
        line.sendall(sent.replace(b"{token}",
                                  server.token.encode()).replace(b"{host}", server.hosts[0].encode()))
        line.shutdown(socket.SHUT_WR)
        reply = b""
        while part := line.recv(4096):
            reply += part
    # in words: those of the server, or of the library it stands on
    assert expected in reply and b"expected" in reply or b"Error code" in reply
    assert capfd.readouterr() == ("", "")


def test_a_body_that_does_not_come_is_waited_for_only_so_long(server, capfd, monkeypatch):
    monkeypatch.setattr(_Handler, "timeout", 0.2)
    head = (
        f"POST /{server.token}/answer HTTP/1.1\r\nHost: {server.hosts[0]}\r\nContent-Type: "
        f"application/json\r\nContent-Length: 9\r\n\r\n{{}}")
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=20) as line:
        line.sendall(head.encode())
        assert b" 408 " in line.recv(4096)
    assert capfd.readouterr() == ("", "")


def test_a_certificate_is_checked_and_a_false_one_is_seen(server):
    case = load(CASE)
    made = certificate(case.scene, case.exact_state)
    told = unframed(ask(server, "POST", "/{token}/verify", json.dumps({"text": json.dumps(made)}))[2])[0]
    assert told["status"] == "proved" and told["findings"]
    made["motion"]["fate"] = "spin-up"
    assert unframed(ask(server, "POST", "/{token}/verify",
                        json.dumps({"text": json.dumps(made)}))[2])[0]["status"] == "refuted"
    for text in ("{}", "no JSON", 3, "\ud800"):
        assert "no certificate" in unframed(ask(server, "POST", "/{token}/verify",
                                                json.dumps({"text": text}))[2])[0]["error"]


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
    run = subprocess.Popen([sys.executable, "-m", "stabilab", "explore", CASE, "--no-browser"],
                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                           env={**os.environ, "PYTHONUNBUFFERED": "1"},
                           # a test run in the background may hand down an ignored one
                           preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    try:
        assert run.stdout.readline().startswith("http://127.0.0.1:")
        run.send_signal(signal.SIGINT)
        assert run.wait(20) == 130 and run.stderr.read() == "Ctrl-C ends it.\n"
    finally:
        run.kill()
        run.wait()
