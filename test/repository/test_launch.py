"""The launch file: what it clears, and the commands that it runs for a robot's description."""
import os
import unittest
import unittest.mock

from folders import ROOT

try:
    import roslaunch.config
except ImportError:
    roslaunch = None

LAUNCH_FILES = ROOT / "launch"


@unittest.skipUnless(roslaunch, "needs roslaunch")
class LaunchFile(unittest.TestCase):
    def load(self, *arguments, file="planning_scene.launch"):
        path = str(LAUNCH_FILES / file)
        config = roslaunch.config.ROSLaunchConfig()
        with unittest.mock.patch.dict(os.environ, ROS_PACKAGE_PATH=str(ROOT)):
            roslaunch.xmlloader.XmlLoader().load(path, config, argv=[path, *arguments], verbose=False)
        return config

    def arguments_of_show_scene(self, config):
        return [node.args for node in config.nodes if node.type == "show_scene.py"]

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

    def test_rviz_is_started_with_the_node_or_for_a_node_that_runs_already(self):
        self.assertEqual([], self.arguments_of_show_scene(self.load()))
        expected = ["--node checker --up=0,1,0"]
        arguments = ["name:=checker", "up:=0,1,0"]
        self.assertEqual(expected, self.arguments_of_show_scene(self.load("rviz:=true", *arguments)))
        self.assertEqual(expected, self.arguments_of_show_scene(self.load(*arguments, file="show_scene.launch")))

    def test_the_live_demo_has_sliders_unless_they_are_off(self):
        def programs(*arguments):
            return {node.type for node in self.load(*arguments, file="live_demo.launch").nodes}

        self.assertEqual({"planning_scene_node", "show_scene.py", "joint_sliders.py"}, programs())
        self.assertEqual({"planning_scene_node"}, programs("sliders:=false", "rviz:=false"))
        self.assertIn("joint_state_publisher_gui", programs("joint_state_publisher_gui:=true"))


if __name__ == "__main__":
    unittest.main()
