"""The libraries for C++ as a package of Conan 2: `conan create packages/conan`. The program is not part of it."""

import pathlib
import re
import shutil

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain
from conan.tools.files import copy, load

PARTS = ("system", "emulator", "games", "environment", "library", "include", "clients/cpp", "packages")


class Racebeam(ConanFile):
    name = "racebeam"
    description = "Atari 2600 games for agents, in the process of the caller"
    license = "MIT"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False]}
    default_options = {"shared": False}
    generators = "CMakeDeps"
    package_type = "library"

    @property
    def tree(self):
        return pathlib.Path(self.recipe_folder).parents[1]

    def set_version(self):
        text = load(self, self.tree / "CMakeLists.txt")
        self.version = re.search(r"project\(racebeam VERSION ([0-9.]+)", text)[1]

    def export_sources(self):
        # copy() walks the whole folder that it gets: here each part, rather than the tree with its builds.
        into = pathlib.Path(self.export_sources_folder)
        for name in ("CMakeLists.txt", "LICENSE"):
            shutil.copy2(self.tree / name, into)
        for part in PARTS:
            copy(self, "*", self.tree / part, into / part)

    def requirements(self):
        self.requires("openssl/[>=3 <4]")
        self.requires("zlib/[>=1.2.11 <2]")

    def build_requirements(self):
        self.tool_requires("cmake/[>=3.25]")
        self.test_requires("tomlplusplus/[>=3.3 <4]")
        if self.settings.arch == "x86_64":
            self.test_requires("xbyak/[>=6]")

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["RACEBEAM_PROGRAM"] = False
        toolchain.cache_variables["BUILD_TESTING"] = False
        toolchain.cache_variables["RACEBEAM_SHARED"] = bool(self.options.shared)
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, pathlib.Path(self.package_folder, "licenses"))
        cmake = CMake(self)
        cmake.install(component="development")
        if self.options.shared:
            cmake.install(component="library")

    def package_info(self):
        # The package's own racebeamConfig.cmake is what find_package reads.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = ["lib/cmake/racebeam"]
        self.cpp_info.libs = ["racebeam"]
