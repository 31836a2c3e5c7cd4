#!/usr/bin/python3
"""Plans for MoveIt's panda in ten generated scenes with shelves, cages and slots.

Usage: panda_scenes.py RESOURCES OUT.csv [RUNS]. RESOURCES: MoveIt's folder with panda_description and
panda_moveit_config. Prints, for each scene and motion rule, the medians of the checked states and the seconds, and
writes one row for each plan. Start and goal of a scene are random free states with the hand in two given regions, so
that the straight motion between them collides; the same seed gives the same states in each version of the package.
"""
import csv
import pathlib
import sys

import numpy as np

import gpu_planning_scene as gps

GROUP = "panda_arm"
HAND = "panda_hand"
TRIES = 400_000


def boxes(*items):
    """(size, centre) of each box."""
    return [(np.array(size, float), np.array(centre, float)) for size, centre in items]


def shelf(x, y, heights, depth=0.35, width=0.7, board=0.02, side=1):
    """Boards one above the other with a back and two sides, open towards the robot (side 1: the opening looks to -x)."""
    top = max(heights)
    made = [((depth, width, board), (x, y, z)) for z in heights]
    made.append(((board, width, top), (x + side * depth / 2, y, top / 2)))
    made += [((depth, board, top), (x, y + s * width / 2, top / 2)) for s in (-1, 1)]
    return boxes(*made)


def bars(radius, count, height, thick=0.03):
    """Vertical bars on a circle round the robot."""
    angles = np.linspace(-np.pi, np.pi, count, endpoint=False)
    return boxes(*[((thick, thick, height), (radius * np.cos(a), radius * np.sin(a), height / 2)) for a in angles])


def rings(half, heights, thick=0.03):
    """Square frames round the robot."""
    made = []
    for z in heights:
        made += [((2 * half, thick, thick), (0, s * half, z)) for s in (-1, 1)]
        made += [((thick, 2 * half, thick), (s * half, 0, z)) for s in (-1, 1)]
    return boxes(*made)


def slot(x, gap, z):
    """Two plates with a horizontal gap between them."""
    return boxes(((0.02, 1.6, z - gap / 2), (x, 0, (z - gap / 2) / 2)),
                 ((0.02, 1.6, 1.0), (x, 0, z + gap / 2 + 0.5)))


def pit(x, y, size, height, board=0.02):
    """A box that is open at its top."""
    made = [((size, board, height), (x, y + s * size / 2, height / 2)) for s in (-1, 1)]
    made += [((board, size, height), (x + s * size / 2, y, height / 2)) for s in (-1, 1)]
    return boxes(*made, ((size, size, board), (x, y, board / 2)))


TABLE = boxes(((0.8, 1.6, 0.02), (0.6, 0, 0.0)))


def region(low, high):
    return np.array(low, float), np.array(high, float)


# The scene, and where the hand is at the start and at the goal.
SCENES = {
    "table": (TABLE + pit(0.5, 0.3, 0.2, 0.2),
              region((0.3, -0.6, 0.1), (0.7, -0.2, 0.4)), region((0.3, 0.5, 0.1), (0.7, 0.8, 0.4))),
    "shelf": (TABLE + shelf(0.65, 0, (0.3, 0.6, 0.9)),
              region((0.5, -0.3, 0.35), (0.8, 0.3, 0.58)), region((0.5, -0.3, 0.65), (0.8, 0.3, 0.88))),
    "deep shelf": (TABLE + shelf(0.65, 0, (0.3, 0.55, 0.8), depth=0.45),
                   region((0.55, -0.3, 0.33), (0.8, 0.3, 0.53)), region((0.55, -0.3, 0.58), (0.8, 0.3, 0.78))),
    "two shelves": (TABLE + shelf(0.1, 0.65, (0.3, 0.6), width=0.5, depth=0.5) + shelf(0.65, 0, (0.3, 0.6)),
                    region((0.5, -0.3, 0.33), (0.8, 0.3, 0.58)), region((-0.1, 0.5, 0.33), (0.3, 0.8, 0.58))),
    "bars": (bars(0.45, 9, 1.0),
             region((0.5, -0.2, 0.2), (0.8, 0.0, 0.7)), region((-0.2, 0.5, 0.2), (0.2, 0.8, 0.7))),
    "dense bars": (bars(0.5, 12, 1.2),
                   region((0.55, -0.2, 0.2), (0.8, 0.1, 0.7)), region((-0.3, 0.55, 0.2), (0.1, 0.8, 0.7))),
    "cage": (bars(0.5, 8, 1.2) + rings(0.52, (0.35, 0.75)),
             region((0.55, -0.2, 0.4), (0.8, 0.2, 0.7)), region((-0.2, 0.55, 0.4), (0.2, 0.8, 0.7))),
    "slot": (slot(0.45, 0.22, 0.5),
             region((0.5, -0.4, 0.3), (0.8, -0.1, 0.7)), region((0.0, 0.3, 0.2), (0.35, 0.7, 0.8))),
    "narrow slot": (slot(0.45, 0.17, 0.5),
                    region((0.5, -0.4, 0.3), (0.8, 0.0, 0.7)), region((0.0, 0.3, 0.2), (0.35, 0.7, 0.8))),
    "two pits": (TABLE + pit(0.5, -0.25, 0.3, 0.35) + pit(0.5, 0.25, 0.3, 0.35),
                 region((0.42, -0.33, 0.12), (0.58, -0.17, 0.33)), region((0.42, 0.17, 0.12), (0.58, 0.33, 0.33))),
}


def robot_of(resources):
    config = pathlib.Path(resources, "panda_moveit_config", "config", "panda.srdf")
    urdf = pathlib.Path(resources, "panda_description", "urdf", "panda.urdf")
    packages = {"moveit_resources_panda_description": pathlib.Path(resources, "panda_description")}
    return gps.RobotModel.from_files(urdf, config, packages=packages)


def hands(robot, states):
    return robot.link_poses(states)[:, robot.link_index(HAND), :3, 3]


def scene_of(robot, objects):
    scene = gps.PlanningScene(robot)
    for number, (size, centre) in enumerate(objects):
        scene.add_object(f"box{number}", gps.Box(size), centre)
    return scene


def ends(robot, checker, regions, motions, seed):
    """The first pair of a start and a goal whose straight motion collides."""
    states = np.tile(robot.default_state(), (TRIES, 1))
    random = np.random.default_rng(seed)
    for column, variable in enumerate(robot.variables):
        if variable.name.startswith("panda_joint"):
            states[:, column] = random.uniform(variable.lower, variable.upper, TRIES)
    at = hands(robot, states)
    found = []
    for low, high in regions:
        inside = states[((at > low) & (at < high)).all(axis=1)]
        found.append(inside[checker.check(inside).valid])
    for start, goal in zip(*found):
        if not motions.check(start[None], goal[None]).valid[0]:
            return start, goal
    raise SystemExit(f"no start and goal: {[len(some) for some in found]}")


def main(resources, out, runs=20):
    robot = robot_of(resources)
    with open(out, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(["scene", "rule", "run", "status", "states_checked", "planning_seconds", "length", "colliding"])
        for seed, (name, (objects, *regions)) in enumerate(SCENES.items(), 1):
            scene = scene_of(robot, objects)
            checker = gps.StateChecker(scene, device="cpu")
            start, goal = ends(robot, checker, regions, gps.MotionChecker(checker, GROUP, "samples"), seed)
            for rule in ("samples", "bound"):
                rows = []
                for run in range(runs):
                    result = gps.plan_motion(checker, GROUP, start, goal, seconds=20.0, rule=rule, simplify=False)
                    path = np.array(result.waypoints)
                    steps = np.diff(path, axis=0)
                    fine = [a + np.linspace(0, 1, 500)[:, None] * step for a, step in zip(path, steps)]
                    wrong = sum(int((~checker.check(part).valid).sum()) for part in fine)
                    rows.append([name, rule, run, result.status.name, result.states_checked, result.planning_seconds,
                                 np.linalg.norm(steps, axis=1).sum() if len(path) else "", wrong])
                table.writerows(rows)
                file.flush()
                states = [row[4] for row in rows]
                seconds = [1e3 * row[5] for row in rows]
                print(f"{name:12} {rule:8} solved {sum(row[3] == 'SOLVED' for row in rows)} of {runs}, states median "
                      f"{np.median(states):.0f}, 95 % {np.quantile(states, 0.95):.0f}; ms median {np.median(seconds):.2f}, "
                      f"95 % {np.quantile(seconds, 0.95):.2f}; colliding path states {sum(row[7] for row in rows)}",
                      flush=True)


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        raise SystemExit(__doc__)
    main(sys.argv[1], sys.argv[2], *map(int, sys.argv[3:]))
