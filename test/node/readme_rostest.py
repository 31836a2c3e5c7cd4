#!/usr/bin/env python3
"""The README's examples are run beside a node, as a reader would: the calls from a shell, and the rospy program."""

import os
import re
import subprocess
import sys
import unittest

import rospy
import rostest

README = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "README.md")


def examples():
    """The indented blocks of the README's section on the node."""
    with open(README, encoding="utf-8") as file:
        section = file.read().split("### The node")[1].split("\n### ")[0]
    blocks = re.findall(r"(?:^(?:    .*)?\n)+", section, flags=re.MULTILINE)
    return ["\n".join(line[4:] for line in block.split("\n")).strip() for block in blocks]


class ReadmeExamples(unittest.TestCase):
    def test_each_call_from_a_shell_succeeds(self):
        calls = [line for block in examples() for line in block.split("\n") if line.startswith("rosservice call")]
        self.assertGreater(len(calls), 7)
        for call in calls:
            answer = subprocess.run(["bash", "-c", call], capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(0, answer.returncode, call + "\n" + answer.stderr)
            self.assertNotIn("success: False", answer.stdout, call)

    def test_the_program_ends_with_answers(self):
        programs = [block for block in examples() if block.startswith("import rospy")]
        self.assertEqual(1, len(programs))
        answer = subprocess.run([sys.executable, "-c", programs[0]], capture_output=True, text=True, timeout=60,
                                check=False)
        self.assertEqual(0, answer.returncode, answer.stderr)
        self.assertNotIn("False", answer.stdout)
        self.assertNotIn("success: False", answer.stdout)
        self.assertRegex(answer.stdout, r"(?m)^(free|\w+ - \w+) [0-9.inf]+$")


if __name__ == "__main__":
    rospy.init_node("readme_rostest")
    rospy.wait_for_service("/planning_scene/check_states", 60)
    rostest.rosrun("gpu_planning_scene", "readme_rostest", ReadmeExamples)
