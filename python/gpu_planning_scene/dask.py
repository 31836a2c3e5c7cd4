"""Bulk checking on Dask arrays, for programs with a pipeline of their own: see docs/bulk.md.

The arrays may be of any size, on any Dask scheduler. A robot and a scene are inputs of the graph: Dask brings each of
them to a worker once. The workers need this package, and no files.

    import gpu_planning_scene.dask as gps_dask
    from gpu_planning_scene.bulk import RobotBundle, SceneBundle

    robot = RobotBundle.from_files("robot.urdf", "robot.srdf")
    scene = SceneBundle.from_file("scene.yaml", robot.load())
    states = gps_dask.random_states(robot, scene, 10**9, seed=1)
    share = gps_dask.check_states(states, robot, scene).mean().compute()
"""
from __future__ import annotations

from typing import Optional

import dask
import dask.array
import numpy as np

import gpu_planning_scene as gps
from gpu_planning_scene.bulk import RobotBundle, SceneBundle, work
from gpu_planning_scene.bulk.states import RandomSlice

CHUNK = 524288  # states

__all__ = ["check_states", "random_states"]


def random_states(robot: RobotBundle, scene: SceneBundle, count: int, seed: int, moves_base: bool = False,
                  chunk: int = CHUNK) -> dask.array.Array:
    """Random states within the joint limits, shape (count, variables).

    They are those of python3 -m gpu_planning_scene.bulk with the same seed, and do not depend on `chunk`, the number of
    states in a block. moves_base: planar and floating joints, which otherwise have their values from the scene, get
    random values too."""
    model = robot.load()
    base = scene.load(model).current_state
    sent = _sent(robot)
    blocks = []
    for first in range(0, count, chunk):
        part = RandomSlice(seed, first, min(chunk, count - first), moves_base)
        block = dask.delayed(_random_block, pure=True)(sent, part, base)
        blocks.append(dask.array.from_delayed(block, (part.count, len(model.variables)), float))
    if not blocks:
        return dask.array.zeros((0, len(model.variables)))
    return dask.array.concatenate(blocks)


def check_states(states: dask.array.Array, robot: RobotBundle, scene: SceneBundle, group: str = "",
                 device: str = "auto") -> dask.array.Array:
    """Whether states are free of collision: an array of bool, shape (n,), with the blocks of `states`.

    states: shape (n, variables), radians and metres. group, device: as in gpu_planning_scene.StateChecker. Raises Error
    for another number of dimensions; when the result is computed, Error for another number of variables and for values
    that are not finite."""
    if states.ndim != 2:
        raise gps.Error(f"states: the shape is {states.shape}; it must be (n, variables)")
    return states.rechunk({1: -1}).map_blocks(_check_block, _sent(robot), _sent(scene), group, device, dtype=bool,
                                              drop_axis=1, meta=np.empty(0, bool))


def _sent(bundle):
    """The bundle as a task of its own, so that it is not part of other tasks."""
    return dask.delayed(bundle, name=f"gpu_planning_scene-{bundle.digest}", traverse=False)


def _random_block(robot: RobotBundle, part: RandomSlice, base: Optional[np.ndarray]) -> np.ndarray:
    return part.states(work.robot_of(robot), base)


def _check_block(states: np.ndarray, robot: RobotBundle, scene: SceneBundle, group: str, device: str) -> np.ndarray:
    prepared = work.prepared_scene(robot, device)
    return prepared.run(scene, lambda checker, _: checker.check(states, group).valid.copy())[0]
