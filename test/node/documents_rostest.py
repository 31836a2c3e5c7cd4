#!/usr/bin/env python3
"""Runs the examples of the documents beside a node: calls from a shell, and rospy programs."""

import os
import re
import subprocess
import sys
import unittest

import rospy
import rostest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


def examples(document):
    """The indented blocks of a document."""
    with open(os.path.join(ROOT, document), encoding="utf-8") as file:
        blocks = re.findall(r"(?:^(?:    .*)?\n)+", file.read(), flags=re.MULTILINE)
    return ["\n".join(line[4:] for line in block.split("\n")).strip() for block in blocks]


class DocumentExamples(unittest.TestCase):
    def test_each_call_from_a_shell_succeeds(self):
        # The calls of docs/node.md set the current state. The others must work on a fresh node.
        for document, least in (("README.md", 1), (os.path.join("docs", "planning.md"), 1),
                                (os.path.join("docs", "node.md"), 8)):
            lines = [line for block in examples(document) for line in block.split("\n")]
            calls = [line for line in lines if line.startswith("rosservice call")]
            self.assertGreaterEqual(len(calls), least, document)
            for call in calls:
                answer = subprocess.run(["bash", "-c", call], capture_output=True, text=True, timeout=60, check=False)
                self.assertEqual(0, answer.returncode, call + "\n" + answer.stderr)
                self.assertNotIn("success: False", answer.stdout, call)

    def run_program(self, document):
        programs = [block for block in examples(document) if block.startswith("import rospy")]
        self.assertEqual(1, len(programs), document)
        answer = subprocess.run([sys.executable, "-c", programs[0]], capture_output=True, text=True, timeout=60,
                                check=False)
        self.assertEqual(0, answer.returncode, answer.stderr)
        return answer.stdout

    def test_the_readmes_program_ends_with_answers(self):
        self.assertRegex(self.run_program("README.md"), r"(?m)^(free|\w+ collides with \w+)$")

    def test_the_nodes_program_ends_with_answers(self):
        output = self.run_program(os.path.join("docs", "node.md"))
        self.assertNotIn("False", output)
        self.assertRegex(output, r"(?m)^(free|\w+ - \w+) [0-9.inf]+$")


if __name__ == "__main__":
    rospy.init_node("documents_rostest")
    rospy.wait_for_service("/planning_scene/check_states", 60)
    rostest.rosrun("gpu_planning_scene", "documents_rostest", DocumentExamples)
