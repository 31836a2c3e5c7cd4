#!/usr/bin/env python3
"""The client of several nodes in Python, with the nodes of replicas.launch."""
import os
import random
import signal
import threading
import time
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import Point
from gpu_planning_scene.msg import AnswerStatus, CollisionObject, PlanningScene
from gpu_planning_scene.sharded_checker import ShardedChecker
from gpu_planning_scene.srv import ApplyPlanningScene, CheckStates, CheckStatesRequest
from shape_msgs.msg import SolidPrimitive

LEADER = "/planning_scene"
REPLICAS = [LEADER + "_1", LEADER + "_2"]
# The joints and a free state of config/demo/arm.urdf.
NAMES = ["waist", "shoulder", "elbow", "wrist_roll", "wrist_pitch", "palm_roll", "grip"]
FREE = [0.0, -0.4, 1.6, 0.0, 1.2, 0.0, 0.03]
PATIENCE = 60  # seconds


def service(node, name, kind):
    rospy.wait_for_service(f"{node}/{name}", PATIENCE)
    return rospy.ServiceProxy(f"{node}/{name}", kind, persistent=True)


def box_change(x):
    """A box around the robot, or at the distance x."""
    box = CollisionObject(id="box", operation=CollisionObject.ADD)
    box.primitives = [SolidPrimitive(type=SolidPrimitive.BOX, dimensions=[0.5, 0.5, 0.5])]
    box.pose.position = Point(x, 0.0, 0.5)
    box.pose.orientation.w = 1.0
    scene = PlanningScene(is_diff=True)
    scene.robot_state.is_diff = True
    scene.world.collision_objects = [box]
    return scene


def kill(node):
    uri = rosgraph.Master("/test").lookupNode(node)
    os.kill(xmlrpc.client.ServerProxy(uri).getPid("/test")[2], signal.SIGKILL)


class Sharding(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.apply = service(LEADER, "apply_planning_scene", ApplyPlanningScene)
        cls.checks = {node: service(node, "check_states", CheckStates) for node in [LEADER, *REPLICAS]}
        for node in REPLICAS:
            end = time.monotonic() + PATIENCE
            while not cls.checks[node](joint_names=NAMES, positions=FREE).success and time.monotonic() < end:
                time.sleep(0.05)

    def test_1_the_answer_is_that_of_one_node(self):
        revision = self.apply(box_change(50.0)).scene_revision
        generator = random.Random(1)
        request = CheckStatesRequest(joint_names=NAMES, scene_revision=revision)
        request.positions = [generator.uniform(-1.0, 1.0) for _ in range(10000 * len(NAMES))]
        expected = self.checks[LEADER](request)
        self.assertEqual({0, 1}, set(expected.valid))
        for node in REPLICAS:
            self.assertEqual(expected.valid, self.checks[node](request).valid)
        check = ShardedChecker([LEADER, *REPLICAS])
        found = check(request)
        self.assertEqual((True, revision), (found.success, found.scene_revision), found.message)
        self.assertEqual(expected.valid, found.valid)
        self.assertEqual(expected.valid, check(joint_names=NAMES, positions=request.positions).valid)
        refused = check(joint_names=["no such joint"], positions=[0.0])
        self.assertEqual((False, AnswerStatus.INVALID_REQUEST), (refused.success, refused.status))
        self.assertIn("no such joint", refused.message)

    def test_2_no_answer_is_mixed_or_lost_while_the_scene_changes_and_a_node_is_killed(self):
        free = {}
        done = threading.Event()

        def change():
            near = False
            while not done.is_set():
                near = not near
                free[self.apply(box_change(0.0 if near else 50.0)).scene_revision] = not near

        changes = threading.Thread(target=change)
        changes.start()
        check = ShardedChecker([LEADER, *REPLICAS], part_states=1000)
        judged = 0
        try:
            for i in range(20):
                killer = threading.Timer(0.02, kill, (REPLICAS[1],))
                if i == 8:
                    killer.start()
                answer = check(joint_names=NAMES, positions=5000 * FREE)
                self.assertTrue(answer.success, answer.message)
                self.assertEqual((5000, 1), (len(answer.valid), len(set(answer.valid))))
                if answer.scene_revision in free:
                    self.assertEqual(free[answer.scene_revision], answer.valid[0] != 0)
                    judged += 1
                killer.join() if i == 8 else None
        finally:
            done.set()
            changes.join()
        self.assertGreater(judged, 10)
        dead = ShardedChecker([REPLICAS[1]], patience=0.1)(joint_names=NAMES, positions=FREE)
        self.assertEqual((False, AnswerStatus.UNAVAILABLE), (dead.success, dead.status), dead.message)
        check = ShardedChecker([LEADER], patience=1000.0)  # at once: that scene will not come back
        gone = check(joint_names=NAMES, positions=FREE, scene_revision=1)
        self.assertEqual((False, AnswerStatus.UNKNOWN_REVISION), (gone.success, gone.status), gone.message)


if __name__ == "__main__":
    rospy.init_node("sharded_checker_rostest")
    rostest.rosrun("gpu_planning_scene", "sharded_checker_rostest", Sharding)
