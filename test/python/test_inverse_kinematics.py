"""solve_ik: states in which a frame has a wanted pose."""
import unittest

import numpy as np

import gpu_planning_scene as gps
from robots import ARM, Case, arm_scene

GROUP = "arm"
TIP = "palm"


def poses_in(scene, states, link=TIP):
    """The poses of a link, shape (n, 4, 4)."""
    return scene.robot.link_poses(states)[:, scene.robot.link_index(link)]


def angle_between(first, second):
    """The angles between rotations, from the norm of the difference: exact also for small angles."""
    difference = np.linalg.norm(first[..., :3, :3] - second[..., :3, :3], axis=(-2, -1))
    return 2.0 * np.arcsin(np.clip(difference / np.sqrt(8.0), 0.0, 1.0))


class Poses(Case):
    def setUp(self):
        self.scene = arm_scene()
        self.checker = gps.StateChecker(self.scene, device="cpu")
        self.robot = self.scene.robot
        self.base = self.scene.current_state

    def free_states(self, count, seed=1):
        """Random states of the arm that are free. The gripper is as in the current state."""
        states = self.robot.random_states(20 * count, seed=seed)
        grip = self.robot.variable_index("grip")
        states[:, grip] = self.base[grip]
        return states[self.checker.check(states, GROUP).valid][:count]

    def assert_reached(self, result, pose, tolerances=(1e-6, 1e-6)):
        """All states of the result have the pose, keep the limits and are free."""
        self.assertEqual((gps.IkStatus.SOLVED, ""), (result.status, result.message))
        self.assertEqual((len(result.distances), len(self.robot.variables)), result.states.shape)
        reached = poses_in(self.scene, result.states)
        distances = np.linalg.norm(reached[:, :3, 3] - pose[:3, 3], axis=1)
        self.assertLessEqual(distances.max(), tolerances[0] + 1e-12)
        self.assertLessEqual(angle_between(reached, pose).max(), tolerances[1] + 1e-9)
        for values, variable in zip(result.states.T, self.robot.variables):
            self.assertTrue((values >= variable.lower).all() and (values <= variable.upper).all(), variable.name)
        self.assertTrue(self.checker.check(result.states, GROUP).valid.all())
        grip = self.robot.variable_index("grip")  # not of the group
        np.testing.assert_array_equal(self.base[grip], result.states[:, grip])

    def test_poses_of_free_states_are_reached_within_the_limits_and_without_collision(self):
        poses = poses_in(self.scene, self.free_states(200))
        self.assertEqual(200, len(poses))
        results = gps.solve_ik(self.checker, GROUP, poses)
        self.assertEqual((list, 200), (type(results), len(results)))
        for result, pose in zip(results, poses):
            self.assertEqual(1, len(result.states))
            self.assert_reached(result, pose)

    def test_one_pose_gives_one_result_and_a_batch_a_list(self):
        poses = poses_in(self.scene, self.free_states(2))
        one = gps.solve_ik(self.checker, GROUP, poses[0])
        self.assertIsInstance(one, gps.IkResult)
        self.assert_reached(one, poses[0])
        batch = gps.solve_ik(self.checker, GROUP, poses[:1])
        self.assertEqual(1, len(batch))
        np.testing.assert_array_equal(one.states, batch[0].states)
        self.assertEqual([], gps.solve_ik(self.checker, GROUP, poses[:0]))

    def test_the_search_begins_at_the_seed_state(self):
        """So the pose of the seed state is reached there, and `distances` is measured from there."""
        for state in self.free_states(20):
            result = gps.solve_ik(self.checker, GROUP, poses_in(self.scene, state[None])[0], seed_state=state)
            np.testing.assert_allclose(result.states[0], state, atol=1e-9)
            self.assertLess(result.distances[0], 1e-9)
        ready = gps.solve_ik(self.checker, GROUP, self.scene.frame(TIP), seed_state="ready")
        self.assertLess(ready.distances[0], 1e-9)

    def test_several_solutions_differ_and_the_nearest_comes_first(self):
        most = 0
        arm = self.robot.group(GROUP).variables
        for pose in poses_in(self.scene, self.free_states(20)):
            result = gps.solve_ik(self.checker, GROUP, pose, max_solutions=8)
            self.assert_reached(result, pose)
            self.assertLessEqual(len(result.states), 8)
            most = max(most, len(result.states))
            np.testing.assert_allclose(np.linalg.norm((result.states - self.base)[:, arm], axis=1), result.distances)
            self.assertTrue((np.diff(result.distances) >= 0.0).all())
            for i, state in enumerate(result.states):
                for other in result.states[:i]:
                    self.assertGreaterEqual(np.abs(state - other).max(), 0.1)
        self.assertGreaterEqual(most, 4)  # the wrist alone gives two states of most poses

    def test_tolerances_are_those_of_the_call(self):
        for pose in poses_in(self.scene, self.free_states(20)):
            self.assert_reached(gps.solve_ik(self.checker, GROUP, pose, position_tolerance=0.01,
                                             orientation_tolerance=0.05), pose, (0.01, 0.05))
            any_orientation = gps.solve_ik(self.checker, GROUP, pose, orientation_tolerance=np.pi)
            self.assert_reached(any_orientation, pose, (1e-6, np.pi))

    def test_the_frame_of_a_carried_object_reaches_the_pose(self):
        self.scene.add_object("stick", gps.Cylinder(radius=0.01, length=0.1), pose=self.scene.frame(TIP))
        self.scene.move_object("stick", self.scene.frame(TIP) @ np.array(
            [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.2], [0, 0, 0, 1.0]]))
        self.scene.attach("stick", TIP, touch_links=["left_finger", "right_finger", "hand"])
        self.checker.set_scene(self.scene)
        pose = self.scene.frame("stick")
        pose[:3, 3] += [-0.05, 0.1, 0.1]
        result = gps.solve_ik(self.checker, GROUP, pose, frame="stick")
        self.assertEqual(gps.IkStatus.SOLVED, result.status, result.message)
        np.testing.assert_allclose(self.scene.frame("stick", result.states[0]), pose, atol=3e-6)

    def test_a_pose_inside_an_object_names_the_bodies_that_collide(self):
        pose = self.scene.frame(TIP)
        pose[:3, 3] = [0.55, 0.0, 0.15]  # inside the table
        result = gps.solve_ik(self.checker, GROUP, pose)
        self.assertEqual(gps.IkStatus.IN_COLLISION, result.status)
        self.assertRegex(result.message, r"^no solution without collision: of \d+ solutions?, .*collides: .* and table$")
        self.assertNotIn("\n", result.message)
        self.assertEqual(((0, 7), (0,)), (result.states.shape, result.distances.shape))
        without = gps.solve_ik(self.checker, GROUP, pose, check_collisions=False)
        self.assertEqual(gps.IkStatus.SOLVED, without.status)
        np.testing.assert_allclose(poses_in(self.scene, without.states)[0], pose, atol=3e-6)

    def test_a_pose_out_of_reach_says_how_near_the_search_came(self):
        pose = self.scene.frame(TIP)
        pose[0, 3] += 10.0
        good = self.scene.frame(TIP)
        far, near = gps.solve_ik(self.checker, GROUP, [pose, good], max_attempts=30)
        self.assertEqual(gps.IkStatus.NO_SOLUTION, far.status)
        self.assertRegex(far.message, r"^no solution in 30 attempts: the nearest state is [\d.]+ m from the wanted position")
        self.assertEqual(0, len(far.states))
        self.assert_reached(near, good)  # beside a pose out of reach

    def test_equal_seeds_give_equal_states(self):
        poses = poses_in(self.scene, self.free_states(20))
        pairs = [[np.vstack([result.states for result in gps.solve_ik(self.checker, GROUP, poses, seed=seed,
                                                                      max_solutions=4)])
                  for _ in range(2)] for seed in (1, 2)]
        for first, second in pairs:
            np.testing.assert_array_equal(first, second)
        self.assertFalse(np.array_equal(pairs[0][0], pairs[1][0]))

    def test_a_seed_outside_the_limits_of_a_joint_that_the_search_keeps_is_refused(self):
        # The group `hand` holds the arm and the gripper, which does not move the palm.
        srdf = ARM.with_suffix(".srdf").read_text(encoding="utf-8")
        hand = '<group name="hand"><group name="arm"/><joint name="grip"/></group></robot>'
        robot = gps.RobotModel.from_xml(ARM.read_text(encoding="utf-8"), srdf.replace("</robot>", hand))
        checker = gps.StateChecker(gps.PlanningScene(robot), device="cpu")
        seed = np.array(self.base)
        grip = robot.variable_index("grip")
        limits = robot.variables[grip]
        pose = self.scene.frame(TIP)
        for value in (limits.lower, limits.upper + 5e-7):  # the second one is outside by rounding
            seed[grip] = value
            result = gps.solve_ik(checker, "hand", pose, seed_state=seed, frame=TIP)
            self.assertEqual(gps.IkStatus.SOLVED, result.status)
            self.assertTrue(limits.lower <= result.states[0, grip] <= limits.upper)
        seed[grip] = 0.5
        self.assert_one_line(
            gps.Error, "^the given state must be within the limits of the joints that the search does not move: "
            "joint 'grip' is 0.5, outside its limits 0 to ", gps.solve_ik, checker, "hand", [pose, pose], seed_state=seed,
            frame=TIP)
        self.assertEqual(gps.IkStatus.SOLVED, gps.solve_ik(checker, "arm", pose, seed_state=seed, frame=TIP).status)

    def test_wrong_input_is_refused_in_one_line(self):
        pose = self.scene.frame(TIP)
        sheared = pose.copy()
        sheared[0, 1] += 0.1
        endless = pose.copy()
        endless[0, 3] = np.nan
        for message, arguments, keywords in (
                ("no group 'leg'", ("leg", pose), {}),
                ("the scene has no frame 'plam'.*palm", (GROUP, pose), {"frame": "plam"}),
                ("frame 'table' does not move with the robot", (GROUP, pose), {"frame": "table"}),
                ("group 'gripper' has no joint that moves link 'palm'", ("gripper", pose), {"frame": TIP}),
                (r"poses: the shape is \(3,\); it must be \(4, 4\)", (GROUP, pose[:3, 3]), {}),
                ("poses", (GROUP, sheared), {}),
                ("poses: pose 1", (GROUP, [pose, sheared]), {}),
                ("poses", (GROUP, endless), {}),
                ("position_tolerance is 0; it must be at least 1e-9", (GROUP, pose), {"position_tolerance": 0.0}),
                ("orientation_tolerance is -1; it must be at least", (GROUP, pose), {"orientation_tolerance": -1.0}),
                ("at least one attempt and one solution", (GROUP, pose), {"max_solutions": 0}),
                ("at least one attempt and one solution", (GROUP, pose), {"max_attempts": 0}),
                ("seed_state", (GROUP, pose), {"seed_state": [0.0]}),
                ("seed_state", (GROUP, pose), {"seed_state": "nose"})):
            with self.subTest(message, **keywords):
                self.assert_one_line(gps.Error, message, gps.solve_ik, self.checker, *arguments, **keywords)
        self.assert_one_line(TypeError, "expected a StateChecker", gps.solve_ik, self.scene, GROUP, pose)


if __name__ == "__main__":
    unittest.main()
