# SPDX-License-Identifier: Apache-2.0
"""Modelhouse from Python: a simulated robot, recordings, SLAM, its equations on arrays, and a base
class for your own SLAM system (System, serve), which needs only numpy."""
from typing import TYPE_CHECKING, Any

from .environments import KidnapEnv, SearchEnv
from .results import Results
from .system import Reply, System, serve

if TYPE_CHECKING:
    from ._core import (Camera, Frame, InputError, LaserScan, MachineError, Observation, SearchStart,
                        Sequence, Simulation, Slam, Step, Trajectory, classes, evaluate,
                        open_sequence, read_trajectory, semantics)

__all__ = ["Camera", "Frame", "InputError", "KidnapEnv", "LaserScan", "MachineError", "Observation", "Reply",
           "Results", "SearchEnv", "SearchStart", "Sequence", "Simulation", "Slam", "Step", "System",
           "Trajectory", "classes", "evaluate", "open_sequence", "read_trajectory", "semantics",
           "serve"]


def __getattr__(name: str) -> Any:
    """The compiled part is loaded when it is first needed: a System does not need it."""
    if name in __all__:
        from . import _core
        return getattr(_core, name)
    raise AttributeError(f"module 'modelhouse' has no attribute '{name}'")
