#!/usr/bin/env python3
"""Runs the calls of the documents beside a node. fresh_node_rostest.py runs the programs."""

import os
import re
import subprocess
import unittest

import rospy
import rostest

# The calls of docs/node.md set the current state and remove the objects. So they come last.
DOCUMENTS = ["README.md", os.path.join("docs", "planning.md"), os.path.join("docs", "node.md")]
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


def examples(document):
    """The indented blocks of a document."""
    with open(os.path.join(ROOT, document), encoding="utf-8") as file:
        blocks = re.findall(r"(?:^(?:    .*)?\n)+", file.read(), flags=re.MULTILINE)
    return ["\n".join(line[4:] for line in block.split("\n")).strip() for block in blocks]


def printed_answers(document):
    """(call, answer) for each call that the document prints with its answer. The answer begins with `success:`."""
    blocks = examples(document)
    return [(call, answer) for call, answer in zip(blocks, blocks[1:])
            if call.startswith("rosservice call") and answer.startswith("success:")]


def refused(document):
    """The calls whose printed answer is not a success."""
    return [call for call, answer in printed_answers(document) if answer.startswith("success: False")]


def run_call(call):
    """The lines of the answer."""
    return subprocess.run(["bash", "-c", call], capture_output=True, text=True, timeout=60, check=True).stdout.split("\n")


class DocumentExamples(unittest.TestCase):
    def test_1_printed_answers_are_those_of_the_node(self):
        """A line ... of a printed answer stands for other lines."""
        answers = [pair for document in DOCUMENTS for pair in printed_answers(document)]
        self.assertGreaterEqual(len(answers), 3)
        for call, printed in answers:
            lines = [line.strip() for line in run_call(call)]
            for line in (line.strip() for line in printed.split("\n")):
                if line != "...":
                    self.assertIn(line, lines, call)
                    lines = lines[lines.index(line) + 1:]

    def test_2_the_printed_path_goes_around_the_obstacle(self):
        calls = [call for call, answer in printed_answers(DOCUMENTS[1]) if "status: 1\n" in answer and "planner:" in answer]
        self.assertEqual(1, len(calls))
        self.assertGreater(sum("positions:" in line for line in run_call(calls[0])), 2)

    def test_3_each_call_from_a_shell_succeeds(self):
        for document, least in zip(DOCUMENTS, (1, 4, 8)):
            lines = [line for block in examples(document) for line in block.split("\n")]
            calls = [line for line in lines if line.startswith("rosservice call")]
            self.assertGreaterEqual(len(calls), least, document)
            for call in calls:
                answer = subprocess.run(["bash", "-c", call], capture_output=True, text=True, timeout=60, check=False)
                self.assertEqual(0, answer.returncode, call + "\n" + answer.stderr)
                self.assertEqual(call in refused(document), "success: False" in answer.stdout, call)


if __name__ == "__main__":
    rospy.init_node("documents_rostest")
    rospy.wait_for_service("/planning_scene/check_states", 60)
    rostest.rosrun("gpu_planning_scene", "documents_rostest", DocumentExamples)
