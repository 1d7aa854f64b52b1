# SPDX-License-Identifier: Apache-2.0
"""The simulated robot, its sensors and object search."""
import math
import pathlib
import subprocess
import tempfile
import threading
import unittest

import numpy as np

import modelhouse as mh
from tests.python.tools import CACHE, PROGRAM, ROOM

# Duration in s; velocity ahead and to the left in m/s; turn rate in deg/s.
COMMANDS = [(3.0, 0.3, 0.0, 0.0), (2.0, 0.1, 0.1, 30.0), (2.0, 0.0, 0.0, -35.0)]


class SimulationTest(unittest.TestCase):
    def setUp(self):
        self.sim = mh.Simulation(ROOM, level="ideal", seed=7, cache=CACHE)

    def drive(self):
        """Each observation and true camera pose along COMMANDS, one step per tick."""
        self.sim.reset(pose=(2.0, 2.0, 0.0))
        seen = []
        for duration, vx, vy, turn in COMMANDS:
            for _ in range(round(30 * duration)):
                seen.append((self.sim.step(vx, vy, turn * (math.pi / 180), 1 / 30), self.sim.truth()))
        return seen

    def test_is_the_drive_of_the_program_to_the_bit(self):
        seen = self.drive()
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder)
            script = out / "commands.yaml"
            script.write_text(
                "name: commands\nstart: {position: [2, 2], heading_deg: 0}\nreflex: false\ncommands:\n"
                + "".join(f"- {{for_s: {duration}, forward_m_per_s: {vx}, left_m_per_s: {vy}, "
                          f"turn_deg_per_s: {turn}}}\n" for duration, vx, vy, turn in COMMANDS))
            subprocess.run([PROGRAM, "drive", ROOM, f"commands:{script}", "--sensors", "--seed", "7",
                            "--out", out / "drive"], check=True, capture_output=True)
            base = mh.read_trajectory(out / "drive/base.tum")
            odometry = mh.read_trajectory(out / "drive/odometry.tum")
        self.assertEqual(len(base), len(seen) + 1)
        for i, (observation, truth) in enumerate(seen):
            self.assertEqual(observation.stamp_ns, base.stamps_ns[i + 1])
            for ours, theirs in ((truth["world_from_base"], base), (observation.odometry, odometry)):
                np.testing.assert_array_equal(ours[:3, 3], theirs.positions[i + 1])
                np.testing.assert_allclose(ours, theirs.poses[i + 1], atol=1e-12)

    def test_the_same_commands_give_the_same_bits(self):
        first, second = self.drive(), self.drive()
        frames = [[o for o, _ in seen if o.frame is not None] for seen in (first, second)]
        self.assertEqual(len(frames[0]), 70)
        for a, b in zip(*frames):
            for name in ("color", "depth", "labels", "instances"):
                np.testing.assert_array_equal(getattr(a, name), getattr(b, name))

    def test_a_frame_is_what_is_rendered_at_its_pose(self):
        seen = self.drive()
        k = next(i for i, (o, _) in enumerate(seen) if i > 30 and o.frame is not None)
        pose = seen[k - 1][1]["world_from_camera"]  # one tick before the frame arrived
        np.testing.assert_array_equal(seen[k][1]["frame_pose"], pose)
        exact = self.sim.render(pose)
        np.testing.assert_array_equal(exact["color"], seen[k][0].color)
        np.testing.assert_array_equal(exact["instances"], seen[k][0].instances)
        np.testing.assert_array_equal(exact["labels"], seen[k][0].labels)

    def test_batches_are_single_views(self):
        poses = np.stack([truth["world_from_camera"] for _, truth in self.drive()[::70]])
        together = self.sim.render(poses)
        self.assertEqual(together["color"].shape, (3, 480, 640, 3))
        for i, pose in enumerate(poses):
            for name, image in self.sim.render(pose).items():
                np.testing.assert_array_equal(image, together[name][i])

    def test_observations_have_shapes_and_types(self):
        self.sim.reset(pose=(2.0, 2.0, 0.0))
        seen = self.sim.step(0.2, 0, 0)
        self.assertEqual((seen.color.shape, seen.color.dtype), ((480, 640, 3), np.uint8))
        self.assertEqual((seen.depth.shape, seen.depth.dtype), ((480, 640), np.float32))
        self.assertEqual((seen.labels.dtype, seen.instances.dtype), (np.uint8, np.uint16))
        self.assertFalse(seen.color.flags.writeable)
        self.assertEqual(sorted(seen.lasers), ["front", "left", "right"])
        self.assertEqual(seen.lasers["front"].shape, (15,))
        self.assertEqual(sorted(seen.sonars), ["back", "front"])
        self.assertEqual(seen.imu.shape, (6,))
        self.assertIsNone(self.sim.step(0, 0, 0, 1 / 30).frame)

    def test_images_outlive_what_they_came_from(self):
        color = self.sim.step(0, 0, 0).color
        copy = color.copy()
        for _ in range(5):
            self.sim.step(0.1, 0, 0.3)
        del self.sim
        np.testing.assert_array_equal(color, copy)

    def test_a_kidnapped_robot_does_not_feel_it(self):
        self.sim.reset(pose=(2.0, 2.0, 0.0))
        before = self.sim.step(0, 0, 0).odometry
        self.sim.carry_to((3.0, 2.5, 1.0))
        np.testing.assert_allclose(self.sim.step(0, 0, 0).odometry, before, atol=1e-6)
        self.assertAlmostEqual(self.sim.truth()["world_from_base"][0, 3], 3.0, 5)
        self.sim.switch_light(False)
        self.assertEqual(self.sim.step(0, 0, 0).color.max(), 0)

    def test_bad_input_is_one_clear_error(self):
        for arguments, part in ((("no_such_place",), "no scene of that name"),
                                ((ROOM, "no_robot"), "no robot of that name"),
                                ((ROOM, "pepper", "no_level"), "no sensor level of that name")):
            with self.assertRaisesRegex(mh.InputError, part):
                mh.Simulation(*arguments)
        with self.assertRaisesRegex(ValueError, "labels='exakt'"):
            mh.Simulation(ROOM, labels="exakt", cache=CACHE)
        with self.assertRaises(mh.InputError):
            self.sim.reset(pose=(100.0, 100.0, 0.0))
        with self.assertRaisesRegex(ValueError, "not finite"):
            self.sim.step(float("nan"), 0, 0)
        with self.assertRaisesRegex(ValueError, "dt=0"):
            self.sim.step(0, 0, 0, 0)
        far, row = np.eye(4), np.eye(4)
        far[0, 3], row[3, 0] = 1e300, 1
        for pose, part in ((2 * np.eye(4), "not a rigid pose"), (far, "not within"), (row, "last row")):
            with self.assertRaisesRegex(ValueError, part):
                self.sim.render(pose)
        with self.assertRaisesRegex(mh.InputError, "ticks_per_frame=0"):
            mh.Simulation(ROOM, ticks_per_frame=0, cache=CACHE)

    def test_what_is_refused_changes_nothing(self):
        self.sim.reset(pose=(2.0, 2.0, 0.5))
        self.sim.step(0, 0, 0)
        before = self.sim.truth()["world_from_base"]
        for pose in ((0.0, 0.0, 0.0), (float("nan"), 2, 0), (2, 2, float("inf"))):
            with self.assertRaises(mh.InputError):
                self.sim.carry_to(pose)
            with self.assertRaises(mh.InputError):
                self.sim.reset(pose, seed=99)
            np.testing.assert_allclose(self.sim.truth()["world_from_base"], before, atol=1e-6)
        self.sim.step(0, 0, 0)
        self.sim.reset()
        drawn = self.sim.truth()["world_from_base"]
        again = mh.Simulation(ROOM, level="ideal", seed=7, cache=CACHE)
        np.testing.assert_array_equal(again.truth()["world_from_base"], drawn)

    def test_threads_may_share_a_simulation(self):
        self.sim.reset(pose=(2.0, 2.0, 0.0))
        stamps = []

        def drive():
            for k in range(10):
                stamps.append(self.sim.step(0.05, 0, 0.1).stamp_ns)
                if k == 5:
                    self.sim.reset(pose=(2.0, 2.0, 0.0))
                self.sim.truth()

        threads = [threading.Thread(target=drive) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(stamps), 30)


class SearchTest(unittest.TestCase):
    def test_spl_is_the_shortest_way_over_the_way_driven(self):
        sim = mh.Simulation(ROOM, level="ideal", labels="none", cache=CACHE)
        env = mh.SearchEnv(sim, sim.things, limit_s=3)
        observation, info = env.reset(seed=3)
        self.assertIn(info["goal"], sim.things)
        self.assertIsNotNone(observation.frame)
        self.assertEqual(env.reset(seed=3)[1], info)
        self.assertGreaterEqual(env.start.shortest_m, 0.5)
        _, reward, terminated, truncated, info = env.step((0, 0, 0, 1))
        self.assertEqual((reward, terminated, truncated), (0, True, False))
        self.assertFalse(info["success"])
        env.reset(seed=3)
        cut = [env.step((0.1, 0, 0.1, 0))[3] for _ in range(30)]
        self.assertTrue(cut[-1] and not any(cut[:-2]))
        # A robot that is placed next to the goal arrives at once, without driving.
        env.reset(seed=3)
        places = [(x, y) for x in np.arange(0, 5, 0.1) for y in np.arange(0, 4.2, 0.1)
                  if env.start.is_arrival(x, y)]
        for x, y in places:
            try:
                sim.carry_to((x, y, 0.0))
                break
            except mh.InputError:
                continue
        _, reward, _, _, info = env.step((0, 0, 0, 1))
        self.assertTrue(info["success"])
        self.assertEqual((reward, info["spl"]), (1, 1))


class KidnapTest(unittest.TestCase):
    def test_slam_says_where_it_is(self):
        sim = mh.Simulation(ROOM, level="ideal", cache=CACHE)
        sim.reset(pose=(2.5, 2.0, 0.0))
        slam, first = mh.Slam(sim.camera), None
        for _ in range(70):
            seen = sim.step(0, 0, 1.0)
            slam.step(seen.frame)
            first = sim.truth()["frame_pose"] if first is None else first
        env = mh.KidnapEnv(sim, limit_s=4)
        seen, _ = env.reset(options={"pose": (2.3, 2.1, 0.7)})
        found = slam.relocalize(seen.frame)
        self.assertEqual(found.status, "relocalized")
        _, reward, terminated, truncated, info = env.step((0, 0, 0.3, first @ found.pose))
        self.assertEqual((reward, terminated, truncated), (1, True, False))
        self.assertLess(info["distance_m"], 0.05)
        env.reset(seed=1)
        env.step((0, 0, 0.3, None))
        _, reward, terminated, _, info = env.step((0, 0, 0, np.eye(4)))
        self.assertEqual((reward, terminated), (-1, True))
        env.reset(seed=1)
        cut = [env.step((0, 0, 0.3, None))[3] for _ in range(30)]
        self.assertTrue(cut[-1])


if __name__ == "__main__":
    unittest.main()
