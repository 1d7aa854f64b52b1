# SPDX-License-Identifier: Apache-2.0
"""Recordings, SLAM, evaluation, equations, results."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import modelhouse as mh
from tests.python.tools import CACHE, PROGRAM, ROOM, ROOT

TOUR = ROOT + "/bench/scenarios/tours/room.yaml"
ROBOT = ROOT + "/bench/scenarios/robot.yaml"


class RecordingTest(unittest.TestCase):
    """A rendered recording, mapped from Python and by the program."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name)
        subprocess.run([PROGRAM, "render", ROOM, "--motion", TOUR, "--robot", ROBOT, "--level",
                        "pepper", "--frames", "60", "--out", cls.out / "room"],
                       check=True, capture_output=True)
        cls.recording = mh.open_sequence(f"tum:{cls.out / 'room'}")
        cls.slam = mh.Slam(cls.recording)
        cls.steps = [cls.slam.step(cls.recording[i]) for i in range(len(cls.recording))]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_frames_are_arrays(self):
        self.assertEqual(len(self.recording), 60)
        frame = self.recording[3]
        self.assertEqual(frame.stamp_ns, self.recording.stamps_ns[3])
        self.assertEqual(frame.color.shape, (240, 320, 3))
        self.assertEqual(frame.depth.shape, (240, 320))
        self.assertEqual(frame.labels.dtype, np.uint8)
        self.assertEqual(mh.classes[5], "chair")
        np.testing.assert_array_equal(self.recording[-1].color, self.recording[59].color)
        with self.assertRaises(IndexError):
            self.recording[60]

    def test_slam_maps_as_the_program_does_to_the_bit(self):
        subprocess.run([PROGRAM, "slam", f"tum:{self.out / 'room'}", "--out", self.out / "slam",
                        "--save-map", self.out / "program.mhmap"], check=True, capture_output=True)
        theirs = mh.read_trajectory(self.out / "slam/estimate.tum")
        ours = self.slam.trajectory()
        np.testing.assert_array_equal(ours.stamps_ns, theirs.stamps_ns)
        np.testing.assert_array_equal(ours.positions, theirs.positions)
        self.slam.save(self.out / "python.mhmap")
        self.assertEqual((self.out / "python.mhmap").read_bytes(),
                         (self.out / "program.mhmap").read_bytes())
        self.assertEqual(self.steps[0].status, "initialized")
        self.assertTrue(self.steps[0].keyframe)
        np.testing.assert_allclose(self.steps[0].pose, np.eye(4), atol=1e-12)

    def test_errors_are_those_of_the_command(self):
        errors = mh.evaluate(self.recording.truth, self.slam.trajectory())
        self.assertEqual(errors["pairs"], 60)
        self.assertLess(errors["ate_m"]["rmse"], 0.02)
        self.assertLess(errors["rpe_frame_m"]["rmse"], 0.01)
        moved = self.recording.truth.poses.copy()
        moved[:, 0, 3] += 3
        shifted = mh.Trajectory(self.recording.truth.stamps_ns, moved)
        self.assertAlmostEqual(mh.evaluate(self.recording.truth, shifted, "none")["ate_m"]["rmse"], 3)
        self.assertAlmostEqual(mh.evaluate(self.recording.truth, shifted)["ate_m"]["rmse"], 0)
        with self.assertRaisesRegex(ValueError, "align='umeyama'"):
            mh.evaluate(self.recording.truth, shifted, "umeyama")
        later = mh.Trajectory(self.recording.truth.stamps_ns + 10 ** 12, moved)
        with self.assertRaisesRegex(ValueError, "no pose of the estimate"):
            mh.evaluate(self.recording.truth, later)
        still = mh.Trajectory(self.recording.truth.stamps_ns, np.tile(np.eye(4), (60, 1, 1)))
        with self.assertRaisesRegex(ValueError, "undetermined"):
            mh.evaluate(self.recording.truth, still)

    def test_the_map_is_arrays_and_answers(self):
        landmarks = self.slam.landmarks
        self.assertEqual(landmarks.shape[1], 3)
        self.assertEqual(len(self.slam.landmark_labels), len(landmarks))
        self.assertGreater(len(landmarks), 200)
        self.assertGreaterEqual(len(self.slam.keyframes), 2)
        found = self.slam.relocalize(self.recording[30])
        self.assertEqual((found.status, found.stage), ("relocalized", "verified"))
        at = self.slam.trajectory().poses[30]
        self.assertLess(np.linalg.norm(found.pose[:3, 3] - at[:3, 3]), 0.05)
        self.assertGreater(found.candidates["final"], 0)
        copy = self.out / "copy.mhmap"
        self.slam.save(copy)
        again = mh.Slam.load(copy).relocalize(self.recording[30])
        np.testing.assert_array_equal(again.pose, found.pose)

    def test_frames_of_arrays_are_frames(self):
        frame = self.recording[30]
        made = mh.Frame(frame.color, frame.depth, frame.stamp_ns, frame.labels)
        np.testing.assert_array_equal(made.depth, frame.depth)
        np.testing.assert_array_equal(made.labels, frame.labels)
        np.testing.assert_array_equal(self.slam.relocalize(made).pose,
                                      self.slam.relocalize(frame).pose)
        with self.assertRaisesRegex(ValueError, "depth is 160 x 240"):
            mh.Frame(frame.color, frame.depth[:, :160])
        for color, depth, labels, part in (
                (frame.depth, frame.depth, None, "color: expected uint8, got float32"),
                (frame.color.astype(np.uint16), frame.depth, None, "color: expected uint8"),
                (frame.color, (5000 * frame.depth).astype(np.uint16), None, "depth: expected meters"),
                (frame.color, -frame.depth, None, "negative"),
                (frame.color, frame.depth, frame.labels + 0.5, "labels: expected integers"),
                (frame.color, frame.depth, np.full(frame.labels.shape, 300), "300 is not a class")):
            with self.assertRaisesRegex(ValueError, part):
                mh.Frame(color, depth, labels=labels)

    def test_settings_are_checked(self):
        few = mh.Slam(self.recording, {"features.count": 300, "semantics.gamma": 0})
        self.assertLess(few.step(self.recording[0]).keypoints, self.steps[0].keypoints)
        for settings, part in (({"features.cuont": 3}, "features.cuont"),
                               ({"features.count": -3}, "count"), ({"features.count": "many"}, "count")):
            with self.assertRaisesRegex(mh.InputError, part):
                mh.Slam(self.recording, settings)
        with self.assertRaisesRegex(mh.InputError, "stamp"):
            few.step(self.recording[0])

    def test_what_is_no_recording_is_refused(self):
        with self.assertRaisesRegex(mh.InputError, "nowhere"):
            mh.open_sequence("tum:/nowhere")


class SemanticsTest(unittest.TestCase):
    def test_equation_1(self):
        # Labels 5, 5, 7 and words 1, 2, 2. With labels of double weight, labels 5 and 7 weigh 4 and 2 of 9,
        # words 1 and 2 weigh 1 and 2 of 9.
        v = mh.semantics.augmented_vector([5, 5, 7, 0], [1, 2, 2], gamma=2)
        self.assertEqual(v.labels, {5: 4 / 9, 7: 2 / 9})
        self.assertEqual(v.words, {1: 1 / 9, 2: 2 / 9})
        self.assertAlmostEqual(v.label_mass, 2 / 3)
        weighed = mh.semantics.augmented_vector([], [0, 1], gamma=1, eta=[3, 1])
        self.assertEqual(weighed.words, {0: 0.75, 1: 0.25})
        with self.assertRaisesRegex(ValueError, "gamma"):
            mh.semantics.augmented_vector([1], [1], gamma=-1)
        for arguments, part in ((([], [2], 1, [3, 1]), "no word 2"), (([-1], [1], 1), "-1 is not an id"),
                                (([1.5], [1], 1), "expected integers"), (([1], [1], np.inf), "gamma"),
                                (([1], [1], 1, [1, np.nan]), "eta")):
            with self.assertRaisesRegex(ValueError, part):
                mh.semantics.augmented_vector(*arguments)

    def test_equation_2(self):
        np.testing.assert_array_equal(
            mh.semantics.distance([10, 10, 10, 10], [5, 5, 0, 5], [5, 6, 5, 0], xi=1.5),
            [10, 15, 10, 10])
        np.testing.assert_array_equal(
            mh.semantics.distance([10, 10], [5, 0], [0, 5], xi=2, void_is_a_label=True), [20, 20])

    def test_equations_3_to_6(self):
        # alpha 0.5 removes the last two of the overlaps 4, 3, 1, 0; scores are sums over neighborhoods.
        found, left = mh.semantics.select_candidates(
            overlap=[4, 3, 1, 0], neighbors=[[0, 1], [1, 3], [2], [3]],
            similarity=[0.5, 0.25, 0.9, 0.125], alpha=0.5, beta=0.4)
        self.assertEqual(left, {"c1": 3, "c2": 2, "c3": 2, "final": 2})
        self.assertEqual(found, [(0, 0.75), (1, 0.375)])
        f, k = (mh.semantics.augmented_vector([1], words, gamma=1) for words in ([1, 2], [2, 3]))
        self.assertAlmostEqual(mh.semantics.similarity(f, k), 2 / 3)
        self.assertEqual((mh.semantics.shared_labels(f, k), mh.semantics.shared_words(f, k)), (1, 1))


class ResultsTest(unittest.TestCase):
    def test_tables_are_those_of_the_store(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder)
            suite = out / "suite.yaml"
            suite.write_text(f"""environments:
- {{category: room, scene: {ROOM}, mapping_tour: {TOUR}}}
robot: {ROBOT}
vocabulary: vocabulary
levels: [pepper]
systems:
- {{name: mine, protocol: conversation, command: "exec /usr/bin/python3 {out}/mine.py"}}
- {{name: opencv, protocol: conversation, command: "exec /usr/bin/python3 {ROOT}/examples/peers/opencv_odometry.py"}}
- {{name: bad, protocol: conversation, command: "exec /usr/bin/python3 {out}/mine.py bad"}}
labels: [none]
protocol: {{test_interval: 10}}
""")
            (out / "mine.py").write_text("""import sys
import numpy as np
from modelhouse import System, serve


class Mine(System):
    def track(self, frame):
        print("frame", frame.stamp, frame.color.shape)
        if "bad" in sys.argv and frame.stamp > 0.5:
            raise ValueError("no idea")
        return np.eye(4)


serve(Mine())
""")
            bench = subprocess.run([PROGRAM, "bench", suite, "--frames", "30", "--out", out / "results",
                                    "--cache", CACHE], capture_output=True, text=True)
            self.assertEqual(bench.returncode, 3, bench.stderr)
            self.assertIn("ValueError: no idea", bench.stdout + bench.stderr)
            results = mh.Results(out / "results")
            runs = results.runs()
            self.assertEqual(list(runs["name"]), ["bad-pepper-0", "mine-pepper-0", "opencv-pepper-0"])
            self.assertEqual(list(runs["status"]), ["failed", "done", "done"])
            metrics = results.metrics()
            value = {(run, name): value for run, name, value in
                     zip(metrics["run"], metrics["name"], metrics["value"])}
            self.assertEqual(value["mine-pepper-0", "completeness"], 1)
            self.assertEqual(value["opencv-pepper-0", "completeness"], 1)
            self.assertLess(value["opencv-pepper-0", "ate_rmse_m"], 0.05)
            self.assertEqual(len(results.frames()["frame"]), 2 * 30)
            self.assertEqual(set(results.queries()["query_set"]), {"held_out"})
            self.assertIn("<td>mine</td><td>none</td>", results._repr_html_())
            self.assertEqual(results.table(["completeness"]),
                             [("room", system, "none", {"completeness": 1})
                              for system in ("mine", "opencv")])
        with self.assertRaises(FileNotFoundError):
            mh.Results("/nowhere")
        with tempfile.TemporaryDirectory(suffix="?a#b%41") as folder:
            file = pathlib.Path(folder) / "results.sqlite"
            file.write_text("this is text")
            with self.assertRaisesRegex(ValueError, "not a results file"):
                mh.Results(folder)
            self.assertEqual(file.read_text(), "this is text")


class SystemTest(unittest.TestCase):
    def test_poses_are_rigid(self):
        numbers = mh.system.numbers
        np.testing.assert_allclose(numbers(np.eye(4)), [0, 0, 0, 0, 0, 0, 1])
        mirrored, row = np.diag([1, 1, -1, 1]), np.eye(4)
        row[3, 3] = 2
        for pose in (np.zeros((4, 4)), 5 * np.eye(4), mirrored, row, np.zeros(7), np.eye(3),
                     np.full((4, 4), np.nan)):
            with self.assertRaisesRegex(ValueError, "not a pose"):
                numbers(pose)

    def test_what_it_says_is_passed_on_or_refused(self):
        def said(reply):
            with tempfile.TemporaryDirectory() as folder:
                script = pathlib.Path(folder) / "mine.py"
                script.write_text("import numpy as np\nfrom modelhouse import Reply, System, serve\n\n\n"
                                  "class Mine(System):\n    def track(self, frame):\n"
                                  f"        print('aside')\n        {reply}\n\n\nserve(Mine())\n")
                camera = dict(width=4, height=2, fx=1, fy=1, cx=1, cy=1, k1=0, k2=0, p1=0, p2=0, k3=0,
                              fps=30, bf=1)
                asked = [dict(id=1, do="hello", camera=camera, depth_per_meter=5000.0, settings="",
                              classes=[]), dict(id=2, do="track", stamp="0.5", seed=1)]
                done = subprocess.run([sys.executable, script], capture_output=True, text=True,
                                      input="\n".join(map(json.dumps, asked)))
                return json.loads(done.stdout.splitlines()[1])

        self.assertEqual(said("return Reply(np.eye(4), keypoints=np.int64(3), keyframe=np.bool_(True))"),
                         {"id": 2, "pose": [0, 0, 0, 0, 0, 0, 1], "keypoints": 3, "keyframe": True})
        self.assertEqual(said("return None"), {"id": 2, "pose": None})
        for reply, part in (("return Reply(None, keypoints=2.5)", "TypeError"),
                            ("return np.zeros((4, 4))", "ValueError: not a pose"),
                            ("raise SystemExit('enough')", "SystemExit: enough"),
                            ("raise ValueError('two\\nlines')", "ValueError: two lines")):
            self.assertIn(part, said(reply)["error"])


if __name__ == "__main__":
    unittest.main()
