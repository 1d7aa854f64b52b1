#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""SLAM from laser scans alone: each scan is matched to a map of all earlier scans; a lost
robot is searched for at all places where it has been.

The images are not read. Needs `senses: [laser]` and numpy: apt-get install python3-numpy. With
`senses: [laser, odometry]`, wheel odometry predicts the motion.
"""
import numpy as np

from modelhouse.system import Reply, System, serve

CELL_M = 0.05      # cells of the map, a square of CELLS x CELLS cells around the start
CELLS = 1200
SIGMA_M = 0.07     # standard deviation of the blur of a ray's end
KEYFRAME_M, KEYFRAME_RAD = 0.15, 0.15  # a scan this far from all scans in the map is added to it
LEAST_ENDS = 20    # ray ends that a scan needs to be useful
LEAST_SHARE = 0.85  # share of a scan's ends that must match the map for a pose to be believed


def planar(pose):
    """x, y and heading as a 4 x 4 matrix."""
    c, s = np.cos(pose[2]), np.sin(pose[2])
    found = np.eye(4)
    found[:2, :2] = [[c, -s], [s, c]]
    found[:2, 3] = pose[:2]
    return found


def flat(pose):
    """x, y and heading from a 4 x 4 matrix."""
    return np.array([pose[0, 3], pose[1, 3], np.arctan2(pose[1, 0], pose[0, 0])])


def compose(a, b):
    return flat(planar(a) @ planar(b))


def ends_of(scans):
    """The end points of all lasers' rays, m, in the plane of the first laser; N x 2."""
    ends = []
    for scan in scans:
        hit = scan.ranges > 0
        rays = np.zeros((hit.sum(), 4))
        rays[:, 0] = scan.ranges[hit] * np.cos(scan.angles[hit])
        rays[:, 1] = scan.ranges[hit] * np.sin(scan.angles[hit])
        rays[:, 3] = 1
        first_from_laser = np.linalg.inv(scans[0].camera_from_laser) @ scan.camera_from_laser
        ends.append((rays @ first_from_laser.T)[:, :2])
    return np.concatenate(ends)


class Map:
    """For each cell, the number of rays that ended in it or near it, weighted by a Gaussian of SIGMA_M."""

    def __init__(self):
        self.ends = np.zeros((CELLS, CELLS), np.float32)
        self.seen_from = []  # poses of the scans in the map
        reach = int(3 * SIGMA_M / CELL_M)
        off = np.arange(-reach, reach + 1) * CELL_M
        self.stamp = np.exp(-0.5 * (off[:, None] ** 2 + off[None, :] ** 2) / SIGMA_M ** 2)
        self.reach = reach

    def cells(self, pose, ends):
        """Row and column of each end, for one pose or many (N x 3), clipped to the map."""
        pose = np.asarray(pose)[..., None, :]
        c, s = np.cos(pose[..., 2]), np.sin(pose[..., 2])
        x = pose[..., 0] + c * ends[:, 0] - s * ends[:, 1]
        y = pose[..., 1] + s * ends[:, 0] + c * ends[:, 1]
        into = lambda m: np.clip(np.rint(m / CELL_M) + CELLS // 2, self.reach,
                                 CELLS - 1 - self.reach).astype(int)
        return into(y), into(x)

    def score(self, poses, ends):
        """How well the ends fit the map at each pose; walls that were seen more often count only a little more."""
        return np.log1p(self.ends[self.cells(poses, ends)]).mean(axis=-1)

    def share(self, pose, ends):
        """The share of the ends that lie where the ends of mapped scans lie."""
        return (self.ends[self.cells(pose, ends)] > 0.5).mean()

    def add(self, pose, ends):
        for row, column in {*zip(*self.cells(pose, ends))}:
            around = np.s_[row - self.reach:row + self.reach + 1,
                           column - self.reach:column + self.reach + 1]
            self.ends[around] += self.stamp
        self.seen_from.append(pose)

    def is_new(self, pose):
        away = np.abs(np.array(self.seen_from) - pose)
        away[:, 2] = np.minimum(away[:, 2] % (2 * np.pi), -away[:, 2] % (2 * np.pi))
        return np.all((np.hypot(away[:, 0], away[:, 1]) > KEYFRAME_M) | (away[:, 2] > KEYFRAME_RAD))

    def refine(self, pose, ends, step_m, step_rad):
        """Climbs to the best pose nearby, in ever smaller steps."""
        best, steps = self.score(pose, ends), np.array([step_m, step_m, step_rad])
        around = np.array(np.meshgrid(*[[-1, 0, 1]] * 3)).reshape(3, -1).T
        while steps[0] > 0.002:
            tried = pose + around * steps
            scores = self.score(tried, ends)
            if scores.max() > best + 1e-9:
                pose, best = tried[scores.argmax()], scores.max()
            else:
                steps = steps / 2
        return pose

    def search(self, ends):
        """The best pose, with any heading, near any place from which a mapped scan was taken."""
        if len(ends) < LEAST_ENDS:
            return np.zeros(3)
        few = ends[::max(1, len(ends) // 90)]
        places = {(round(p[0] / 0.2), round(p[1] / 0.2)) for p in self.seen_from}
        places = {(x + i, y + j) for x, y in places for i in (-1, 0, 1) for j in (-1, 0, 1)}
        headings = np.arange(0, 2 * np.pi, np.pi / 36)
        tried = np.array([(0.2 * x, 0.2 * y, a) for x, y in sorted(places) for a in headings])
        scores = np.concatenate([self.score(part, few) for part in np.array_split(tried, 40)])
        best = [self.refine(tried[i], ends, 0.1, 0.05) for i in np.argsort(-scores)[:20]]
        return max(best, key=lambda pose: self.score(pose, ends))


class LaserSlam(System):
    def start(self):
        self.map, self.last, self.step, self.wheels = Map(), None, np.zeros(3), None

    def reset(self):
        self.start()

    def rewind(self):
        self.last = None

    def predict(self, wheels):
        if wheels is not None and self.wheels is not None:
            return compose(self.last, flat(np.linalg.inv(self.wheels) @ wheels))
        return compose(self.last, self.step)

    def track(self, frame):
        ends, laser_from_camera = scan_of(frame)
        wheels = None
        if frame.odometry is not None:
            wheels = frame.odometry @ np.linalg.inv(laser_from_camera)
        if self.last is not None and len(ends) > 0:
            found = self.map.refine(self.predict(wheels), ends, 0.08, 0.04)
        else:
            found = self.map.search(ends) if self.map.seen_from else np.zeros(3)
        if not self.is_believed(found, ends):
            self.last, self.wheels = None, None
            return None
        if self.last is not None:
            self.step = flat(np.linalg.inv(planar(self.last)) @ planar(found))
        self.last, self.wheels = found, wheels
        is_keyframe = not self.map.seen_from or bool(self.map.is_new(found))
        if is_keyframe:
            self.map.add(found, ends)
        return Reply(planar(found) @ laser_from_camera, keyframe=is_keyframe)

    def relocalize(self, frame):
        ends, laser_from_camera = scan_of(frame)
        if not self.map.seen_from:
            return None
        found = self.map.search(ends)
        return planar(found) @ laser_from_camera if self.is_believed(found, ends) else None

    def is_believed(self, pose, ends):
        """Whether enough of a scan fits the map; the first scan only needs enough ends."""
        fits = not self.map.seen_from or self.map.share(pose, ends) > LEAST_SHARE
        return len(ends) >= LEAST_ENDS and fits


def scan_of(frame):
    """The ends of all rays, and first_laser_from_camera."""
    lasers = frame.lasers
    if not lasers:
        raise ValueError("no lasers: the suite must say `senses: [laser]`")
    return ends_of(lasers), np.linalg.inv(lasers[0].camera_from_laser)


if __name__ == "__main__":
    serve(LaserSlam())
