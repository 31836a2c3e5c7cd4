"""The view and the configuration that show_scene.py makes for RViz."""
import importlib.util
import math
import types
import unittest

import numpy
import yaml

from folders import ROOT, SCRIPTS

spec = importlib.util.spec_from_file_location("show_scene", SCRIPTS / "show_scene.py")
show_scene = importlib.util.module_from_spec(spec)
spec.loader.exec_module(show_scene)

TRIANGLE_LIST, CUBE_LIST = 11, 6


def vector(x, y, z, **more):
    return types.SimpleNamespace(x=x, y=y, z=z, **more)


def box(namespace, center, size, turn=0.0):
    """A cube list with one box, turned about z."""
    return types.SimpleNamespace(
        ns=namespace,
        type=CUBE_LIST,
        TRIANGLE_LIST=TRIANGLE_LIST,
        scale=vector(*size),
        points=[vector(0, 0, 0)],
        pose=types.SimpleNamespace(
            position=vector(*center), orientation=vector(0, 0, math.sin(turn / 2), w=math.cos(turn / 2))
        ),
    )


class Points(unittest.TestCase):
    def test_of_a_box_are_its_corners_in_the_fixed_frame(self):
        points = show_scene.points_of(box("robot", (1, 2, 3), (2, 4, 6), math.pi / 2))
        self.assertTrue(numpy.allclose(points.min(axis=0), [-1, 1, 0]))
        self.assertTrue(numpy.allclose(points.max(axis=0), [3, 3, 6]))

    def test_of_a_mesh_are_its_vertices(self):
        mesh = box("robot", (1, 0, 0), (1, 1, 1))
        mesh.type, mesh.points = TRIANGLE_LIST, [vector(0, 0, 0), vector(1, 0, 0), vector(0, 2, 0)]
        self.assertTrue(numpy.allclose(show_scene.points_of(mesh), [[1, 0, 0], [2, 0, 0], [1, 2, 0]]))


class Views(unittest.TestCase):
    robot = box("robot", (5, 0, 0.5), (0.2, 0.2, 1))

    def test_show_the_middle_of_the_robot_from_the_front_if_nothing_hides_it(self):
        focus, distance, yaw = show_scene.view_of([self.robot, box("objects", (5, 0, -0.1), (4, 4, 0.1))], numpy.eye(3))
        self.assertTrue(numpy.allclose(focus, [5, 0, 0.5]))
        self.assertTrue(1.5 < distance < 4, distance)
        self.assertEqual(show_scene.YAWS[0], yaw)

    def test_are_not_of_the_back_of_a_shelf(self):
        shelf = box("objects", (5.5, 0, 0.75), (0.4, 3, 1.5))
        _, _, yaw = show_scene.view_of([self.robot, shelf], numpy.eye(3))
        self.assertLess(math.cos(yaw), 0.5, "the camera is behind the shelf")

    def test_show_the_robots_along_a_path(self):
        _, _, first = show_scene.view_of([self.robot], numpy.eye(3))
        to_the_camera = 1.5 * numpy.array([math.cos(first), math.sin(first), 0])
        goal = box("ghosts", (5, 3, 0.5), (0.2, 0.2, 1))
        before_it = box("objects", numpy.array([5, 3, 0.75]) + to_the_camera, (1, 1, 1.5))
        _, _, yaw = show_scene.view_of([self.robot, before_it], numpy.eye(3))
        self.assertEqual(first, yaw, "the object hides nothing without the goal")
        focus, _, yaw = show_scene.view_of([self.robot, goal, before_it], numpy.eye(3))
        self.assertTrue(numpy.allclose(focus, [5, 1.5, 0.5]))
        self.assertNotEqual(first, yaw)

    def test_of_a_robot_without_shapes_show_the_origin(self):
        focus, _, _ = show_scene.view_of([], numpy.eye(3))
        self.assertTrue(numpy.allclose(focus, 0))

    def test_are_in_the_fixed_frame(self):
        y_up = numpy.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])  # the fixed frame's z axis is the y axis of the markers
        focus, _, _ = show_scene.view_of([self.robot], y_up)
        self.assertTrue(numpy.allclose(focus, [5, -0.5, 0]))


class Upright(unittest.TestCase):
    def test_turns_z_to_the_upward_direction(self):
        try:
            import geometry_msgs.msg  # noqa: F401
        except ImportError:
            self.skipTest("needs geometry_msgs")
        for up in ((0, 0, 1), (0, 1, 0), (-2, 0, 0), (0, 0, -1), (1, 2, -3)):
            turned = show_scene.rotation_of(show_scene.upright(up)) @ [0, 0, 1]
            self.assertTrue(numpy.allclose(turned, numpy.array(up) / numpy.linalg.norm(up)), up)
        self.assertEqual(1.0, show_scene.upright((0, 0, 2)).w)


class Rviz(unittest.TestCase):
    def test_draws_through_x11_even_where_qt_would_choose_wayland(self):
        made = show_scene.environment_of_rviz({"DISPLAY": ":1", "PATH": "/bin"})
        self.assertEqual({"DISPLAY": ":1", "PATH": "/bin", "QT_QPA_PLATFORM": "xcb"}, made)
        made = show_scene.environment_of_rviz({"DISPLAY": ":1", "QT_QPA_PLATFORM": "wayland;xcb"})
        self.assertEqual("xcb", made["QT_QPA_PLATFORM"])
        chosen = show_scene.environment_of_rviz({"DISPLAY": ":1", "QT_QPA_PLATFORM": "offscreen"})
        self.assertEqual("offscreen", chosen["QT_QPA_PLATFORM"])

    def test_is_not_started_without_a_screen(self):
        self.assertIsNone(show_scene.environment_of_rviz({"PATH": "/bin"}))

    def test_that_crashes_is_reported_with_what_to_try(self):
        self.assertEqual("", show_scene.fault_of(0))
        self.assertIn("RViz was ended by signal 6", show_scene.fault_of(-6))
        self.assertIn("exit code 134", show_scene.fault_of(134))
        self.assertIn("LIBGL_ALWAYS_SOFTWARE=1", show_scene.fault_of(134))


class Configuration(unittest.TestCase):
    def test_has_the_frame_and_the_topics_of_the_scene(self):
        template = yaml.safe_load((ROOT / "config" / "scene.rviz").read_text())
        made = show_scene.configuration(template, "/cell/scene", "panda_base", (numpy.array([1.0, 2, 3]), 4.0, 0.5))
        manager = made["Visualization Manager"]
        self.assertEqual("panda_base", manager["Global Options"]["Fixed Frame"])
        topics = [display.get("Marker Topic") for display in manager["Displays"] if "Marker Topic" in display]
        self.assertEqual([f"/cell/scene/{name}" for name in ("markers", "plan_markers", "plan_animation")], topics)
        self.assertEqual({"X": 1.0, "Y": 2.0, "Z": 3.0}, manager["Views"]["Current"]["Focal Point"])
        self.assertEqual(4.0, manager["Views"]["Current"]["Distance"])


if __name__ == "__main__":
    unittest.main()
