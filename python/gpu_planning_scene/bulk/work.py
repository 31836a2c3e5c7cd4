"""The answer of a shard. This module runs in the process of a worker, and keeps the robots and checkers there."""
from __future__ import annotations

import collections
import dataclasses
import socket
import threading
from typing import Any, Callable, Optional, Tuple, Union

import numpy as np

import gpu_planning_scene as gps
from gpu_planning_scene.bulk.bundle import RobotBundle, SceneBundle
from gpu_planning_scene.bulk.plans import ProblemSlice, bytes_of
from gpu_planning_scene.bulk.states import Slice

MAX_KEPT = 4  # robots and checkers in one process; the oldest one is closed


@dataclasses.dataclass(frozen=True)
class CheckTask:
    """Checks states. Answer: a bit for each state, 1 for a valid one, as numpy.packbits makes them."""
    states: Slice
    group: str

    def run(self, checker: gps.StateChecker, scene: gps.PlanningScene) -> bytes:
        parts = self.states.parts(scene.robot, scene.current_state)
        valid = [checker.check(states, self.group).valid.copy() for states in parts]
        return np.packbits(np.concatenate(valid)).tobytes()


@dataclasses.dataclass(frozen=True)
class PlanTask:
    """Plans motions. Answer: an .npz file with the arrays of ProblemSlice.plan."""
    problems: ProblemSlice

    def run(self, checker: gps.StateChecker, scene: gps.PlanningScene) -> bytes:
        del scene
        return bytes_of(self.problems.plan(checker))


Task = Union[CheckTask, PlanTask]


@dataclasses.dataclass(frozen=True)
class Answer:
    """The answer of a shard. hardware: the host and the device, which a restarted worker has again. warnings: of a
    worker on another machine, where nobody sees them."""
    data: bytes
    hardware: str
    warnings: Tuple[str, ...] = ()


class PreparedScene:
    """A checker of one robot on one device, for one scene after the other. Thread-safe: calls wait for each other."""

    def __init__(self, robot: gps.RobotModel, device: str):
        self._robot = robot
        self._device = device
        self._lock = threading.Lock()
        self._digest = ""
        self._scene: Optional[gps.PlanningScene] = None
        self._checker: Optional[gps.StateChecker] = None

    def run(self, scene: SceneBundle, task: Callable[[gps.StateChecker, gps.PlanningScene], Any]) -> Tuple[Any, str]:
        """What the task returns for a checker and its scene, and the name of the device."""
        with self._lock:
            if self._digest != scene.digest:
                self._open(scene.load(self._robot))
                self._digest = scene.digest
            return task(self._checker, self._scene), self._checker.device_name

    def _open(self, scene: gps.PlanningScene) -> None:
        self._digest = ""  # of no scene, if the next line raises an error
        if self._checker is None:
            self._checker = gps.StateChecker(scene, device=self._device)
        else:
            self._checker.set_scene(scene)
        self._scene = scene


class _Kept:
    """Values by key, of which only the last ones are kept. Thread-safe."""

    def __init__(self, make: Callable[..., Any]):
        self._make = make
        self._values: collections.OrderedDict = collections.OrderedDict()
        self._lock = threading.Lock()

    def get(self, key: Any, *arguments: Any) -> Any:
        with self._lock:
            if key not in self._values:
                self._values[key] = self._make(*arguments)
            self._values.move_to_end(key)
            while len(self._values) > MAX_KEPT:
                self._values.popitem(last=False)
            return self._values[key]

    def drop(self, key: Any) -> None:
        with self._lock:
            self._values.pop(key, None)


_robots = _Kept(RobotBundle.load)
_prepared = _Kept(PreparedScene)


def robot_of(bundle: RobotBundle) -> gps.RobotModel:
    """The robot, made once in this process."""
    return _robots.get(bundle.digest, bundle)


def prepared_scene(bundle: RobotBundle, device: str) -> PreparedScene:
    """The PreparedScene of this process for a robot and a device."""
    return _prepared.get((bundle.digest, device), robot_of(bundle), device)


def perform(robot: RobotBundle, scene: SceneBundle, task: Task, device: str) -> Answer:
    """Runs the task of a shard on a device of this machine. Raises gpu_planning_scene.DeviceLost and Error."""
    try:
        data, name = prepared_scene(robot, device).run(scene, task.run)
    except gps.DeviceLost:
        _prepared.drop((robot.digest, device))  # the next call opens the device anew
        raise
    return Answer(data, f"{socket.gethostname()}, {name}")
