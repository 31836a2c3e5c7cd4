"""MotionChecker: both rules, the three queries, errors, Ctrl-C."""
import pathlib
import subprocess
import sys
import textwrap
import threading
import unittest

import numpy as np

import gpu_planning_scene as gps
from robots import Case, arm_scene, kr5_scene, rail
from signals import pressed_during_a_call


def wall_scene(thickness):
    """A wall across the rail at x = 1."""
    scene = gps.PlanningScene(rail())
    scene.add_object("wall", gps.Box([thickness, 1, 1]), [1, 0, 0])
    return scene


def motions(scene, **options):
    return gps.MotionChecker(gps.StateChecker(scene, device="cpu"), **options)


class MotionChecker(Case):
    def test_the_outlook_of_a_trajectory_is_that_of_its_rest(self):
        checker = motions(wall_scene(0.1))
        seconds, states = [0.0, 1.0, 2.0], [[-1.0], [0.0], [3.0]]
        blocked = checker.outlook(seconds, states, now=0.5)
        self.assertFalse(blocked.free)
        self.assertLessEqual(blocked.free_until, blocked.collision)
        self.assertLess(blocked.brake_by, blocked.free_until)
        self.assertNotEqual([-1, -1], list(blocked.colliding))
        self.assertTrue(checker.outlook(seconds, states, now=2.0).free)
        self.assert_one_line(gps.Error, "row 1", checker.outlook, [0.0, 0.0, 1.0], states, 0.0)
        self.assert_one_line(gps.Error, "3 values for 2 rows", checker.outlook, [0.0, 1.0], states, 0.0)

    def test_a_motion_is_valid_up_to_the_wall(self):
        # The ball has a radius of 0.1 m, so it meets the wall at x = 0.85.
        for rule in ("bound", "samples"):
            checker = motions(wall_scene(0.1), rule=rule, translation_resolution=0.01)
            answer = checker.check([[0.0], [0.0], [0.84]], [[0.8], [2.0], [0.0]], query="last_valid")
            self.assertEqual([True, False, True], answer.valid.tolist())
            self.assertEqual([1.0, 1.0], answer.last_valid[[0, 2]].tolist())
            self.assertTrue(0.83 <= 2 * answer.last_valid[1] < 0.85)
            self.assertTrue(2 * answer.last_valid[1] < 2 * answer.first_invalid[1] < 0.87)
            self.assertEqual([-1, -1], answer.colliding[0].tolist())
            self.assertFalse(answer.given_up.any())
            self.assertEqual(3, len(answer))

    def test_a_base_with_differential_drive_moves_along_its_heading(self):
        robot = gps.RobotModel.from_xml(
            '<robot name="r"><link name="body"/></robot>',
            '<robot name="r"><virtual_joint name="drive" type="planar" parent_frame="world" child_link="body"/>'
            '<joint_property joint_name="drive" property_name="motion_model" value="diff_drive"/></robot>',
        )
        checker = motions(gps.PlanningScene(robot))
        self.assertTrue(checker.check([[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]).valid.all())
        self.assert_one_line(
            gps.Error, "motion 0: joint 'drive' moves 1 m sideways", checker.check, [[0.0] * 3], [[0.0, 1.0, 0.0]]
        )

    def test_a_call_checks_one_scene_while_another_thread_changes_it(self):
        # Each wall forbids the motion. Between the walls' scenes, a motion could pass both.
        robot = rail()
        scenes = []
        for x in (0.75, 4.5):
            scenes.append(gps.PlanningScene(robot))
            scenes[-1].add_object("wall", gps.Box([0.1, 1, 1]), [x, 0, 0])
        checker = gps.StateChecker(scenes[0], device="cpu")
        motions_checker = gps.MotionChecker(checker, rule="samples", translation_resolution=0.05)
        ended = threading.Event()

        def change():
            while not ended.is_set():
                for scene in scenes:
                    checker.set_scene(scene)

        thread = threading.Thread(target=change)
        thread.start()
        try:
            for _ in range(20):
                answer = motions_checker.check(np.zeros((2000, 1)), np.full((2000, 1), 9.0))
                self.assertFalse(answer.valid.any())
                self.assertEqual(1, len(set(answer.first_invalid.tolist())))
        finally:
            ended.set()
            thread.join()

    def test_a_checker_can_be_made_while_another_thread_checks(self):
        # In a process of its own: if the threads wait for each other, the interpreter hangs.
        program = textwrap.dedent(f"""
            import sys, threading
            sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
            import gpu_planning_scene as gps
            from robots import kr5_scene
            scene = kr5_scene()
            checker = gps.StateChecker(scene, device="cpu")
            states = scene.robot.random_states(20000, seed=1)
            ended = threading.Event()

            def check():
                while not ended.is_set():
                    checker.check(states)

            thread = threading.Thread(target=check)
            thread.start()
            for _ in range(5):
                gps.MotionChecker(checker)
            ended.set()
            thread.join()
        """)
        subprocess.run([sys.executable, "-c", program], check=True, timeout=100)

    def test_ends_can_be_states_of_the_srdf(self):
        scene = arm_scene()
        start, end = np.tile(scene.current_state, (2, 1))
        for row, name in ((start, "ready"), (end, "extended")):
            row[scene.robot.named_state(name).variables] = scene.robot.named_state(name).values
        checker = motions(scene, rule="samples")
        expected = checker.check([start, end], [end, start], query="last_valid")
        answer = checker.check(["ready", "extended"], ["extended", "ready"], query="last_valid")
        np.testing.assert_array_equal(expected.last_valid, answer.last_valid)
        np.testing.assert_array_equal(expected.valid, answer.valid)
        self.assert_one_line(gps.Error, "^ends: the SRDF has no state 'nose'", checker.check, "ready", "nose")

    def test_a_variable_that_the_name_of_the_end_does_not_set_keeps_its_start(self):
        joint = "<joint name='{0}' type='prismatic'><parent link='{1}'/><child link='{2}'/><axis xyz='{3}'/>" \
                "<limit lower='-3' upper='3' effort='1' velocity='1'/></joint>"
        ball = "<collision><geometry><sphere radius='0.1'/></geometry></collision>"
        robot = gps.RobotModel.from_xml(
            "<robot name='crane'><link name='rail'/><link name='cart'/><link name='ball'>" + ball + "</link>" +
            joint.format("slide", "rail", "cart", "1 0 0") + joint.format("lift", "cart", "ball", "0 0 1") + "</robot>",
            "<robot name='crane'><group name='carts'><joint name='slide'/></group>"
            "<group_state name='far' group='carts'><joint name='slide' value='2'/></group_state></robot>")
        scene = gps.PlanningScene(robot)
        scene.add_object("wall", gps.Box([0.1, 1, 0.4]), [1, 0, 0])
        scene.current_state = [0.0, -1.0]
        # From z = 1 to the current z = -1, the ball would hit the wall.
        self.assertEqual([True], motions(scene).check([[0.0, 1.0]], ["far"]).valid.tolist())
        self.assertEqual([False], motions(scene).check([[0.0, 0.0]], ["far"]).valid.tolist())

    def test_the_query_valid_ends_at_the_first_collision(self):
        answer = motions(wall_scene(0.1), rule="samples").check([0.0], [2.0])
        self.assertEqual((False, 0.0), (answer.valid[0], answer.last_valid[0]))
        self.assertEqual([1, 2], answer.colliding[0].tolist())

    def test_only_the_rule_bound_finds_an_obstacle_between_two_samples(self):
        # With a step of 3 m the samples are at 0 and 3: both ends are free.
        scene = wall_scene(0.001)
        step = {"translation_resolution": 3.0}
        self.assertEqual([True], motions(scene, rule="samples", **step).check([0.0], [3.0]).valid.tolist())
        bound = motions(scene, rule="bound", **step)
        self.assertEqual([False], bound.check([0.0], [3.0]).valid.tolist())
        self.assertEqual([True], bound.check([0.0], [3.0], query="samples").valid.tolist())
        self.assertGreater(bound.states_checked, 2)
        scene.remove_object("wall")
        self.assertEqual([True], motions(scene, rule="bound", **step).check([0.0], [3.0]).valid.tolist())

    def test_samples_are_those_of_the_straight_motion(self):
        scene = kr5_scene()
        checker = gps.StateChecker(scene, device="cpu")
        states = scene.robot.random_states(120, seed=1)
        starts, ends = states[:60], 0.7 * states[:60] + 0.3 * states[60:]
        found = gps.MotionChecker(checker, rule="samples", resolution=0.05).check(starts, ends).valid
        for start, end, valid in zip(starts, ends, found):
            count = int(np.ceil(np.abs(end - start).max() / 0.05 - 1e-9))
            samples = start + np.linspace(0, 1, count + 1)[:, None] * (end - start)
            self.assertEqual(bool(checker.check(samples).valid.all()), valid)
        self.assertTrue(5 < found.sum() < 55)

    def test_no_sample_of_a_motion_that_bound_accepts_collides(self):
        scene = arm_scene()
        checker = gps.StateChecker(scene, device="cpu")
        states = scene.robot.random_states(200, seed=2)
        starts, ends = states[:100], 0.8 * states[:100] + 0.2 * states[100:]
        bound = gps.MotionChecker(checker, rule="bound").check(starts, ends).valid
        samples = gps.MotionChecker(checker, rule="samples").check(starts, ends).valid
        self.assertTrue(bound.any())
        self.assertTrue(np.all(samples[bound]))
        for start, end in zip(starts[bound], ends[bound]):
            fine = start + np.linspace(0, 1, 500)[:, None] * (end - start)
            self.assertTrue(checker.check(fine).valid.all())

    def test_limits_end_the_checks(self):
        scene = wall_scene(0.001)
        answer = motions(scene, rule="samples", translation_resolution=1e-3, max_checks=50).check([[0.0]], [[0.5]])
        self.assertEqual(([False], [True]), (answer.valid.tolist(), answer.given_up.tolist()))
        few = motions(scene, rule="samples", translation_resolution=1e-3, max_samples=50)
        self.assertEqual([False], few.check([0.0], [0.5]).valid.tolist())

    def test_no_motion_is_a_batch(self):
        answer = motions(wall_scene(0.1)).check(np.empty((0, 1)), np.empty((0, 1)))
        self.assertEqual(((0,), (0, 2)), (answer.valid.shape, answer.colliding.shape))

    def test_wrong_arguments_are_errors(self):
        checker = gps.StateChecker(wall_scene(0.1), device="cpu")
        for error, pattern, options in (
            (gps.Error, "it must be samples or bound", {"rule": "hope"}),
            (gps.Error, "step|0", {"resolution": 0.0}),
            (gps.Error, "step|-1", {"translation_resolution": -1.0}),
            (gps.Error, "'legs'", {"group": "legs"}),
            (TypeError, "whole number", {"max_samples": 1.5}),
        ):
            self.assert_one_line(error, pattern, gps.MotionChecker, checker, **options)
        self.assert_one_line(TypeError, "expected a StateChecker", gps.MotionChecker, wall_scene(0.1))
        check = gps.MotionChecker(checker).check
        self.assert_one_line(gps.Error, "2 starts and 1 ends", check, [[0.0], [1.0]], [[0.0]])
        self.assert_one_line(gps.Error, "^ends: the shape", check, [0.0], [0.0, 1.0])
        self.assert_one_line(gps.Error, "'slide'", check, [0.0], [float("nan")])
        self.assert_one_line(gps.Error, "valid, last_valid or samples", check, [0.0], [1.0], query="why")

    def test_ctrl_c_ends_a_check(self):
        checker = motions(wall_scene(0.1), translation_resolution=1e-4, rule="samples")
        starts = np.zeros((5000, 1))
        with self.assertRaises(KeyboardInterrupt), pressed_during_a_call():
            checker.check(starts, starts + 0.8)  # 8000 samples each


if __name__ == "__main__":
    unittest.main()
