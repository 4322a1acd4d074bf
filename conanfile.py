# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

"""conan create . -s compiler.cppstd=17 [-o "taut/*:system_eigen=True"]"""

import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain
from conan.tools.files import load

required_conan_version = ">=2.0"


class Taut(ConanFile):
    name = "taut"
    description = "Mass-spring systems whose time step is proved, not guessed"
    license = "MIT"
    topics = ("simulation", "cloth", "mass-spring", "stability", "eigen", "header-only")
    package_type = "header-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"system_eigen": [True, False]}
    default_options = {"system_eigen": False}
    exports_sources = "CMakeLists.txt", "LICENSE", "cmake/*", "include/*", "scripts/*"
    test_package_folder = "tests/consumer/conan"
    no_copy_source = True

    def set_version(self):
        header = load(self, os.path.join(self.recipe_folder, "include/taut/core/version.hpp"))
        self.version = ".".join(re.findall(r"#define TAUT_VERSION_\w+ (\d+)", header))

    def requirements(self):
        if not self.options.system_eigen:
            self.requires("eigen/[>=3.4 <6]", transitive_headers=True)

    def package_id(self):
        self.info.settings.clear()  # headers are the same everywhere

    def validate(self):
        check_min_cppstd(self, 17)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for option in ("TAUT_BUILD_TESTS", "TAUT_BUILD_EXAMPLES"):
            toolchain.cache_variables[option] = False
        toolchain.generate()
        if not self.options.system_eigen:
            CMakeDeps(self).generate()

    def build(self):
        CMake(self).configure()

    def package(self):
        CMake(self).install()

    def package_info(self):
        # Taut's own package files, which know the components.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = ["."]
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
