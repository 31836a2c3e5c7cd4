"""limit_speed.py: the states that it checks, the factor that it derives from their distances, and when it stops."""
import importlib.util
import sys
import types
import unittest
from unittest import mock

from folders import SCRIPTS

spec = importlib.util.spec_from_file_location("limit_speed", SCRIPTS / "limit_speed.py")
limit_speed = importlib.util.module_from_spec(spec)
spec.loader.exec_module(limit_speed)


class LimitSpeed(unittest.TestCase):
    def scale(self, *states):
        return limit_speed.scale_of(states, slow=0.1, stop=0.02)

    def test_the_joints_together_move_no_farther_than_a_step_between_two_states(self):
        states = limit_speed.future_states([0.5, 1.0], [1.0, -0.2], 0.5, 0.02)
        self.assertEqual([0.5, 1.0], states[0])
        self.assertAlmostEqual(1.0, states[-1][0])
        self.assertAlmostEqual(0.9, states[-1][1])
        for before, after in zip(states, states[1:]):
            self.assertLessEqual(sum(abs(b - a) for a, b in zip(before, after)), 0.02 + 1e-12)

    def test_a_pair_that_comes_nearer_slows_the_command(self):
        self.assertEqual(1.0, self.scale({}, {}))
        self.assertAlmostEqual(0.5, self.scale({}, {"pair": 0.06}))
        self.assertEqual(0.0, self.scale({"pair": 0.05}, {"pair": 0.02}))
        self.assertEqual(0.0, self.scale({"pair": 0.05}, {"pair": -0.1}, {"pair": 0.05}, {"pair": 0.05}))

    def test_the_speed_is_such_that_the_states_within_the_horizon_allow_it(self):
        # At half of the speed, the robot reaches the second of four states, which allows 0.75.
        self.assertAlmostEqual(0.5, self.scale({}, {}, {"pair": 0.08}, {"pair": 0.04}, {"pair": 0.0}))
        # At a quarter of it, the first one, which allows 0.5. The second one allows nothing.
        self.assertAlmostEqual(0.25, self.scale({}, {"pair": 0.06}, {"pair": 0.02}, {"pair": -0.1}, {"pair": -0.2}))

    def test_a_pair_that_keeps_its_distance_or_leaves_does_not(self):
        self.assertEqual(1.0, self.scale({"base": 0.01}, {"base": 0.01}))
        self.assertEqual(1.0, self.scale({"base": 0.01}, {"base": 0.01 - 1e-6}))
        self.assertEqual(1.0, self.scale({"hand": -0.01}, {"hand": 0.03}))

    def test_the_pair_that_comes_nearest_decides(self):
        self.assertAlmostEqual(0.25, self.scale({"base": 0.01}, {"base": 0.01, "hand": 0.06, "arm": 0.04}))


class Stamp(float):
    def to_sec(self):
        return float(self)


class Node:
    """Stands for ROS, its clock, the steady clock, and a planning_scene_node whose group arm has shoulder and elbow."""
    INVALID_REQUEST, UNAVAILABLE = 2, 6
    GROUP, ROBOT = ("shoulder", "elbow"), ("torso", "shoulder", "elbow", "grip")

    def __init__(self, group=""):
        self.steady = 100.0
        self.ros = 1000.0
        self.parameters = {"~group": group}
        self.published = []
        self.log = []
        self.while_checked = lambda: None
        self.faults = []  # a status for each of the next requests; None: no fault
        rospy = types.SimpleNamespace(
            get_param=lambda name, default: self.parameters.get(name, default), get_time=lambda: self.ros,
            wait_for_service=lambda name: None, ServiceProxy=lambda *_: self.check, Subscriber=mock.Mock(),
            Publisher=lambda *_, **__: types.SimpleNamespace(publish=lambda message: self.published.append(message)),
            logwarn_throttle=lambda period, text: self.log.append(text))
        modules = {"rospy": rospy, "sensor_msgs": mock.Mock(),
                   "sensor_msgs.msg": types.SimpleNamespace(JointState=types.SimpleNamespace),
                   "gpu_planning_scene": mock.Mock(), "gpu_planning_scene.srv": mock.Mock(),
                   "gpu_planning_scene.msg": types.SimpleNamespace(AnswerStatus=Node)}
        with mock.patch.dict(sys.modules, modules):
            self.limiter = limit_speed.SpeedLimiter()

    def pass_time(self, seconds):
        self.steady += seconds
        self.ros += seconds

    def check(self, group="", joint_names=(), positions=(), **_):
        if fault := self.faults.pop(0) if self.faults else None:
            return types.SimpleNamespace(success=False, status=fault, message="a value is unknown")
        if group and joint_names and not set(joint_names) & set(self.GROUP):
            return types.SimpleNamespace(success=False, status=self.INVALID_REQUEST, message="no variable of the group")
        self.while_checked()
        return types.SimpleNamespace(success=True, status=1, message="", distances=[],
                                     gradient_names=list(joint_names or self.ROBOT))

    def send(self, names, stamp=0.0):
        self.limiter.take_values(types.SimpleNamespace(name=names, position=[0.1] * len(names),
                                                       header=types.SimpleNamespace(stamp=Stamp(stamp))))

    def command(self, *names):
        """The velocities that are published for a command of 1 rad/s, and what the log says."""
        self.log.clear()
        self.limiter.take_command(types.SimpleNamespace(header=None, name=list(names), position=[], effort=[],
                                                        velocity=[1.0] * len(names)))
        return self.published[-1].velocity, " ".join(self.log)


class Stops(unittest.TestCase):
    """Each test first sees a command that passes."""
    ARM = ["shoulder", "elbow"]

    def setUp(self):
        clock = mock.patch.object(limit_speed, "time", types.SimpleNamespace(monotonic=lambda: self.node.steady),
                                  create=True)
        clock.start()
        self.addCleanup(clock.stop)
        self.node = Node()

    def assert_passes(self, *names):
        self.assertEqual(([1.0] * len(names), ""), self.node.command(*names))

    def assert_stops(self, names, *said):
        velocities, log = self.node.command(*names)
        self.assertEqual([0.0] * len(names), velocities)
        for text in said:
            self.assertIn(text, log)

    def test_an_answer_that_comes_late_is_not_used_although_newer_joint_values_have_come(self):
        def answer_after(seconds):
            self.node.pass_time(seconds)
            self.node.send(self.ARM)
        self.node.send(self.ARM)
        self.node.while_checked = lambda: answer_after(0.2)
        self.assert_passes(*self.ARM)
        self.node.while_checked = lambda: answer_after(2.0)
        self.assert_stops(self.ARM, "the node has answered too late", "2.00 s old")

    def test_a_robot_does_not_keep_its_last_velocity_while_a_node_hangs(self):
        def hang():
            for _ in range(4):
                self.node.pass_time(0.1)
                self.node.limiter.stop_while_waiting()
            self.hung = [message.velocity for message in self.node.published]
        self.node.send(self.ARM)
        self.assert_passes(*self.ARM)
        self.node.limiter.stop_while_waiting()
        self.assertEqual(1, len(self.node.published), "no call waits")
        self.node.while_checked = hang
        self.assert_stops(self.ARM, "the node has not answered for 0.25 s")
        self.assertEqual([[1.0, 1.0], [0.0, 0.0], [0.0, 0.0]], self.hung)

    def test_calls_are_watched_without_the_clock_of_ros(self):
        looks = []
        self.node.limiter.stop_while_waiting = lambda: looks.append(1)
        waits = mock.Mock(side_effect=[None, None, KeyboardInterrupt])
        with mock.patch.object(limit_speed.time, "sleep", waits, create=True), self.assertRaises(KeyboardInterrupt):
            self.node.limiter.watch_calls()
        self.assertEqual(2, len(looks))

    def test_a_joint_outside_the_group_is_not_moved(self):
        self.node = Node(group="arm")
        self.node.send(["torso", *self.ARM])
        self.assert_passes(*self.ARM)
        self.assert_stops([*self.ARM, "torso"], "~group arm does not move torso", "set ~group to")

    def test_a_joint_of_the_group_that_joint_states_does_not_bring_stops_the_others(self):
        self.node = Node(group="arm")
        self.node.send(self.ARM)
        self.assert_passes("elbow")
        self.node.pass_time(0.3)
        self.node.send(["elbow"])
        self.assert_stops(["elbow"], "the value of shoulder is 0.30 s old")
        self.node = Node(group="arm")
        self.node.send(["elbow"])
        self.assert_stops(["elbow"], "no value of shoulder")

    def test_joints_outside_the_group_may_be_published_once_a_second(self):
        self.node = Node(group="arm")
        self.node.send(["torso", *self.ARM])
        self.node.pass_time(2.0)
        self.node.send(self.ARM)
        self.assert_passes(*self.ARM)
        self.node.pass_time(1.0)
        self.node.send(self.ARM)
        self.assert_stops(self.ARM, "the value of torso is 3.00 s old")

    def test_without_a_group_a_joint_whose_values_have_ended_stops_the_others(self):
        self.node.send(["torso", *self.ARM])
        self.assert_passes(*self.ARM)
        self.node.pass_time(0.3)
        self.node.send(self.ARM)
        self.assert_stops(self.ARM, "the value of torso is 0.30 s old")

    def test_a_node_that_cannot_tell_the_group_is_asked_again(self):
        self.node = Node(group="arm")
        self.node.send(self.ARM)
        for answered in range(3):
            self.node.faults = [None] * answered + [Node.UNAVAILABLE]
            self.assert_stops(self.ARM, "a value is unknown")
        self.assert_passes(*self.ARM)

    def test_values_from_before_a_backward_jump_of_the_clock_are_old(self):
        self.node.send(self.ARM, stamp=self.node.ros)
        self.assert_passes(*self.ARM)
        self.node.steady += 0.3
        self.node.ros -= 500.0
        self.assert_stops(self.ARM, "joint_states is late", "0.30 s old")

    def test_values_with_an_old_stamp_are_not_used(self):
        self.node.send(self.ARM, stamp=self.node.ros - 0.1)
        self.assert_passes(*self.ARM)
        self.node.send(self.ARM, stamp=self.node.ros - 0.5)
        self.assert_stops(self.ARM, "joint_states is late", "0.50 s old")


if __name__ == "__main__":
    unittest.main()
