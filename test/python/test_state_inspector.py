"""StateInspector: contacts, clearances and distances whose values are known."""
import unittest

import numpy as np

import gpu_planning_scene as gps
from robots import Case, kr5_scene, rail
from signals import pressed_during_a_call


def post_scene():
    scene = gps.PlanningScene(rail())
    scene.add_object("post", gps.Sphere(0.1), [1, 0, 0])
    return scene


class StateInspector(Case):
    def test_clearance_is_the_distance_of_the_spheres(self):
        inspector = gps.StateInspector(post_scene())
        positions = np.linspace(-5, 5, 41)
        answer = inspector.clearances(positions[:, None])
        expected = np.maximum(np.abs(positions - 1) - 0.2, 0)
        self.assertTrue(np.all(answer.world <= expected + 1e-12))
        self.assertTrue(np.all(answer.world >= expected - 1e-6))
        self.assertTrue(np.all(answer.self == np.inf))  # the rail has no shape
        self.assertEqual([[1, 2]], np.unique(answer.nearest_world, axis=0).tolist())
        self.assertEqual([[-1, -1]], np.unique(answer.nearest_self, axis=0).tolist())
        self.assertEqual(41, len(answer))

    def test_states_are_free_where_their_clearance_is_positive(self):
        scene = kr5_scene()
        states = scene.robot.random_states(100, seed=1)
        answer = gps.StateInspector(scene).clearances(states)
        valid = gps.StateChecker(scene, device="cpu").check(states).valid
        np.testing.assert_array_equal(valid, np.minimum(answer.world, answer.self) > 0)
        one = gps.StateInspector(scene).clearances(states[5])
        self.assertEqual((1, answer.world[5]), (len(one), one.world[0]))

    def test_contacts_lie_where_the_spheres_overlap(self):
        inspector = gps.StateInspector(post_scene())
        contact = inspector.contacts([0.85])[0]
        self.assertEqual((1, 2), tuple(contact.bodies))
        self.assertAlmostEqual(0.05, contact.depth, places=3)
        np.testing.assert_allclose([0.925, 0, 0], contact.point, atol=0.026)
        np.testing.assert_allclose([1, 0, 0], contact.normal, atol=1e-2)
        self.assertEqual([], inspector.contacts([0.0]))

    def test_distances_are_those_of_the_spheres(self):
        inspector = gps.StateInspector(post_scene())
        positions = np.linspace(-5, 5, 41)
        near = inspector.distances(positions[:, None])
        signed = np.abs(positions - 1) - 0.2
        free = signed > 1e-9
        self.assertEqual(41, len(near))
        np.testing.assert_array_equal(np.arange(41), near.state)
        self.assertEqual([[1, 2]], np.unique(near.bodies, axis=0).tolist())
        np.testing.assert_allclose(near.distance[free], signed[free], rtol=0, atol=1.1e-6)
        np.testing.assert_array_equal(near.distance < 0, ~free)
        np.testing.assert_array_equal(near.collides, ~free)
        self.assertTrue(np.all(near.depth_at_least[free] == 0))
        self.assertTrue(np.all(near.depth_at_least[~free] <= -near.distance[~free]))
        side = np.where(positions < 1, 1.0, -1.0)  # the direction to the post
        np.testing.assert_allclose(near.normal[free], side[free, None] * [1, 0, 0], atol=1e-9)
        np.testing.assert_allclose(near.points[free, 0, 0], (positions + 0.1 * side)[free], atol=1e-9)
        np.testing.assert_allclose(near.points[free, 1, 0], (1 - 0.1 * side)[free], atol=1e-9)
        np.testing.assert_allclose(near.gradient[free, 0], -side[free], atol=1e-9)

    def test_distances_beyond_the_range_are_left_out(self):
        inspector = gps.StateInspector(post_scene())
        positions = np.linspace(-5, 5, 41)
        near = inspector.distances(positions[:, None], range=0.5, gradients=False)
        np.testing.assert_array_equal(np.flatnonzero(np.abs(positions - 1) - 0.2 < 0.5), near.state)
        self.assertEqual((0, 0), near.gradient.shape)
        self.assertEqual(0, len(inspector.distances(np.empty((0, 1)))))
        for wrong in (0.0, -1.0, np.nan):
            with self.assertRaisesRegex(gps.Error, "range"):
                inspector.distances([[0.0]], range=wrong)

    def test_the_nearest_pair_of_each_body_is_among_all_pairs(self):
        scene = kr5_scene()
        states = scene.robot.random_states(200, seed=2)
        inspector = gps.StateInspector(scene)
        every = inspector.distances(states)
        nearest = inspector.distances(states, nearest_of_each_body=True)
        self.assertLess(len(nearest), len(every))
        links = len(scene.robot.links)
        for state, bodies, distance in zip(nearest.state, nearest.bodies, nearest.distance):
            of_body = (every.state == state) & np.any(every.bodies == bodies[0], axis=1)
            self.assertLess(bodies[0], links)
            self.assertAlmostEqual(every.distance[of_body].min(), distance, delta=1.1e-6)

    def test_links_that_touch_have_no_negative_depth(self):
        shapes = ('<sphere radius="0.1"/>', '<box size="0.2 0.2 0.2"/>', '<cylinder radius="0.1" length="0.2"/>')
        link = '<link name="{}"><collision><geometry>{}</geometry></collision></link>'
        joint = ('<joint name="slide" type="prismatic"><parent link="a"/><child link="b"/><origin xyz="0.1 0 0"/>'
                 '<axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>')
        for first in shapes:
            for second in shapes:
                urdf = f'<robot name="r">{link.format("a", first)}{link.format("b", second)}{joint}</robot>'
                inspector = gps.StateInspector(gps.PlanningScene(gps.RobotModel.from_xml(urdf, '<robot name="r"/>')))
                touching = 0
                for beyond in np.linspace(-5e-10, 5e-10, 11):  # metres; up to 1e-9 m is a collision
                    for contact in inspector.contacts([0.1 + beyond]):
                        self.assertGreaterEqual(contact.depth, 0, (first, second, beyond))
                        touching += 1
                self.assertGreater(touching, 5, (first, second))

    def test_contacts_are_those_of_pairs_that_collide(self):
        scene = kr5_scene()
        states = scene.robot.random_states(50, seed=2)
        result = gps.StateChecker(scene, device="cpu").check(states)
        inspector = gps.StateInspector(scene)
        for state, valid, pair in zip(states, result.valid, result.colliding):
            contacts = inspector.contacts(state, max_contacts=1000)
            self.assertEqual(valid, not contacts)
            self.assertTrue(valid or tuple(pair) in {tuple(contact.bodies) for contact in contacts})
            self.assertLessEqual(len(inspector.contacts(state, max_contacts=2)), 2)

    def test_a_scene_is_copied(self):
        scene = post_scene()
        inspector = gps.StateInspector(scene)
        scene.remove_object("post")
        self.assertTrue(inspector.contacts([1.0]))

    def test_wrong_arguments_are_errors(self):
        inspector = gps.StateInspector(post_scene())
        self.assert_one_line(gps.Error, "^state: the shape", inspector.contacts, [[0.0], [1.0]])
        self.assert_one_line(gps.Error, "^states: the shape", inspector.clearances, [0.0, 1.0])
        for call in (inspector.contacts, inspector.clearances):
            self.assert_one_line(gps.Error, "'legs'", call, [0.0], "legs")
            self.assert_one_line(gps.Error, "'slide'", call, [float("nan")])
            self.assert_one_line(TypeError, "array of numbers", call, [["ready"]])
            self.assert_one_line(gps.Error, "^states?: the SRDF has no state 'ready'; it names no states", call, "ready")
        self.assert_one_line(TypeError, "expected a PlanningScene", gps.StateInspector, None)

    def test_ctrl_c_ends_a_call(self):
        scene = kr5_scene()
        states = np.tile(scene.robot.random_states(1000, seed=3), (2000, 1))
        with self.assertRaises(KeyboardInterrupt), pressed_during_a_call():
            gps.StateInspector(scene).clearances(states)


if __name__ == "__main__":
    unittest.main()
