#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""RGB-D odometry from frame to frame, with keyframes for recovery: about the smallest SLAM system
that can take part in a suite.

Reads a folder in TUM's layout, writes a trajectory in TUM's format (camera to world, the first
frame at the origin). Needs numpy and OpenCV: apt-get install python3-opencv
"""
import argparse
import pathlib

import cv2
import numpy as np


def read_camera(settings):
    """The 3 x 3 matrix K, distortion, and depth steps per meter, from a file with ORB-SLAM2's keys."""
    file = cv2.FileStorage(settings, cv2.FILE_STORAGE_READ)
    fx, fy, cx, cy, *distortion = (
        file.getNode(f"Camera.{key}").real() for key in "fx fy cx cy k1 k2 p1 p2".split())
    k = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
    return k, np.array(distortion), file.getNode("DepthMapFactor").real()


def find_keypoints(orb, image, depth_m, k, distortion):
    """Pixels, descriptors and points (m, in the camera's frame) of keypoints that have a depth."""
    keypoints, descriptors = orb.detectAndCompute(image, None)
    if not keypoints:
        return np.empty((0, 2)), np.empty((0, 32), np.uint8), np.empty((0, 3))
    pixels = np.array([keypoint.pt for keypoint in keypoints])
    columns, rows = np.rint(pixels).astype(int).T
    z = depth_m[rows, columns]
    near = (z > 0.3) & (z < 5.0)  # beyond 5 m, a structured-light sensor's depth is noise
    rays = cv2.undistortPoints(pixels[:, None], k, distortion)[:, 0]
    points = np.column_stack([rays * z[:, None], z])
    return pixels[near], descriptors[near], points[near]


def estimate_motion(before, now, k, distortion):
    """now_from_before as a 4 x 4 matrix; None if too few keypoints agree on a motion."""
    _, descriptors_before, points_before = before
    pixels, descriptors, _ = now
    if len(descriptors_before) < 20 or len(descriptors) < 20:
        return None
    matches = cv2.BFMatcher(cv2.NORM_HAMMING, crossCheck=True).match(descriptors_before, descriptors)
    matches = [match for match in matches if match.distance < 64]
    if len(matches) < 20:
        return None
    found, rotation, translation, inliers = cv2.solvePnPRansac(
        points_before[[match.queryIdx for match in matches]],
        pixels[[match.trainIdx for match in matches]],
        k, distortion, reprojectionError=2.0, iterationsCount=200, flags=cv2.SOLVEPNP_SQPNP)
    if not found or inliers is None or len(inliers) < 15:
        return None
    now_from_before = np.eye(4)
    now_from_before[:3, :3] = cv2.Rodrigues(rotation)[0]
    now_from_before[:3, 3] = translation.ravel()
    return now_from_before


def recover(now, keyframes, last, k, distortion):
    """world_from_camera of a frame that does not match the previous frame, from a keyframe near the last pose."""
    near = sorted(keyframes, key=lambda of: np.linalg.norm(of[1][:3, 3] - last[:3, 3]))
    for features, world_from_keyframe in near[:20]:
        motion = estimate_motion(features, now, k, distortion)
        if motion is not None:
            return world_from_keyframe @ np.linalg.inv(motion)
    return None


def is_new(world_from_camera, keyframes):
    """Whether no keyframe is both within 0.25 m and within 0.3 rad."""
    return all(np.linalg.norm(pose[:3, 3] - world_from_camera[:3, 3]) > 0.25
               or (np.trace(pose[:3, :3].T @ world_from_camera[:3, :3]) - 1) / 2 < np.cos(0.3)
               for _, pose in keyframes)


def quaternion(rotation):
    """The quaternion x, y, z, w of a rotation matrix."""
    vector = cv2.Rodrigues(rotation)[0].ravel()
    half_angle = np.linalg.norm(vector) / 2
    return [*(vector * np.sinc(half_angle / np.pi) / 2), np.cos(half_angle)]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("dataset", "associations", "settings", "trajectory"):
        parser.add_argument(name)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    cv2.setRNGSeed(arguments.seed)
    cv2.setNumThreads(1)
    k, distortion, steps_per_m = read_camera(arguments.settings)
    orb = cv2.ORB_create(1000)
    folder = pathlib.Path(arguments.dataset)
    before, world_from_camera, keyframes = None, np.eye(4), []
    with open(arguments.associations) as lines, open(arguments.trajectory, "w") as trajectory:
        for line in lines:
            stamp, color, _, depth = line.split()
            image = cv2.imread(str(folder / color), cv2.IMREAD_GRAYSCALE)
            depth_m = cv2.imread(str(folder / depth), cv2.IMREAD_UNCHANGED) / steps_per_m
            now = find_keypoints(orb, image, depth_m, k, distortion)
            if keyframes:
                motion = None if before is None else estimate_motion(before, now, k, distortion)
                found = (world_from_camera @ np.linalg.inv(motion) if motion is not None
                         else recover(now, keyframes, world_from_camera, k, distortion))
                if found is None:
                    before = None
                    continue  # lost: this frame has no pose; the next one is matched to keyframes
                world_from_camera = found
            before = now
            if is_new(world_from_camera, keyframes):
                keyframes.append((now, world_from_camera))
            pose = [*world_from_camera[:3, 3], *quaternion(world_from_camera[:3, :3])]
            print(stamp, *(f"{number:.7f}" for number in pose), file=trajectory)


if __name__ == "__main__":
    main()
