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
from gpu_planning_scene.bulk.plans import PlanOptions, ProblemFile
from gpu_planning_scene.bulk.run import CheckJob, Job, PlanJob, Scene, run
from gpu_planning_scene.bulk.runner import Runner
from gpu_planning_scene.bulk.shards import PlanFiles, VerdictFiles
from gpu_planning_scene.bulk.states import ArrayFile, RandomStates, Source, TableFile, first_line

PROGRAM = "gpu_planning_scene.bulk"
STATES_PER_SHARD = 131072
PROBLEMS_PER_SHARD = 16
SCENE_SUFFIXES = (".yaml", ".yml", ".scene")


class UsageError(gps.Error):
    """Wrong options."""


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message}; --help lists the options")


def parser() -> argparse.ArgumentParser:
    result = _Parser(prog=f"python3 -m {PROGRAM}", description="Checks states, or plans motions, in one scene or in all "
                     "scenes of a folder. A run that was interrupted goes on when the same command is started again.")
    result.add_argument("--urdf", required=True, metavar="FILE")
    result.add_argument("--srdf", metavar="FILE")
    result.add_argument("--package", action="append", default=[], metavar="NAME=DIR", help="the folder of a ROS package")
    result.add_argument("--scene", required=True, metavar="FILE|DIR", help="a scene file, or a folder of scene files")
    result.add_argument("--out", required=True, metavar="DIR", help="the folder for the shards and index.json")
    inputs = result.add_mutually_exclusive_group(required=True)
    inputs.add_argument("--states", metavar="FILE", help=".npy: an array (n, variables); .csv: a line with the names of "
                        "variables, then a line for each state")
    inputs.add_argument("--random", type=_count, metavar="N", help="N random states within the joint limits; planar and "
                        "floating joints stay where they are in the scene")
    inputs.add_argument("--plans", metavar="FILE", help=".npz with the arrays start and goal (n, variables): plans "
                        "motions instead of checking states")
    result.add_argument("--seed", type=_count_or_0, default=0, help="of random states and of plans (default 0)")
    result.add_argument("--random-base", action="store_true", help="random values of planar and floating joints too")
    result.add_argument("--group", default="", help="check only pairs with a link that this group moves; plans need it")
    result.add_argument("--max-rounds", type=_count, default=PlanOptions.max_rounds, metavar="N",
                        help=f"rounds of the planner, after which a plan fails (default {PlanOptions.max_rounds})")
    result.add_argument("--rule", choices=("bound", "samples"), default="bound", help="of the motions of plans")
    result.add_argument("--shard", type=_count, metavar="N", help=f"states or problems in a file (default "
                        f"{STATES_PER_SHARD} states or {PROBLEMS_PER_SHARD} problems)")
    result.add_argument("--with-states", action="store_true", help="write the states beside their verdicts")
    result.add_argument("--format", choices=("npy", "parquet"), default="npy", help="of verdicts (default npy)")
    result.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster, for example tcp://host:8786; without "
                        "it, the devices of this machine are used")
    result.add_argument("--device", action="append", metavar="DEVICE", help="cpu, auto, software, an index or a part of "
                        "a name; several on this machine, one on a cluster (default: all GPUs, or auto)")
    result.add_argument("--check-twice", type=_share, default=DispatchOptions.check_twice, metavar="SHARE",
                        help="share of the shards that two workers compute, 0 to 1 (default "
                        f"{DispatchOptions.check_twice})")
    result.add_argument("--timeout", type=_seconds, default=DispatchOptions.timeout, metavar="S",
                        help="seconds for a shard, after which a worker is given up (default "
                        f"{DispatchOptions.timeout:g})")
    shown = result.add_mutually_exclusive_group()
    shown.add_argument("--progress", dest="progress", action="store_true", default=None,
                       help="show the progress also without a terminal")
    shown.add_argument("--no-progress", dest="progress", action="store_false")
    return result


def _count_or_0(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number of at least 0")
    return int(text)


def _count(text: str) -> int:
    if _count_or_0(text) == 0:
        raise argparse.ArgumentTypeError("the number must be at least 1")
    return int(text)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number") from None


def _share(text: str) -> float:
    if not 0.0 <= _number(text) <= 1.0:
        raise argparse.ArgumentTypeError(f"{text} is not from 0 to 1")
    return float(text)


def _seconds(text: str) -> float:
    if not 0.0 < _number(text) <= 1e9:
        raise argparse.ArgumentTypeError(f"{text} is not above 0 and at most 1e9")
    return float(text)


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
    robot = RobotBundle.from_files(arguments.urdf, arguments.srdf, packages)
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


def check_usage(arguments: argparse.Namespace) -> None:
    """Options that would have no effect are refused."""
    wrong = [name for name, given in (("--random-base", arguments.random_base),) if given and arguments.random is None]
    if arguments.plans is not None:
        wrong += [name for name, given in (("--with-states", arguments.with_states),
                                           ("--format parquet", arguments.format != "npy")) if given]
        if not arguments.group:
            raise UsageError("--plans needs --group, the planning group that moves")
    if wrong:
        raise UsageError(f"{wrong[0]} has no effect with this input; leave it out")
    if arguments.scheduler and len(arguments.device or []) > 1:
        raise UsageError("--device can be given once with --scheduler; the workers of a cluster are processes")


def runner_of(arguments: argparse.Namespace, job: Job) -> Runner:
    if not arguments.scheduler:
        return LocalRunner(job.robot, arguments.device or devices_of_this_machine(), job.shard)
    try:
        from gpu_planning_scene.bulk.cluster import CONNECT_SECONDS, DaskRunner  # pylint: disable=import-outside-toplevel
    except ImportError as error:
        raise gps.Error(f"--scheduler needs Dask ({first_line(error)}); install python3-distributed") from None
    return DaskRunner(arguments.scheduler, job.robot, (arguments.device or ["auto"])[0], job.shard,
                      min(CONNECT_SECONDS, arguments.timeout))


def execute(words: Optional[Sequence[str]] = None) -> Tuple[int, str]:
    """Runs the program in this process. Returns the exit status of `main`, and a line: the summary, or the error."""
    try:
        arguments = parser().parse_args(words)
        check_usage(arguments)
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
