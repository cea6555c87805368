"""The server as a process: TLS, signals, restarts, and the examples for clients. Argument: the program's path."""
import json
import os
import pathlib
import signal
import socket
import ssl
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from web_socket import WebSocket  # noqa: E402

PROGRAM = sys.argv.pop(1)
ROOT = pathlib.Path(__file__).resolve().parents[2]
TOKEN = "service-test-token-0123456789"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Server:
    """`lightwell serve` on the software device, with a folder of its own unless given one."""

    def __init__(self, *options, data=None, context=None):
        self.port = free_port()
        self.context = context
        self.data = data or tempfile.TemporaryDirectory()
        folder = self.data if isinstance(self.data, str) else self.data.name
        self.log = tempfile.TemporaryFile()
        self.process = subprocess.Popen(
            [PROGRAM, "serve", "builtin:cornell", "--device", "software", "--port", str(self.port), "--data", folder,
             "--log-format", "json", *options], stdout=subprocess.DEVNULL, stderr=self.log)

    @property
    def url(self):
        return f"{'https' if self.context else 'http'}://localhost:{self.port}"

    def ask(self, method, path, body=None, headers=None):
        """(status, headers, bytes); 0 if nobody answers."""
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.url + path, data, {"Content-Type": "application/json", **(headers or {})},
                                         method=method)
        try:
            with urllib.request.urlopen(request, timeout=120, context=self.context) as response:
                return response.status, response.headers, response.read()
        except urllib.error.HTTPError as error:
            return error.code, error.headers, error.read()
        except (urllib.error.URLError, ConnectionError):
            return 0, {}, b""

    def wait_until_ready(self):
        deadline = time.monotonic() + 90
        while self.ask("GET", "/readyz")[0] != 200:
            if self.process.poll() is not None or time.monotonic() > deadline:
                raise AssertionError(f"not ready: {self.log_text()}")
            time.sleep(0.05)
        return self

    def wait_until(self, condition, seconds=60):
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > deadline:
                raise AssertionError(f"it never came: {self.log_text()}")
            time.sleep(0.05)

    def metric(self, name):
        """A number that /metrics tells."""
        lines = self.ask("GET", "/metrics")[2].decode().splitlines()
        return next(float(line.split()[1]) for line in lines if line.startswith(name + " "))

    def log_text(self):
        self.log.seek(0)
        return self.log.read().decode()

    def log_events(self):
        return [json.loads(line) for line in self.log_text().splitlines()]

    def stop(self, how=signal.SIGKILL):
        self.process.send_signal(how)
        code = self.process.wait(timeout=60)
        return code


def small(**more):
    return {"scene": "cornell", "width": 48, "height": 32, "settings": {"samples": 4, "indirect_size": 16}, **more}


class TlsTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.key, self.certificate = f"{self.folder.name}/key.pem", f"{self.folder.name}/certificate.pem"
        subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=localhost",
                        "-addext", "subjectAltName=DNS:localhost", "-keyout", self.key, "-out", self.certificate],
                       check=True, capture_output=True)
        context = ssl.create_default_context(cafile=self.certificate)
        self.server = Server("--tls-certificate", self.certificate, "--tls-key", self.key, "--token", TOKEN,
                             "--host", "0.0.0.0", context=context).wait_until_ready()

    def tearDown(self):
        self.server.stop()
        self.folder.cleanup()

    def test_https(self):
        bearer = {"Authorization": f"Bearer {TOKEN}"}
        self.assertEqual(self.server.ask("GET", "/v1/scenes")[0], 401)
        self.assertEqual(self.server.ask("GET", "/v1/scenes", headers=bearer)[0], 200)
        status, headers, picture = self.server.ask("POST", "/v1/render", small(), bearer)
        self.assertEqual((status, headers["Content-Type"], picture[:4]), (200, "image/png", b"\x89PNG"))
        self.assertIn("trace;dur=", headers["Server-Timing"])

        # Who speaks plain HTTP is told so.
        with socket.create_connection(("127.0.0.1", self.server.port)) as line:
            line.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
            answer = line.makefile("rb").read()
        self.assertTrue(answer.startswith(b"HTTP/1.1 400 "), answer)
        self.assertIn(b"this port speaks TLS", answer)

        # Old versions of TLS are not spoken.
        old = ssl.create_default_context(cafile=self.certificate)
        old.minimum_version = ssl.TLSVersion.TLSv1
        old.maximum_version = ssl.TLSVersion.TLSv1_1
        with socket.create_connection(("127.0.0.1", self.server.port)) as line, self.assertRaises((ssl.SSLError, OSError)):
            old.wrap_socket(line, server_hostname="localhost")

        # A WebSocket goes the same way: the handshake is answered and a hello is welcomed.
        session = json.loads(self.server.ask("POST", "/v1/sessions", small(), bearer)[2])["id"]
        stream = WebSocket(self.server.port, f"/v1/sessions/{session}/stream", f"lightwell.v1, bearer.{TOKEN}",
                           self.server.context)
        self.assertEqual(stream.status, 101)
        stream.send({"type": "hello", "codecs": ["jpeg"], "width": 48, "height": 32})
        self.assertEqual(stream.receive()["type"], "welcome")
        stream.close()


class SignalTest(unittest.TestCase):
    def test_sigterm_drains(self):
        server = Server("--drain-delay", "5").wait_until_ready()
        slow = subprocess.Popen(["curl", "--silent", "--output", "/dev/null", "--write-out", "%{http_code}", "--json",
                                 json.dumps(small(spp_frames=150)), f"{server.url}/v1/render"], stdout=subprocess.PIPE)
        server.wait_until(lambda: server.metric("lightwell_renders_waiting") == 1)
        server.process.send_signal(signal.SIGTERM)
        server.wait_until(lambda: server.ask("GET", "/readyz")[0] == 503)  # a balancer sends nobody more
        self.assertEqual(server.ask("GET", "/v1/scenes")[0], 200)  # and who comes still is served
        self.assertEqual(slow.communicate(timeout=60)[0], b"200")
        self.assertEqual(server.process.wait(timeout=60), 0)
        events = [event["event"] for event in server.log_events() if event["event"] != "request"]
        self.assertEqual([events[0], *events[-2:]], ["starting", "stopping", "stopped"])

    def test_a_second_signal_ends_it_at_once(self):
        server = Server("--drain-delay", "60").wait_until_ready()
        server.process.send_signal(signal.SIGTERM)
        server.wait_until(lambda: server.ask("GET", "/readyz")[0] == 503)
        server.process.send_signal(signal.SIGTERM)
        self.assertEqual(server.process.wait(timeout=30), -signal.SIGTERM)


class RestartTest(unittest.TestCase):
    def test_a_killed_server_loses_no_finished_frame(self):
        with tempfile.TemporaryDirectory() as data, tempfile.TemporaryDirectory() as other:
            request = small(last_frame=29, spp_frames=2, keyframes=[
                {"path": "/extensions/KHR_lights_punctual/lights/0/intensity", "times_s": [0, 1], "values": [10, 40]}])
            first = Server(data=data).wait_until_ready()
            sequence = json.loads(first.ask("POST", "/v1/sequences", request)[2])
            path = f"/v1/sequences/{sequence['id']}"
            while json.loads(first.ask("GET", path)[2])["frames_done"] < 5:
                time.sleep(0.02)
            first.stop(signal.SIGKILL)
            folder = pathlib.Path(data, "sequences", sequence["id"])
            finished = {file.name: file.stat().st_mtime_ns for file in folder.glob("0*.png")}
            self.assertGreaterEqual(len(finished), 5)

            second = Server(data=data).wait_until_ready()
            deadline = time.monotonic() + 100
            while (state := json.loads(second.ask("GET", path)[2]))["state"] != "done":
                self.assertLess(time.monotonic(), deadline, state)
                time.sleep(0.1)
            self.assertEqual(state["frames_done"], 30)
            kept = [name for name, time_ns in finished.items() if folder.joinpath(name).stat().st_mtime_ns == time_ns]
            self.assertGreaterEqual(len(kept), len(finished) - 1)  # one may have been written, and not booked yet
            status, headers, archive = second.ask("GET", path + "/archive")
            self.assertEqual(status, 200)
            second.stop()

            # The same request elsewhere gives the same name and the same bytes.
            third = Server(data=other).wait_until_ready()
            self.assertEqual(json.loads(third.ask("POST", "/v1/sequences", request)[2])["id"], sequence["id"])
            while json.loads(third.ask("GET", path)[2])["state"] != "done":
                time.sleep(0.1)
            self.assertEqual(third.ask("GET", path + "/archive")[2], archive)
            third.stop()


class FaultTest(unittest.TestCase):
    def test_a_lost_device_is_set_up_again(self):
        os.environ["LIGHTWELL_FAULT"] = "device-lost@3"
        try:
            server = Server().wait_until_ready()
        finally:
            del os.environ["LIGHTWELL_FAULT"]
        session = json.loads(server.ask("POST", "/v1/sessions", small(playing=False))[2])["id"]
        pictures = [server.ask("GET", f"/v1/sessions/{session}/frame?format=png") for _ in range(6)]
        self.assertEqual([status for status, _, _ in pictures], [200] * 6)
        self.assertEqual(len({picture for _, _, picture in pictures}), 1)
        self.assertIn(b"lightwell_device_rebuilds_total 1\n", server.ask("GET", "/metrics")[2])
        self.assertEqual([event["reason"] for event in server.log_events() if event["event"] == "device_lost"],
                         ["LIGHTWELL_FAULT says so"])
        server.stop()


class ExamplesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server("--token", TOKEN).wait_until_ready()
        cls.folder = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        cls.server.stop()
        cls.folder.cleanup()

    def run_example(self, *command, code=0, token=TOKEN):
        environment = {**os.environ, "LIGHTWELL_URL": self.server.url.replace("localhost", "127.0.0.1"),
                       "LIGHTWELL_TOKEN": token}
        run = subprocess.run([ROOT / "examples" / command[0], *command[1:]], env=environment, capture_output=True,
                             timeout=120, text=True)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout + run.stderr

    def test_curl(self):
        picture = pathlib.Path(self.folder.name, "picture.png")
        self.assertIn("trace;dur=", self.run_example("picture.sh", str(picture)))
        self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")
        self.run_example("picture.sh", str(picture), code=22, token="not-the-token-of-this-server")

    def test_python(self):
        for picture_format, frames in (("png", 6), ("exr", 2)):
            folder = pathlib.Path(self.folder.name, picture_format)
            out = self.run_example("sequence.py", str(folder), "--frames", str(frames), "--format", picture_format)
            self.assertIn(f"done: {frames} of {frames} frames", out)
            self.assertEqual(len(list(folder.glob(f"*.{picture_format}"))), frames)
        self.assertIn("there is no scene", self.run_example("sequence.py", "x", "--scene", "nothing", code=1))

    def test_javascript(self):
        folder = pathlib.Path(self.folder.name, "session")
        self.run_example("session.mjs", str(folder))
        before, after = (folder.joinpath(name).read_bytes() for name in ("before.png", "after.png"))
        self.assertEqual(before[:4], b"\x89PNG")
        self.assertNotEqual(before, after)


if __name__ == "__main__":
    unittest.main(warnings="ignore")
