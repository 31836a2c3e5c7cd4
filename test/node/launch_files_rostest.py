#!/usr/bin/env python3
"""The live demo without a screen, and a node of a robot without an SRDF: see launch_files.test."""
import time
import unittest

import rospy
import rostest
from gpu_planning_scene.srv import CheckStates, GetReport, PlanMotion
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState
from visualization_msgs.msg import MarkerArray

# The joints and two states of config/demo/arm.urdf.
NAMES = ["waist", "shoulder", "elbow", "wrist_roll", "wrist_pitch", "palm_roll", "grip"]
FREE = [0.0, -0.4, 1.6, 0.0, 1.2, 0.0, 0.03]
IN_THE_BALL = [0.34, 0.44, 1.6, 0.0, 1.2, 0.0, 0.03]
PATIENCE = 60  # seconds


def is_red(marker):
    return marker.color.r > 2 * marker.color.g and marker.color.r > 2 * marker.color.b


class LaunchFiles(unittest.TestCase):
    def setUp(self):
        self.markers = None
        self.publisher = rospy.Publisher("joint_states", JointState, queue_size=1, latch=True)
        self.subscriber = rospy.Subscriber("/planning_scene/markers", MarkerArray, self.take)

    def tearDown(self):
        self.subscriber.unregister()

    def take(self, message):
        self.markers = message.markers

    def red_bodies(self, positions, wanted):
        """The namespaces of red markers, robot and objects, after the robot has moved. Waits until they are `wanted`."""
        self.publisher.publish(JointState(name=NAMES, position=positions))
        end = time.monotonic() + PATIENCE
        found = None
        while found != wanted and time.monotonic() < end:
            time.sleep(0.05)
            if self.markers:
                found = {marker.ns for marker in self.markers if marker.ns != "contacts" and is_red(marker)}
        return found

    def test_bodies_turn_red_while_they_collide(self):
        for positions, red in ((FREE, set()), (IN_THE_BALL, {"robot", "objects"}), (FREE, set())):
            self.assertEqual(red, self.red_bodies(positions, red))

    def test_a_robot_that_is_drawn_in_a_state_that_nobody_gave_is_logged(self):
        logged = []
        log = rospy.Subscriber("/rosout", Log, lambda message: logged.append(message.name + ": " + message.msg))
        markers = rospy.Subscriber("/without_srdf/markers", MarkerArray, lambda message: None)
        wanted = "/without_srdf: the current state is not known yet, so RViz shows the robot with default joint values"
        end = time.monotonic() + PATIENCE
        while not any(line.startswith(wanted) for line in logged) and time.monotonic() < end:
            time.sleep(0.05)
        markers.unregister()
        log.unregister()
        self.assertTrue(any(line.startswith(wanted) for line in logged), logged)

    def test_without_an_srdf_states_are_checked_and_only_adjacent_links_are_left_out(self):
        check = rospy.ServiceProxy("/without_srdf/check_states", CheckStates)
        answer = check(joint_names=["slide", "turn"], positions=[0.0, 0.0])
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(b"\x01", answer.valid)
        report = rospy.ServiceProxy("/without_srdf/get_report", GetReport)("")
        self.assertEqual(1.0, dict(zip(report.names, report.values))["allowed_self_pairs"], report.lines)

    def test_without_an_srdf_a_group_or_a_named_state_is_refused_with_what_is_missing(self):
        plan = rospy.ServiceProxy("/without_srdf/plan", PlanMotion)
        answer = plan(group="drive", start_names=["slide", "turn"], start=[0, 0], goal_names=["turn"], goals=[1])
        self.assertFalse(answer.success)
        self.assertIn("has no group 'drive'", answer.message)
        self.assertIn("SRDF", answer.message)
        check = rospy.ServiceProxy("/without_srdf/check_states", CheckStates)
        answer = check(named_state="ready")
        self.assertFalse(answer.success)
        self.assertIn("SRDF", answer.message)


if __name__ == "__main__":
    rospy.init_node("launch_files_rostest")
    for node in ("planning_scene", "without_srdf"):
        rospy.wait_for_service(f"/{node}/check_states", PATIENCE)
    rostest.rosrun("gpu_planning_scene", "launch_files", LaunchFiles)
