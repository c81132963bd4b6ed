"""cluster/kubernetes: kustomize builds it, the schemas of Kubernetes accept it, and it fits the server and itself;
Prometheus accepts the rules and scrapes a server. What is not installed is skipped."""

import copy
import functools
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.parse
import urllib.request

import pytest

try:
    import kubernetes_validate
    import yaml
except ImportError:
    kubernetes_validate = yaml = None

TOP = pathlib.Path(__file__).resolve().parents[2]
FOLDER = TOP / "cluster/kubernetes"
BINARY = os.environ.get("RACEBEAM_BINARY", str(TOP / "build/release/racebeam"))
PATIENCE = float(os.environ.get("RACEBEAM_PATIENCE", 20))
# The kubectl of scripts/cluster-test, which is beside its Python, else one in the PATH.
KUBECTL = shutil.which(
    "kubectl", path=os.pathsep.join([str(pathlib.Path(sys.executable).parent), os.environ.get("PATH", "")])
)
LABELS = {"app.kubernetes.io/name": "racebeam"}
METRIC = re.compile(r"racebeam_\w+")


def wait_for(found):
    """What `found` returns as soon as it is true. It may raise OSError until then."""
    until = time.monotonic() + PATIENCE
    while True:
        try:
            if value := found():
                return value
        except OSError:
            pass
        if time.monotonic() > until:
            raise AssertionError("it took too long")
        time.sleep(0.05)


class Server:
    """A server with --http on a free port, of which `port` is the number."""

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory()
        ready = pathlib.Path(self.folder.name, "ready")
        self.process = subprocess.Popen(
            [
                BINARY,
                "serve",
                "--listen",
                "unix:s",
                "--http",
                "127.0.0.1:0",
                "--ready-file",
                ready,
                "--log-level",
                "error",
            ],
            cwd=self.folder.name,
        )
        self.port = int(wait_for(lambda: re.search(r"http://127\.0\.0\.1:(\d+)", ready.read_text()))[1])
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.folder.cleanup()


def get(port, path):
    with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=PATIENCE) as reply:
        return reply.read().decode()


@functools.cache
def built(name):
    """The objects that kustomize makes of a folder, and what it complains of."""
    done = subprocess.run(
        [KUBECTL, "kustomize", FOLDER / name], capture_output=True, text=True, timeout=PATIENCE, check=True
    )
    return {each["kind"]: each for each in yaml.safe_load_all(done.stdout)}, done.stderr


@pytest.mark.skipif(
    not (yaml and KUBECTL), reason="kubectl or kubernetes-validate is not installed; scripts/cluster-test installs both"
)
class TestManifests:
    def objects(self, name):
        found, complaints = built(name)
        assert complaints == ""
        return copy.deepcopy(found)

    def pod(self, name, kind):
        return self.objects(name)[kind]["spec"]["template"]["spec"]

    def test_the_schemas_accept_all_of_it(self):
        for name, count in (("server", 5), ("benchmark", 1)):
            found = self.objects(name)
            assert len(found) == count
            for each in found.values():
                kubernetes_validate.validate(each, desired_version=kubernetes_validate.latest_version(), strict=True)

    def test_the_schemas_refuse_what_is_wrong(self):
        deployment = self.objects("server")["Deployment"]
        deployment["spec"]["template"]["spec"]["containers"][0]["port"] = 1
        with pytest.raises(kubernetes_validate.ValidationError):
            kubernetes_validate.validate(deployment, desired_version=kubernetes_validate.latest_version(), strict=True)

    def test_the_objects_select_the_pods_of_the_deployment(self):
        found = self.objects("server")
        assert found["Deployment"]["spec"]["selector"]["matchLabels"] == LABELS
        assert found["Deployment"]["spec"]["template"]["metadata"]["labels"] == LABELS
        assert found["Service"]["spec"]["selector"] == LABELS
        assert found["NetworkPolicy"]["spec"]["podSelector"]["matchLabels"] == LABELS
        assert found["PodDisruptionBudget"]["spec"]["selector"]["matchLabels"] == LABELS
        assert found["HorizontalPodAutoscaler"]["spec"]["scaleTargetRef"] == {
            "apiVersion": "apps/v1",
            "kind": "Deployment",
            "name": found["Deployment"]["metadata"]["name"],
        }

    def test_agents_need_one_label_and_may_reach_the_protocol_alone(self):
        agents, monitoring = self.objects("server")["NetworkPolicy"]["spec"]["ingress"]
        assert agents == {
            "from": [{"podSelector": {"matchLabels": {"racebeam-client": "true"}}}],
            "ports": [{"protocol": "TCP", "port": 7800}],
        }
        assert monitoring["ports"] == [{"protocol": "TCP", "port": 7801}]

    def test_a_pod_has_no_privileges(self):
        for pod in (self.pod("server", "Deployment"), self.pod("benchmark", "Job")):
            assert not pod["automountServiceAccountToken"]
            assert pod["securityContext"]["runAsNonRoot"]
            assert pod["containers"][0]["securityContext"] == {
                "allowPrivilegeEscalation": False,
                "readOnlyRootFilesystem": True,
                "capabilities": {"drop": ["ALL"]},
            }

    def test_the_server_takes_its_options(self):
        container = self.pod("server", "Deployment")["containers"][0]
        done = subprocess.run([BINARY, "config", *container["args"]], capture_output=True, text=True, timeout=PATIENCE)
        assert (done.returncode, done.stderr) == (0, "")
        settings = dict(
            line.split(" = ")
            for line in (line.split("  #")[0].strip() for line in done.stdout.splitlines())
            if " = " in line
        )
        ports = {each["name"]: each["containerPort"] for each in container["ports"]}
        assert settings["listen"] == f'["tcp://0.0.0.0:{ports["line"]}"]'
        assert settings["http"] == f'"0.0.0.0:{ports["http"]}"'
        grace = int(settings["grace"])
        assert self.pod("server", "Deployment")["terminationGracePeriodSeconds"] > grace + 5 + 1  # preStop, farewell

    def test_the_server_has_the_pages_of_the_probes(self):
        container = self.pod("server", "Deployment")["containers"][0]
        with Server() as server:
            for probe in ("startupProbe", "livenessProbe", "readinessProbe"):
                get(server.port, container[probe]["httpGet"]["path"])

    def test_every_shard_of_the_benchmark_is_run_once(self):
        job = self.objects("benchmark")["Job"]["spec"]
        command = job["template"]["spec"]["containers"][0]["command"][-1]
        shards = [
            subprocess.run(
                ["sh", "-c", command.replace("exec racebeam", "echo")],
                capture_output=True,
                text=True,
                check=True,
                env=os.environ | {"JOB_COMPLETION_INDEX": str(index)},
            ).stdout.split()[-1]
            for index in range(job["completions"])
        ]
        assert shards == [f"{number}/{len(shards)}" for number in range(1, len(shards) + 1)]


class TestMonitoring:
    def test_every_metric_that_is_named_exists(self):
        with Server() as server:
            exist = set(METRIC.findall(get(server.port, "/metrics")))
        texts = {path: path.read_text() for path in (FOLDER / "monitoring").iterdir()}
        texts[FOLDER / "server/autoscaler.yaml"] = (FOLDER / "server/autoscaler.yaml").read_text()
        for path, text in texts.items():
            metrics = set(METRIC.findall(text))
            assert metrics <= exist, path
        assert "racebeam_sessions_open" in exist

    def test_the_dashboard_is_whole(self):
        dashboard = json.loads((FOLDER / "monitoring/dashboard.json").read_text())
        panels = dashboard["panels"]
        assert len({panel["id"] for panel in panels}) == len(panels)
        assert all(target["expr"] for panel in panels for target in panel["targets"])

    @pytest.mark.needs_programs("promtool")
    def test_promtool_accepts_the_rules_and_their_tests_pass(self):
        for words in (
            ("check", "config", "prometheus.yaml"),
            ("check", "rules", "racebeam.rules.yaml"),
            ("test", "rules", "racebeam.test.yaml"),
        ):
            done = subprocess.run(
                ["promtool", *words], cwd=FOLDER / "monitoring", capture_output=True, text=True, timeout=PATIENCE
            )
            assert done.returncode == 0, done.stdout + done.stderr

    @pytest.mark.needs_programs("prometheus")
    def test_prometheus_scrapes_a_server_and_knows_the_panels(self):
        with Server() as server, tempfile.TemporaryDirectory() as folder:
            text = (
                (FOLDER / "monitoring/prometheus.yaml")
                .read_text()
                .replace("127.0.0.1:7801", f"127.0.0.1:{server.port}")
            )
            pathlib.Path(folder, "prometheus.yaml").write_text(text.replace("15s", "1s"))
            shutil.copy(FOLDER / "monitoring/racebeam.rules.yaml", folder)
            with socket.create_server(("127.0.0.1", 0)) as free:
                port = free.getsockname()[1]
            prometheus = subprocess.Popen(
                [
                    "prometheus",
                    f"--config.file={folder}/prometheus.yaml",
                    f"--storage.tsdb.path={folder}/data",
                    f"--web.listen-address=127.0.0.1:{port}",
                ],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            try:

                def values(expression):
                    reply = get(port, "/api/v1/query?query=" + urllib.parse.quote(expression))
                    return json.loads(reply)["data"]["result"]

                wait_for(lambda: values('up{job="racebeam"} == 1'))
                assert values("racebeam_sessions_open")[0]["value"][1] == "0"
                for panel in json.loads((FOLDER / "monitoring/dashboard.json").read_text())["panels"]:
                    for target in panel["targets"]:
                        values(target["expr"].replace("$__rate_interval", "1m"))  # an error is an HTTPError
            finally:
                prometheus.terminate()
                prometheus.wait()
