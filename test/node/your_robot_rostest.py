#!/usr/bin/env python3
"""Follows docs/your_robot.md as a reader does: runs its commands, its scene file and its program as they are printed."""

import os
import re
import signal
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest

from documents_rostest import ROOT, examples


# The folder of the built programs is in the workspace that the test runs in.
PROGRAMS = os.path.join(os.environ["CMAKE_PREFIX_PATH"].split(":")[0], "lib", "gpu_planning_scene")


class YourRobot(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        # The page uses the demo's folders; here the robots are elsewhere, and the workspace is set up.
        urdf = rospy.get_param("~urdf")
        blocks = [
            block.replace("/tmp/", self.folder.name + "/")
            .replace("source build/demo/devel/setup.bash", "true")
            .replace("$PWD/build/demo/devel/lib/gpu_planning_scene", PROGRAMS)
            .replace("$PWD/build/robots/urdf/KR5", os.path.dirname(urdf))
            .replace("$(rospack find gpu_planning_scene)", ROOT)
            for block in examples(os.path.join("docs", "your_robot.md"))
            if block
        ]
        self.assertEqual(18, len(blocks))
        self.variables, self.arm, self.generate, limits, time_limits, scene, self.first_verdict = blocks[:7]
        self.launch, self.report, self.set_state, self.collides_now, self.carry, self.client = blocks[7:13]
        self.client_answer, self.plan, self.picture, self.check_many, self.colliding_state = blocks[13:]
        with open(os.path.join(self.folder.name, "my_scene.yaml"), "w", encoding="utf-8") as file:
            file.write(scene)
        self.limits = os.path.join(self.folder.name, "limits.yaml")
        with open(self.limits, "w", encoding="utf-8") as file:
            file.write(limits)
        self.time_limits = os.path.join(self.folder.name, "time_limits.yaml")
        with open(self.time_limits, "w", encoding="utf-8") as file:
            file.write(time_limits)

    def run_block(self, block):
        answer = subprocess.run(["bash", "-c", self.variables + "\n" + block], capture_output=True, text=True,
                                timeout=200, check=False)
        self.assertEqual(0, answer.returncode, block + "\n" + answer.stdout + answer.stderr)
        self.assertNotIn("success: False", answer.stdout, answer.stdout)
        return answer.stdout + answer.stderr

    def test_each_step_of_the_page_works(self):
        answer = self.run_block(self.arm + '\n"$programs/check_states" --urdf "$urdf" --srdf "$srdf" --package '
                                '"$package_name=$package_folder" --scene "${srdf%.srdf}_scene.yaml" --random 100 '
                                '--out /dev/null')
        self.assertIn("100 states", answer)
        self.assertIn("planning groups: palm\n", self.run_block(self.generate))
        self.assertRegex(self.run_block(self.first_verdict), r"\n0,(wrist|palm),box\n")
        self.assertIn("shoulder_pitch (-1.5 to 1.5)", self.run_block(self.first_verdict + " --planning " + self.limits))
        answer = self.run_block(self.first_verdict + " --planning " + self.time_limits)
        self.assertNotRegex(answer, "warning|limit")
        with subprocess.Popen(["bash", "-c", self.variables + "\nexec " + self.launch + " device:=cpu"]) as node:
            try:
                rospy.wait_for_service("/planning_scene/check_states", 60)
                report = self.run_block(self.report)
                # The scene file sets the current state, so a request that names one joint has an answer.
                self.run_block(self.collides_now)
                self.assertRegex(report, r"scene: \d+ objects")
                self.run_block(self.set_state)
                answer = self.run_block(self.collides_now)
                self.assertRegex(answer, r'body_1:\s+- "?(wrist|palm)')
                self.assertIn("depth:", answer)
                self.assertEqual(2, self.run_block(self.carry).count("success: True"))
                answer = subprocess.run([sys.executable, "-c", self.client], capture_output=True, text=True, timeout=60,
                                        check=False)
                self.assertEqual(0, answer.returncode, answer.stderr)
                # The first state is free, the second is not. The pair of the verdict may differ between runs.
                self.assertRegex(answer.stdout, r"^free\n\w+ collides with box\n")
                self.assertEqual(self.client_answer.splitlines()[2:], answer.stdout.splitlines()[2:])
                plan = self.run_block(self.plan)
                self.assertRegex(plan, r"status: 1\n")
                self.assertGreater(plan.count("positions:"), 2, "the path goes around the post")
            finally:
                node.send_signal(signal.SIGINT)
                node.wait(60)
        self.assertRegex(self.run_block(self.picture), r"collides: \w+ - \w+")
        self.assertTrue(os.path.exists(os.path.join(self.folder.name, "my_robot.png")))
        self.assertIn("1000 states, ", self.run_block(self.check_many))
        for name in ("answers.csv", "states.csv"):
            with open(os.path.join(self.folder.name, name), encoding="utf-8") as file:
                self.assertEqual(1001, len(file.readlines()), name)
        names, state = self.run_block(self.colliding_state).splitlines()
        self.assertEqual("shoulder_yaw,", names[:13])
        self.assertEqual(6, len(state.split(",")))

    def test_the_scene_has_15_lines_with_each_kind_of_object(self):
        with open(os.path.join(self.folder.name, "my_scene.yaml"), encoding="utf-8") as file:
            text = file.read().strip()
        self.assertLessEqual(len(text.splitlines()), 15)
        for kind in ("box", "sphere", "cylinder", "cone", "planes", "meshes", "attached_collision_objects"):
            self.assertTrue(re.search(kind, text), kind)


if __name__ == "__main__":
    rospy.init_node("your_robot_rostest")
    rostest.rosrun("gpu_planning_scene", "your_robot_rostest", YourRobot)
