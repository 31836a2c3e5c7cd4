"""The states that limit_speed.py checks, and the factor that it derives from their distances."""
import importlib.util
import unittest

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


if __name__ == "__main__":
    unittest.main()
