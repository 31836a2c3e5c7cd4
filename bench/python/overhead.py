#!/usr/bin/python3
"""overhead.py URDF SCENE [--package NAME=DIR] [--device cpu]: the time that Python adds to a check, by batch size.

The time of a call in Python is compared with BatchResult.seconds of the same call, the time that the library measures
for itself. So the load of the machine changes both. Each figure is the median of many calls. The call includes reading
`valid` of the result.
"""
import argparse
import time

import numpy as np

import gpu_planning_scene as gps


def medians(checker, states, calls):
    """Seconds in Python and in the library."""
    outer, inner = np.empty(calls), np.empty(calls)
    for i in range(calls):
        begin = time.perf_counter()
        result = checker.check(states)
        result.valid  # pylint: disable=pointless-statement
        outer[i] = time.perf_counter() - begin
        inner[i] = result.seconds
    return np.median(outer), np.median(inner), np.median(outer - inner)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("urdf")
    parser.add_argument("scene")
    parser.add_argument("--package", action="append", default=[])
    parser.add_argument("--device", default="cpu")
    arguments = parser.parse_args()
    packages = dict(each.split("=", 1) for each in arguments.package)
    robot = gps.RobotModel.from_files(arguments.urdf, packages=packages)
    checker = gps.StateChecker(gps.load_scene_file(arguments.scene, robot, packages), arguments.device)
    states = robot.random_states(65536, seed=1)
    for _ in range(3):
        checker.check(states)
    print("states  python us  library us  added us  added %")
    for count, calls in ((1, 20000), (64, 10000), (1024, 2000), (65536, 30)):
        outer, inner, added = medians(checker, states[:count], calls)
        print(f"{count:6d}  {outer * 1e6:9.2f}  {inner * 1e6:10.2f}  {added * 1e6:8.2f}  {100 * added / inner:7.2f}")


if __name__ == "__main__":
    main()
