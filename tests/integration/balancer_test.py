"""Three server processes behind Debian's haproxy with the configuration of setup/deploy. Argument: the program's path."""
import csv
import json
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from service_test import ROOT, Server, free_port, small  # noqa: E402  (takes the program's path from the arguments)
from web_socket import Viewer  # noqa: E402

HAPROXY = shutil.which("haproxy") or "/usr/sbin/haproxy"


class BalancerTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.servers = [Server("--drain-delay", "8", "--max-request-rate", "0", data=f"{self.folder.name}/data")
                        for _ in range(3)]
        for server in self.servers:
            server.wait_until_ready()
        self.proxy_port = free_port()
        text = ROOT.joinpath("setup/deploy/haproxy.cfg").read_text()
        text = text.replace("127.0.0.1:8080", f"127.0.0.1:{self.proxy_port}")
        self.statistics = f"{self.folder.name}/statistics"
        text = text.replace("global\n", f"global\n  stats socket {self.statistics}\n")
        for number, server in enumerate(self.servers, 1):
            text = text.replace(f"127.0.0.1:900{number}", f"127.0.0.1:{server.port}")
        configuration = pathlib.Path(self.folder.name, "haproxy.cfg")
        configuration.write_text(text)
        self.proxy = subprocess.Popen([HAPROXY, "-f", configuration], stderr=subprocess.PIPE)
        self.wait_until(lambda: self.servers_up() == 3)

    def tearDown(self):
        self.proxy.kill()
        self.proxy.wait()
        self.proxy.stderr.close()
        for server in self.servers:
            if server.process.poll() is None:
                server.stop()
        self.folder.cleanup()

    def wait_until(self, condition, seconds=60):
        deadline = time.monotonic() + seconds
        while not condition():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.1)

    def servers_up(self):
        """How many servers the balancer has asked, and found well."""
        try:
            with socket.socket(socket.AF_UNIX) as line:
                line.connect(self.statistics)
                line.sendall(b"show stat\n")
                rows = line.makefile().read().lstrip("# ").splitlines()
        except OSError:  # it does not listen yet
            return 0
        return sum(row["svname"].startswith("gpu") and row["check_status"] == "L7OK" for row in csv.DictReader(rows))

    def ask(self, method, path, body=None):
        """Of whichever server the balancer chooses."""
        return Server.ask(self, method, path, body)

    context = None

    @property
    def url(self):
        return f"http://localhost:{self.proxy_port}"

    def begin_sessions(self, count):
        """Each with an edit of its own, by which it is known again."""
        sessions = {}
        for number in range(count):
            session = json.loads(self.ask("POST", "/v1/sessions", {**small(), "playing": False})[2])["id"]
            self.assertEqual(self.ask("PATCH", f"/v1/sessions/{session}", {"time_s": number})[0], 200)
            sessions[session] = number
        return sessions

    def home_of(self, session):
        homes = [server for server in self.servers
                 if server.process.poll() is None and server.ask("GET", f"/v1/sessions/{session}")[0] == 200]
        self.assertEqual(len(homes), 1)
        return homes[0]

    def session(self, session):
        """What the balancer's choice of server says of it; none if it does not have it."""
        status, _, body = self.ask("GET", f"/v1/sessions/{session}")
        return json.loads(body) if status == 200 else None

    def edit_light(self, intensity):
        return [{"op": "replace", "path": "/extensions/KHR_lights_punctual/lights/0/intensity", "value": intensity}]

    def test_a_killed_server_takes_no_session_and_no_frame_with_it(self):
        sessions = self.begin_sessions(12)
        homes = {session: self.home_of(session) for session in sessions}
        self.assertEqual(len(set(homes.values())), 3, "the sessions are not spread")
        for session, number in sessions.items():  # sticky: each is found again, whoever is asked in between
            self.assertEqual(json.loads(self.ask("GET", f"/v1/sessions/{session}")[2])["time_s"], number)
        victim = self.servers[1]
        on_victim = [session for session, home in homes.items() if home is victim]
        viewers = {session: Viewer(self.proxy_port, session) for session in on_victim}
        for number, viewer in enumerate(viewers.values()):
            self.assertEqual(viewer.welcome["role"], "driver")
            viewer.socket.send({"type": "input", "seq": 1, "edits": self.edit_light(100 + number)})
            self.assertTrue(viewer.frame_of_input(1))

        requests = [small(last_frame=24, settings={"samples": 4, "indirect_size": 16, "seed": seed}) for seed in range(4)]
        sequences = [json.loads(self.ask("POST", "/v1/sequences", request)[2])["id"] for request in requests]
        while sum(json.loads(self.ask("GET", f"/v1/sequences/{each}")[2])["frames_done"] for each in sequences) < 20:
            time.sleep(0.05)
        victim.stop(signal.SIGKILL)

        for session, number in sessions.items():
            if homes[session] is not victim:
                self.assertEqual(json.loads(self.ask("GET", f"/v1/sessions/{session}")[2])["time_s"], number)
        deadline = time.monotonic() + 120
        for each in sequences:
            while (state := json.loads(self.ask("GET", f"/v1/sequences/{each}")[2]))["state"] != "done":
                self.assertLess(time.monotonic(), deadline, state)
                time.sleep(0.2)
            self.assertEqual(state["frames_done"], 25)
            status, _, archive = self.ask("GET", f"/v1/sequences/{each}/archive")
            self.assertEqual((status, archive.count(b"PK\x01\x02")), (200, 25))
        # The sessions of the killed server go on at the others, as their viewers left them.
        for number, (session, before) in enumerate(viewers.items()):
            self.assertIsNone(before.next(lambda message: False))  # its stream has ended
            before.close()
            self.wait_until(lambda: self.session(session))
            self.assertEqual(self.session(session)["time_s"], sessions[session])
            self.assertIsNot(self.home_of(session), victim)
            stranger, same = Viewer(self.proxy_port, session), Viewer(self.proxy_port, session, before.welcome["resume"])
            self.assertEqual((stranger.welcome["role"], same.welcome["role"]), ("viewer", "driver"))
            self.assertEqual(same.welcome["lights"][0]["intensity"], 100 + number)
            same.socket.send({"type": "input", "seq": 1, "edits": self.edit_light(7)})
            self.assertTrue(same.frame_of_input(1))
            stranger.close()
            same.close()

    def test_a_server_is_drained_without_a_broken_request(self):
        failures, answered = [], []
        stop = threading.Event()

        def keep_asking():
            while not stop.is_set():
                status = self.ask("POST", "/v1/render", small())[0]
                (answered if status == 200 else failures).append(status)

        askers = [threading.Thread(target=keep_asking) for _ in range(4)]
        for asker in askers:
            asker.start()
        self.wait_until(lambda: len(answered) > 10)
        self.servers[2].process.send_signal(signal.SIGTERM)
        code = self.servers[2].process.wait(timeout=120)
        after = len(answered)
        self.wait_until(lambda: failures or len(answered) > after + 10)
        stop.set()
        for asker in askers:
            asker.join()
        self.assertEqual(code, 0)
        self.assertEqual(failures, [])
        self.assertGreater(len(answered), 20)


if __name__ == "__main__":
    unittest.main(warnings="ignore")
