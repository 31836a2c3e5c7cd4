"""The sliders of joint_sliders.py and the variables that they stand for."""
import importlib.util
import math
import unittest

from folders import SCRIPTS

spec = importlib.util.spec_from_file_location("joint_sliders", SCRIPTS / "joint_sliders.py")
joint_sliders = importlib.util.module_from_spec(spec)
spec.loader.exec_module(joint_sliders)

URDF = """<robot name="r">
  <joint name="elbow" type="revolute"><limit lower="-1" upper="2"/></joint>
  <joint name="base" type="planar"/>
  <joint name="body" type="floating"/>
</robot>"""


def sliders(start):
    return joint_sliders.sliders_of(joint_sliders.variables_of(URDF), start)


class Sliders(unittest.TestCase):
    def test_have_a_name_and_limits_for_each_variable_and_angles_for_a_rotation(self):
        made = {slider.name: slider for slider in sliders({})}
        planar = ["base/x", "base/y", "base/theta"]
        floating = [f"body/{part}" for part in ("trans_x", "trans_y", "trans_z", "roll", "pitch", "yaw")]
        self.assertEqual(["elbow"] + planar + floating, list(made))
        self.assertEqual((-1.0, 2.0), (made["elbow"].lower, made["elbow"].upper))

    def test_start_with_the_state_of_the_scene_within_the_limits(self):
        made = {slider.name: slider.value for slider in sliders({"elbow": 3.0, "base/y": 0.5})}
        self.assertEqual(2.0, made["elbow"])
        self.assertEqual(0.5, made["base/y"])

    def test_say_so_if_the_state_of_the_scene_is_outside_the_limits(self):
        made = {slider.name: slider.warning() for slider in sliders({"elbow": 90.0, "base/y": 0.5})}
        self.assertEqual(
            "elbow of the scene is 90, outside the range of its slider, -1 to 2; the slider starts at 2", made.pop("elbow")
        )
        self.assertEqual({""}, set(made.values()))

    def test_give_the_values_with_which_they_started(self):
        half = math.sqrt(0.5)
        start = {"elbow": 0.25, "base/x": 0.5, "body/trans_z": 0.75}
        start.update({"body/rot_x": 0.0, "body/rot_y": 0.0, "body/rot_z": half, "body/rot_w": half})
        values = joint_sliders.values_of(sliders(start))
        self.assertEqual({variable.name for variable in joint_sliders.variables_of(URDF)}, set(values))
        for name, value in start.items():
            self.assertAlmostEqual(value, values[name], 12)

    def test_turn_about_fixed_axes(self):
        for angles in ((0.3, -0.4, 2.0), (-3.0, 1.2, -0.1)):
            quaternion = joint_sliders.quaternion_of(*angles)
            self.assertAlmostEqual(1.0, sum(value * value for value in quaternion), 12)
            for expected, value in zip(angles, joint_sliders.angles_of(*quaternion)):
                self.assertAlmostEqual(expected, value, 12)


if __name__ == "__main__":
    unittest.main()
