# SPDX-License-Identifier: Apache-2.0
"""Object search and kidnapping with the interface of gymnasium environments; gymnasium is not needed."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ._core import Observation, SearchStart, Simulation


class SearchEnv:
    """A robot is put somewhere and must find an object of a class: it has arrived when it stops
    within arrival_m of one, with no wall in between.

    An action is (vx, vy, wz, stop): m/s and rad/s in the base's frame, held for dt seconds; stop > 0
    ends the episode. The last reward is the SPL (Anderson et al., arXiv 1807.06757): 0 without success,
    else the length of the shortest path divided by that of the path driven; all others are 0. The
    episode is cut off after limit_s."""

    def __init__(self, simulation: Simulation, goals: Sequence[str], dt: float = 0.1,
                 limit_s: float = 240, arrival_m: float = 1.0) -> None:
        self.simulation = simulation
        self.goals: List[str] = list(goals)
        self.dt, self.limit_s, self.arrival_m = dt, limit_s, arrival_m
        self.start: Optional[SearchStart] = None
        self._episodes = 0

    def reset(self, *, seed: Optional[int] = None,
              options: Optional[Dict[str, Any]] = None) -> Tuple[Observation, Dict[str, Any]]:
        """Puts the robot somewhere else; the same seed gives the same start. Returns what the robot
        senses after a step at rest, and info: `goal`."""
        number = self._episodes if seed is None else seed
        self._episodes += 1
        self.start = self.simulation.draw_start(self.goals, number, self.arrival_m)
        self.simulation.reset(self.start.pose, number)
        return self.simulation.step(0, 0, 0, self.dt), {"goal": self.start.goal}

    def step(self, action: Sequence[float]
             ) -> Tuple[Observation, float, bool, bool, Dict[str, Any]]:
        """Returns observation, reward, terminated, truncated and info: `goal`, and at the end
        `success` and `spl`."""
        if self.start is None:
            raise RuntimeError("no episode has begun: call reset() first")
        vx, vy, wz, stop = (float(number) for number in action)
        seen = self.simulation.step(vx, vy, wz, self.dt)
        truth = self.simulation.truth()
        stopped, cut = stop > 0, truth["time_s"] >= self.limit_s
        info: Dict[str, Any] = {"goal": self.start.goal}
        spl = 0.0
        if stopped or cut:
            x, y = truth["world_from_base"][:2, 3]
            success = stopped and self.start.is_arrival(x, y, self.arrival_m)
            if success:
                spl = self.start.shortest_m / max(truth["length_m"], self.start.shortest_m)
            info.update(success=success, spl=spl)
        return seen, spl, stopped, cut and not stopped, info


class KidnapEnv:
    """A robot is carried somewhere in the dark and must say where it is.

    An action is (vx, vy, wz, answer): m/s and rad/s held for dt seconds, and world_from_camera of the
    last frame (4 x 4), or None to keep looking. An answer ends the episode: the reward is 1 if it is
    within 0.25 m and 10 degrees of the truth, as in the bench, else -1. The episode is cut off after
    limit_s.
    """

    def __init__(self, simulation: Simulation, dt: float = 0.1, limit_s: float = 60,
                 dark_s: float = 1.0) -> None:
        self.simulation = simulation
        self.dt, self.limit_s, self.dark_s = dt, limit_s, dark_s
        self._episodes = 0

    def reset(self, *, seed: Optional[int] = None,
              options: Optional[Dict[str, Any]] = None) -> Tuple[Observation, Dict[str, Any]]:
        """Carries the robot to a place drawn from the seed, or to options["pose"], (x, y, heading), if given.
        Returns what it senses when the light is on again."""
        self._episodes += 1
        self.simulation.reset((options or {}).get("pose"), self._episodes if seed is None else seed)
        self.simulation.switch_light(False)
        self.simulation.step(0, 0, 0, self.dark_s)
        self.simulation.switch_light(True)
        return self.simulation.step(0, 0, 0, self.dt), {}

    def step(self, action: Tuple[float, float, float, Optional[npt.ArrayLike]]
             ) -> Tuple[Observation, float, bool, bool, Dict[str, Any]]:
        """Returns observation, reward, terminated, truncated and info: at the end `distance_m` and
        `angle_deg` of the answer."""
        vx, vy, wz, answer = action
        truth = self.simulation.truth()
        info: Dict[str, Any] = {}
        reward = 0.0
        if answer is not None:
            error = np.linalg.inv(truth["frame_pose"]) @ np.asarray(answer, dtype=np.float64)
            turn = np.clip((np.trace(error[:3, :3]) - 1) / 2, -1, 1)
            info = {"distance_m": float(np.linalg.norm(error[:3, 3])),
                    "angle_deg": float(np.degrees(np.arccos(turn)))}
            reward = 1.0 if info["distance_m"] <= 0.25 and info["angle_deg"] <= 10 else -1.0
        seen = self.simulation.step(vx, vy, wz, self.dt)
        cut = self.simulation.truth()["time_s"] >= self.limit_s
        return seen, reward, answer is not None, cut and answer is None, info
