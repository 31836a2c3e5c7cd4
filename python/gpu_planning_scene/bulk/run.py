"""A run: all shards of all scenes, from the inputs to the files."""
from __future__ import annotations

import dataclasses
from typing import Any, Dict, List, Optional, Sequence, Union

import numpy as np

import gpu_planning_scene as gps
from gpu_planning_scene.bulk import work
from gpu_planning_scene.bulk.bundle import RobotBundle, SceneBundle
from gpu_planning_scene.bulk.dispatch import DispatchOptions, Dispatcher, WorkerIsWrong
from gpu_planning_scene.bulk.output import OutputFolder
from gpu_planning_scene.bulk.plans import ProblemFile
from gpu_planning_scene.bulk.progress import Progress
from gpu_planning_scene.bulk.runner import Runner, Shard
from gpu_planning_scene.bulk.shards import PlanFiles, VerdictFiles
from gpu_planning_scene.bulk.states import Source


@dataclasses.dataclass
class Scene:
    """A scene of a run. current_state: shape (variables,), or None."""
    bundle: SceneBundle
    current_state: Optional[np.ndarray]


class Job:
    """What a run computes. Each shard belongs to one scene; the numbers of shards run on from scene to scene."""

    unit = ""  # what the source counts

    def __init__(self, robot: RobotBundle, scenes: Sequence[Scene], source: Union[Source, ProblemFile],
                 per_shard: int, files: Union[VerdictFiles, PlanFiles]):
        self.robot = robot
        self.scenes = scenes
        self.source = source
        self.per_shard = per_shard
        self.files = files
        self.per_scene = -(-source.count // per_shard)  # shards

    def definition(self) -> Dict[str, Any]:
        """What defines the output; all of it is compared when a run goes on."""
        return {"robot": self.robot.digest,
                "scenes": [{"name": scene.bundle.name, "sha256": scene.bundle.digest} for scene in self.scenes],
                "input": self.source.identity(), "shard size": self.per_shard, "options": self.options()}

    def options(self) -> Dict[str, Any]:
        """The part of the definition that depends on the kind of job."""
        raise NotImplementedError

    def names(self) -> List[str]:
        """The file of each shard."""
        digits = max(6, len(str(self.per_scene - 1)))  # so that the order of the names is that of the shards
        return [f"{scene.bundle.name}/{i:0{digits}d}{self.files.suffix}"
                for scene in self.scenes for i in range(self.per_scene)]

    def first(self, number: int) -> int:
        """The index of the first row of the source in a shard."""
        return number % self.per_scene * self.per_shard

    def size(self, number: int) -> int:
        """The number of rows of the source in a shard."""
        return min(self.per_shard, self.source.count - self.first(number))

    def scene(self, number: int) -> Scene:
        return self.scenes[number // self.per_scene]

    def label(self, number: int) -> str:
        first = self.first(number)
        return f"{self.scene(number).bundle.name}, {self.unit} {first} to {first + self.size(number) - 1}"

    def shard(self, number: int) -> Shard:
        """The scene and the task of a shard."""
        part = self.source.slice(self.first(number), self.size(number))
        return self.scene(number).bundle, self.task(part)

    def task(self, part: Any) -> work.Task:
        raise NotImplementedError

    def content(self, number: int, data: bytes) -> bytes:
        """The file of a shard, from its answer."""
        raise NotImplementedError

    def summary(self, number: int, content: bytes) -> Dict[str, Any]:
        return self.files.summary(self.size(number), content)


class CheckJob(Job):
    """Checks states. group: a planning group, or "". has_states: the files have the states too."""

    unit = "states"

    def __init__(self, robot: RobotBundle, model: gps.RobotModel, scenes: Sequence[Scene], source: Source,
                 per_shard: int, files: VerdictFiles, group: str, has_states: bool):
        super().__init__(robot, scenes, source, per_shard, files)
        if group:
            model.group(group)
        self._model = model
        self._group = group
        self._has_states = has_states

    def options(self) -> Dict[str, Any]:
        return {"kind": "states", "group": self._group, "format": self.files.suffix, "states": self._has_states,
                "variables": list(self._model.variable_names)}

    def task(self, part: Any) -> work.Task:
        return work.CheckTask(part, self._group)

    def content(self, number: int, data: bytes) -> bytes:
        size = self.size(number)
        valid = np.unpackbits(np.frombuffer(data, np.uint8), count=size).astype(bool)
        states = None
        if self._has_states:
            part = self.source.slice(self.first(number), size)
            states = part.states(self._model, self.scene(number).current_state)
        return self.files.content(valid, states)


class PlanJob(Job):
    """Plans motions."""

    unit = "problems"

    def options(self) -> Dict[str, Any]:
        return {"kind": "plans", "statuses": {each.name: each.value for each in (
            gps.PlanningStatus.SOLVED, gps.PlanningStatus.NO_SOLUTION, gps.PlanningStatus.START_IN_COLLISION,
            gps.PlanningStatus.GOAL_IN_COLLISION, gps.PlanningStatus.OUT_OF_BOUNDS)}}

    def task(self, part: Any) -> work.Task:
        return work.PlanTask(part)

    def content(self, number: int, data: bytes) -> bytes:
        return data


async def run(job: Job, folder: gps.Path, runner: Runner, options: DispatchOptions,
              progress_shown: Optional[bool] = None) -> str:
    """Computes the shards that are not in the folder. Returns a summary, a line. Raises Error."""
    with OutputFolder(folder, job.definition(), job.names(), job.summary) as output:
        return await _run(job, output, runner, options, progress_shown)


async def _run(job: Job, output: OutputFolder, runner: Runner, options: DispatchOptions,
               progress_shown: Optional[bool]) -> str:
    missing = output.missing
    total = len(job.scenes) * job.source.count
    progress = Progress(job.unit, total, total - sum(map(job.size, missing)), progress_shown)

    def deliver(number: int, answer: work.Answer, compared: bool) -> None:
        output.write(number, job.content(number, answer.data), answer.hardware, compared)
        progress.add(job.size(number), dispatcher.live_workers)

    def referee(number: int) -> bytes:
        return work.perform(job.robot, *job.shard(number), "cpu").data

    dispatcher = Dispatcher(runner, missing, deliver, referee, options, job.label,
                            lambda line: progress.line(f"warning: {line}"))
    try:
        if missing:
            await runner.open()
            progress.begin()
            await dispatcher.run()
    except WorkerIsWrong as wrong:
        count = output.discard(wrong.hardware)
        raise gps.Error(f"{wrong}; {count} shards of this hardware were deleted; repair it or leave it out, then start "
                        "the same command again") from None
    finally:
        progress.close()
        await runner.close()
    output.finish()
    return _summary(job, output, dispatcher, len(missing), progress.rate)


def _summary(job: Job, output: OutputFolder, dispatcher: Dispatcher, computed: int, rate: float) -> str:
    records = output.records
    good = "valid" if job.unit == "states" else "solved"
    text = (f"{sum(each[job.unit] for each in records):,} {job.unit}, {sum(each[good] for each in records):,} {good}; "
            f"{computed} of {len(records)} shards computed now")
    if computed:
        text += f", {rate:,.0f} {job.unit}/s, {dispatcher.checked_twice} shards computed twice"
    if dispatcher.lost_workers:
        text += f", {dispatcher.lost_workers} workers lost"
    if dispatcher.not_compared:
        text += f", {dispatcher.not_compared} shards not compared because there was no second worker"
    return text
