"""RobotModel: files and texts, packages, names, forward kinematics, random states."""
import contextlib
import io
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np

import gpu_planning_scene as gps
from gpu_planning_scene.bulk import RobotBundle
from robots import ARM, EXPAND, RAIL, RAIL_SRDF, RAIL_XACRO, Case, arm, kr5, rail, xacro

MESH = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nf 1 2 3\n"
WITH_MESH = ('<robot name="part"><link name="part"><collision><geometry><mesh filename="{}"/></geometry></collision>'
             '</link></robot>')


def poses_by_numpy(robot, state):
    """The poses of the links, from the joints' origins and axes, with Rodrigues' formula."""
    poses = {robot.joints[0].parent_link: np.eye(4)} if robot.joints else {}
    poses[0] = np.eye(4)
    for joint in robot.joints:
        motion = np.eye(4)
        if joint.type in (gps.JointType.REVOLUTE, gps.JointType.CONTINUOUS):
            x, y, z = joint.axis
            cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            angle = state[joint.first_variable]
            motion[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
        elif joint.type == gps.JointType.PRISMATIC:
            motion[:3, 3] = joint.axis * state[joint.first_variable]
        poses[joint.child_link] = poses[joint.parent_link] @ joint.origin @ motion
    return np.array([poses[i] for i in range(len(robot.links))])


class RobotModel(Case):
    def test_a_robot_from_text_is_the_robot_from_the_file(self):
        a, b = arm(), gps.RobotModel.from_xml(ARM.read_text(), ARM.with_suffix(".srdf").read_text())
        self.assertEqual(a.variable_names, b.variable_names)
        self.assertEqual([link.name for link in a.links], [link.name for link in b.links])
        self.assertEqual([group.name for group in a.groups], [group.name for group in b.groups])
        self.assertTrue(a.groups)

    def test_a_robot_needs_no_srdf(self):
        self.assertEqual([], gps.RobotModel.from_files(str(ARM)).groups)
        self.assertEqual([], gps.RobotModel.from_files(ARM, None).groups)

    def test_the_limits_of_a_planning_file_replace_those_of_the_urdf(self):
        text = "joint_limits: {shoulder: {min_position: 0.25, max_position: 0.5}}"
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "limits.yaml")
            path.write_text(text, encoding="utf-8")
            robots = {str(path): gps.RobotModel.from_files(ARM, planning=path),
                      "planning": gps.RobotModel.from_xml(ARM.read_text(), planning=text)}
            bundle = RobotBundle.from_files(ARM, planning=path)
        robots["planning, in a bundle"] = bundle.load()
        self.assertNotEqual(bundle.digest, RobotBundle.from_files(ARM).digest)
        for source, robot in robots.items():
            shoulder = robot.variables[robot.variable_index("shoulder")]
            self.assertEqual((0.25, 0.5, source.split(",")[0]),
                             (shoulder.lower, shoulder.upper, shoulder.limits_source))
            states = robot.random_states(100, seed=1)[:, robot.variable_index("shoulder")]
            self.assertTrue(((states >= 0.25) & (states <= 0.5)).all())
            self.assertEqual("", robot.variables[robot.variable_index("elbow")].limits_source)
        self.assert_one_line(gps.Error, "planning:1: 'shoulder': unknown key 'max_positon'; did you mean "
                             "'max_position'?", gps.RobotModel.from_xml, ARM.read_text(),
                             planning=text.replace("max_position", "max_positon"))
        with self.assertWarnsRegex(UserWarning, "the robot does not have the joint: shulder"):
            gps.RobotModel.from_xml(ARM.read_text(), planning=text.replace("shoulder", "shulder"))

    def test_indices_and_names_agree(self):
        robot = arm()
        for i, name in enumerate(robot.variable_names):
            self.assertEqual(i, robot.variable_index(name))
        for i, link in enumerate(robot.links):
            self.assertEqual(i, robot.link_index(link.name))
        for i, joint in enumerate(robot.joints):
            self.assertEqual(i, robot.joint_index(joint.name))

    def test_an_unknown_name_is_an_error(self):
        robot = arm()
        for call in (robot.link_index, robot.joint_index, robot.variable_index, robot.group, robot.named_state):
            self.assert_one_line(gps.Error, "'nose'", call, "nose")
            self.assert_one_line(TypeError, r"expected a str, but got 5 \(int\)", call, 5)
        for call, parts in ((robot.link_index, robot.links), (robot.joint_index, robot.joints),
                            (robot.variable_index, robot.variables)):
            self.assert_one_line(gps.Error, "there are: " + ", ".join(part.name for part in parts), call, "nose")

    def test_a_named_state_has_its_values(self):
        robot = arm()
        ready = robot.named_state("ready")
        self.assertEqual(len(ready.variables), len(ready.values))
        self.assertGreater(len(ready.values), 3)

    def test_poses_are_those_of_the_joints_of_the_urdf(self):
        robot = kr5()
        states = robot.random_states(50, seed=3)
        poses = robot.link_poses(states)
        self.assertEqual((50, len(robot.links), 4, 4), poses.shape)
        for state, found in zip(states, poses):
            np.testing.assert_allclose(found, poses_by_numpy(robot, state), atol=1e-12)
        np.testing.assert_array_equal(poses[7], robot.link_poses(states[7]))

    def test_poses_of_states_in_other_layouts_are_the_same(self):
        robot = kr5()
        states = robot.random_states(20, seed=4)
        poses = robot.link_poses(states)
        np.testing.assert_array_equal(poses, robot.link_poses(np.asfortranarray(states)))
        np.testing.assert_array_equal(poses, robot.link_poses(states.tolist()))
        np.testing.assert_array_equal(poses[::2], robot.link_poses(states[::2]))
        self.assertEqual((0, len(robot.links), 4, 4), robot.link_poses(np.empty((0, 6))).shape)

    def test_random_states_are_within_the_limits_and_repeat_with_the_seed(self):
        robot = kr5()
        states = robot.random_states(2000, seed=5)
        lower = np.array([variable.lower for variable in robot.variables])
        upper = np.array([variable.upper for variable in robot.variables])
        self.assertTrue(np.all(states >= lower) and np.all(states <= upper))
        self.assertTrue(np.all(np.abs(states.mean(axis=0) - (lower + upper) / 2) < 0.05 * (upper - lower)))
        np.testing.assert_array_equal(states, robot.random_states(2000, 5))
        self.assertFalse(np.any(states == robot.random_states(2000, seed=6)))

    def test_random_states_can_be_drawn_into_an_array(self):
        robot = kr5()
        rows = np.full((7, len(robot.variables)), np.nan)
        self.assertIs(rows[1:5].base, robot.random_states(4, seed=5, out=rows[1:5]).base)
        np.testing.assert_array_equal(robot.random_states(4, seed=5), rows[1:5])
        self.assertTrue(np.isnan(rows[[0, 5, 6]]).all())
        read_only = np.zeros(rows.shape)
        read_only.flags.writeable = False
        for out in (rows.astype(np.float32), np.asfortranarray(rows), rows.tolist(), read_only):
            self.assert_one_line(TypeError, "a writable array of float64 in C order for out", robot.random_states, 7, 1,
                                 None, out)
        self.assert_one_line(gps.Error, r"out: the shape is \(7, 6\); it must be \(3, 6\)", robot.random_states, 3, 1,
                             None, rows)

    def test_the_base_of_random_states_stands_still_unless_it_is_to_move(self):
        srdf = ('<robot name="rail"><virtual_joint name="world" type="planar" parent_frame="map" child_link="rail"/>'
                "</robot>")
        robot = gps.RobotModel.from_xml(RAIL, srdf)
        base = robot.default_state()
        base[:3] = [1.0, 2.0, 0.5]
        states = robot.random_states(10, seed=1, base=base)
        np.testing.assert_array_equal(states[:, :3], np.tile(base[:3], (10, 1)))
        default = robot.default_state()
        np.testing.assert_array_equal(robot.random_states(10, seed=1)[:, :3], np.tile(default[:3], (10, 1)))
        self.assertTrue(np.all(robot.random_states(10, seed=1, moves_base=True)[:, 0] != default[0]))
        self.assert_one_line(gps.Error, "base is given and moves_base is True", robot.random_states, 10, 1, base, None,
                             True)

    def test_a_wrong_shape_of_states_names_the_variables(self):
        robot = rail()
        for states in (np.zeros((3, 2)), np.zeros(2), np.zeros((1, 1, 1)), 5.0):
            self.assert_one_line(gps.Error, r"^states: the shape is .*must be \(n, 1\) or \(1,\).*slide",
                                 robot.link_poses, states)
        for states in (None, [["a"]], np.zeros((2, 1), dtype=complex), object()):
            self.assert_one_line(TypeError, "^states: expected an array of numbers, but got", robot.link_poses, states)

    def test_wrong_files_are_errors_that_name_them(self):
        self.assert_one_line(gps.Error, "URDF /none.urdf: cannot read the file: No such file", gps.RobotModel.from_files, "/none.urdf")
        self.assert_one_line(gps.Error, "urdf", gps.RobotModel.from_xml, "<robot")
        self.assert_one_line(TypeError, "urdf: expected a str or a path", gps.RobotModel.from_files, 5)

    def test_a_xacro_file_is_expanded_where_xacro_is_installed(self):
        with tempfile.TemporaryDirectory() as folder:
            urdf = pathlib.Path(folder, "rail.urdf.xacro")
            urdf.write_text(RAIL_XACRO, encoding="utf-8")
            with xacro(EXPAND) as program, contextlib.redirect_stderr(io.StringIO()) as printed:
                robot = gps.RobotModel.from_files(urdf)
            self.assertEqual(0.1, robot.links[1].shapes[0][0].radius)
            self.assertEqual(f"URDF '{urdf}' is a xacro file: it was expanded with its default arguments by {program}\n", printed.getvalue())
            with xacro("echo no such property >&2; exit 2"):
                self.assert_one_line(gps.Error, "failed with exit code 2: no such property", gps.RobotModel.from_files,
                                     urdf)
            with xacro(EXPAND):
                self.assert_one_line(gps.Error, "is xacro, which must be expanded first", gps.RobotModel.from_xml,
                                     RAIL_XACRO)

    def test_xacro_finds_the_packages_of_the_call(self):
        find = "for f in $(echo $ROS_PACKAGE_PATH | tr ':' ' '); do cat $f/rail.xml 2> /dev/null; done; true"
        with tempfile.TemporaryDirectory() as folder:
            urdf = pathlib.Path(folder, "rail.urdf.xacro")
            urdf.write_text(RAIL_XACRO, encoding="utf-8")
            pathlib.Path(folder, "rail.xml").write_text(RAIL, encoding="utf-8")
            with xacro(find), contextlib.redirect_stderr(io.StringIO()):
                robot = gps.RobotModel.from_files(urdf, packages={"my_rail": folder})
        self.assertEqual("rail", robot.name)

    def test_a_file_in_iso_8859_1_is_read(self):
        for declaration in ("", '<?xml version="1.0" encoding="ISO-8859-1"?>'):
            with tempfile.TemporaryDirectory() as folder:
                urdf = pathlib.Path(folder, "rail.urdf")
                urdf.write_bytes((declaration + RAIL.replace("ball", "Kugel für é")).encode("latin-1"))
                robot = gps.RobotModel.from_files(urdf)
                self.assertEqual("Kugel für é", robot.links[1].name)
                self.assertEqual("Kugel für é", RobotBundle.from_files(urdf).load().links[1].name)

    def test_messages_need_not_be_utf_8(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.fsdecode(os.path.join(os.fsencode(folder), b"\xe9.urdf"))
            self.assert_one_line(gps.Error, "URDF .*/é.urdf: cannot read the file", gps.RobotModel.from_files, path)
            planning = pathlib.Path(folder, "limits.yaml")
            planning.write_bytes("joint_limits: {é: {max_position: 1}}".encode("latin-1"))
            with self.assertWarnsRegex(UserWarning, "the robot does not have the joint: é"):
                gps.RobotModel.from_files(ARM, planning=planning)

    def test_a_named_state_has_poses_if_it_sets_all_variables(self):
        robot = arm()
        self.assert_one_line(gps.Error, "^states: the state 'ready' of the SRDF has no value for grip; give numbers",
                             robot.link_poses, "ready")
        srdf = RAIL_SRDF.replace("</robot>", '<group_state name="far" group="all"><joint name="slide" value="2"/>'
                                 "</group_state></robot>")
        robot = gps.RobotModel.from_xml(RAIL, srdf)
        np.testing.assert_array_equal(robot.link_poses([2.0]), robot.link_poses("far"))
        np.testing.assert_array_equal(robot.link_poses([[2.0], [2.0]]), robot.link_poses(("far", "all/far")))

    def test_harmless_faults_are_warnings(self):
        srdf = '<robot name="rail"><disable_collisions link1="nose" link2="ball"/></robot>'
        with self.assertWarnsRegex(UserWarning, "nose"):
            gps.RobotModel.from_xml(RAIL, srdf)

    def test_packages_are_folders_by_name_or_a_function(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "part.obj").write_text(MESH, encoding="utf-8")
            text = WITH_MESH.format("package://crane/part.obj")
            asked = []

            def find(name):
                asked.append(name)
                return pathlib.Path(folder)

            for packages in ({"crane": folder}, {"crane": pathlib.Path(folder)}, find):
                robot = gps.RobotModel.from_xml(text, packages=packages)
                (mesh, pose), = robot.links[0].shapes
                self.assertEqual((1, 3), mesh.triangles.shape)
                np.testing.assert_array_equal(np.eye(4), pose)
            self.assertEqual({"crane"}, set(asked))
            load = gps.RobotModel.from_xml
            relative = WITH_MESH.format("part.obj")
            self.assertEqual(3, len(load(relative, urdf_folder=folder).links[0].shapes[0][0].vertices))
            self.assert_one_line(gps.Error, "part.obj", load, relative)
            self.assert_one_line(gps.Error, "crane.*in the argument packages", load, text)
            self.assert_one_line(gps.Error, "crane.*not known", load, text, packages=lambda name: None)
            self.assert_one_line(TypeError, "a dict or a function", load, text, packages=[folder])
            self.assert_one_line(TypeError, "a package: expected a str or a path", load, text, packages={"crane": 5})

    def test_a_function_finds_files_before_the_rules(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh, other = pathlib.Path(folder, "part.obj"), pathlib.Path(folder, "other.obj")
            mesh.write_text(MESH)
            other.write_text(MESH.replace("0.1", "0.7"))
            text = WITH_MESH.format("package://crane/part.obj")
            asked = []
            robot = gps.RobotModel.from_xml(text, files=lambda uri: asked.append(uri) or mesh)
            self.assertEqual((["package://crane/part.obj"], 1), (asked, len(robot.links[0].shapes)))
            self.assert_one_line(gps.Error, "crane", gps.RobotModel.from_xml, text, files=lambda uri: None)
            urdf = pathlib.Path(folder, "robot.urdf")
            urdf.write_text(WITH_MESH.format("part.obj"))
            for files, size in ((None, 0.1), (lambda uri: None, 0.1), (lambda uri: other, 0.7)):
                shape, _ = gps.RobotModel.from_files(urdf, files=files).links[0].shapes[0]
                self.assertAlmostEqual(size, shape.vertices.max(), places=6)
            text = "world: {collision_objects: [{id: x, meshes: [{resource: x.obj}]}]}"
            scene = gps.load_scene_text(text, robot, files=lambda uri: other)
            self.assertAlmostEqual(0.7, scene.objects[0].shapes[0][0].vertices.max(), places=6)
            path = pathlib.Path(folder, "scene.yaml")
            path.write_text(text)
            scene = gps.load_scene_file(path, robot, files=lambda uri: other)
            self.assertAlmostEqual(0.7, scene.objects[0].shapes[0][0].vertices.max(), places=6)
        self.assert_one_line(TypeError, "^files: expected a function", gps.RobotModel.from_xml, text, files={})
        self.assert_one_line(TypeError, "the path of a file: expected a str or a path", gps.load_scene_text, text, robot,
                             files=lambda uri: 5)

    def test_uris_are_resolved_as_the_loaders_do(self):
        with tempfile.TemporaryDirectory() as folder:
            for uri, expected in (("package://crane/a%20b.obj", f"{folder}/a b.obj"), ("a.obj", f"{folder}/a.obj"),
                                  ("file:///x/a.obj", "/x/a.obj"), ("/x/a.obj", "/x/a.obj")):
                self.assertEqual(expected, gps.resolve_uri(uri, folder, {"crane": folder}))
        self.assert_one_line(gps.Error, "crane.*in the argument packages", gps.resolve_uri, "package://crane/a.obj")
        self.assert_one_line(gps.Error, "is relative", gps.resolve_uri, "a.obj")

    def test_an_exception_of_the_function_for_packages_reaches_the_caller(self):
        def fail(name):
            raise LookupError("no " + name)

        with self.assertRaisesRegex(LookupError, "no crane"):
            gps.RobotModel.from_xml(WITH_MESH.format("package://crane/part.obj"), packages=fail)

    def test_links_have_rules_for_their_solids(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "part.obj")
            path.write_text(MESH, encoding="utf-8")
            robot = gps.RobotModel.from_xml(WITH_MESH.format(path))
            self.assertEqual("filled", gps.Mesh.from_file(path, solid="filled").solid)
        link = robot.links[0].name
        filled = robot.with_solids({link: "filled"})
        self.assertEqual(["auto", "filled"], [model.links[0].shapes[0][0].solid for model in (robot, filled)])
        self.assert_one_line(gps.Error, "solid of link 'nose': the robot has no such link", robot.with_solids,
                             {"nose": "filled"})
        self.assert_one_line(gps.Error, "'full' is unknown; known are auto, surface and filled", robot.with_solids,
                             {link: "full"})

    def test_mesh_files_are_read_in_another_process(self):
        """Another process does not have the files that are open here, so it cannot follow this link."""
        with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile(mode="w+") as file:
            file.write(MESH)
            file.flush()
            path = pathlib.Path(folder, "part.obj")
            path.symlink_to(f"/proc/self/fd/{file.fileno()}")
            self.assertEqual(path.read_text(encoding="utf-8"), MESH)
            self.assert_one_line(gps.Error, "does not exist", gps.Mesh.from_file, path)
            self.assert_one_line(gps.Error, "does not exist", gps.RobotModel.from_xml, WITH_MESH.format(path))

    def test_arrays_of_a_mesh_keep_its_memory(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "part.obj")
            path.write_text(MESH, encoding="utf-8")
            vertices = gps.Mesh.from_file(path, scale=2.0).vertices
        np.testing.assert_allclose(vertices[1], [0.2, 0, 0])
        with self.assertRaises(ValueError):
            vertices[0, 0] = 1.0
        alone = np.zeros(3)  # the count depends on the version of Python
        self.assertEqual(sys.getrefcount(alone), sys.getrefcount(vertices))


if __name__ == "__main__":
    unittest.main()
