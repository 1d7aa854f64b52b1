#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""RGB-D SLAM built from Open3D's parts: odometry from keyframe to frame, loop closures between keyframes,
a pose graph. (Open3D's dense tracking against a model needs a filter that Debian's CPU build lacks.)
Needs apt-get install python3-open3d
"""
import os

os.environ["OMP_NUM_THREADS"] = "1"  # sums are the same in every run
import numpy as np
import open3d as o3d

from modelhouse.system import Reply, System, serve

STEP = 2                               # every second pixel: a quarter of the time
FAR_M = 4.0                            # depth beyond this is noise
KEYFRAME_M, KEYFRAME_RAD = 0.15, 0.15  # a frame this far from the last keyframe becomes one
LOST_M, LOST_RAD = 0.3, 0.3            # no camera moves this far between two frames
LOOP_M, LOOP_RAD, LOOP_GAP = 0.8, 0.5, 15  # keyframes this close, but this many apart, may close a loop
LOOP_ERROR_M, LOOP_ERROR_RAD = 0.3, 0.2    # a loop that deviates more from the path is rejected


def size_of(motion):
    """Length (m) and angle (rad) of a motion."""
    return (np.linalg.norm(motion[:3, 3]),
            np.arccos(np.clip((np.trace(motion[:3, :3]) - 1) / 2, -1, 1)))


class Open3dSlam(System):
    def start(self):
        c = self.camera
        self.intrinsic = o3d.camera.PinholeCameraIntrinsic(
            c.width // STEP, c.height // STEP, c.fx / STEP, c.fy / STEP, c.cx / STEP, c.cy / STEP)
        self.graph = o3d.pipelines.registration.PoseGraph()
        self.images, self.frames = [], []  # the keyframes' images; each frame's (stamp, keyframe, keyframe_from_frame)
        self.last = None                   # keyframe_from_frame of the last frame; None: lost
        self.pose = np.eye(4)

    def reset(self):
        self.start()

    def rewind(self):
        self.last = None

    def align(self, image, keyframe, guess):
        """keyframe_from_image and its information matrix; None if the two images do not fit."""
        odometry = o3d.pipelines.odometry
        options = odometry.OdometryOption()
        options.depth_max = FAR_M
        found, motion, information = odometry.compute_rgbd_odometry(
            image, self.images[keyframe], self.intrinsic, guess,
            odometry.RGBDOdometryJacobianFromHybridTerm(), options)
        return (motion, information) if found else None

    def track(self, frame):
        image = o3d.geometry.RGBDImage.create_from_color_and_depth(
            o3d.geometry.Image(np.ascontiguousarray(frame.color[::STEP, ::STEP])),
            o3d.geometry.Image(np.ascontiguousarray(frame.depth[::STEP, ::STEP])), depth_scale=1.0,
            depth_trunc=FAR_M)
        if self.last is None:
            return self.begin(frame, image, self.pose, None)
        of = len(self.images) - 1
        found = self.align(image, of, self.last)
        meters, angle = size_of(np.linalg.inv(self.last) @ found[0]) if found else (1, 1)
        if meters > LOST_M or angle > LOST_RAD:
            self.last = None
            return None
        self.last, information = found
        self.pose = self.graph.nodes[of].pose @ self.last
        meters, angle = size_of(self.last)
        if meters > KEYFRAME_M or angle > KEYFRAME_RAD:
            return self.begin(frame, image, self.pose, (self.last, information))
        self.frames.append((frame.stamp_text, of, self.last))
        return self.pose

    def begin(self, frame, image, pose, edge):
        r, new = o3d.pipelines.registration, len(self.images)
        self.images.append(image)
        self.graph.nodes.append(r.PoseGraphNode(np.array(pose)))
        if edge:
            self.graph.edges.append(r.PoseGraphEdge(new, new - 1, *edge, False))
        self.frames.append((frame.stamp_text, new, np.eye(4)))
        self.last = np.eye(4)
        return Reply(pose, keyframe=True)

    def freeze(self):
        r = o3d.pipelines.registration
        poses = [np.array(node.pose) for node in self.graph.nodes]
        for new, pose in enumerate(poses):
            for old in range(0, new - LOOP_GAP):
                guess = np.linalg.inv(poses[old]) @ pose
                meters, angle = size_of(guess)
                if meters > LOOP_M or angle > LOOP_RAD:
                    continue
                found = self.align(self.images[new], old, guess)
                error = size_of(np.linalg.inv(guess) @ found[0]) if found else (1, 1)
                if error[0] < LOOP_ERROR_M and error[1] < LOOP_ERROR_RAD:
                    self.graph.edges.append(r.PoseGraphEdge(new, old, *found, True))
                    break
        r.global_optimization(self.graph, r.GlobalOptimizationLevenbergMarquardt(),
                              r.GlobalOptimizationConvergenceCriteria(),
                              r.GlobalOptimizationOption(max_correspondence_distance=0.07,
                                                         edge_prune_threshold=0.25, reference_node=0))
        return [(stamp, self.graph.nodes[of].pose @ motion) for stamp, of, motion in self.frames]


if __name__ == "__main__":
    serve(Open3dSlam())
