"""render: pictures as arrays."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import gpu_planning_scene as gps
from robots import KR5, ROOT, Case, arm_scene, rail


def red_pixels(image):
    image = image.astype(int)
    return int(np.sum((image[..., 0] > 1.6 * image[..., 1]) & (image[..., 0] > 1.6 * image[..., 2])))


class Render(Case):
    def test_a_picture_has_the_size_and_shows_collisions_in_red(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("post", gps.Sphere(0.1), [1, 0, 0])
        free, collides = (gps.render(scene, [x], width=160, height=120) for x in (0.5, 0.9))
        self.assertEqual(((120, 160, 3), np.uint8), (free.shape, free.dtype))
        self.assertGreater(red_pixels(collides), red_pixels(free) + 300)

    def test_the_view_can_be_chosen(self):
        scene = arm_scene()
        chosen = gps.render(scene, width=80, height=60, eye=[2, 2, 2], target=[0, 0, 0.5], up=[0, 0, 2])
        np.testing.assert_array_equal(
            chosen, gps.render(scene, scene.current_state, width=80, height=60, eye=[2, 2, 2], target=[0, 0, 0.5]))
        self.assertTrue(np.any(chosen != gps.render(scene, width=80, height=60, eye=[-2, 2, 2], target=[0, 0, 0.5])))

    def test_wrong_arguments_are_errors(self):
        scene = gps.PlanningScene(rail())
        for error, pattern, options in (
            (gps.Error, "^state: the shape", {"state": [0.0, 1.0]}),
            (gps.Error, "0", {"width": 0}),
            (gps.Error, "", {"height": 10**9}),
            (gps.Error, "^up: the vector has length 0", {"up": [0, 0, 0]}),
            (gps.Error, "^eye: the shape", {"eye": [0, 0]}),
            (gps.Error, "warp drive", {"device": "warp drive"}),
            (TypeError, "whole number", {"width": "wide"}),
        ):
            self.assert_one_line(error, pattern, gps.render, scene, **options)
        self.assert_one_line(TypeError, "expected a PlanningScene", gps.render, None)


class MovingPicture(Case):
    def test_the_straight_motion_turns_red_and_the_plan_does_not(self):
        if not KR5.exists():
            self.skipTest("Debian's dart-doc is not here")
        try:
            from PIL import Image
        except ImportError:
            self.skipTest("python3-pil is not here")

        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder, "plan.gif")
            program = [sys.executable, ROOT / "scripts" / "moving_picture", "--urdf", KR5, "--out", out]
            subprocess.run([*program, "--pictures", "6", "--size", "160"], check=True)
            red = []
            with Image.open(out) as animation:
                for frame in range(animation.n_frames):
                    animation.seek(frame)
                    red.append(red_pixels(np.asarray(animation.convert("RGB"))))
        # Equal pictures at the end of a motion are one frame.
        self.assertGreater(max(red[:6]), min(red) + 100)
        self.assertLess(max(red[6:]), min(red) + 20)


if __name__ == "__main__":
    unittest.main()
