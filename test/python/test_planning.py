"""plan_motion: paths, statuses, errors, Ctrl-C."""
import unittest

import numpy as np

import gpu_planning_scene as gps
from robots import RAIL, RAIL_SRDF, Case, arm_scene, rail
from signals import pressed_during_a_call


class Planning(Case):
    def test_a_path_leads_from_the_start_to_the_goal_and_is_free(self):
        scene = arm_scene()
        checker = gps.StateChecker(scene, device="cpu")
        start, goal = np.array([[0.7, 0.6, 0.6, 0, 0.6, 0, 0.03], [2.5, 0.6, 0.6, 0, 0.6, 0, 0.03]])
        self.assertFalse(gps.MotionChecker(checker, "arm", "samples").check(start, goal).valid[0])
        for rule in ("bound", "samples"):
            result = gps.plan_motion(checker, "arm", start, goal, seconds=20.0, rule=rule)
            self.assertEqual((gps.PlanningStatus.SOLVED, ""), (result.status, result.message))
            np.testing.assert_array_equal(start, result.waypoints[0])
            np.testing.assert_allclose(goal, result.waypoints[-1], atol=1e-9)
            for a, b in zip(result.waypoints[:-1], result.waypoints[1:]):
                fine = a + np.linspace(0, 1, 300)[:, None] * (b - a)
                self.assertTrue(rule == "samples" or checker.check(fine).valid.all())
            self.assertTrue(gps.MotionChecker(checker, "arm", rule).check(result.waypoints[:-1],
                                                                          result.waypoints[1:]).valid.all())
            self.assertGreater(result.states_checked, 0)
            self.assertGreater(result.planning_seconds, 0.0)

    def test_the_start_and_the_goals_can_be_states_of_the_srdf(self):
        scene = arm_scene()
        scene.current_state = [1, 1, 1, 1, 1, 1, 0.02]
        checker = gps.StateChecker(scene, device="cpu")
        for goals in ("extended", ["extended"]):
            result = gps.plan_motion(checker, "arm", "ready", goals, seconds=20.0)
            self.assertEqual((gps.PlanningStatus.SOLVED, ""), (result.status, result.message))
            np.testing.assert_array_equal([0, -0.4, 1.6, 0, 1.2, 0, 0.02], result.waypoints[0])
            np.testing.assert_allclose([-0.6, 0.2, 0.3, 0, 0.3, 0, 0.02], result.waypoints[-1], atol=1e-9)
        self.assert_one_line(gps.Error, "^goals: the SRDF has no state 'nose'; its states: arm/ready, arm/extended",
                             gps.plan_motion, checker, "arm", "ready", ["extended", "nose"])

    def test_a_goal_moves_only_the_variables_of_the_group(self):
        robot = gps.RobotModel.from_xml(
            '<robot name="lift"><link name="foot"/><link name="mast"/><link name="arm"/>'
            '<joint name="up" type="prismatic"><parent link="foot"/><child link="mast"/><axis xyz="0 0 1"/>'
            '<limit lower="0" upper="1" effort="1" velocity="1"/></joint>'
            '<joint name="turn" type="revolute"><parent link="mast"/><child link="arm"/><axis xyz="0 0 1"/>'
            '<limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>',
            '<robot name="lift"><group name="mast"><joint name="up"/></group><group name="arm"><joint name="turn"/></group>'
            '<group name="all"><joint name="up"/><joint name="turn"/></group>'
            '<group_state name="raised" group="mast"><joint name="up" value="1"/></group_state>'
            '<group_state name="away" group="all"><joint name="up" value="0.5"/><joint name="turn" value="1.5"/></group_state>'
            '</robot>')
        scene = gps.PlanningScene(robot)
        scene.current_state = [0.1, 0.0]
        checker = gps.StateChecker(scene, device="cpu")
        result = gps.plan_motion(checker, "arm", [0.1, 0.0], "away")
        np.testing.assert_array_equal([0.1, 1.5], result.waypoints[-1])
        self.assert_one_line(gps.Error, "^goals: 'raised': the state sets no variable of the group 'arm'; for example, 'up' is not",
                             gps.plan_motion, checker, "arm", [0.1, 0.0], ["away", "raised"])
        self.assert_one_line(gps.Error, "^states: 'raised': the state sets no variable of the group 'arm'",
                             gps.StateChecker(scene, device="cpu").check, "raised", "arm")
        self.assert_one_line(gps.Error, "^goal 0: up is 1 and at the start 0.1, but group 'arm' does not plan for it",
                             gps.plan_motion, checker, "arm", [0.1, 0.0], [1.0, 0.5])

    def test_a_start_outside_the_limits_beside_the_group_gives_a_warning(self):
        robot = gps.RobotModel.from_xml(
            '<robot name="two"><link name="foot"/><link name="mast"/><link name="arm"/>'
            '<joint name="up" type="prismatic"><parent link="foot"/><child link="mast"/><axis xyz="0 0 1"/>'
            '<limit lower="0" upper="1" effort="1" velocity="1"/></joint>'
            '<joint name="turn" type="revolute"><parent link="mast"/><child link="arm"/><axis xyz="0 0 1"/>'
            '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>',
            '<robot name="two"><group name="lift"><joint name="up"/></group></robot>')
        checker = gps.StateChecker(gps.PlanningScene(robot), device="cpu")
        with self.assertWarnsRegex(UserWarning, "start: joint 'turn' is -45, outside its limits -1 to 1 rad"):
            gps.plan_motion(checker, "lift", [0.1, -45.0], [0.9, -45.0], rule="samples")

    def test_a_seed_repeats_a_path(self):
        checker = gps.StateChecker(arm_scene(), device="cpu")
        start, goal = np.array([[0.7, 0.6, 0.6, 0, 0.6, 0, 0.03], [2.5, 0.6, 0.6, 0, 0.6, 0, 0.03]])

        def path(seed):
            result = gps.plan_motion(checker, "arm", start, goal, seconds=60.0, seed=seed)
            self.assertEqual(gps.PlanningStatus.SOLVED, result.status)
            return result.waypoints.tolist()

        expected = path(3)
        self.assertNotEqual(expected, path(4))
        path(None)
        self.assertEqual(expected, path(3))

    def test_a_path_gets_times_under_the_limits_of_the_joints(self):
        limits = "joint_limits: {slide: {has_velocity_limits: true, max_velocity: 0.5, max_acceleration: 0.25}}"
        robot = gps.RobotModel.from_xml(RAIL, RAIL_SRDF, planning=limits)
        slide = robot.variables[0]
        self.assertEqual((0.5, 0.25), (slide.max_velocity, slide.max_acceleration))
        checker = gps.StateChecker(gps.PlanningScene(robot), device="cpu")
        timed = gps.time_path(checker, "all", [[-1.0], [0.0], [1.0]])
        self.assertEqual(("", 0, 0), (timed.message, timed.blends, timed.stops))
        self.assertAlmostEqual(2.0 / 0.5 + 0.5 / 0.25, timed.times[-1])
        self.assertTrue((np.diff(timed.times) > 0).all())
        self.assertEqual((len(timed.times), 1), timed.positions.shape)
        np.testing.assert_array_equal([[-1.0], [1.0]], timed.positions[[0, -1]])
        np.testing.assert_array_equal([[0.0], [0.0]], timed.velocities[[0, -1]])
        self.assertAlmostEqual(0.5, timed.velocities.max())
        self.assertAlmostEqual(0.25, np.abs(timed.accelerations).max())
        slower = gps.time_path(checker, "all", [[-1.0], [1.0]], max_velocity_scaling_factor=0.5,
                               max_acceleration_scaling_factor=0.5)
        self.assertAlmostEqual(2.0 / 0.25 + 0.25 / 0.125, slower.times[-1])
        turned = gps.time_path(checker, "all", [[-1.0], [1.0], [0.0]])
        self.assertEqual((1, 0), (turned.blends, turned.stops))
        self.assertGreater(turned.states_checked, 0)
        self.assertEqual(1, gps.time_path(checker, "all", [[-1.0], [1.0], [0.0]], max_deviation=0.0).stops)
        assumed = gps.time_path(gps.StateChecker(gps.PlanningScene(rail()), device="cpu"), "all", [[0.0]])
        self.assertEqual((1, 1), assumed.accelerations.shape)
        self.assertRegex(assumed.message, "^assumed limits, .*: acceleration 1 .* of slide$")
        for error, pattern, arguments, options in (
                (gps.Error, "^max_velocity_scaling_factor is 2; it must be above 0 and at most 1", [[0.0]],
                 {"max_velocity_scaling_factor": 2.0}),
                (gps.Error, "^the path has no waypoint", np.zeros((0, 1)), {}),
                (gps.Error, "^waypoint 0: slide is nan", [[float("nan")]], {}),
                (gps.Error, "waypoints", [[0.0, 0.0]], {}),
                (TypeError, "waypoints", object(), {})):
            self.assert_one_line(error, pattern, gps.time_path, checker, "all", arguments, **options)

    def test_a_path_is_optimized_for_the_time_that_is_given(self):
        checker = gps.StateChecker(arm_scene(), device="cpu")
        start, goal = np.array([[0.7, 0.6, 0.6, 0, 0.6, 0, 0.03], [2.5, 0.6, 0.6, 0, 0.6, 0, 0.03]])
        result = gps.plan_motion(checker, "arm", start, goal, seconds=20.0, optimize=0.2)
        self.assertEqual(gps.PlanningStatus.SOLVED, result.status)
        self.assertGreaterEqual(result.simplification_seconds, 0.2)
        self.assert_one_line(gps.Error, "the time to optimize is -1", gps.plan_motion, checker, "arm", start, goal,
                             optimize=-1.0)

    def test_a_base_is_planned_for_within_the_workspace(self):
        srdf = ('<robot name="rail"><virtual_joint name="base" type="planar" parent_frame="map" child_link="rail"/>'
                '<group name="all"><joint name="base"/></group></robot>')
        scene = gps.PlanningScene(gps.RobotModel.from_xml(RAIL, srdf))
        scene.current_state = [0.0, 0.0, 0.0, 0.0]
        checker = gps.StateChecker(scene, device="cpu")
        start, goal = [0.0, 0.0, 0.0, 0.0], [5.0, -3.0, 1.0, 0.0]
        outside = gps.plan_motion(checker, "all", start, goal)
        self.assertEqual(gps.PlanningStatus.OUT_OF_BOUNDS, outside.status)
        self.assertIn("set a larger unbounded_translation, or give the request a workspace", outside.message)
        inside = gps.plan_motion(checker, "all", start, goal, workspace=([-6, -6, 0], [6, 6, 0]))
        self.assertEqual((gps.PlanningStatus.SOLVED, ""), (inside.status, inside.message))
        np.testing.assert_allclose(goal, inside.waypoints[-1], atol=1e-9)

    def test_a_search_ends_after_its_rounds(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("wall", gps.Box([0.1, 1, 1]), [1, 0, 0])
        blocked = gps.plan_motion(gps.StateChecker(scene, device="cpu"), "all", [0.0], [2.0], seconds=1e6,
                                  parameters={"max_rounds": 10})
        self.assertNotEqual(gps.PlanningStatus.SOLVED, blocked.status)

    def test_one_of_several_goals_is_enough(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("wall", gps.Box([0.1, 1, 1]), [1, 0, 0])
        checker = gps.StateChecker(scene, device="cpu")
        result = gps.plan_motion(checker, "all", [0.0], [[1.0], [3.0], [-2.0]])
        self.assertEqual(([0.0], [-2.0]), (result.waypoints[0].tolist(), result.waypoints[-1].tolist()))

    def test_the_status_says_why_there_is_no_path(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("wall", gps.Box([0.1, 1, 1]), [1, 0, 0])
        checker = gps.StateChecker(scene, device="cpu")
        status = gps.PlanningStatus
        for start, goal, expected, message in (
            (1.0, 0.0, status.START_IN_COLLISION, "wall"),
            (0.0, 1.0, status.GOAL_IN_COLLISION, "wall"),
            (0.0, 11.0, status.OUT_OF_BOUNDS, "slide"),
        ):
            result = gps.plan_motion(checker, "all", [start], [goal])
            self.assertEqual(expected, result.status)
            self.assertIn(message, result.message)
            self.assertNotIn("\n", result.message)
            self.assertEqual(0, len(result.waypoints))
        blocked = gps.plan_motion(checker, "all", [0.0], [2.0], seconds=0.2)
        self.assertIn(blocked.status, (status.APPROXIMATE, status.NO_SOLUTION))

    def test_wrong_arguments_are_errors(self):
        checker = gps.StateChecker(gps.PlanningScene(rail()), device="cpu")
        for error, pattern, arguments, options in (
            (gps.Error, "'legs'", ("legs", [0.0], [1.0]), {}),
            (gps.Error, "^start: the shape", ("all", [0.0, 1.0], [1.0]), {}),
            (gps.Error, "^goals: the shape", ("all", [0.0], [1.0, 2.0]), {}),
            (gps.Error, "no goal", ("all", [0.0], np.empty((0, 1))), {}),
            (gps.Error, "finite", ("all", [0.0], [float("nan")]), {}),
            (gps.Error, "planning time", ("all", [0.0], [1.0]), {"seconds": 0.0}),
            (gps.Error, "samples or bound", ("all", [0.0], [1.0]), {"rule": "hope"}),
            (gps.Error, "speed", ("all", [0.0], [1.0]), {"parameters": {"speed": 3}}),
            (TypeError, "a dict", ("all", [0.0], [1.0]), {"parameters": 3}),
            (gps.Error, "the seed is 0; it must be from 1 to 4294967295", ("all", [0.0], [1.0]), {"seed": 0}),
            (gps.Error, "the seed is 4294967296", ("all", [0.0], [1.0]), {"seed": 2**32}),
            (TypeError, "whole number", ("all", [0.0], [1.0]), {"seed": -1}),
            (TypeError, "a pair of corners", ("all", [0.0], [1.0]), {"workspace": 3.0}),
            (gps.Error, "the first must not be above", ("all", [0.0], [1.0]), {"workspace": ([1, 0, 0], [0, 0, 0])}),
        ):
            self.assert_one_line(error, pattern, gps.plan_motion, checker, *arguments, **options)
        self.assert_one_line(TypeError, "expected a StateChecker", gps.plan_motion, None, "all", [0.0], [1.0])

    def test_a_base_is_planned_for_within_the_workspace(self):
        srdf = ('<robot name="rail"><virtual_joint name="drive" type="planar" parent_frame="map" child_link="rail"/>'
                '<group name="base"><joint name="drive"/></group></robot>')
        robot = gps.RobotModel.from_xml(RAIL, srdf)
        checker = gps.StateChecker(gps.PlanningScene(robot), device="cpu")
        start, goal = np.zeros((2, len(robot.variables)))
        goal[robot.variable_index("drive/x")] = 3.0
        result = gps.plan_motion(checker, "base", start, goal)
        self.assertEqual(gps.PlanningStatus.OUT_OF_BOUNDS, result.status)
        self.assertIn("unbounded_translation", result.message)
        result = gps.plan_motion(checker, "base", start, goal, workspace=([-4, -4, 0], [4, 4, 0]))
        self.assertEqual(gps.PlanningStatus.SOLVED, result.status)

    def test_parameters_reach_the_planner(self):
        checker = gps.StateChecker(gps.PlanningScene(rail()), device="cpu")
        result = gps.plan_motion(checker, "all", [0.0], [1.0], parameters={"range": 0.5, "branches": 8})
        self.assertEqual(gps.PlanningStatus.SOLVED, result.status)

    def test_ctrl_c_ends_a_call(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("wall", gps.Box([0.1, 1, 1]), [1, 0, 0])
        checker = gps.StateChecker(scene, device="cpu")
        with self.assertRaises(KeyboardInterrupt), pressed_during_a_call():
            gps.plan_motion(checker, "all", [0.0], [2.0], seconds=250.0)


if __name__ == "__main__":
    unittest.main()
