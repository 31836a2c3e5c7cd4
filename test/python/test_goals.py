"""Goals as poses, path constraints and straight lines."""
import unittest

import numpy as np

import gpu_planning_scene as gps
from robots import Case, arm_scene

START = np.array([0.7, 0.6, 0.6, 0, 0.6, 0, 0.03])
GOAL = np.array([2.5, 0.6, 0.6, 0, 0.6, 0, 0.03])
TIP = "palm"


def pose_in(scene, state, link=TIP):
    return scene.robot.link_poses(state)[[each.name for each in scene.robot.links].index(link)]


def stops_of(timed):
    """Waypoints that the motion passes beside the path, and those at which it stops."""
    return timed.blends, timed.stops


class PoseGoals(Case):
    def setUp(self):
        self.scene = arm_scene()
        self.checker = gps.StateChecker(self.scene, device="cpu")
        self.wanted = pose_in(self.scene, GOAL)

    def goal(self, pose):
        constraints = gps.KinematicConstraints(self.scene)
        constraints.add_pose(TIP, pose)
        return constraints

    def test_a_path_ends_at_the_pose(self):
        goal = self.goal(self.wanted)
        result = gps.plan_motion(self.checker, "arm", START, goal_constraints=goal, seconds=20.0)
        self.assertEqual((gps.PlanningStatus.SOLVED, ""), (result.status, result.message))
        np.testing.assert_allclose(pose_in(self.scene, result.waypoints[-1]), self.wanted, atol=1e-3)
        self.assertEqual((0.0, 0.0, 0.0), goal.violation(result.waypoints[-1]))
        for a, b in zip(result.waypoints[:-1], result.waypoints[1:]):
            self.assertTrue(self.checker.check(a + np.linspace(0, 1, 300)[:, None] * (b - a)).valid.all())

    def test_a_pose_out_of_reach_is_no_exception(self):
        far = self.wanted.copy()
        far[0, 3] += 10.0
        result = gps.plan_motion(self.checker, "arm", START, goal_constraints=[self.goal(far)])
        self.assertEqual(gps.PlanningStatus.GOAL_UNREACHABLE, result.status)
        self.assertRegex(result.message, "m from the wanted position")
        self.assertEqual(0, len(result.waypoints))

    def test_states_are_goals_beside_poses(self):
        far = self.wanted.copy()
        far[0, 3] += 10.0
        result = gps.plan_motion(self.checker, "arm", START, GOAL, goal_constraints=self.goal(far), seconds=20.0)
        np.testing.assert_allclose(GOAL, result.waypoints[-1], atol=1e-9)

    def test_path_constraints_hold_along_the_path(self):
        level = gps.KinematicConstraints(self.scene)
        heights = [pose_in(self.scene, state)[2, 3] for state in (START, GOAL)]
        region = np.eye(4)
        region[2, 3] = np.mean(heights)
        level.add_position(TIP, region, box=(10, 10, 0.2))
        result = gps.plan_motion(self.checker, "arm", START, GOAL, path_constraints=level, seconds=20.0)
        self.assertEqual((gps.PlanningStatus.SOLVED, ""), (result.status, result.message))
        for a, b in zip(result.waypoints[:-1], result.waypoints[1:]):
            for state in a + np.linspace(0, 1, 50)[:, None] * (b - a):
                self.assertEqual((0.0, 0.0, 0.0), level.violation(state))
        # A path with these constraints has no rounded corners.
        corners = np.vstack([START, START + [0.3, 0, 0, 0, 0, 0, 0], START + [0.3, 0, 0.3, 0, 0, 0, 0]])
        self.assertEqual((1, 0), stops_of(gps.time_path(self.checker, "arm", corners, rule="samples")))
        timed = gps.time_path(self.checker, "arm", corners, path_constraints=[level])
        self.assertEqual((0, 1), stops_of(timed))
        self.assert_one_line(TypeError, "path_constraints: expected a KinematicConstraints", gps.time_path, self.checker,
                             "arm", corners, path_constraints=np.eye(4))

    def test_wrong_constraints_are_refused_in_one_line(self):
        constraints = gps.KinematicConstraints(self.scene)
        for message, call in (
                ("the scene has no frame 'elbow'", lambda: constraints.add_pose("elbow", np.eye(4))),
                ("does not move with the robot", lambda: constraints.add_pose("post", np.eye(4))),
                ("give one of them", lambda: constraints.add_position(TIP, np.eye(4))),
                ("a tolerance is 0", lambda: constraints.add_orientation(TIP, np.eye(4), (0, 1, 1))),
                ("is not a range", lambda: constraints.add_joint(self.scene.robot.variables[0].name, 1, 0)),
                ("no variable 'knee'", lambda: constraints.add_joint("knee", 0, 1))):
            self.assert_one_line(gps.Error, message, call)
        self.assertEqual((0.0, 0.0, 0.0), constraints.violation(START))  # nothing was added
        self.assert_one_line(TypeError, "goal_constraints: expected a KinematicConstraints", gps.plan_motion, self.checker,
                             "arm", START, goal_constraints=np.eye(4))
        self.assert_one_line(gps.Error, "there is no goal", gps.plan_motion, self.checker, "arm", START)


class Lines(Case):
    def test_a_line_is_followed_to_its_end_or_to_what_ends_it(self):
        scene = arm_scene()
        checker = gps.StateChecker(scene, device="cpu")
        pose = pose_in(scene, START)
        pose[2, 3] += 0.05
        path = gps.follow_lines(checker, "arm", START, [pose], frame=TIP)
        self.assertEqual((1.0, ""), (path.fraction, path.message))
        np.testing.assert_array_equal(START, path.waypoints[0])
        np.testing.assert_allclose(pose_in(scene, path.waypoints[-1]), pose, atol=1e-4)
        first = pose_in(scene, START)[:3, 3]
        for a, b in zip(path.waypoints[:-1], path.waypoints[1:]):
            for state in a + np.linspace(0, 1, 10)[:, None] * (b - a):
                np.testing.assert_allclose(pose_in(scene, state)[:2, 3], first[:2], atol=1e-4)
                self.assertTrue(checker.check(state).valid[0])
        pose[2, 3] += 10.0
        path = gps.follow_lines(checker, "arm", START, [pose], frame=TIP)
        self.assertLess(path.fraction, 0.5)
        self.assertNotEqual("", path.message)
        self.assert_one_line(gps.Error, "there is no waypoint", gps.follow_lines, checker, "arm", START, [])

    def test_a_base_that_drives_only_along_its_heading_is_refused(self):
        robot = gps.RobotModel.from_xml(
            '<robot name="r"><link name="body"/></robot>',
            '<robot name="r"><virtual_joint name="drive" type="planar" parent_frame="world" child_link="body"/>'
            '<joint_property joint_name="drive" property_name="motion_model" value="diff_drive"/>'
            '<group name="base"><joint name="drive"/></group></robot>')
        checker = gps.StateChecker(gps.PlanningScene(robot), device="cpu")
        beside = np.eye(4)
        beside[1, 3] = 0.05
        for call, goal in ((gps.follow_lines, [beside]), (gps.plan_motion, [0.0, 0.05, 0.0])):
            self.assert_one_line(gps.Error, "^joint 'drive' of group 'base' cannot be planned for: it drives only along its "
                                 "heading", call, checker, "base", np.zeros(3), goal)


if __name__ == "__main__":
    unittest.main()
