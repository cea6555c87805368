"""The files of setup/deploy, held to what can be known of them without a cluster: they are well formed, name what there
is, and the commands in them run. Argument: the program's path."""
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

import yaml

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from service_test import Server  # noqa: E402  (takes the program's path from the arguments)

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEPLOY = ROOT / "setup/deploy"
HAPROXY = shutil.which("haproxy") or "/usr/sbin/haproxy"


def options_of(command):
    """Every option that the program's help names."""
    text = subprocess.run([PROGRAM, command, "--help"], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", text)) | {"-o"}


def given_options(words):
    return {word for word in words if re.fullmatch(r"--[a-z][a-z-]*|-[a-z]", word)}


def run_with_program(folder, words, **environment):
    """As a worker would, with the program in its path and pictures so small that a hundred take seconds."""
    bin_folder = pathlib.Path(folder, "bin")
    bin_folder.mkdir(exist_ok=True)
    small = bin_folder / "lightwell"
    small.write_text(f'#!/bin/sh\nexec {PROGRAM} "$@" --size 16x16 --samples 1 --indirect-size 8 --shadow-size 64\n')
    small.chmod(0o755)
    return subprocess.run(words, env={"PATH": f"{bin_folder}:/usr/bin:/bin", **environment}, capture_output=True,
                          text=True, timeout=250)


class KubernetesTest(unittest.TestCase):
    def setUp(self):
        with open(DEPLOY / "kubernetes.yaml") as file:
            everything = list(yaml.safe_load_all(file))
        self.claims = [each for each in everything if each["kind"] == "PersistentVolumeClaim"]
        self.objects = {each["kind"]: each for each in everything if each not in self.claims}

    def pod_of(self, kind):
        return self.objects[kind]["spec"]["template"]["spec"]

    def container_of(self, kind):
        (container,) = self.pod_of(kind)["containers"]
        return container

    def test_objects_are_of_the_versions_that_have_them(self):
        versions = {kind: each["apiVersion"] for kind, each in self.objects.items()}
        self.assertEqual(versions, {"StatefulSet": "apps/v1", "Service": "v1", "Job": "batch/v1"})
        self.assertEqual([each["apiVersion"] for each in self.claims], ["v1", "v1"])
        for each in [*self.objects.values(), *self.claims]:
            self.assertRegex(each["metadata"]["name"], r"^[a-z0-9]([a-z0-9-]*[a-z0-9])?$")

    def test_names_lead_to_what_they_mean(self):
        servers, service = self.objects["StatefulSet"], self.objects["Service"]
        labels = servers["spec"]["template"]["metadata"]["labels"]
        self.assertEqual(servers["spec"]["selector"]["matchLabels"], labels)
        self.assertEqual(service["spec"]["selector"], labels)
        self.assertEqual(servers["spec"]["serviceName"], service["metadata"]["name"])
        for kind in ("StatefulSet", "Job"):
            volumes = self.pod_of(kind)["volumes"]
            mounts = self.container_of(kind)["volumeMounts"]
            self.assertEqual([each["name"] for each in mounts], [each["name"] for each in volumes])
            claims = {each["metadata"]["name"]: each["spec"]["accessModes"] for each in self.claims}
            for each in volumes:  # of all pods at once
                self.assertEqual(claims[each["persistentVolumeClaim"]["claimName"]], ["ReadWriteMany"])
            for each in mounts:
                self.assertTrue(each["mountPath"].startswith("/"))

    def test_probes_and_ports_are_those_of_the_server(self):
        container = self.container_of("StatefulSet")
        (port,) = container["ports"]
        document = (ROOT / "protocol/openapi.json").read_text()
        for probe in ("readinessProbe", "livenessProbe"):
            self.assertEqual(container[probe]["httpGet"]["port"], port["containerPort"])
            self.assertIn(f'"{container[probe]["httpGet"]["path"]}"', document)
        self.assertEqual(self.objects["Service"]["spec"]["ports"], [{"name": "http", "port": port["containerPort"]}])
        self.assertIn(f'EXPOSE {port["containerPort"]}\n', (DEPLOY / "Dockerfile").read_text())

    def test_pods_may_finish_their_drain(self):
        entry_point = re.search(r'"--drain-delay", "(\d+)"', (DEPLOY / "Dockerfile").read_text())
        drain_s = int(entry_point.group(1)) + 15  # what is in flight may take so long: kDrainLimit
        self.assertGreater(self.pod_of("StatefulSet")["terminationGracePeriodSeconds"], drain_s)

    def test_the_workers_of_the_job_render_each_frame_once(self):
        spec = self.objects["Job"]["spec"]
        self.assertEqual(spec["completionMode"], "Indexed")
        self.assertIn(self.pod_of("Job")["restartPolicy"], ("Never", "OnFailure"))
        container = self.container_of("Job")
        self.assertEqual(container["command"], ["bash", "-c"])
        (script,) = container["args"]
        self.assertLessEqual(given_options(shlex.split(script)), options_of("render"))
        with tempfile.TemporaryDirectory() as folder:
            for index in (0, 3):
                result = run_with_program(folder, ["bash", "-c", script.replace("/frames/", f"{folder}/")],
                                          JOB_COMPLETION_INDEX=str(index))
                self.assertEqual(result.returncode, 0, result.stderr)
            frames = sorted(int(path.stem) for path in pathlib.Path(folder).glob("*.png"))
        self.assertEqual(frames, [*range(100), *range(300, 400)])


class MetricsTest(unittest.TestCase):
    """How Prometheus is told to ask, held to what a server answers that asks for tokens."""
    TOKEN = "a-token-of-the-deploy-test"

    def setUp(self):
        with open(DEPLOY / "kubernetes.yaml") as file:
            self.objects = {each["kind"]: each for each in yaml.safe_load_all(file)}
        with open(DEPLOY / "service_monitor.yaml") as file:
            self.monitor = yaml.safe_load(file)
        with open(DEPLOY / "prometheus.yml") as file:
            (self.scraping,) = yaml.safe_load(file)["scrape_configs"]
        self.server = Server("--token", self.TOKEN).wait_until_ready()

    def tearDown(self):
        self.server.stop()

    def test_the_monitor_finds_the_service_and_its_token(self):
        self.assertEqual((self.monitor["apiVersion"], self.monitor["kind"]),
                         ("monitoring.coreos.com/v1", "ServiceMonitor"))
        service = self.objects["Service"]
        self.assertLessEqual(self.monitor["spec"]["selector"]["matchLabels"].items(),
                             service["metadata"]["labels"].items())
        (endpoint,) = self.monitor["spec"]["endpoints"]
        self.assertIn(endpoint["port"], [port["name"] for port in service["spec"]["ports"]])
        (container,) = self.objects["StatefulSet"]["spec"]["template"]["spec"]["containers"]
        (token,) = [each for each in container["env"] if each["name"] == "LIGHTWELL_TOKEN"]
        self.assertEqual(endpoint["authorization"]["credentials"], token["valueFrom"]["secretKeyRef"])

    def test_asked_so_a_server_tells_and_not_otherwise(self):
        (endpoint,) = self.monitor["spec"]["endpoints"]
        for path, authorization in ((endpoint["path"], endpoint["authorization"]),
                                    (self.scraping["metrics_path"], self.scraping["authorization"])):
            fields = {"Authorization": f"{authorization['type']} {self.TOKEN}"}
            status, headers, body = self.server.ask("GET", path, headers=fields)
            self.assertEqual((status, headers.get_content_type()), (200, "text/plain"))
            self.assertIn(b"lightwell_ready 1", body)
            self.assertEqual(self.server.ask("GET", path)[0], 401)

    def test_the_targets_are_the_balancers_servers(self):
        (group,) = self.scraping["static_configs"]
        servers = re.findall(r"^  server \S+ (\S+)$", (DEPLOY / "haproxy.cfg").read_text(), re.MULTILINE)
        self.assertEqual(group["targets"], servers)


class SlurmTest(unittest.TestCase):
    SCRIPT = DEPLOY / "film.slurm"

    def test_asks_for_what_slurm_knows(self):
        asked = re.findall(r"^#SBATCH +(\S+)", self.SCRIPT.read_text(), re.MULTILINE)
        self.assertTrue(asked)
        for option in asked:
            self.assertIn(option.split("=")[0], {"--gres", "--requeue", "--array", "--time", "--cpus-per-task", "--mem"})

    def test_a_task_renders_its_hundred_frames(self):
        with tempfile.TemporaryDirectory() as folder:
            result = run_with_program(folder, ["bash", self.SCRIPT, "builtin:cornell", f"{folder}/film"],
                                      SLURM_ARRAY_TASK_ID="2")
            self.assertEqual(result.returncode, 0, result.stderr)
            frames = sorted(int(path.stem) for path in pathlib.Path(folder, "film").glob("*.png"))
        self.assertEqual(frames, [*range(200, 300)])

    def test_says_what_it_wants(self):
        result = subprocess.run(["bash", self.SCRIPT], capture_output=True, text=True)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("usage: film.slurm SCENE FOLDER", result.stderr)


class DockerfileTest(unittest.TestCase):
    def setUp(self):
        text = (DEPLOY / "Dockerfile").read_text()
        self.lines = [line for line in text.splitlines() if line and not line.startswith("#")]

    def values(self, instruction):
        return [line.split(" ", 1)[1] for line in self.lines if line.split(" ", 1)[0] == instruction]

    def test_has_instructions_that_there_are(self):
        known = {"FROM", "COPY", "WORKDIR", "RUN", "ENV", "USER", "VOLUME", "EXPOSE", "HEALTHCHECK", "ENTRYPOINT"}
        self.assertLessEqual({line.split(" ", 1)[0] for line in self.lines}, known)
        self.assertTrue(self.lines[0].startswith("FROM "))

    def test_commands_are_shell(self):
        for command in self.values("RUN"):
            subprocess.run(["bash", "-n", "-c", command], check=True)

    def test_copies_what_a_build_makes(self):
        """From this very build, which has the same targets, and from the sources."""
        built, copied = PROGRAM.parent, 0
        for value in self.values("COPY"):
            match = re.fullmatch(r"--from=build /source/(\S+) (\S+)", value)
            if not match:
                self.assertEqual(value, ". /source")
                continue
            copied += 1
            source = match.group(1)
            path = built / source[len("build/release/"):] if source.startswith("build/release/") else ROOT / source
            self.assertTrue(path.exists(), source)
        self.assertGreater(copied, 1)
        modules = {path.name for path in built.glob("liblightwell_*.so")}
        self.assertEqual(modules, {name for name in modules if any(name in value for value in self.values("COPY"))})

    def test_what_was_copied_runs_from_where_it_lies(self):
        """The program finds its modules beside the folder it is in, as they are copied."""
        with tempfile.TemporaryDirectory() as root:
            for value in self.values("COPY"):
                match = re.fullmatch(r"--from=build /source/build/release/(\S+) /(\S+)", value)
                if match:
                    target = pathlib.Path(root, match.group(2))
                    target.mkdir(parents=True, exist_ok=True)
                    shutil.copy(PROGRAM.parent / match.group(1), target)
            picture = pathlib.Path(root, "picture.png")
            subprocess.run([f"{root}/usr/local/bin/lightwell", "render", "builtin:cornell", "-o", picture, "--size",
                            "16x16"], check=True, capture_output=True, timeout=250)
            self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))

    def test_its_server_is_begun_with_options_that_there_are(self):
        (entry_point,) = self.values("ENTRYPOINT")
        words = yaml.safe_load(entry_point)
        self.assertEqual(words[:2], ["lightwell", "serve"])
        self.assertLessEqual(given_options(words), options_of("serve"))


class HaproxyTest(unittest.TestCase):
    def test_takes_its_configuration(self):
        result = subprocess.run([HAPROXY, "-c", "-f", DEPLOY / "haproxy.cfg"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)


if __name__ == "__main__":
    unittest.main(warnings="ignore")
