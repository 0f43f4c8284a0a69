# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the Python module with CMake for pip; CMake's own build needs none of this."""
import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).parent.resolve()
OFF = ["COMMAND", "LIGGGHTS", "TESTS", "BENCHMARKS"]


def version():
    return re.search(r"project\(pfv VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


class BuildWithCMake(build_ext):
    """Installs the component `python` of CMake's build where setuptools packs its files."""

    def build_extension(self, extension):
        # FOLDER/pfv/_pfv.so -> FOLDER
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).parent.parent.resolve()
        build = ROOT / "build-pip"
        os.environ.setdefault("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count()))
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
                        "-DPFV_BUILD_PYTHON=ON", *[f"-DPFV_BUILD_{part}=OFF" for part in OFF],
                        f"-DPython_EXECUTABLE={sys.executable}", "-DPFV_PYTHON_INSTALL_DIR=."], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "pfv_python"], check=True)
        subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", target], check=True)


setup(version=version(), packages=[], ext_modules=[Extension("pfv._pfv", sources=[])],
      cmdclass={"build_ext": BuildWithCMake},
      options={"build": {"build_base": "build-pip/setuptools"}, "egg_info": {"egg_base": "pfvlib/python"}})
