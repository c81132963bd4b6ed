"""The packages that are not made here: Dockerfile, compose file, Homebrew's formula, Arch's PKGBUILD. Where a linter or
a packager is installed, it accepts them."""

import json
import os
import pathlib
import re
import subprocess
import tempfile
import time

import pytest
from harness import BINARY, sanitized

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PACKAGES = SOURCE / "packages"
BUILD = pathlib.Path(BINARY).parent
MARKS = {"VERSION": "1.2.3", "HOMEPAGE": "https://example.org/racebeam", "SHA256": "0" * 64}
UNPRIVILEGED = {"user": "nobody"} if os.geteuid() == 0 else {}  # makepkg refuses root


class TestRecipes:
    @pytest.fixture(autouse=True)
    def set_up(self):
        with tempfile.TemporaryDirectory() as folder:  # another user may not reach that of pytest
            self.folder = pathlib.Path(folder)
            self.folder.chmod(0o777)  # another user may write here
            yield

    def write(self, recipe):
        """A recipe as scripts/release writes it, in its own folder."""
        text = (PACKAGES / recipe).read_text()
        for mark, value in MARKS.items():
            text = text.replace(f"@{mark}@", value)
        path = self.folder / pathlib.Path(recipe).name
        path.write_text(text)
        return path

    def output(self, *command, **options):
        """What a command prints, which must end with status 0."""
        done = subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **{"cwd": self.folder, **options}
        )
        assert done.returncode == 0, done.stdout
        return done.stdout

    @pytest.mark.needs_programs("hadolint")
    def test_the_dockerfile(self):
        assert self.output("hadolint", "--no-color", PACKAGES / "docker/Dockerfile") == ""

    @pytest.mark.skipif(sanitized(), reason="the container has no sanitizer")
    @pytest.mark.needs_programs("readelf")
    @pytest.mark.needs_programs("dpkg-query")
    def test_the_container_has_the_libraries_that_the_program_needs(self):
        final = (PACKAGES / "docker/Dockerfile").read_text().rpartition("FROM ")[2]
        packages = set(re.findall(r"\blib[\w.+-]+|\bzlib1g\b", final))
        has = packages | {"libc6", "libgcc-s1", "libstdc++6"}  # which Debian always has
        for depends in self.output("dpkg-query", "--show", "--showformat=${Depends}\n", *packages).splitlines():
            has |= {word.split()[0].partition(":")[0] for word in depends.split(", ")}
        libraries = re.findall(r"\(NEEDED\).*\[(.*)\]", self.output("readelf", "--dynamic", BINARY))
        paths = dict(re.findall(r"(\S+) => (/\S+)", self.output("ldd", BINARY)))
        files = [str(pathlib.Path(paths[name]).resolve()).removeprefix("/usr") for name in libraries]
        found = self.output("dpkg-query", "--search", *(f"*{file}" for file in files))
        assert len(files) > 5
        assert {line.partition(":")[0] for line in found.splitlines()} <= has

    def test_the_container_is_the_image_of_the_pods(self):
        lines = (PACKAGES / "docker/Dockerfile").read_text().splitlines()
        pods = "".join(path.read_text() for path in (SOURCE / "cluster/kubernetes").glob("*/*.yaml"))
        user, group = next(line for line in lines if line.startswith("USER ")).split()[1].split(":")
        assert set(re.findall(r"runAsUser: (\d+)", pods)) == {user}
        assert set(re.findall(r"runAsGroup: (\d+)", pods)) == {group}
        exposed = next(line for line in lines if line.startswith("EXPOSE ")).split()[1:]
        assert set(re.findall(r"containerPort: (\d+)", pods)) == set(exposed)
        assert set(re.findall(r"image: (.+)", pods)) == {re.search(r"docker build .* -t (\S+)", lines[0])[1]}
        assert 'ENTRYPOINT ["racebeam"]' in lines  # the pods' commands begin with it, too

    @pytest.mark.needs_programs("bash")
    def test_the_container_knows_whether_its_server_is_well(self, cleanup):
        [command] = re.findall(r"(?m)^  CMD (\[.*\])$", (PACKAGES / "docker/Dockerfile").read_text())
        ready = self.folder / "ready"
        options = ["--listen", f"unix:{self.folder}/socket", "--http", "127.0.0.1:0", "--ready-file", ready]
        server = subprocess.Popen([BINARY, "serve", *options], stderr=subprocess.DEVNULL)
        cleanup(server.wait)
        cleanup(server.kill)
        while not ready.exists():
            assert server.poll() is None
            time.sleep(0.01)
        port = ready.read_text().split()[-1].rpartition(":")[2]

        def status(*change):
            words = [word.replace("7801", port).replace(*change) for word in json.loads(command)]
            return subprocess.run(words, stderr=subprocess.DEVNULL).returncode

        assert status("", "") == 0
        assert status("healthz", "nothing") != 0
        server.kill()
        server.wait()
        assert status("", "") != 0

    def test_the_ports_of_the_container_are_published(self):
        exposed = re.search(r"(?m)^EXPOSE (.*)$", (PACKAGES / "docker/Dockerfile").read_text())[1].split()
        published = re.findall(r'- "127.0.0.1:(\d+):(\d+)"', (PACKAGES / "docker/compose.yaml").read_text())
        assert published == [(port, port) for port in exposed]

    def test_the_container_gets_no_image(self):
        ignored = (SOURCE / ".dockerignore").read_text().splitlines()
        assert {".git", ".venv", "build"} <= set(ignored)

    @pytest.mark.needs_programs("docker-compose")
    def test_the_compose_file(self):
        output = self.output("docker-compose", "-f", PACKAGES / "docker/compose.yaml", "config")
        assert "dockerfile: packages/docker/Dockerfile" in output

    @pytest.mark.needs_programs("ruby")
    def test_the_formula(self):
        assert self.output("ruby", "-wc", self.write("homebrew/racebeam.rb")) == "Syntax OK\n"

    @pytest.mark.needs_programs("shellcheck")
    def test_the_pkgbuild_as_a_program(self):
        unused_or_given = "SC2034,SC2154"  # variables that makepkg reads and sets
        assert (
            self.output("shellcheck", "--shell=bash", f"--exclude={unused_or_given}", self.write("arch/PKGBUILD")) == ""
        )

    @pytest.mark.needs_programs("makepkg")
    def test_the_pkgbuild_as_a_package(self):
        self.write("arch/PKGBUILD")
        output = self.output("makepkg", "--printsrcinfo", **UNPRIVILEGED)
        assert "\tpkgver = 1.2.3\n" in output
        assert "/v1.2.3/racebeam-1.2.3-source.tar.gz\n" in output

    @pytest.mark.skipif(not (BUILD / "packages/texts/racebeam.1").exists(), reason="the build has no man pages")
    def test_the_package_for_arch_has_the_places_of_arch(self):
        self.write("arch/PKGBUILD")
        (self.folder / "racebeam-1.2.3").symlink_to(SOURCE)
        (self.folder / "build").symlink_to(BUILD)
        root = self.folder / "root"
        installed_to_usr = 'cmake() { command cmake "$@" --prefix /usr; }'  # as build() would have configured it
        self.output(
            "bash", "-euc", f"{installed_to_usr}; . ./PKGBUILD; package", env={**os.environ, "pkgdir": str(root)}
        )
        assert {path.name for path in root.iterdir()} == {"usr", "etc"}
        for path in (
            "bin/racebeam",
            "lib/systemd/system/racebeam.service",
            "lib/sysusers.d/racebeam.conf",
            "share/zsh/site-functions/_racebeam",
            "share/licenses/racebeam/LICENSE",
        ):
            assert (root / "usr" / path).is_file(), path
        assert not (root / "usr/share/zsh/vendor-completions").exists()
