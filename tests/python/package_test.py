# SPDX-License-Identifier: Apache-2.0
"""The metadata of the package, and the scripts in docs/python.md."""
import inspect
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import modelhouse as mh
from tests.python.tools import ROOT


class PackageTest(unittest.TestCase):
    def test_every_public_name_has_a_docstring(self):
        silent = []
        for name in mh.__all__:
            thing = getattr(mh, name)
            if not inspect.isclass(thing) and not callable(thing) and name != "semantics":
                continue
            if not inspect.getdoc(thing) and not issubclass(thing, Exception):
                silent.append(name)
            members = vars(thing).items() if inspect.isclass(thing) or name == "semantics" else ()
            silent += [f"{name}.{member}" for member, value in members
                       if not member.startswith("_") and not inspect.getdoc(value)
                       and member not in getattr(thing, "__dataclass_fields__", ())]
        self.assertEqual(silent, [])

    def test_types_are_stated_and_hold(self):
        if shutil.which("mypy") is None:
            self.skipTest("mypy is not installed")
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder) / "typed.py"
            script.write_text("""import modelhouse as mh
import numpy as np
import numpy.typing as npt


def drive(sim: mh.Simulation) -> npt.NDArray[np.float64]:
    seen = sim.step(0.1, 0, 0)
    slam = mh.Slam(sim.camera, {"features.count": 500})
    if seen.frame is not None:
        step = slam.step(seen.frame)
        print(step.status, step.pose)
    return slam.trajectory().positions


class Mine(mh.System):
    def track(self, frame: mh.system.Frame) -> mh.Reply:
        return mh.Reply(np.eye(4), keypoints=frame.color.shape[0])


mh.serve(Mine())
""")
            checked = subprocess.run(["mypy", "--strict", "--cache-dir", folder, script],
                                     env={"MYPYPATH": ROOT + "/python", "PATH": "/usr/bin:/bin"},
                                     capture_output=True, text=True)
            self.assertEqual(checked.returncode, 0, checked.stdout)

    def test_types_name_what_is_there(self):
        text = (pathlib.Path(ROOT) / "python/modelhouse/_core.pyi").read_text()
        core = sys.modules["modelhouse._core"]
        for block in re.split(r"\n(?=class |def )", text):
            if not (found := re.match(r"class (\w+)", block)):
                continue
            thing = getattr(core, found[1])
            stated = set(re.findall(r"    def (\w+)\(", block)) - {"__init__"}
            there = {name for name in vars(thing) if not name.startswith("_")}
            self.assertEqual({name for name in stated if not name.startswith("_")}, there, found[1])

    def test_scripts_of_the_manual_run(self):
        page = (pathlib.Path(ROOT) / "docs/python.md").read_text()
        scripts = re.findall(r"```python\n# (map\.py|search\.py)\n(.*?)```", page, re.S)
        self.assertEqual([name for name, _ in scripts], ["map.py", "search.py"])
        for name, text in scripts:
            with tempfile.TemporaryDirectory() as folder:
                script = pathlib.Path(folder) / name
                script.write_text(text)
                done = subprocess.run([sys.executable, script], cwd=folder, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertRegex(done.stdout, r"(ATE|SPL) [0-9.]+")


if __name__ == "__main__":
    unittest.main()
