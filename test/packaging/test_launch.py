"""The launch file: what it clears, and the commands that it runs for a robot's description."""
import unittest

from repository import ROOT

try:
    import roslaunch.config
except ImportError:
    roslaunch = None

LAUNCH_FILE = str(ROOT / "launch" / "planning_scene.launch")


@unittest.skipUnless(roslaunch, "needs roslaunch")
class LaunchFile(unittest.TestCase):
    def load(self, *arguments):
        config = roslaunch.config.ROSLaunchConfig()
        loader = roslaunch.xmlloader.XmlLoader()
        loader.load(LAUNCH_FILE, config, argv=[LAUNCH_FILE, *arguments], verbose=False)
        return config

    def test_clears_the_parameters_of_an_earlier_launch(self):
        self.assertEqual(self.load("name:=checker").clear_params, ["/checker/"])

    def test_runs_a_command_for_the_urdf_and_the_srdf(self):
        config = self.load("urdf_command:=echo <robot/>", "srdf_command:=echo <robot><group/></robot>")
        self.assertEqual(config.params["/robot_description"].value, "<robot/>\n")
        self.assertEqual(config.params["/robot_description_semantic"].value, "<robot><group/></robot>\n")

    def test_the_srdf_of_an_earlier_launch_does_not_stay(self):
        config = self.load("urdf_command:=echo <robot/>")
        self.assertEqual(config.params["/robot_description_semantic"].value, "")

    def test_sets_no_description_that_it_was_not_given(self):
        config = self.load()
        self.assertNotIn("/robot_description", config.params)
        self.assertNotIn("/robot_description_semantic", config.params)


if __name__ == "__main__":
    unittest.main()
