"""The demo's client: the variables that it reads from a URDF, its random states, and its summary of answers."""
import collections
import contextlib
import importlib.util
import io
import pathlib
import tempfile
import unittest
from unittest import mock

import numpy

from folders import ROOT, SCRIPTS

spec = importlib.util.spec_from_file_location("demo_client", SCRIPTS / "demo_client.py")
demo_client = importlib.util.module_from_spec(spec)
spec.loader.exec_module(demo_client)

URDF = """<robot name="r">
  <joint name="still" type="fixed"/>
  <joint name="elbow" type="revolute"><limit lower="-1" upper="2"/></joint>
  <joint name="finger" type="prismatic"><limit lower="0" upper="0.04"/></joint>
  <joint name="other_finger" type="prismatic"><mimic joint="finger"/><limit lower="0" upper="0.04"/></joint>
  <joint name="wheel" type="continuous"/>
  <joint name="base" type="planar"/>
  <joint name="body" type="floating"/>
</robot>"""


class Variables(unittest.TestCase):
    def test_are_those_of_moving_joints_with_moveit_names(self):
        names = [variable.name for variable in demo_client.variables_of(URDF)]
        self.assertEqual(names[:6], ["elbow", "finger", "wheel", "base/x", "base/y", "base/theta"])
        self.assertEqual(
            names[6:], ["body/" + part for part in "trans_x trans_y trans_z rot_x rot_y rot_z rot_w".split()]
        )

    def test_have_the_limits_of_the_urdf(self):
        elbow = demo_client.variables_of(URDF)[0]
        self.assertEqual((elbow.lower, elbow.upper), (-1.0, 2.0))

    def test_have_the_soft_limits_of_the_urdf_and_those_of_joint_limits(self):
        soft = '<limit lower="-1" upper="2"/><safety_controller soft_lower_limit="-0.5" soft_upper_limit="3"/>'
        urdf = URDF.replace('<limit lower="-1" upper="2"/>', soft)
        self.assertEqual(demo_client.variables_of(urdf)[0], ("elbow", -0.5, 2.0))
        limits = {"elbow": {"min_position": -3.0, "has_velocity_limits": True}, "wheel": {"max_position": 1.0}}
        variables = demo_client.variables_of(urdf, limits)
        self.assertEqual(variables[0], ("elbow", -3.0, 2.0))
        self.assertGreater(variables[2].upper, 3.0)


class RandomStates(unittest.TestCase):
    def setUp(self):
        self.variables = demo_client.variables_of(URDF)

    def test_fill_the_limits(self):
        states = demo_client.random_states(self.variables, 4000, seed=3)
        for column, variable in enumerate(self.variables[:9]):
            width = variable.upper - variable.lower
            self.assertGreaterEqual(states[:, column].min(), variable.lower)
            self.assertLessEqual(states[:, column].max(), variable.upper)
            self.assertGreater(numpy.ptp(states[:, column]), 0.99 * width, variable.name)

    def test_have_unit_quaternions_that_favour_no_direction(self):
        rotations = demo_client.random_states(self.variables, 4000, seed=3)[:, 9:]
        numpy.testing.assert_allclose(numpy.linalg.norm(rotations, axis=1), 1.0)
        numpy.testing.assert_allclose((rotations**2).mean(axis=0), 0.25, atol=0.02)

    def test_around_a_state_stay_near_it_and_within_limits(self):
        around = {"elbow": 1.95, "body/rot_w": 1.0}
        states = demo_client.random_states(self.variables, 1000, seed=3, around=around, spread=0.1)
        self.assertGreaterEqual(states[:, 0].min(), 1.85)
        self.assertEqual(states[:, 0].max(), 2.0)
        self.assertGreater(states[:, 12].min(), 0.9)

    def test_are_the_same_for_the_same_seed(self):
        first, second = (demo_client.random_states(self.variables, 10, seed=7) for _ in range(2))
        numpy.testing.assert_array_equal(first, second)


class Summary(unittest.TestCase):
    def test_names_share_rate_and_commonest_pairs_in_either_order(self):
        Response = collections.namedtuple("Response", "valid body_1 body_2 seconds")
        response = Response(bytes([1, 0, 0, 0]), ["", "a", "b", "a"], ["", "b", "a", "c"], 0.5)
        lines = demo_client.summary(response, 4, 0.75)
        self.assertEqual(lines[0], "valid: 1 of 4 states (25.0 %)")
        self.assertTrue(lines[1].startswith("rate: 8 states/s "), lines[1])
        self.assertEqual(lines[2:], ["states in collision, by the pair that was found first:", "  a - b: 2 states",
                                     "  a - c: 1 states"])

    def test_counts_each_state_in_collision_once_also_those_of_rare_pairs(self):
        Response = collections.namedtuple("Response", "valid body_1 body_2 seconds")
        partners = ["b"] * 3 + ["c"] * 3 + ["d"] * 3 + ["e"] * 3 + ["f"] * 3 + ["g", "h"]
        response = Response(bytes(len(partners)), ["a"] * len(partners), partners, 0.5)
        lines = demo_client.summary(response, len(partners), 0.75)
        self.assertEqual("  other pairs: 2 states", lines[-1])
        self.assertEqual(len(partners), sum(int(line.split(": ")[1].split()[0]) for line in lines[3:]))


class Call(unittest.TestCase):
    def test_prints_a_warning_of_the_node_once(self):
        Response = collections.namedtuple("Response", "success message valid body_1 body_2 seconds")
        response = Response(True, "values are in radians", bytes([1, 1]), ["", ""], ["", ""], 0.5)
        rospy = mock.Mock()
        rospy.get_param.side_effect = lambda name, default=URDF: default
        rospy.ServiceProxy.return_value = lambda **request: response
        arguments = mock.Mock(around=None, states=2, seed=1, spread=0.2, group="")
        modules = {"rospy": rospy, "gpu_planning_scene": mock.Mock(), "gpu_planning_scene.srv": mock.Mock()}
        errors = io.StringIO()
        with mock.patch.dict("sys.modules", modules), contextlib.redirect_stderr(errors), \
                contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(0, demo_client.call(arguments))
        self.assertEqual("demo_client: values are in radians\n", errors.getvalue())


class DemoScenes(unittest.TestCase):
    def test_the_state_of_the_hubo_scene_is_read(self):
        state = demo_client.state_of_scene(ROOT / "config" / "demo" / "hubo_scene.yaml")
        self.assertEqual(len(state), 51)
        self.assertEqual(state["LEP"], -1.4)

    def test_a_scene_with_a_named_state_is_refused_with_the_reason(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, "scene.yaml")
            scene.write_text("robot_state: {named_state: ready}\n", encoding="utf-8")
            with self.assertRaisesRegex(SystemExit, "scene.yaml: --around needs joint values"):
                demo_client.state_of_scene(scene)


if __name__ == "__main__":
    unittest.main()
