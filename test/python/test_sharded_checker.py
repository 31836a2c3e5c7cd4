"""The client of several nodes in Python: its inputs, and nodes that hang, die or refuse. The nodes are fakes, without a
roscore. test/node/follow has tests with real nodes."""
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
import unittest

import genpy
from fake_ros import FakeMaster, answering, receive, receive_block, shake_hands
from gpu_planning_scene.msg import AnswerStatus, PlanningScene
from gpu_planning_scene.sharded_checker import ShardedChecker
from gpu_planning_scene.srv import (CheckStatesRequest, CheckStatesResponse, GetPlanningSceneRequest,
                                    GetPlanningSceneResponse, GetReportRequest, GetReportResponse)

SOON = 20.0  # seconds, also in sanitized code on a busy machine
LONG = 100.0  # seconds
TIMEOUT = 3.0  # seconds
REVISION = 7
LARGE_PART = 1000000  # states of one joint: 8 MB, more than the buffers of the system hold


def free(request):
    return CheckStatesResponse(success=True, status=AnswerStatus.OK, scene_revision=request.scene_revision,
                               valid=bytes([1]) * len(request.positions))


def silent(_connection):
    time.sleep(LONG)


def deaf(connection):
    """Does not read a request. Its buffer is small, so the client cannot write the whole request either."""
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    shake_hands(connection)
    time.sleep(LONG)


def dying(connection):
    """Is killed while it receives a request."""
    shake_hands(connection)
    receive(connection, 1000000)
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))


def of_another_version(connection):
    shake_hands(connection, b"error=client wants service check_states to have md5sum 1, but it has 2.")


def failing(connection):
    shake_hands(connection)
    receive_block(connection)
    connection.sendall(b"\0\4\0\0\0oops")


CHILD = """
import signal, sys, threading, time
from gpu_planning_scene.sharded_checker import ShardedChecker
signal.signal(signal.SIGINT, signal.default_int_handler)
check = ShardedChecker([{node!r}], timeout=100.0, patience=100.0)
def call():
    print("ready", flush=True)
    check(named_state="home")
"""


class Client(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = FakeMaster()
        for name, serve in {"free": answering(CheckStatesRequest, free), "silent": silent, "deaf": deaf,
                            "dying": dying, "other": of_another_version, "failing": failing}.items():
            cls.add_node(f"/{name}", serve)

    @classmethod
    def add_node(cls, name, serve):
        scene = PlanningScene(scene_revision=REVISION)
        report = GetReportResponse(success=True, status=AnswerStatus.OK, names=["variables"], values=[1.0])
        cls.master.add(f"{name}/get_planning_scene",
                       answering(GetPlanningSceneRequest, lambda _: GetPlanningSceneResponse(
                           success=True, status=AnswerStatus.OK, scene=scene)))
        cls.master.add(f"{name}/get_report", answering(GetReportRequest, lambda _: report))
        cls.master.add(f"{name}/check_states", serve)

    def child(self, node, last_lines, *arguments):
        """A process that makes a checker for the node and then runs the lines."""
        return subprocess.Popen([sys.executable, "-B", "-c", CHILD.format(node=node) + last_lines, *arguments],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def test_a_request_and_its_answer_arrive_as_they_are(self):
        received = []
        answer = CheckStatesResponse(success=True, status=AnswerStatus.OK, message="näher", valid=b"\0\1", seconds=0.5,
                                     body_1=["a", ""], body_2=["b", ""], clearance_world=[0.0, float("inf")],
                                     clearance_self=[0.1, 0.2], scene_revision=5)
        self.add_node("/kept", answering(CheckStatesRequest, lambda request: received.append(request) or answer))
        request = CheckStatesRequest(group="arm", named_state="home", max_contacts=3, clearance=True, scene_revision=5)
        request.scene_diff.name = "näher"
        self.assertEqual(answer, ShardedChecker(["/kept"])(request))
        self.assertEqual(answer, ShardedChecker(("/kept",))(named_state="home", scene_revision=5))
        self.assertEqual([request, CheckStatesRequest(named_state="home", scene_revision=5)], received)

    def test_wrong_inputs_are_errors(self):
        for wrong in ({"nodes": []}, {"nodes": ["/a node"]}, {"part_states": 0}, {"timeout": 0.0},
                      {"timeout": float("nan")}, {"patience": -1.0}):
            with self.assertRaises(ValueError, msg=wrong):
                ShardedChecker(**{"nodes": ["/free"], **wrong})
        for wrong in ({"nodes": "/free"}, {"nodes": [1]}, {"part_states": 1.5}, {"timeout": "1"}):
            with self.assertRaises(TypeError, msg=wrong):
                ShardedChecker(**{"nodes": ["/free"], **wrong})
        check = ShardedChecker(["/free"])
        with self.assertRaises(AttributeError):
            check(no_such_field=1)
        with self.assertRaises(genpy.SerializationError):
            check(joint_names=["joint"], positions=["far"])

    def test_a_request_is_the_only_argument(self):
        check = ShardedChecker(["/nobody"])
        for arguments, fields in (((CheckStatesRequest(),), {"positions": [1.0]}), ((CheckStatesRequest(), ["a"]), {})):
            with self.assertRaisesRegex(TypeError, "is the only argument"):
                check(*arguments, **fields)

    def test_threads_share_a_checker(self):
        check = ShardedChecker(["/free"])
        wrong = []

        def call(states):
            for _ in range(20):
                answer = check(joint_names=["joint"], positions=states * [0.0])
                if len(answer.valid) != states:
                    wrong.append(answer)

        threads = [threading.Thread(target=call, args=(states,)) for states in (1, 2, 5000, 5001)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([], wrong)

    def test_the_reason_of_a_node_without_an_answer_is_reported(self):
        for node, reason in {"/silent": "the node has not answered within 3 s",
                             "/other": "the node has another version of this package, or another type of service: "
                                       "client wants service check_states to have md5sum 1, but it has 2.",
                             "/failing": "the service has failed: oops"}.items():
            answer = ShardedChecker([node], timeout=TIMEOUT, patience=0.0)(joint_names=["joint"], positions=[0.0])
            self.assertEqual((False, AnswerStatus.UNAVAILABLE), (answer.success, answer.status))
            self.assertEqual(f"no node can answer; the last reason: {node}: {reason}", answer.message)

    def test_another_node_takes_the_large_part_of_a_node_that_hangs_or_is_killed(self):
        states = 4 * LARGE_PART  # two parts for each node
        request = CheckStatesRequest(joint_names=["joint"], positions=states * [0.0])
        answers = {}

        def call(node):
            check = ShardedChecker([node, "/free"], part_states=LARGE_PART, timeout=SOON, patience=LONG)
            answers[node] = check(request)

        threads = [threading.Thread(target=call, args=(node,)) for node in ("/silent", "/deaf", "/dying")]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(3, len(answers))
        for node, answer in answers.items():
            self.assertTrue(answer.success, answer.message)
            self.assertEqual(states * b"\1", answer.valid, node)

    def test_ctrl_c_ends_a_waiting_call(self):
        for node in ("/silent", "/deaf", "/no_such_node"):
            with self.child(node, "call()") as child:
                self.assertEqual("ready\n", child.stdout.readline())
                time.sleep(0.5)
                sent = time.monotonic()
                child.send_signal(signal.SIGINT)
                _, errors = child.communicate(timeout=LONG)
                self.assertLess(time.monotonic() - sent, SOON)
                self.assertIn("KeyboardInterrupt", errors)

    def test_the_interpreter_ends_while_a_thread_calls(self):
        repeat = "\n".join(["def repeat():", "    call()", "    while True:",
                            "        try: check(named_state='home')", "        except RuntimeError: pass", ""])
        for node in ("/silent", "/free"):
            lines = repeat + "threading.Thread(target=repeat, daemon=True).start(); time.sleep(0.5)"
            with self.child(node, lines) as child:
                self.assertEqual("ready\n", child.stdout.readline())
                read = time.monotonic()
                _, errors = child.communicate(timeout=LONG)
                self.assertLess(time.monotonic() - read, SOON)
                self.assertEqual(0, child.returncode, errors)

    def test_remappings_of_the_command_line_hold(self):
        lines = "print(ShardedChecker(['node'], patience=0.0)(named_state='home').message)"
        with self.child("node", lines, "__ns:=/cell", "_rate:=10", "not a remapping") as child:
            message, errors = child.communicate(timeout=LONG)
            self.assertIn("does not know the service /cell/node/get_planning_scene", message, errors)

    def test_a_wrong_address_of_the_master_is_an_error(self):
        with self.child("/free", "", "__master:=nonsense") as child:
            _, errors = child.communicate(timeout=LONG)
            self.assertIn("ValueError: the address of the master 'nonsense' has no host and port", errors)


if __name__ == "__main__":
    unittest.main()
