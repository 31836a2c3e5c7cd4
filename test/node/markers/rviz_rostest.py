#!/usr/bin/env python3
"""Looks at the scene of a running node in a real RViz, on a screen in memory. The robot is config/demo/arm.urdf."""
import os
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from sensor_msgs.msg import JointState

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from virtual_screen import VirtualScreen  # noqa: E402

NAMES = ["waist", "shoulder", "elbow", "wrist_roll", "wrist_pitch", "palm_roll", "grip"]
FREE = [0.0, -0.4, 1.6, 0.0, 1.2, 0.0, 0.03]
IN_THE_BALL = [0.34, 0.44, 1.6, 0.0, 1.2, 0.0, 0.03]
GOAL = [-1.3, 0.3, 1.2, 0.0, 0.3, 0.0, 0.03]
PATIENCE = 120  # seconds: RViz draws without a GPU, perhaps on a busy machine


def scripts(name):
    return os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "scripts", name)


def channels(pixels):
    """Red, green and blue of the part of the screen in which RViz draws the scene."""
    return (pixels[80:760, 380:1180, channel].astype(int) for channel in range(3))


def red(pixels):
    r, g, b = channels(pixels)
    return int(((r > 100) & (r > 2 * g) & (r > 2 * b)).sum())


def yellow(pixels):
    r, g, b = channels(pixels)
    return int(((r > 150) & (10 * g > 5 * r) & (b < g // 3)).sum())


def changed(pixels, before):
    """The number of pixels that differ clearly."""
    differences = [abs(now - then) for now, then in zip(channels(pixels), channels(before))]
    return int((differences[0] + differences[1] + differences[2] > 60).sum())


def grey(pixels):
    r, g, b = channels(pixels)
    return int(((r > 60) & (r < 200) & (abs(r - g) < 12) & (abs(b - g) < 12)).sum())


class SceneInRviz(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.screen = VirtualScreen()
        cls.publisher = rospy.Publisher("joint_states", JointState, queue_size=1, latch=True)
        cls.rviz = subprocess.Popen([sys.executable, scripts("show_scene.py")], env=cls.screen.environment())

    @classmethod
    def tearDownClass(cls):
        cls.rviz.terminate()
        cls.rviz.wait(30)
        cls.screen.close()

    def move_to(self, positions):
        self.publisher.publish(JointState(name=NAMES, position=positions))

    def wait_until(self, condition):
        """Waits until the condition is true of the screen. Returns the last picture."""
        end = time.monotonic() + PATIENCE
        pixels = self.screen.pixels()
        while not condition(pixels) and time.monotonic() < end:
            self.assertIsNone(self.rviz.poll(), "RViz has ended")
            time.sleep(0.2)
            pixels = self.screen.pixels()
        folder = os.environ.get("GPS_SCREENSHOTS")
        if folder:
            self.screen.save(os.path.join(folder, f"{self._testMethodName}_{time.monotonic():.0f}.png"))
        return pixels

    def test_1_the_robot_is_shown_at_once_and_a_free_robot_is_not_red(self):
        self.move_to(FREE)
        pixels = self.wait_until(lambda pixels: grey(pixels) > 5000)
        self.assertGreater(grey(pixels), 5000)
        self.assertEqual(0, red(pixels))
        self.assertEqual(0, yellow(pixels))

    def test_2_bodies_that_collide_are_red_and_contacts_are_visible_through_them(self):
        self.move_to(IN_THE_BALL)
        pixels = self.wait_until(lambda pixels: red(pixels) > 700 and yellow(pixels) > 20)
        self.assertGreater(red(pixels), 700)
        self.assertGreater(yellow(pixels), 20, "the contacts are as large as a finger is wide, about 10 pixels")
        self.assertGreater(grey(pixels), 3000, "the other links are not red")
        self.move_to(FREE)
        self.assertEqual(0, red(self.wait_until(lambda pixels: red(pixels) == 0)))

    def test_3_a_plan_is_shown_as_ghosts_along_its_path(self):
        from gpu_planning_scene.srv import PlanMotion

        self.move_to(FREE)
        before = self.wait_until(lambda pixels: red(pixels) == 0 and grey(pixels) > 5000)
        plan = rospy.ServiceProxy("/planning_scene/plan", PlanMotion)
        answer = plan(group="arm", start_names=NAMES, start=FREE, goal_names=NAMES[:6], goals=GOAL[:6], simplify=True)
        self.assertTrue(answer.success, answer.message)
        pixels = self.wait_until(lambda pixels: changed(pixels, before) > 6000)
        self.assertGreater(changed(pixels, before), 6000, "more than the lines, which have 2000 pixels")

    def test_4_sliders_start_with_the_state_of_the_scene(self):
        self.move_to(FREE)
        window = subprocess.Popen([sys.executable, scripts("joint_sliders.py")], env=self.screen.environment())
        try:
            states = []
            rospy.Subscriber("joint_states", JointState, states.append)
            end = time.monotonic() + PATIENCE
            own = []
            while not own:
                self.assertLess(time.monotonic(), end, "no message")
                time.sleep(0.1)
                own = [state for state in states if state._connection_header["callerid"] == "/joint_sliders"]
            self.assertEqual(NAMES, list(own[0].name))
            for expected, value in zip(FREE, own[0].position):
                self.assertAlmostEqual(expected, value, 6)
        finally:
            window.terminate()
            window.wait(30)


if __name__ == "__main__":
    rospy.init_node("rviz_rostest")
    rospy.wait_for_service("/planning_scene/check_states", PATIENCE)
    rostest.rosrun("gpu_planning_scene", "scene_in_rviz", SceneInRviz)
