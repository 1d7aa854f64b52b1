# SPDX-License-Identifier: Apache-2.0
"""`modelhouse stress` finds what systems stand that return the truth until a known dose, and nothing beyond."""
import json
import pathlib
import subprocess
import tempfile
import unittest

from tests.python.tools import CACHE, PROGRAM, ROOM

ORACLE = """import sys
import numpy as np
from modelhouse import System, serve

POSES = {}
for line in open(sys.argv[1]):
    if not line.startswith("#"):
        stamp, *pose = line.split()
        POSES[round(1000 * float(stamp))] = [float(number) for number in pose]


class Oracle(System):
    def track(self, frame):
        missing = np.mean(frame.depth == 0)
        longer = self.camera.fx / float(sys.argv[3]) - 1
        if {"depth": missing > 0.35, "focal": longer > 0.02}[sys.argv[2]]:
            return None
        return POSES[round(1000 * frame.stamp)]

    relocalize = track


serve(Oracle())
"""

SUITE = """name: oracles
environments: [{{category: room, scene: {room}, mapping_tour: "handheld:0:40"}}]
robot: pepper
levels: [ideal]
labels: [none]
trials: 1
seed: 0
protocol: {{test_interval: 5, max_effort: 1}}
systems:
- {{name: depth, protocol: conversation, command: "/usr/bin/python3 oracle.py truth.txt depth {fx}"}}
- {{name: focal, protocol: conversation, command: "/usr/bin/python3 oracle.py truth.txt focal {fx}"}}
stress:
  steps: 5
  dials:
    depth_faults.holes: {{from: 0, to: 0.9}}
    told.focal: {{from: 1, to: 1.1}}
"""


class StressTest(unittest.TestCase):
    def test_the_doses_at_which_oracles_fail_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            run = lambda *words: subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=True)
            run("render", ROOM, "--motion", "handheld:0:40", "--robot", "pepper", "--out", folder / "seen")
            (folder / "truth.txt").write_text((folder / "seen/groundtruth.txt").read_text())
            calibration = (folder / "seen/camera.yaml").read_text()
            fx = next(line.split(":")[1].split("#")[0].strip() for line in calibration.splitlines()
                      if line.strip().startswith("fx"))
            (folder / "oracle.py").write_text(ORACLE)
            (folder / "suite.yaml").write_text(SUITE.format(room=ROOM, fx=fx))
            run("stress", folder / "suite.yaml", "--out", folder / "out", "--cache", CACHE, "--jobs", "2")
            sheet = json.loads((folder / "out/stress.json").read_text())
            found = {(dial["dial"], system["system"]): system
                     for dial in sheet["dials"] for system in dial["systems"]}
            for dial, limit, system, other in (("depth_faults.holes", 0.35, "depth", "focal"),
                                               ("told.focal", 1.02, "focal", "depth")):
                self.assertEqual(found[dial, other]["breaks"], "never")
                self.assertEqual(found[dial, system]["breaks"], "at")
                low, high = found[dial, system]["interval"]
                self.assertLessEqual(low, limit)
                self.assertGreaterEqual(high, limit)
                self.assertLess(high - low, 0.1)


if __name__ == "__main__":
    unittest.main()
