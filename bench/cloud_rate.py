#!/usr/bin/env python3
"""Sends point clouds to a running planning_scene_node while a client checks states. Prints the number of clouds that
became part of the scene, the time from sending a cloud to the first answer with it, and the time of the checks. Sets the
robot to its zero state first."""

import argparse
import threading
import time
import xml.etree.ElementTree as xml

import numpy
import rospy
from gpu_planning_scene.srv import ApplyPlanningScene, CheckStates, GetPlanningScene
from gpu_planning_scene.msg import PlanningScene
from sensor_msgs.msg import PointCloud2, PointField


def room(points, generator):
    """Points on the floor and walls of a room of 6 m x 6 m x 3 m, and on boxes in it; metres."""
    share = points // 2
    sides = generator.integers(0, 5, share)
    cloud = generator.uniform([-3, -3, -0.5], [3, 3, 2.5], (share, 3))
    for side, (axis, value) in enumerate([(2, -0.5), (0, -3.0), (0, 3.0), (1, -3.0), (1, 3.0)]):
        cloud[sides == side, axis] = value
    rest = points - share
    boxes = generator.uniform([-2, -2, -0.4], [2, 2, 0.8], (40, 3))
    boxes = boxes[numpy.linalg.norm(boxes[:, :2], axis=1) > 0.7]
    at = boxes[generator.integers(0, len(boxes), rest)]
    surface = generator.uniform(-0.15, 0.15, (rest, 3))
    axis = generator.integers(0, 3, rest)
    surface[numpy.arange(rest), axis] = numpy.where(generator.integers(0, 2, rest) == 0, -0.15, 0.15)
    return numpy.concatenate([cloud, at + surface]).astype(numpy.float32)


def message_of(points, frame):
    message = PointCloud2(height=1, width=len(points), point_step=12, row_step=12 * len(points), is_dense=True)
    message.header.frame_id = frame
    message.fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate("xyz")]
    message.data = points.tobytes()
    return message


class Checker(threading.Thread):
    """Checks states continuously. Records the time of the first answer with each revision."""

    def __init__(self, node, names, states):
        super().__init__(daemon=True)
        self.check = rospy.ServiceProxy(node + "/check_states", CheckStates, persistent=True)
        self.names, self.states = names, states
        self.first, self.seconds, self.done = {}, [], False

    def run(self):
        while not self.done:
            start = time.monotonic()
            answer = self.check(joint_names=self.names, positions=self.states)
            if not answer.success:
                raise SystemExit(answer.message)
            end = time.monotonic()
            self.seconds.append(end - start)
            self.first.setdefault(answer.scene_revision, end)
            time.sleep(0.005)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--node", default="/planning_scene")
    parser.add_argument("--topic", default="/cloud")
    parser.add_argument("--points", type=int, default=100000)
    parser.add_argument("--rate", type=float, default=2.0, help="clouds a second")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--states", type=int, default=64, help="states of each check")
    arguments = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("cloud_rate")
    get = rospy.ServiceProxy(arguments.node + "/get_planning_scene", GetPlanningScene)
    get.wait_for_service(30)
    got = get()
    if not got.success:
        raise SystemExit(got.message)
    frame = got.scene.robot_state.joint_state.header.frame_id
    robot = xml.fromstring(rospy.get_param("robot_description"))
    moving = ("revolute", "continuous", "prismatic")
    names = [joint.get("name") for joint in robot.findall("joint") if joint.get("type") in moving]
    generator = numpy.random.default_rng(1)
    change = PlanningScene(is_diff=True)
    change.robot_state.is_diff = True
    change.robot_state.joint_state.name = names
    change.robot_state.joint_state.position = [0.0] * len(names)
    apply = rospy.ServiceProxy(arguments.node + "/apply_planning_scene", ApplyPlanningScene)
    answer = apply(change)
    if not answer.success:
        raise SystemExit(answer.message)
    checker = Checker(arguments.node, names, generator.uniform(-1.5, 1.5, arguments.states * len(names)).tolist())
    checker.start()

    publisher = rospy.Publisher(arguments.topic, PointCloud2, queue_size=1)
    while publisher.get_num_connections() == 0:
        time.sleep(0.05)
    clouds = [message_of(room(arguments.points, generator), frame) for _ in range(8)]
    sent = []
    for i in range(int(arguments.seconds * arguments.rate)):
        sent.append(time.monotonic())
        publisher.publish(clouds[i % len(clouds)])
        time.sleep(max(0.0, sent[0] + (i + 1) / arguments.rate - time.monotonic()))
    time.sleep(2.0)
    checker.done = True
    checker.join()
    taken = get().scene.scene_revision - answer.scene_revision
    delays = []
    for revision, when in checker.first.items():
        number = revision - answer.scene_revision
        if taken == len(sent) and number >= 1:
            delays.append(when - sent[number - 1])
    print(f"{len(sent)} clouds of {arguments.points} points at {arguments.rate:g} Hz; {taken} became part of the scene")
    if delays:
        print(f"from sending to the first answer with it: median {1e3 * numpy.median(delays):.0f} ms, "
              f"longest {1e3 * max(delays):.0f} ms")
    print(f"{len(checker.seconds)} checks of {arguments.states} states beside it: median "
          f"{1e3 * numpy.median(checker.seconds):.1f} ms, 99 % {1e3 * numpy.quantile(checker.seconds, 0.99):.0f} ms")


if __name__ == "__main__":
    main()
