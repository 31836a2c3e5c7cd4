"""The options of the program python3 -m gpu_planning_scene.bulk."""
from __future__ import annotations

import argparse
from typing import NoReturn, Optional, Sequence

import gpu_planning_scene as gps
from gpu_planning_scene.bulk.dispatch import DispatchOptions
from gpu_planning_scene.bulk.plans import PlanOptions

PROGRAM = "gpu_planning_scene.bulk"
STATES_PER_SHARD = 524288
PROBLEMS_PER_SHARD = 16


class UsageError(gps.Error):
    """Wrong options."""


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message}; --help lists the options")


def parsed(words: Optional[Sequence[str]]) -> argparse.Namespace:
    """The options. words: None takes those of the process. Raises UsageError."""
    parser = _Parser(prog=f"python3 -m {PROGRAM}", description="Checks states, or plans motions, in one scene or in "
                     "all scenes of a folder. An interrupted run goes on when the same command is started again.")
    _add_robot_and_scenes(parser)
    _add_inputs(parser)
    _add_output(parser)
    _add_workers(parser)
    arguments = parser.parse_args(words)
    _check_usage(arguments)
    return arguments


def _add_robot_and_scenes(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--urdf", required=True, metavar="FILE")
    parser.add_argument("--srdf", metavar="FILE")
    parser.add_argument("--package", action="append", default=[], metavar="NAME=DIR",
                        help="the folder of a ROS package")
    parser.add_argument("--planning", metavar="FILE", help="a YAML file with MoveIt's joint_limits, whose position "
                        "limits replace those of the URDF")
    parser.add_argument("--scene", required=True, metavar="FILE|DIR", help="a scene file, or a folder of scene files")
    parser.add_argument("--group", default="",
                        help="check only pairs with a link that this group moves; plans need it")


def _add_inputs(parser: argparse.ArgumentParser) -> None:
    inputs = parser.add_mutually_exclusive_group(required=True)
    inputs.add_argument("--states", metavar="FILE", help=".npy: an array (n, variables); .csv: a line with the names "
                        "of variables, then a line for each state")
    inputs.add_argument("--random", type=_count, metavar="N", help="N random states within the joint limits; planar "
                        "and floating joints have their values in the scene, or else their default values")
    inputs.add_argument("--plans", metavar="FILE", help=".npz with the arrays start and goal (n, variables): plans "
                        "motions instead of checking states")
    parser.add_argument("--seed", type=_count_or_0, default=0, help="seed of random states and of plans (default 0)")
    parser.add_argument("--random-base", action="store_true", help="random values of planar and floating joints too")
    parser.add_argument("--max-rounds", type=_count, default=PlanOptions.max_rounds, metavar="N",
                        help=f"rounds of the planner, after which a plan fails (default {PlanOptions.max_rounds})")
    parser.add_argument("--rule", choices=("bound", "samples"), default="bound",
                        help="for plans; bound: each motion is proven free between its samples too (default)")


def _add_output(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", required=True, metavar="DIR", help="the folder for the shards and index.json")
    parser.add_argument("--shard", type=_count, metavar="N", help=f"states or problems in a file (default "
                        f"{STATES_PER_SHARD} states or {PROBLEMS_PER_SHARD} problems)")
    parser.add_argument("--with-states", action="store_true", help="write the states beside their verdicts")
    parser.add_argument("--format", choices=("npy", "parquet"), default="npy",
                        help="file format of the verdicts (default npy)")
    shown = parser.add_mutually_exclusive_group()
    shown.add_argument("--progress", dest="progress", action="store_true", default=None,
                       help="show the progress also without a terminal")
    shown.add_argument("--no-progress", dest="progress", action="store_false")


def _add_workers(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--scheduler", metavar="ADDRESS", help="scheduler of a Dask cluster, e.g. tcp://host:8786; "
                        "without it, the devices of this machine are used")
    parser.add_argument("--device", action="append", metavar="DEVICE", help="cpu, auto, software, an index or a part "
                        "of a name; several on this machine, one on a cluster (default: all GPUs, or auto)")
    parser.add_argument("--check-twice", type=_share, default=DispatchOptions.check_twice, metavar="SHARE",
                        help="share of the shards that two workers compute, 0 to 1 (default "
                        f"{DispatchOptions.check_twice})")
    parser.add_argument("--timeout", type=_seconds, default=DispatchOptions.timeout, metavar="S",
                        help="seconds for a shard, after which a worker is given up (default "
                        f"{DispatchOptions.timeout:g})")


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


def _check_usage(arguments: argparse.Namespace) -> None:
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
