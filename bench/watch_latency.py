#!/usr/bin/env python3
"""Times how long the verdict of ~watch takes after a change of the scene.

Needs a running planning_scene_node with a robot whose group is given. The scene gets OBJECTS boxes. A free trajectory of
200 waypoints is watched while one box after the other moves. Prints the medians and 99 percentiles, in milliseconds, of
`latency` (from the change in the node to the message) and of the whole round trip (from the request that changes the
scene to the message in this program).
"""
import argparse
import queue
import random
import time

import rospy
from geometry_msgs.msg import Point, Pose, Quaternion
from gpu_planning_scene.msg import CollisionObject, PlanningScene, WatchState
from gpu_planning_scene.srv import ApplyPlanningScene, CheckMotions, CheckStates, GetReport, WatchTrajectory
from shape_msgs.msg import SolidPrimitive
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

WAYPOINTS = 200


def service(name, kind):
    proxy = rospy.ServiceProxy(f"/planning_scene/{name}", kind, persistent=True)
    proxy.wait_for_service(30)
    return proxy


def box(number):
    while True:
        place = [random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0, 1.2)]
        if place[0] ** 2 + place[1] ** 2 > 0.2:
            break
    made = CollisionObject(id=f"box{number}", operation=CollisionObject.ADD)
    made.primitives = [SolidPrimitive(type=SolidPrimitive.BOX, dimensions=[0.06, 0.05, 0.07])]
    made.primitive_poses = [Pose(Point(*place), Quaternion(0, 0, 0, 1))]
    return made


def apply(change, boxes):
    scene = PlanningScene(is_diff=True)
    scene.robot_state.is_diff = True
    scene.world.collision_objects = boxes
    answer = change(scene=scene)
    assert answer.success, answer.message
    return answer.scene_revision


def free_motion(joints, lower, upper):
    """The longest of many free motions from a free state."""
    states = [[random.uniform(a, b) for a, b in zip(lower, upper)] for _ in range(4000)]
    flat = [value for state in states for value in state]
    checked = service("check_states", CheckStates)(joint_names=joints, positions=flat)
    assert checked.success, checked.message
    valid = checked.valid
    free = [state for state, is_free in zip(states, valid) if is_free]
    ends = free[1:]
    answer = service("check_motions", CheckMotions)(
        joint_names=joints, starts=free[0] * len(ends), ends=[value for end in ends for value in end],
        resolution=0.02, translation_resolution=0.02)
    assert answer.success, answer.message
    found = [end for end, is_free in zip(ends, answer.valid) if is_free]
    return free[0], max(found, key=lambda end: max(abs(a - b) for a, b in zip(free[0], end)))


def percentiles(values):
    values = sorted(values)
    return f"median {1e3 * values[len(values) // 2]:.2f}, 99 % {1e3 * values[int(0.99 * len(values))]:.2f} ms"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("joints", nargs="+", help="NAME:LOWER:UPPER, the joints that move")
    parser.add_argument("--objects", type=int, default=100)
    parser.add_argument("--changes", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args(rospy.myargv()[1:])
    random.seed(arguments.seed)
    rospy.init_node("watch_latency", anonymous=True)
    joints, lower, upper = zip(*(joint.split(":") for joint in arguments.joints))
    change = service("apply_planning_scene", ApplyPlanningScene)
    service("get_report", GetReport)
    apply(change, [box(i) for i in range(arguments.objects)])
    start, end = free_motion(list(joints), list(map(float, lower)), list(map(float, upper)))
    trajectory = JointTrajectory(joint_names=list(joints))
    trajectory.header.stamp = rospy.Time.now() + rospy.Duration(3600)
    for i in range(WAYPOINTS):
        share = i / (WAYPOINTS - 1)
        point = JointTrajectoryPoint(positions=[a + share * (b - a) for a, b in zip(start, end)])
        point.time_from_start = rospy.Duration(20 * share)
        trajectory.points.append(point)
    messages = queue.Queue()
    rospy.Subscriber("/planning_scene/watch", WatchState, lambda m: messages.put((time.monotonic(), m)))
    first = service("watch_trajectory", WatchTrajectory)(id="bench", joint_trajectory=trajectory)
    assert first.success, first.message
    latencies, trips, verdicts = [], [], {}
    for i in range(arguments.changes):
        begin = time.monotonic()
        revision = apply(change, [box(i % arguments.objects)])
        while True:
            arrived, message = messages.get(timeout=10)
            if message.scene_revision >= revision:
                break
        latencies.append(message.latency)
        trips.append(arrived - begin)
        verdicts[message.verdict] = verdicts.get(message.verdict, 0) + 1
        rospy.sleep(0.01)
    print("latency:", percentiles(latencies))
    print("from the request to the message:", percentiles(trips))
    print("verdicts:", {name: verdicts[getattr(WatchState, name)] for name in ("FREE", "COLLISION", "NOT_PROVEN",
                                                                             "UNKNOWN") if getattr(WatchState, name) in
                        verdicts})


if __name__ == "__main__":
    main()
