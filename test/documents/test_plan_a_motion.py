"""The example plan_a_motion plans for any group of any robot, between values and named states."""
import contextlib
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest


@contextlib.contextmanager
def mixed_chain():
    """A URDF and an SRDF: a chain of seven joints, of which the odd ones are continuous and the others have limits."""
    urdf = '<robot name="chain"><link name="link_0"/>'
    for i in range(1, 8):
        urdf += (f'<link name="link_{i}"/><joint name="joint_{i}" type="{"continuous" if i % 2 else "revolute"}">'
                 f'<parent link="link_{i - 1}"/><child link="link_{i}"/><origin xyz="0 0 0.2"/>'
                 '<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>')
    with tempfile.TemporaryDirectory() as folder:
        paths = [pathlib.Path(folder, name) for name in ("chain.urdf", "chain.srdf")]
        paths[0].write_text(urdf + "</robot>", encoding="utf-8")
        paths[1].write_text('<robot name="chain"><group name="arm"><chain base_link="link_0" tip_link="link_7"/></group>'
                            '</robot>', encoding="utf-8")
        yield [str(path) for path in paths]


class PlanAMotion(unittest.TestCase):
    def plan(self, urdf, srdf, *arguments, path=""):
        return subprocess.run(
            [PROGRAM, urdf, srdf, *arguments], capture_output=True, text=True, timeout=100, check=False,
            env={"PATH": "/usr/bin:/bin", "ASAN_OPTIONS": "detect_leaks=0", "ROS_PACKAGE_PATH": str(path)},
        )

    def slider(self, *arguments):
        return self.plan(f"{SOURCE}/test/scene/slider.urdf", f"{SOURCE}/test/scene/slider.srdf", *arguments)

    def rows(self, answer):
        self.assertEqual(answer.returncode, 0, answer.stderr)
        lines = [line.split() for line in answer.stdout.splitlines() if line.strip()]
        return [[float(word) for word in line] for line in lines[1:]]  # the first line has the names

    def test_plans_between_values(self):
        answer = self.slider("drive", "-1,0.5", "1,-0.5")
        rows = self.rows(answer)
        self.assertEqual("slide turn", answer.stdout.splitlines()[0])
        self.assertEqual((rows[0], rows[-1]), ([-1.0, 0.5], [1.0, -0.5]))

    def test_plans_between_named_states(self):
        rows = self.rows(self.slider("drive", "left", "drive/right"))
        self.assertEqual((rows[0], rows[-1]), ([-1.0, 0.8], [1.0, 0.8]))

    def test_a_goal_inside_an_object_of_the_scene_is_not_reached(self):
        for name, start, goal in (("goal", "0,0", "1,0"), ("start", "1,0", "0,0")):
            answer = self.slider("drive", start, goal, f"{SOURCE}/test/node/wall_scene.yaml")
            self.assertEqual(answer.returncode, 1)
            self.assertRegex(answer.stderr,
                             rf"^plan_a_motion: the {name} is in collision: (cart and wall|wall and cart)\n$")

    def test_a_state_outside_the_joint_limits_is_named_with_the_limits(self):
        answer = self.slider("drive", "0,0", "90,0")
        self.assertEqual(answer.returncode, 1)
        self.assertRegex(answer.stderr, r"^plan_a_motion: the goal is outside the joint limits: slide is 90.0+, from -")

    def test_a_wrong_number_of_values_is_named_with_the_variables(self):
        answer = self.slider("drive", "-1", "1,0")
        self.assertEqual(answer.returncode, 1)
        self.assertEqual(
            answer.stderr, "plan_a_motion: '-1' has 1 value; the group plans for slide,turn, in this order\n"
        )

    def test_values_are_in_the_order_of_the_robot_also_where_joints_without_limits_are_between_others(self):
        start = "0.5,0.26,-0.4,0.3,0.2,-0.1,0.7"
        goal = "0.6,0.3,-0.5,0.2,0.1,0.1,0.8"
        with mixed_chain() as (urdf, srdf):
            plain = self.plan(urdf, srdf, "arm", start, goal)
            by_name = self.plan(urdf, srdf, "arm", *(",".join(reversed([
                f"joint_{i}={value}" for i, value in enumerate(text.split(","), 1)])) for text in (start, goal)))
        for answer in (plain, by_name):
            rows = self.rows(answer)
            self.assertEqual(" ".join(f"joint_{i}" for i in range(1, 8)), answer.stdout.splitlines()[0])
            for row, text in ((rows[0], start), (rows[-1], goal)):
                for value, expected in zip(row, text.split(",")):
                    self.assertAlmostEqual(float(expected), value, 5)

    def test_variables_without_a_name_keep_their_values(self):
        with mixed_chain() as (urdf, srdf):
            rows = self.rows(self.plan(urdf, srdf, "arm", "joint_2=0.25", "joint_3=0.5"))
        self.assertEqual([0.0, 0.25, 0.0, 0.0, 0.0, 0.0, 0.0], rows[0])
        self.assertEqual([0.0, 0.25, 0.5, 0.0, 0.0, 0.0, 0.0], rows[-1])

    def test_ambiguous_values_are_refused(self):
        for start, fault in (
            ("slide=1,0.5", "'slide=1,0.5': give a name for each value or for none"),
            ("slide=1,slide=2", "'slide=1,slide=2': 'slide' is given twice"),
            ("slied=1", "'slied=1': the group does not plan for a variable 'slied'; its variables are slide,turn"),
            ("slide=", "'slide=': '' is not a number"),
            ("1,0.5e", "'1,0.5e': '0.5e' is not a number"),
            ("1,", "'1,' has 1 value; the group plans for slide,turn, in this order"),
            ("1,2,3", "'1,2,3' has 3 values; the group plans for slide,turn, in this order"),
        ):
            answer = self.slider("drive", start, "1,0")
            self.assertEqual((1, f"plan_a_motion: {fault}\n"), (answer.returncode, answer.stderr))

    def test_plans_between_the_states_of_the_demos_arm(self):
        arm = f"{SOURCE}/config/demo/arm"
        answer = self.plan(f"{arm}.urdf", f"{arm}.srdf", "arm", "ready", "extended", f"{arm}_scene.yaml")
        rows = self.rows(answer)
        self.assertEqual((rows[0][0], rows[-1][0]), (0.0, -0.6))

    def test_a_missing_package_is_named_with_what_the_user_can_do(self):
        with tempfile.NamedTemporaryFile("w", suffix=".urdf") as urdf:
            urdf.write('<robot name="slider"><link name="rail"><collision><geometry>'
                       '<mesh filename="package://crane/rail.stl"/></geometry></collision></link></robot>')
            urdf.flush()
            answer = self.plan(urdf.name, f"{SOURCE}/test/scene/slider.srdf", "drive", "left", "right")
        self.assertEqual(answer.returncode, 1)
        self.assertIn("--package crane=FOLDER", answer.stderr)
        self.assertIn("ROS_PACKAGE_PATH", answer.stderr)

    def test_a_package_can_be_given(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nf 1 2 3\n"
            pathlib.Path(folder, "cart.obj").write_text(mesh, encoding="utf-8")
            urdf = pathlib.Path(SOURCE, "test", "scene", "slider.urdf").read_text(encoding="utf-8")
            shape = '<mesh filename="package://crane/cart.obj"/>'
            urdf = re.sub(r"<geometry>.*?</geometry>", f"<geometry>{shape}</geometry>", urdf, count=1)
            self.assertIn(shape, urdf)
            path = pathlib.Path(folder, "slider.urdf")
            path.write_text(urdf, encoding="utf-8")
            srdf = f"{SOURCE}/test/scene/slider.srdf"
            rows = self.rows(self.plan("--package", f"crane={folder}", str(path), srdf, "drive", "left", "right"))
            self.assertEqual((rows[0][0], rows[-1][0]), (-1.0, 1.0))
            answer = self.plan("--package", "crane", str(path), srdf, "drive", "left", "right")
            self.assertEqual("plan_a_motion: --package: 'crane' is not NAME=FOLDER\n", answer.stderr)

    def test_plans_for_the_seven_joints_of_panda(self):
        resources = pathlib.Path(SHARED) / "moveit" / "resources"
        urdf = resources / "panda_description" / "urdf" / "panda.urdf"
        if not urdf.exists():
            self.skipTest("MoveIt's panda is not here")
        srdf = resources / "panda_moveit_config" / "config" / "panda.srdf"
        goal = "0.3,-0.785,0,-2.356,0,1.571,0.785"
        rows = self.rows(self.plan(str(urdf), str(srdf), "panda_arm", "ready", goal, path=resources))
        self.assertEqual(len(rows[0]), 7)
        self.assertAlmostEqual(rows[0][3], -2.356, places=3)
        self.assertAlmostEqual(rows[-1][0], 0.3, places=3)


if __name__ == "__main__":
    PROGRAM, SOURCE, SHARED = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
