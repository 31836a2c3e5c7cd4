#!/usr/bin/env python3
"""Runs each Python program of the documents beside a fresh node, which the README's command starts."""

import contextlib
import math
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xmlrpc.client

import numpy as np
import rospy
import rosservice
import rostest

from gpu_planning_scene.srv import CheckStates
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

from documents_rostest import ROOT, examples

PATIENCE = 60  # seconds


def readme_command():
    """The README's command for the node, with the folders of the test in place of those of the demo."""
    commands = [line for block in examples("README.md") for line in block.split("\n") if line.startswith("roslaunch")]
    return (
        commands[0]
        .replace("$PWD/build/robots/urdf/KR5/KR5 sixx R650.urdf", rospy.get_param("~urdf"))
        .replace("$PWD/build/demo/kr5.srdf", rospy.get_param("~srdf"))
        .replace("$PWD/config", os.path.join(ROOT, "config"))
    )


class FreshNode(unittest.TestCase):
    def setUp(self):
        command = "exec " + readme_command() + " device:=cpu"
        self.assertNotIn("$PWD", command)
        self.log = tempfile.NamedTemporaryFile(prefix="node_log")
        self.node = subprocess.Popen(["bash", "-c", command], stdout=self.log)
        rospy.wait_for_service("/planning_scene/check_states", PATIENCE)

    def tearDown(self):
        self.node.send_signal(signal.SIGINT)
        self.node.wait(PATIENCE)
        while "/planning_scene/check_states" in rosservice.get_service_list():
            rospy.sleep(0.1)
        self.log.close()

    def test_a_log_file_says_that_the_node_is_ready_while_the_node_runs(self):
        wanted = "ready: /planning_scene/check_states"
        end = time.monotonic() + PATIENCE
        text = ""
        while wanted not in text and time.monotonic() < end:
            time.sleep(0.05)
            with open(self.log.name, encoding="utf-8") as file:
                text = file.read()
        self.assertIn(wanted, text)
        self.assertIsNone(self.node.poll(), "the node has ended")

    def test_threads_that_wait_take_no_time_from_the_others(self):
        uri = rospy.get_master().lookupNode("/planning_scene")[2]
        tasks = "/proc/%d/task" % xmlrpc.client.ServerProxy(uri).getPid("/test")[2]

        def waits():
            """How often each thread has waited since it began."""
            counts = {}
            for task in os.listdir(tasks):
                with contextlib.suppress(FileNotFoundError, ProcessLookupError):  # the thread has ended
                    with open(os.path.join(tasks, task, "status"), encoding="utf-8") as status:
                        counts[task] = sum(int(line.split()[1]) for line in status if line.startswith("voluntary_ctxt"))
            return counts

        # Each of 440 threads waits for a request. They would wake 880 times a second if each looked twice.
        rate = math.inf
        end = time.monotonic() + PATIENCE
        while rate > 600 and time.monotonic() < end:  # the node may still prepare its scene
            begin, before = time.monotonic(), waits()
            time.sleep(1.0)
            after = waits()
            rate = sum(after[task] - before.get(task, 0) for task in after) / (time.monotonic() - begin)
        self.assertLess(rate, 600)
        policies = []
        for task in os.listdir(tasks):
            with contextlib.suppress(ProcessLookupError):
                policies.append(os.sched_getscheduler(int(task)))
        self.assertEqual(1, policies.count(os.SCHED_BATCH), "roscpp's poll thread")

    def output_of(self, document, start):
        """Returns the output of the program whose text contains `start`."""
        programs = [block for block in examples(document) if block.startswith("import rospy") and start in block]
        self.assertEqual(1, len(programs), document)
        answer = subprocess.run([sys.executable, "-c", programs[0]], capture_output=True, text=True, timeout=60,
                                check=False)
        self.assertEqual(0, answer.returncode, answer.stderr)
        self.assertNotIn("False", answer.stdout)
        return answer.stdout

    def test_the_readmes_program_ends_with_answers(self):
        output = self.output_of("README.md", 'init_node("example")')
        self.assertRegex(output, r"(?m)^(free|\w+ collides with \w+)$")

    def test_the_nodes_client_carries_a_box(self):
        output = self.output_of(os.path.join("docs", "node.md"), 'init_node("example")')
        self.assertEqual(3, output.count("True"), output)
        self.assertRegex(output, r"(?m)^(free|\w+ - \w+) [0-9.inf]+$")

    def is_hand_in_workpiece(self):
        joints = ["shoulder_yaw", "shoulder_pitch", "elbow_pitch", "elbow_roll", "wrist_pitch", "wrist_roll"]
        check = rospy.ServiceProxy("/planning_scene/check_states", CheckStates)
        answer = check(joint_names=joints, positions=[-0.3, 0.3, 0.3, 0.0, 0.0, 0.0])
        pair = {answer.body_1[0], answer.body_2[0]}
        self.assertIn(pair, ({""}, {"palm", "workpiece"}), answer)
        return pair != {""}

    def allow_collision(self, *arguments):
        return subprocess.run([sys.executable, os.path.join(ROOT, "scripts", "allow_collision.py"), *arguments],
                              capture_output=True, text=True, timeout=60, check=False)

    def test_a_collision_is_allowed_and_forbidden_and_the_srdfs_matrix_comes_back(self):
        self.assertTrue(self.is_hand_in_workpiece())
        for arguments, collides in ((["palm", "workpiece"], False), (["workpiece", "palm", "--forbid"], True),
                                    (["workpiece", "palm"], False)):
            answer = self.allow_collision(*arguments)
            self.assertEqual((0, "done"), (answer.returncode, answer.stdout.strip()), answer)
            self.assertEqual(collides, self.is_hand_in_workpiece(), arguments)
        self.output_of(os.path.join("docs", "node.md"), 'init_node("srdf_matrix")')
        self.assertTrue(self.is_hand_in_workpiece())

    def test_a_collision_of_an_unknown_body_is_not_allowed(self):
        answer = self.allow_collision("palm", "workpice")
        self.assertEqual(1, answer.returncode)
        self.assertRegex(answer.stderr, "'workpice' is neither a link nor an object of the scene; there are: .*workpiece")

    def test_the_limited_speed_stops_the_arm_before_the_workpiece_and_lets_it_leave(self):
        joints = ["shoulder_yaw", "shoulder_pitch", "elbow_pitch", "elbow_roll", "wrist_pitch", "wrist_roll"]
        in_workpiece = np.array([-0.3, 0.3, 0.3, 0.0, 0.0, 0.0])
        state = np.array([-1.2, 0.3, 0.3, 0.0, 0.0, 0.0])  # the yaw alone moves, so no links come nearer to each other
        check = rospy.ServiceProxy("/planning_scene/check_states", CheckStates)

        def distance(row):
            answer = check(joint_names=joints, positions=row.tolist(), distances=2, distance_range=1.0)
            self.assertTrue(answer.success, answer.message)
            return min(found.distance for found in answer.distances if "workpiece" in (found.body_1, found.body_2))

        states = rospy.Publisher("joint_states", JointState, queue_size=1)
        commands = rospy.Publisher("command", JointState, queue_size=1)
        limited = []
        rospy.Subscriber("limited_command", JointState, limited.append)
        program = subprocess.Popen([sys.executable, os.path.join(ROOT, "scripts", "limit_speed.py")])

        def answer_to(velocity):
            """The limited velocity, or None if no answer comes in a second."""
            limited.clear()
            commands.publish(JointState(name=joints, velocity=list(velocity)))
            for _ in range(1000):
                if limited:
                    return np.array(limited[0].velocity)
                rospy.sleep(0.001)
            return None

        try:
            end = rospy.get_time() + PATIENCE
            while states.get_num_connections() < 2 or answer_to(np.zeros(6)) is None:  # an early answer may be lost
                self.assertLess(rospy.get_time(), end, "limit_speed.py does not answer")
                rospy.sleep(0.05)

            def drive(state, velocity, count):
                """The states and the shares of the velocity in `count` steps of 0.05 s."""
                shares = []
                for _ in range(count):
                    states.publish(JointState(name=joints, position=state.tolist(),
                                              header=Header(stamp=rospy.Time.now())))
                    rospy.sleep(0.02)  # joint_states and command are two connections
                    allowed = answer_to(velocity)
                    self.assertIsNotNone(allowed, "limit_speed.py does not answer")
                    shares.append(allowed @ velocity / (velocity @ velocity))
                    state = state + 0.05 * allowed
                    self.assertGreater(distance(state), 0.0, state)
                return state, shares

            velocity = (in_workpiece - state) / 2
            near, shares = drive(state, velocity, 80)
            self.assertEqual(1.0, shares[0])
            self.assertLess(shares[-1], 0.05)
            self.assertLess(distance(near), 0.08, "it stops near the workpiece, not far from it")
            _, shares = drive(near, -velocity, 3)
            self.assertEqual([1.0, 1.0, 1.0], shares)
            rospy.sleep(0.3)
            self.assertEqual([0.0] * 6, list(answer_to(velocity)), "the joint values are too old")
        finally:
            program.send_signal(signal.SIGINT)
            program.wait(PATIENCE)


if __name__ == "__main__":
    rospy.init_node("fresh_node_rostest")
    rostest.rosrun("gpu_planning_scene", "fresh_node_rostest", FreshNode)
