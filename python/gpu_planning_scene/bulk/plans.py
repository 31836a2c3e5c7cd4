"""The planning problems of shards: pairs of a start and a goal, with a seed for each."""
from __future__ import annotations

import dataclasses
import hashlib
import io
import pathlib
import zipfile
from typing import Any, Dict

import numpy as np

import gpu_planning_scene as gps
from gpu_planning_scene.bulk.states import UnchangedFile, first_line

NO_LIMIT = 1e6  # seconds: the search is limited by rounds, because a limit of time gives other paths on a busy machine


@dataclasses.dataclass(frozen=True)
class PlanOptions:
    """group: the planning group. max_rounds: of the planner BatchRrtConnect, after which a search fails. rule: of the
    motions, as in gpu_planning_scene.plan_motion."""
    group: str
    max_rounds: int = 1000
    rule: str = "bound"


@dataclasses.dataclass(frozen=True)
class ProblemSlice:
    """starts, goals: shape (count, variables). seeds: shape (count,)."""
    starts: np.ndarray
    goals: np.ndarray
    seeds: np.ndarray
    options: PlanOptions

    def plan(self, checker: gps.StateChecker) -> Dict[str, np.ndarray]:
        """The arrays of a shard: `status`, shape (count,), values of gpu_planning_scene.PlanningStatus; `waypoints`,
        shape (all waypoints, variables); `ends`, shape (count,): path i has the waypoints from ends[i - 1] (or 0) to
        ends[i]. A problem without a solution has no waypoints."""
        status = np.empty(len(self.starts), dtype=np.int8)
        paths = []
        for i, (start, goal) in enumerate(zip(self.starts, self.goals)):
            result = gps.plan_motion(checker, self.options.group, start, goal, seconds=NO_LIMIT,
                                     rule=self.options.rule, seed=int(self.seeds[i]),
                                     parameters={"max_rounds": self.options.max_rounds})
            solved = result.status == gps.PlanningStatus.SOLVED
            # The end of an approximate path depends on the time.
            approximate = result.status == gps.PlanningStatus.APPROXIMATE
            status[i] = (gps.PlanningStatus.NO_SOLUTION if approximate else result.status).value
            paths.append(result.waypoints if solved else np.empty((0, self.starts.shape[1])))
        ends = np.cumsum([len(path) for path in paths], dtype=np.int64)
        return {"status": status, "ends": ends, "waypoints": np.concatenate(paths)}


class ProblemFile:
    """An .npz file with the arrays `start` and `goal`, shape (n, variables). They differ in variables of the group."""

    def __init__(self, path: gps.Path, robot: gps.RobotModel, seed: int, options: PlanOptions):
        self._file = UnchangedFile(path)
        self._seed = seed
        self._options = options
        width = len(robot.variables)
        outside = [i for i in range(width) if i not in robot.group(options.group).variables]
        try:
            with np.load(path, allow_pickle=False) as arrays:
                self._starts, self._goals = (np.asarray(arrays[name], dtype=float) for name in ("start", "goal"))
        except (ValueError, KeyError, EOFError, TypeError, zipfile.BadZipFile) as error:
            raise gps.Error(f"{path}: not an .npz file with the arrays start and goal ({first_line(error)})") from None
        for name, rows in (("start", self._starts), ("goal", self._goals)):
            if rows.ndim != 2 or rows.shape != (len(self._starts), width):
                raise gps.Error(f"{pathlib.Path(path)}: the array {name} has shape {rows.shape}; start and goal need "
                                f"the same shape (n, {width}): {', '.join(robot.variable_names)}")
            if not np.isfinite(rows).all():
                raise gps.Error(f"{pathlib.Path(path)}: the array {name} has values that are not finite")
        moved = np.argwhere(self._starts[:, outside] != self._goals[:, outside])
        if len(moved):
            row, variable = moved[0][0], outside[moved[0][1]]
            raise gps.Error(f"{pathlib.Path(path)}: problem {row}: {robot.variable_names[variable]} differs between "
                            f"start and goal, but group '{options.group}' does not plan for it; give both the same value")
        self.count = len(self._starts)

    def identity(self) -> Dict[str, Any]:
        return {"sha256": self._file.digest(), "problems": self.count, "seed": self._seed,
                **dataclasses.asdict(self._options)}

    def slice(self, first: int, count: int) -> ProblemSlice:
        seeds = np.array([problem_seed(self._seed, i) for i in range(first, first + count)], dtype=np.uint32)
        rows = slice(first, first + count)
        return ProblemSlice(self._starts[rows], self._goals[rows], seeds, self._options)


def problem_seed(seed: int, index: int) -> int:
    """The planner's seed of a problem, from 1 to 4294967295. It depends only on the seed of the run and the index."""
    return 1 + int.from_bytes(hashlib.sha256(f"plan {seed} {index}".encode()).digest()[:8], "little") % (2**32 - 1)


def bytes_of(arrays: Dict[str, np.ndarray]) -> bytes:
    """An .npz file, which has the same bytes for the same arrays."""
    file = io.BytesIO()
    np.savez_compressed(file, **arrays)
    return file.getvalue()
