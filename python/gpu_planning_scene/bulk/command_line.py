"""The program python3 -m gpu_planning_scene.bulk."""
from __future__ import annotations

import argparse
import asyncio
import os
import pathlib
import sys
import warnings
from typing import Dict, List, NoReturn, Optional, Sequence, Tuple

import gpu_planning_scene as gps
from gpu_planning_scene.bulk.bundle import RobotBundle, SceneBundle
from gpu_planning_scene.bulk.dispatch import DispatchOptions
from gpu_planning_scene.bulk.local import LocalRunner, devices_of_this_machine
from gpu_planning_scene.bulk.options import PROBLEMS_PER_SHARD, PROGRAM, STATES_PER_SHARD, UsageError, parsed
from gpu_planning_scene.bulk.plans import PlanOptions, ProblemFile
from gpu_planning_scene.bulk.run import CheckJob, Job, PlanJob, Scene, run
from gpu_planning_scene.bulk.runner import Runner
from gpu_planning_scene.bulk.shards import PlanFiles, VerdictFiles
from gpu_planning_scene.bulk.states import ArrayFile, RandomStates, Source, TableFile, first_line

SCENE_SUFFIXES = (".yaml", ".yml", ".scene")


def packages_of(pairs: Sequence[str]) -> Dict[str, str]:
    packages = {}
    for pair in pairs:
        name, equals, folder = pair.partition("=")
        if not name or not equals:
            raise UsageError(f"--package {pair}: write NAME=DIR")
        packages[name] = folder
    return packages


def scenes_of(path: str, model: gps.RobotModel, packages: Dict[str, str]) -> List[Scene]:
    """A scene file, or all scene files of a folder by name."""
    paths = [pathlib.Path(path)]
    if paths[0].is_dir():
        paths = sorted(each for each in paths[0].iterdir() if each.suffix in SCENE_SUFFIXES)
        if not paths:
            raise gps.Error(f"{path}: the folder has no scene file ({', '.join(SCENE_SUFFIXES)})")
    scenes = []
    for each in paths:
        bundle = SceneBundle.from_file(each, model, packages)
        scenes.append(Scene(bundle, bundle.load(model).current_state))
    return scenes


def source_of(arguments: argparse.Namespace, model: gps.RobotModel) -> Source:
    if arguments.random is not None:
        return RandomStates(arguments.random, arguments.seed, arguments.random_base)
    suffix = pathlib.Path(arguments.states).suffix
    if suffix not in (".npy", ".csv"):
        raise UsageError(f"--states {arguments.states}: the name must end in .npy or .csv")
    return ArrayFile(arguments.states, model) if suffix == ".npy" else TableFile(arguments.states, model)


def job_of(arguments: argparse.Namespace) -> Job:
    """Reads all inputs."""
    packages = packages_of(arguments.package)
    robot = RobotBundle.from_files(arguments.urdf, arguments.srdf, packages, arguments.planning)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # they were shown by the line above
        model = robot.load()
    scenes = scenes_of(arguments.scene, model, packages)
    if arguments.plans is not None:
        problems = ProblemFile(arguments.plans, model, arguments.seed,
                               PlanOptions(arguments.group, arguments.max_rounds, arguments.rule))
        job: Job = PlanJob(robot, scenes, problems, arguments.shard or PROBLEMS_PER_SHARD, PlanFiles())
    else:
        files = VerdictFiles("." + arguments.format, model.variable_names, arguments.with_states)
        job = CheckJob(robot, model, scenes, source_of(arguments, model), arguments.shard or STATES_PER_SHARD, files,
                       arguments.group, arguments.with_states)
    if job.source.count == 0:
        raise gps.Error(f"{arguments.states or arguments.plans}: the file has no {job.unit}")
    return job


def runner_of(arguments: argparse.Namespace, job: Job) -> Runner:
    if not arguments.scheduler:
        return LocalRunner(job.robot, arguments.device or devices_of_this_machine(), job.shard)
    try:
        # pylint: disable-next=import-outside-toplevel
        from gpu_planning_scene.bulk.cluster import CONNECT_SECONDS, DaskRunner
    except ImportError as error:
        raise gps.Error(f"--scheduler needs Dask ({first_line(error)}); install python3-distributed") from None
    return DaskRunner(arguments.scheduler, job.robot, (arguments.device or ["auto"])[0], job.shard,
                      min(CONNECT_SECONDS, arguments.timeout))


def execute(words: Optional[Sequence[str]] = None) -> Tuple[int, str]:
    """Runs the program in this process. Returns the exit status of `main`, and a line: the summary, or the error."""
    try:
        arguments = parsed(words)
        job = job_of(arguments)
        options = DispatchOptions(arguments.timeout, arguments.check_twice)
        return 0, asyncio.run(run(job, arguments.out, runner_of(arguments, job), options, arguments.progress))
    except UsageError as error:
        return 2, first_line(error)
    except (gps.Error, OSError) as error:
        return 1, first_line(error)
    except KeyboardInterrupt:
        return 130, "interrupted; start the same command again to go on"


def main() -> NoReturn:
    """Runs the program and ends the process. Exit status: 0 success, 2 wrong options, 130 Ctrl-C, 1 another error."""
    warnings.showwarning = lambda message, *_, **__: print(f"warning: {message}", file=sys.stderr)
    status, line = execute()
    print(line if status == 0 else f"{PROGRAM}: {line}", file=sys.stdout if status == 0 else sys.stderr)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # a thread may still hang in a device
