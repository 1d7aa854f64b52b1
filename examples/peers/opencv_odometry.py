#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""OpenCV's dense RGB-D odometry (photometric and ICP) from keyframe to frame.
Needs apt-get install python3-opencv
"""
import cv2
import numpy as np

from modelhouse.system import Reply, System, serve

KEYFRAME_M, KEYFRAME_RAD = 0.10, 0.10  # a frame this far from the last keyframe becomes one
FAR_M, FAR_RAD = 0.3, 0.3              # no camera moves this far between two frames: lost


def size_of(motion):
    """Length (m) and angle (rad) of a motion."""
    return (np.linalg.norm(motion[:3, 3]),
            np.arccos(np.clip((np.trace(motion[:3, :3]) - 1) / 2, -1, 1)))


class OpenCvOdometry(System):
    def start(self):
        cv2.setNumThreads(1)
        self.odometry = cv2.rgbd.RgbdICPOdometry_create(self.camera.matrix.astype(np.float32))
        self.keyframe, self.world_from_keyframe = None, np.eye(4)
        self.key_from_now = np.eye(4)  # the last frame's pose relative to the keyframe

    def reset(self):
        self.start()

    def rewind(self):
        self.keyframe = None

    def track(self, frame):
        gray = cv2.cvtColor(frame.color, cv2.COLOR_RGB2GRAY)
        depth = np.where(frame.depth > 0, frame.depth, np.nan).astype(np.float32)
        mask = np.where(np.isnan(depth), 0, 255).astype(np.uint8)
        now = (gray, depth, mask)
        if self.keyframe is None:
            return self.begin(now, self.world_from_keyframe @ self.key_from_now)
        # OpenCV's motion maps points of the first image to the second.
        found, motion = self.odometry.compute(*now, *self.keyframe, None, self.key_from_now)
        meters, angle = size_of(np.linalg.inv(self.key_from_now) @ motion) if found else (1, 1)
        if not found or meters > FAR_M or angle > FAR_RAD:
            self.keyframe = None
            return None
        self.key_from_now = motion
        pose = self.world_from_keyframe @ motion
        meters, angle = size_of(motion)
        return self.begin(now, pose) if meters > KEYFRAME_M or angle > KEYFRAME_RAD else pose

    def begin(self, now, pose):
        self.keyframe, self.world_from_keyframe, self.key_from_now = now, pose, np.eye(4)
        return Reply(pose, keyframe=True)


if __name__ == "__main__":
    serve(OpenCvOdometry())
