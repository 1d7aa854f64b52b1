# SPDX-License-Identifier: Apache-2.0
"""A SLAM system in Python: subclass System, then serve() an instance of it. Needs only numpy.

    class Mine(System):
        def track(self, frame):
            ...
            return world_from_camera  # 4 x 4, or None where it is lost

    serve(Mine())

A suite names the program: {name: mine, protocol: conversation, command: /usr/bin/python3 mine.py}.
"""
from __future__ import annotations

import json
import operator
import os
import pathlib
import sys
import traceback
from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Pose = Union[npt.NDArray[np.floating[Any]], Sequence[float]]


def matrix(numbers: Sequence[float]) -> Floats:
    """The 4 x 4 transform from x y z (m) and a unit quaternion x y z w."""
    x, y, z, w = numbers[3:]
    pose = np.eye(4)
    pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    pose[:3, 3] = numbers[:3]
    return pose


def numbers(pose: Pose) -> List[float]:
    """x y z (m) and the unit quaternion x y z w of a 4 x 4 transform; seven numbers are returned as they are.

    Raises ValueError if it is neither, holds a number that is not finite, or is not a rigid motion."""
    given = np.asarray(pose, dtype=np.float64)
    if given.shape not in ((4, 4), (7,)) or not np.isfinite(given).all():
        raise ValueError(f"not a pose: expected 4 x 4 or 7 finite numbers, got shape {given.shape}")
    if given.shape == (7,):
        if abs(np.linalg.norm(given[3:]) - 1) > 1e-3:
            raise ValueError("not a pose: its quaternion is not of unit length")
        return [float(number) for number in given]
    if (np.abs(given[:3, :3].T @ given[:3, :3] - np.eye(3)).max() > 1e-3
            or np.linalg.det(given[:3, :3]) < 0 or (given[3] != (0, 0, 0, 1)).any()):
        raise ValueError("not a pose: its rotation part is not a rotation, or its last row is not 0 0 0 1")
    r = given[:3, :3]
    # The eigenvector of the largest eigenvalue is the quaternion (Bar-Itzhack, 2000); eigh reads the lower half.
    four = np.zeros((4, 4))
    four[np.diag_indices(4)] = [r[0, 0] - r[1, 1] - r[2, 2], r[1, 1] - r[0, 0] - r[2, 2],
                                r[2, 2] - r[0, 0] - r[1, 1], np.trace(r)]
    four[1, 0], four[2, 0], four[2, 1] = r[0, 1] + r[1, 0], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1]
    four[3, :3] = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
    quaternion = np.linalg.eigh(four)[1][:, 3]
    return [float(number) for number in (*given[:3, 3], *quaternion)]


@dataclass(frozen=True)
class Camera:
    """A pinhole camera; pixel centers at integers."""
    width: int
    height: int
    fx: float  #: px, like the next three
    fy: float
    cx: float
    cy: float
    distortion: Tuple[float, ...]  #: k1 k2 p1 p2 k3, and k4 k5 k6 if they are not 0, as in OpenCV
    fps: float
    depth_per_meter: float  #: steps of a depth image per meter

    @property
    def matrix(self) -> Floats:
        """The 3 x 3 matrix K."""
        return np.array([[self.fx, 0, self.cx], [0, self.fy, self.cy], [0, 0, 1]])


@dataclass(frozen=True)
class Laser:
    """A planar scan."""
    name: str
    camera_from_laser: Floats  #: 4 x 4, at the frame's stamp
    angles: Floats             #: rad; a ray leaves along the laser's x, turned about its z
    ranges: Floats             #: m; 0 where nothing is in range
    limits: Tuple[float, float]  #: least and largest range, m


class Frame:
    """What the camera and, if the suite provides them, other sensors deliver at one time. Images are
    read when they are first used, which must be before the reply: the next frame replaces them.
    """

    def __init__(self, request: Dict[str, Any], depth_per_meter: float) -> None:
        self._request = request
        self._depth_per_meter = depth_per_meter
        self._read: Dict[str, Any] = {}
        self.is_over = False
        self.stamp = float(request["stamp"])  #: s
        self.stamp_text: str = request["stamp"]  #: the same as text, to the nanosecond
        self.seed: int = request["seed"]  #: for all randomness in this call

    def _image(self, name: str) -> npt.NDArray[Any]:
        if name not in self._read:
            if self.is_over:
                raise RuntimeError(f"the {name} image is of an earlier frame: read it before the reply")
            self._read[name] = _read_image(self._request[name])
        image: npt.NDArray[Any] = self._read[name]
        return image

    @property
    def color(self) -> npt.NDArray[np.uint8]:
        """(H, W, 3); red, green, blue."""
        return self._image("color")

    @property
    def depth(self) -> npt.NDArray[np.float32]:
        """(H, W), m along the optical axis; 0 where there is no return."""
        if "depth_m" not in self._read:
            self._read["depth_m"] = self._image("depth") / np.float32(self._depth_per_meter)
        depth: npt.NDArray[np.float32] = self._read["depth_m"]
        return depth

    @property
    def labels(self) -> Optional[npt.NDArray[np.uint8]]:
        """(H, W), the class of each pixel, 0 if unknown; None if the run has no labels."""
        return self._image("labels") if "labels" in self._request else None

    @property
    def odometry(self) -> Optional[Floats]:
        """4 x 4: the camera's pose from wheel odometry alone, in a world that drifts; None if the suite
        does not provide it."""
        pose = self._request.get("odometry")
        return None if pose is None else matrix(pose)

    @property
    def imu(self) -> Floats:
        """(N, 7): stamp (s), angular rate (rad/s), specific force (m/s^2), in the camera's axes,
        since the previous frame."""
        readings = self._request.get("imu", [])
        return np.array([[float(number) for number in reading]
                         for reading in readings]).reshape(-1, 7)

    @property
    def lasers(self) -> List[Laser]:
        """The scans at the stamp; empty if the suite provides none."""
        return [Laser(scan["name"], matrix(scan["camera_from_laser"]),
                      scan["first_rad"] + scan["step_rad"] * np.arange(len(scan["ranges_m"])),
                      np.array(scan["ranges_m"]), (scan["limits_m"][0], scan["limits_m"][1]))
                for scan in self._request.get("lasers", [])]


@dataclass
class Reply:
    """What a system may report about a frame: its pose and more. None means unknown."""
    pose: Optional[Pose] = None  #: world_from_camera; None: lost
    keyframe: bool = False       #: it became a keyframe: its depth is added to the occupancy map
    keypoints: Optional[int] = None
    inliers: Optional[int] = None
    map: int = 0                 #: number of the map that the pose is in
    map_reset: bool = False      #: the map was discarded; a new one begins with this frame
    stage: Optional[str] = None  #: no_candidate, matches, pnp, inliers or verified
    candidates: Dict[str, int] = field(default_factory=dict)  #: keyframes, c1, c2, c3, final


class System:
    """A SLAM system under test. Override track(), and relocalize() to be queried."""
    camera: Camera            #: known from start() on
    classes: List[str]        #: names by class id
    settings: pathlib.Path    #: the calibration with ORB-SLAM2's keys

    def start(self) -> None:
        """Called once, when the camera is known."""

    def track(self, frame: Frame) -> Union[Pose, Reply, None]:
        """The next frame of the mapping tour. Returns world_from_camera as 4 x 4 or as x y z qx qy qz
        qw, in a world that stays the same; None if tracking is lost."""
        raise NotImplementedError

    def relocalize(self, frame: Frame) -> Union[Pose, Reply, None]:
        """Localizes a frame in the frozen map; it must not use anything from earlier queries."""
        return None

    def blank(self, frame: Frame) -> Union[Pose, Reply, None]:
        """A black frame before a query. A system that still returns a pose is shown another black frame."""
        return None

    def rewind(self) -> None:
        """The feed jumps back to earlier frames: tracking is lost, the map stays."""

    def reset(self) -> None:
        """Forgets everything, the map included."""

    def freeze(self) -> Optional[List[Tuple[str, Pose]]]:
        """From now on, the map must not change. May return the final trajectory, a list with
        (Frame.stamp_text, pose) of each tracked frame; None: the poses in the replies are used."""
        return None


def serve(system: System) -> None:
    """Answers the bench for a system until the bench is done (docs/outside_systems.md, "Conversation
    mode"). What the system prints goes to the log. An exception ends the run; its last line is reported."""
    replies = os.fdopen(os.dup(sys.stdout.fileno()), "w", buffering=1)
    sys.stdout.flush()
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    for line in sys.stdin:
        request = json.loads(line)
        try:
            text = json.dumps({"id": request["id"], **_answer(system, request)}, allow_nan=False)
        except BaseException as error:  # whatever it is, the bench must be told
            traceback.print_exc()
            what = traceback.format_exception_only(type(error), error)[-1].strip()
            print(json.dumps({"id": request["id"], "error": what.replace("\n", " ")}), file=replies)
            sys.exit(1)
        print(text, file=replies)


def _answer(system: System, request: Dict[str, Any]) -> Dict[str, Any]:
    do = request["do"]
    if do == "hello":
        of = request["camera"]
        names = ("k1", "k2", "p1", "p2", "k3") + (("k4", "k5", "k6") if "k4" in of else ())
        system.camera = Camera(of["width"], of["height"], of["fx"], of["fy"], of["cx"], of["cy"],
                               tuple(of[name] for name in names), of["fps"],
                               request["depth_per_meter"])
        system.classes = request["classes"]
        system.settings = pathlib.Path(request["settings"])
        system.start()
        return {"protocol": 1, "name": type(system).__name__}
    if do in ("track", "relocalize", "blank"):
        frame = Frame(request, system.camera.depth_per_meter)
        said = getattr(system, do)(frame)
        frame.is_over = True
        return _fields(said if isinstance(said, Reply) else Reply(said))
    if do == "freeze":
        trajectory = system.freeze()
        if trajectory is None:
            return {}
        return {"trajectory": [" ".join([stamp, *(repr(number) for number in numbers(pose))])
                               for stamp, pose in trajectory]}
    if do in ("rewind", "reset"):
        getattr(system, do)()
    return {}


def _fields(reply: Reply) -> Dict[str, Any]:
    said: Dict[str, Any] = {"pose": None if reply.pose is None else numbers(reply.pose)}
    for name in ("keypoints", "inliers"):
        if (number := getattr(reply, name)) is not None:
            said[name] = operator.index(number)  # accepts numpy's integers, too, but no other numbers
    if reply.stage is not None:
        said["stage"] = reply.stage
    for name in ("keyframe", "map_reset"):
        if getattr(reply, name):
            said[name] = True
    if reply.map:
        said["map"] = operator.index(reply.map)
    if reply.candidates:
        said["candidates"] = {name: operator.index(count) for name, count in reply.candidates.items()}
    return said


def _read_image(file: str) -> npt.NDArray[Any]:
    """Reads a binary PGM or PPM as written by the bench."""
    data = pathlib.Path(file).read_bytes()
    kind, width, height, most = data[:60].split(maxsplit=4)[:4]
    pixel = np.dtype(">u2" if int(most) > 255 else "u1")
    channels = 3 if kind == b"P6" else 1
    count = int(width) * int(height) * channels
    image = np.frombuffer(data, pixel, count, len(data) - count * pixel.itemsize)
    shape = (int(height), int(width), 3) if channels == 3 else (int(height), int(width))
    return image.reshape(shape)
