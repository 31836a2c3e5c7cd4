"""PlanningScene: files, text, objects built in Python, attached objects, padding, allowed collisions."""
import copy
import pathlib
import tempfile
import unittest

import numpy as np

import gpu_planning_scene as gps
from robots import ARM_SCENE, Case, arm, arm_scene, rail

TETRAHEDRON = ([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
# A cube of 2 m without its side at x > 0, and this side.
CUBE = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
TROUGH = [[0, 1, 3], [0, 3, 2], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
SIDE = [[4, 6, 7], [4, 7, 5]]


def verdicts(scene, positions):
    """Whether the ball of the rail is free at these positions."""
    states = np.array(positions, dtype=float).reshape(-1, 1)
    return gps.StateChecker(scene, device="cpu").check(states).valid.tolist()


class PlanningScene(Case):
    def test_a_scene_from_text_is_the_scene_of_the_file(self):
        robot = arm()
        a, b = gps.load_scene_file(ARM_SCENE, robot), gps.load_scene_text(ARM_SCENE.read_text(), robot)
        self.assertEqual(a.body_names, b.body_names)
        self.assertIn("table", a.body_names)
        np.testing.assert_array_equal(a.current_state, b.current_state)
        states = robot.random_states(2000, seed=1)
        np.testing.assert_array_equal(*(gps.StateChecker(scene, device="cpu").check(states).valid for scene in (a, b)))

    def test_faults_of_a_scene_name_the_file_or_the_text_and_the_line(self):
        robot = rail()
        self.assert_one_line(gps.Error, "^/none.yaml: ", gps.load_scene_file, "/none.yaml", robot)
        text = "world:\n  collision_objects:\n    - id: box\n      primitives: [{type: bax, dimensions: [1, 1, 1]}]\n"
        self.assert_one_line(gps.Error, "^the text of the scene:4: .*bax", gps.load_scene_text, text, robot)
        self.assert_one_line(gps.Error, "^request 5:4: ", gps.load_scene_text, text, robot, name="request 5")
        self.assert_one_line(gps.Error, "not YAML", gps.load_scene_text, "world: [", robot)
        self.assert_one_line(gps.Error, "holds no YAML value", gps.load_scene_text, "", robot)
        self.assert_one_line(TypeError, "expected a RobotModel, but got None", gps.load_scene_text, text, None)

    def test_a_file_in_iso_8859_1_is_read(self):
        text = "world: {collision_objects: [{id: Tréteau, primitives: [{type: sphere, dimensions: [1]}]}]}"
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "scene.yaml")
            path.write_bytes(text.encode("latin-1"))
            self.assertIn("Tréteau", gps.load_scene_file(path, rail()).body_names)

    def test_text_of_rviz_is_known_by_its_name(self):
        text = "scene\n* can\n1\nsphere\n0.1\n0.5 0 0\n0 0 0 1\n0 0 0 0\n.\n"
        self.assertIn("can", gps.load_scene_text(text, rail(), name="text.scene").body_names)
        self.assert_one_line(gps.Error, "^text.yaml", gps.load_scene_text, text, rail(), name="text.yaml")

    def test_relative_meshes_of_a_text_begin_at_the_folder(self):
        text = "world: {collision_objects: [{id: part, meshes: [{resource: part.obj}]}]}"
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
            scene = gps.load_scene_text(text, rail(), folder=folder)
        self.assertEqual(1, len(scene.objects[0].shapes[0][0].triangles))
        self.assert_one_line(gps.Error, "part.obj", gps.load_scene_text, text, rail(), folder="/none")

    def test_entries_that_are_not_used_are_warnings(self):
        with self.assertWarnsRegex(UserWarning, "unknown key 'comment' is not used"):
            gps.load_scene_text("comment: 5\nname: x\n", rail())
        self.assert_one_line(gps.Error, "did you mean 'world'", gps.load_scene_text, "wurld: 5\nname: x\n", rail())

    def test_each_shape_stands_where_its_pose_says(self):
        # The ball has a radius of 0.1 m. Each obstacle reaches from x = 1 - extent to x = 1 + extent.
        turned = np.array([0.0, np.sqrt(0.5), 0.0, np.sqrt(0.5)])  # z becomes x
        for shape, extent, pose in (
            (gps.Box([0.4, 0.1, 0.1]), 0.2, [1, 0, 0]),
            (gps.Sphere(0.3), 0.3, np.array([1, 0, 0, 0, 0, 0, 1])),
            (gps.Cylinder(radius=0.25, length=1.0), 0.25, ([1, 0, 0], [0, 0, 0, 1])),
            (gps.Cylinder(radius=0.05, length=1.0), 0.5, ([1, 0, 0], turned)),
        ):
            scene = gps.PlanningScene(rail())
            scene.add_object("obstacle", shape, pose)
            touching = 0.1 + extent
            self.assertEqual([True, False, False, False, True],
                             verdicts(scene, [1 - touching - 1e-6, 1 - touching + 1e-6, 1, 1 + touching - 1e-6,
                                              1 + touching + 1e-6]), str(shape))

    def test_planes_cones_and_meshes_are_solids(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("wall", gps.HalfSpace([1, 0, 0], -3.0))
        matrix = np.eye(4)
        matrix[:3, :3] = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]  # z becomes x
        matrix[0, 3] = 2.0
        scene.add_object("cone", gps.Cone(radius=0.2, length=1.0), matrix)
        scene.add_object("part", gps.Mesh(*TETRAHEDRON), pose=[5, -0.05, -0.05])
        self.assertEqual([False, True, False, True], verdicts(scene, [-2.9001, -2.8999, 2.5999, 2.6001]))
        self.assertEqual([True, False, False, True], verdicts(scene, [4.89, 4.91, 5.1, 5.4]))

    def test_a_mesh_has_inside_what_its_rule_says(self):
        for triangles, rule, kinds, free in (
            (TROUGH + SIDE, "auto", [], False), (TROUGH + SIDE, "surface", ["surface"], True),
            (TROUGH, "auto", ["surface"], True), (TROUGH, "surface", ["surface"], True),
            (TROUGH, "filled", ["filled"], False), (TROUGH + [SIDE[0]], "auto", ["filled"], False),
            (TROUGH + [SIDE[0], SIDE[1][::-1]], "auto", ["mended"], False),
        ):
            mesh = gps.Mesh(CUBE, triangles, name="bin.stl", solid=rule)
            scene = gps.PlanningScene(rail())
            scene.add_object("bin", mesh)
            what = f"{len(triangles)} triangles, {rule}"
            self.assertEqual(rule, scene.objects[0].shapes[0][0].solid)
            self.assertEqual([free, False], verdicts(scene, [0, -1]), what)  # the ball is inside, or on a side
            parts = scene.open_parts()
            self.assertEqual(kinds, [part["kind"] for part in parts], what)
            self.assertTrue(all((part["body"], part["mesh"]) == ("bin", "bin.stl") for part in parts))
        self.assert_one_line(gps.Error, "solid: 'full' is unknown; known are auto, surface and filled", gps.Mesh, CUBE,
                             TROUGH, solid="full")

    def test_an_object_has_several_shapes_each_with_a_pose(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("shelf", [gps.Sphere(0.1), (gps.Sphere(0.1), [2, 0, 0])], pose=[1, 0, 0])
        self.assertEqual([False, True, False], verdicts(scene, [1, 2, 3]))
        shapes = scene.objects[0].shapes
        self.assertEqual(2, len(shapes))
        np.testing.assert_array_equal([2, 0, 0], shapes[1][1][:3, 3])

    def test_objects_can_be_moved_and_removed(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("ball 2", gps.Sphere(0.1), [1, 0, 0])
        scene.allowed_collisions.set_entry("ball 2", "rail", True)
        scene.move_object("ball 2", [2, 0, 0])
        self.assertEqual([True, False], verdicts(scene, [1, 2]))
        scene.remove_object("ball 2")
        self.assertEqual([True, True], verdicts(scene, [1, 2]))
        self.assertNotIn("ball 2", scene.allowed_collisions.bodies)

    def test_arrays_of_a_mesh_may_have_other_types_and_layouts(self):
        vertices, triangles = np.array(TETRAHEDRON[0], np.float32), np.asfortranarray(np.array(TETRAHEDRON[1], np.uint8))
        mesh = gps.Mesh(vertices, triangles, name="wedge")
        np.testing.assert_array_equal(vertices, mesh.vertices)
        np.testing.assert_array_equal(TETRAHEDRON[1], mesh.triangles)
        self.assertEqual("wedge", mesh.name)

    def test_wrong_shapes_are_errors(self):
        for error, pattern, call, arguments in (
            (gps.Error, "box", gps.Box, ([1, 1, 0],)),
            (gps.Error, "size of a box: the shape is", gps.Box, ([1, 1],)),
            (gps.Error, "sphere", gps.Sphere, (-1.0,)),
            (TypeError, "expected a number, but got 'a'", gps.Sphere, ("a",)),
            (gps.Error, "cylinder", gps.Cylinder, (0.1, float("nan"))),
            (gps.Error, "cone", gps.Cone, (0.0, 1.0)),
            (gps.Error, "half-space", gps.HalfSpace, ([1, 1, 0], 0.0)),
            (gps.Error, "names vertex 4, but there are 4", gps.Mesh, (TETRAHEDRON[0], [[0, 1, 4]])),
            (gps.Error, "names vertex -1", gps.Mesh, (TETRAHEDRON[0], [[0, 1, -1]])),
            (gps.Error, "no triangle", gps.Mesh, (TETRAHEDRON[0], np.empty((0, 3), int))),
            (gps.Error, "not finite|nan", gps.Mesh, ([[0, 0, 0], [1, 0, 0], [0, np.nan, 0]], [[0, 1, 2]])),
            (gps.Error, "shapes", gps.Mesh, ([0, 0, 0], [[0, 1, 2]])),
            (TypeError, "whole numbers", gps.Mesh, (TETRAHEDRON[0], [[0.5, 1, 2]])),
            (gps.Error, "/none.stl", gps.Mesh.from_file, ("/none.stl",)),
        ):
            self.assert_one_line(error, pattern, call, *arguments)

    def test_wrong_objects_are_errors_that_change_nothing(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("box", gps.Box([1, 1, 1]))
        before = scene.body_names
        ball = gps.Sphere(0.1)
        flat = np.eye(4)
        flat[2, 2] = 0.0
        for error, pattern, arguments in (
            (gps.Error, "'box' cannot be added", ("box", ball)),
            (gps.Error, "'ball' cannot be added", ("ball", ball)),
            (gps.Error, "not empty", ("", ball)),
            (gps.Error, "octomap", ("<octomap>", ball)),
            (gps.Error, "'new' has no shapes", ("new", [])),
            (gps.Error, "object 'new': .*shape", ("new", ball, [1, 2])),
            (gps.Error, "object 'new': .*not a rotation", ("new", ball, flat)),
            (gps.Error, "object 'new': .*quaternion", ("new", ball, ([0, 0, 0], [0, 0, 0, 0]))),
            (gps.Error, "object 'new': .*not finite", ("new", ball, [np.nan, 0, 0])),
            (gps.Error, "last row", ("new", ball, np.ones((4, 4)))),
            (TypeError, "object 'new': a pose: expected an array", ("new", ball, "there")),
            (TypeError, "object 'new': expected a Box, Sphere", ("new", 0.1)),
            (gps.Error, "padding of 'new'", ("new", ball, None, -0.1)),
            (TypeError, "expected a str, but got 5", (5, ball)),
        ):
            self.assert_one_line(error, pattern, scene.add_object, *arguments)
        self.assert_one_line(gps.Error, "'cup'", scene.remove_object, "cup")
        self.assert_one_line(gps.Error, "'cup'", scene.move_object, "cup", [0, 0, 0])
        self.assert_one_line(TypeError, "expected a RobotModel, but got 'rail.urdf'", gps.PlanningScene, "rail.urdf")
        self.assertEqual(before, scene.body_names)

    def test_an_attached_object_moves_with_its_link_and_returns(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("tool", gps.Sphere(0.1), [1.5, 0, 0])
        scene.add_object("post", gps.Sphere(0.1), [4, 0, 0])
        scene.attach("tool", "ball", state=[1.0])  # half a metre before the ball
        self.assertEqual(["post"], [each.id for each in scene.objects])
        attached, = scene.attached
        self.assertEqual(("tool", "ball"), (attached.object.id, scene.robot.links[attached.link].name))
        np.testing.assert_allclose(attached.object.pose[:3, 3], [0.5, 0, 0])
        self.assertEqual([True, False, True], verdicts(scene, [3.2, 3.5, 3.75]))
        scene.detach("tool", state=[3.0])
        np.testing.assert_allclose(scene.objects[-1].pose[:3, 3], [3.5, 0, 0])
        self.assertEqual([False, True], verdicts(scene, [3.5, 3.75]))

    def test_touch_links_may_touch_an_attached_object(self):
        scene = arm_scene()
        links = [link.name for link in scene.robot.links if link.shapes]
        scene.add_object("tool", gps.Sphere(0.3), scene.frame(links[-1]))
        scene.attach("tool", links[-1])
        self.assertEqual(0, gps.StateChecker(scene, device="cpu").check(scene.current_state).valid.sum())
        scene.detach("tool")
        scene.attach("tool", links[-1], touch_links=links)
        for each in scene.objects:
            scene.allowed_collisions.set_entry("tool", each.id, True)
        self.assertEqual(1, gps.StateChecker(scene, device="cpu").check(scene.current_state).valid.sum())

    def test_wrong_attachments_are_errors(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("tool", gps.Sphere(0.1))
        scene.add_object("floor", gps.HalfSpace([0, 0, 1], -1.0))
        self.assert_one_line(gps.Error, "no current_state", scene.attach, "tool", "ball")
        scene.current_state = [0.0]
        self.assert_one_line(gps.Error, "'cup'", scene.attach, "cup", "ball")
        self.assert_one_line(gps.Error, "'nose'", scene.attach, "tool", "nose")
        self.assert_one_line(gps.Error, "'nose'", scene.attach, "tool", "ball", ["nose"])
        self.assert_one_line(TypeError, "expected a list of str", scene.attach, "tool", "ball", "ball")
        self.assert_one_line(gps.Error, "half-space", scene.attach, "floor", "ball")
        self.assert_one_line(gps.Error, "'tool'", scene.detach, "tool")
        self.assert_one_line(gps.Error, "state: the shape", scene.attach, "tool", "ball", state=[0.0, 1.0])
        self.assertEqual([], scene.attached)

    def test_padding_is_a_distance(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("post", gps.Sphere(0.1), [1, 0, 0], padding=0.05)
        scene.set_padding("ball", 0.02)
        self.assertEqual([True, False], verdicts(scene, [1 - 0.2701, 1 - 0.2699]))
        self.assertEqual((0.05, 0.02, 0.0), tuple(scene.padding(body) for body in ("post", "ball", "rail")))
        scene.set_padding("post", 0.0)
        self.assertEqual([True, False], verdicts(scene, [1 - 0.2201, 1 - 0.2199]))
        scene.attach("post", "ball", state=[0.7])
        scene.set_padding("post", 0.3)
        self.assertEqual(0.3, scene.padding("post"))
        self.assert_one_line(gps.Error, "'nose'", scene.set_padding, "nose", 0.1)
        self.assert_one_line(gps.Error, "'nose'", scene.padding, "nose")
        self.assert_one_line(gps.Error, "padding of 'ball'", scene.set_padding, "ball", float("nan"))

    def test_allowed_pairs_are_not_checked(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("post", gps.Sphere(0.1))
        self.assertEqual([False], verdicts(scene, [0]))
        scene.allowed_collisions.set_entry("post", "ball", True)
        self.assertEqual([True], verdicts(scene, [0]))
        self.assertTrue(scene.allowed_collisions.allowed("ball", "post"))
        self.assertEqual(["ball"], scene.allowed_collisions.allowed_partners("post"))
        matrix = gps.AllowedCollisionMatrix.from_robot(scene.robot)
        self.assertNotEqual(matrix, scene.allowed_collisions)
        scene.allowed_collisions = matrix
        self.assertEqual(matrix, scene.allowed_collisions)
        self.assertEqual([False], verdicts(scene, [0]))
        scene.allowed_collisions.set_default("post", True)
        self.assertEqual(True, scene.allowed_collisions.default_of("post"))
        self.assertIsNone(scene.allowed_collisions.default_of("ball"))
        self.assertEqual([True], verdicts(scene, [0]))
        for call, arguments in ((scene.allowed_collisions.set_entry, ("post", "ball", "yes")),
                                (scene.allowed_collisions.set_default, ("post", None))):
            self.assert_one_line(TypeError, "expected True or False", call, *arguments)
        scene.allowed_collisions.remove_entry("post")
        self.assertEqual([False], verdicts(scene, [0]))

    def test_a_matrix_outlives_its_scene(self):
        matrix = gps.PlanningScene(rail()).allowed_collisions
        matrix.set_entry("a", "b", True)
        self.assertTrue(matrix.allowed("b", "a"))

    def test_a_copy_is_independent(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("post", gps.Mesh(*TETRAHEDRON))
        for twin in (scene.copy(), copy.copy(scene)):
            twin.move_object("post", [1, 0, 0])
            twin.allowed_collisions.set_default("post", True)
            np.testing.assert_array_equal([0, 0, 0], scene.objects[0].pose[:3, 3])
            self.assertNotIn("post", scene.allowed_collisions.bodies)

    def test_bodies_are_numbered_links_first(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("post", gps.Sphere(0.1))
        self.assertEqual(["rail", "ball", "post"], scene.body_names)
        self.assertEqual("post", scene.body_name(2))
        for index in (-1, 3, 2**40):
            self.assert_one_line(gps.Error, "the scene has 3 bodies", scene.body_name, index)
        self.assert_one_line(TypeError, "whole number", scene.body_name, "post")

    def test_frames_have_poses(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("post", gps.Sphere(0.1), [1, 2, 3])
        np.testing.assert_array_equal([1, 2, 3], scene.frame("post")[:3, 3])
        np.testing.assert_array_equal([0.7, 0, 0], scene.frame("ball", [0.7])[:3, 3])
        self.assert_one_line(gps.Error, "no frame 'nose'", scene.frame, "nose")
        self.assert_one_line(gps.Error, "ball|state", scene.frame, "ball")

    def test_the_current_state_can_be_set_and_removed(self):
        scene = gps.PlanningScene(rail())
        self.assertIsNone(scene.current_state)
        scene.current_state = np.array([0.5])
        np.testing.assert_array_equal([0.5], scene.current_state)
        self.assert_one_line(gps.Error, "current_state: the shape", setattr, scene, "current_state", [1, 2])
        scene.current_state = None
        self.assertIsNone(scene.current_state)

    def test_the_current_state_can_be_a_state_of_the_srdf(self):
        scene = arm_scene()
        scene.current_state = [1, 1, 1, 1, 1, 1, 0.02]
        scene.current_state = "extended"
        np.testing.assert_array_equal([-0.6, 0.2, 0.3, 0, 0.3, 0, 0.02], scene.current_state)
        palm = scene.frame("palm")
        np.testing.assert_array_equal(palm, scene.frame("palm", "arm/extended"))
        self.assertFalse(np.array_equal(palm, scene.frame("palm", "ready")))
        scene.current_state = None
        self.assert_one_line(gps.Error, "^current_state: the state 'ready' of the SRDF has no value for grip; set "
                             "current_state of the scene, or give numbers", setattr, scene, "current_state", "ready")
        self.assertIsNone(scene.current_state)


if __name__ == "__main__":
    unittest.main()
