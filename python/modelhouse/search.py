# SPDX-License-Identifier: Apache-2.0
"""Object search by a robot, in the shape of a gymnasium environment; needs none of it."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple

if TYPE_CHECKING:
    from ._core import Observation, SearchStart, Simulation


class SearchEnv:
    """A robot is put somewhere and is to find an object of a class: it has arrived when it stops
    within arrival_m of one, with no wall between.

    An action is (vx, vy, wz, stop): m/s and rad/s in the base's frame, held for dt seconds; stop > 0
    ends the episode. The reward is SPL at its end (Anderson et al., arXiv 1807.06757): 0 without
    success, else the shortest way over the way driven; before, 0. It is cut off after limit_s."""

    def __init__(self, simulation: Simulation, goals: Sequence[str], dt: float = 0.1,
                 limit_s: float = 240, arrival_m: float = 1.0) -> None:
        self.simulation = simulation
        self.goals: List[str] = list(goals)
        self.dt, self.limit_s, self.arrival_m = dt, limit_s, arrival_m
        self.start: Optional[SearchStart] = None
        self._episodes = 0

    def reset(self, *, seed: Optional[int] = None,
              options: Optional[Dict[str, Any]] = None) -> Tuple[Observation, Dict[str, Any]]:
        """Puts the robot somewhere else; the same seed is the same start. Returns what it senses after
        a moment at rest, and `goal`."""
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
            raise RuntimeError("reset() begins an episode")
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
