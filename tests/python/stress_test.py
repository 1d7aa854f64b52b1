# SPDX-License-Identifier: Apache-2.0
"""`modelhouse stress` finds what systems stand that return the truth until a known dose, and nothing beyond."""
import hashlib
import json
import pathlib
import subprocess
import tempfile
import unittest

import modelhouse as mh
from tests.python.tools import CACHE, PROGRAM, ROOM

ORACLE = """import hashlib
import json
import sys
import numpy as np
from modelhouse import System, serve

POSES = json.load(open("answers.json"))  # by image: a query comes at another time than it was seen


class Oracle(System):
    def track(self, frame):
        missing = np.mean(frame.depth == 0)
        longer = self.camera.fx / float(sys.argv[2]) - 1
        if {"depth": missing > 0.35, "focal": longer > 0.02}[sys.argv[1]]:
            return None
        return POSES[hashlib.sha1(frame.color.tobytes()).hexdigest()]

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
- {{name: depth, protocol: conversation, command: "/usr/bin/python3 oracle.py depth {fx}"}}
- {{name: focal, protocol: conversation, command: "/usr/bin/python3 oracle.py focal {fx}"}}
stress:
  measure: correct
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
            seen = mh.open_sequence(f"tum:{folder / 'seen'}")
            (folder / "answers.json").write_text(json.dumps(
                {hashlib.sha1(frame.color.tobytes()).hexdigest(): mh.system.numbers(pose)
                 for frame, pose in zip(seen, seen.truth.poses)}))
            fx = mh.Simulation(ROOM, cache=CACHE).camera.fx
            (folder / "oracle.py").write_text(ORACLE)
            (folder / "suite.yaml").write_text(SUITE.format(room=ROOM, fx=fx))
            run("stress", folder / "suite.yaml", "--out", folder / "out", "--cache", CACHE)
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
