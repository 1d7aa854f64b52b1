# SPDX-License-Identifier: Apache-2.0
"""`pip install .`: builds the Python module by CMake and packs it with its data. The libraries of packages.txt must be
installed. MODELHOUSE_BUILD names a build folder to use, so that what is built there is not built again."""
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = Path(__file__).resolve().parent


class Build(build_ext):
    def build_extension(self, ext):
        build = Path(os.environ.get("MODELHOUSE_BUILD", Path(self.build_temp).resolve()))
        if not (build / "CMakeCache.txt").exists():
            subprocess.check_call(["cmake", "-S", HERE, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                                   "-DMODELHOUSE_BUILD_TESTS=OFF"])
        subprocess.check_call(["cmake", "--build", build, "--target", "modelhouse_python"])
        package = Path(self.get_ext_fullpath(ext.name)).resolve().parent
        with tempfile.TemporaryDirectory() as prefix:
            for component in ("python", "data"):
                subprocess.check_call(["cmake", "--install", build, "--component", component, "--prefix", prefix])
            share = Path(prefix) / "share/modelhouse"
            shutil.copytree(share / "python/modelhouse", package, dirs_exist_ok=True)
            shutil.rmtree(share / "python")
            shutil.copytree(share, package / "data", dirs_exist_ok=True)


setup(version=re.search(r"project\(\w+ VERSION ([\d.]+)", (HERE / "CMakeLists.txt").read_text())[1],
      packages=["modelhouse"], package_dir={"": "python"}, package_data={"modelhouse": ["*.pyi", "py.typed"]},
      ext_modules=[Extension("modelhouse._core", [])], cmdclass={"build_ext": Build})
