"""The launch file: what it clears, and the commands that it runs for a robot's description."""
import os
import pathlib
import re
import tempfile
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

    def test_clears_the_limits_of_an_earlier_launch_if_it_loads_the_robot(self):
        limits = "/robot_description_planning/"
        self.assertIn(limits, self.load("urdf_command:=echo <robot/>").clear_params)
        with tempfile.NamedTemporaryFile("w", suffix=".yaml", encoding="utf-8") as file:
            file.write("joint_limits: {slide: {max_position: 1.0}}")
            file.flush()
            for arguments, is_cleared in ((["urdf_command:=echo <robot/>"], True), ([], False)):
                config = self.load("planning:=" + file.name, *arguments)
                self.assertEqual(is_cleared, limits in config.clear_params)
                self.assertEqual(1.0, config.params[limits + "joint_limits/slide/max_position"].value)

    def test_runs_a_command_for_the_urdf_and_the_srdf(self):
        config = self.load("urdf_command:=echo <robot/>", "srdf_command:=echo <robot><group/></robot>")
        self.assertEqual(config.params["/robot_description"].value, "<robot/>\n")
        self.assertEqual(config.params["/robot_description_semantic"].value, "<robot><group/></robot>\n")

    def test_the_srdf_of_an_earlier_launch_does_not_stay(self):
        config = self.load("urdf_command:=echo <robot/>")
        self.assertEqual(config.params["/robot_description_semantic"].value, "")

    def test_the_documents_print_no_argument_that_roslaunch_refuses(self):
        """roslaunch refuses a second := in an argument."""
        documents = [ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *LAUNCH_FILES.iterdir()]
        for path in documents:
            text = path.read_text(encoding="utf-8")
            for argument in re.findall(r'\w+:="[^"]*"|\w+:=\S+', text):
                self.assertEqual(1, argument.count(":="), f"{path.name}: {argument}")
            # These are values of urdf_command and srdf_command.
            self.assertEqual([], re.findall(r"['`]xacro FILE[^'`]*:=", text), path.name)

    def test_sets_no_description_that_it_was_not_given(self):
        config = self.load()
        self.assertNotIn("/robot_description", config.params)
        self.assertNotIn("/robot_description_semantic", config.params)

    def files_of(self, *arguments, folder="/cell", home="/home/me"):
        """The parameters with paths, for a launch in the terminal's folder."""
        with tempfile.TemporaryDirectory() as root:
            for place in (folder, home):
                os.makedirs(root + place)
                for name in ("robot.urdf", "robot.srdf"):
                    pathlib.Path(root + place, name).write_text(place, encoding="utf-8")
            with unittest.mock.patch.dict(os.environ, PWD=root + folder, HOME=root + home):
                values = {name: param.value for name, param in self.load(*arguments).params.items()}
            return {name.split("/")[-1]: str(value).replace(root, "") for name, value in values.items()}

    def test_relative_paths_begin_in_the_folder_of_the_terminal(self):
        values = self.files_of("urdf:=robot.urdf", "srdf:=robot.srdf", "scene:=scenes/a.yaml", folder="/cell")
        self.assertEqual(("/cell", "/cell"), (values["robot_description"], values["robot_description_semantic"]))
        self.assertEqual(("/cell/", "/cell/scenes/a.yaml"), (values["urdf_folder"], values["scene"]))
        self.assertEqual("/cell/meshes", self.files_of("urdf:=robot.urdf", "urdf_folder:=meshes")["urdf_folder"])

    def test_a_tilde_is_the_home_folder(self):
        values = self.files_of("urdf:=~/robot.urdf", "srdf:=~/robot.srdf", "scene:=~/a.yaml", home="/home/me")
        self.assertEqual(("/home/me", "/home/me"), (values["robot_description"], values["robot_description_semantic"]))
        self.assertEqual(("/home/me/", "/home/me/a.yaml"), (values["urdf_folder"], values["scene"]))

    def test_absolute_paths_and_uris_stay(self):
        self.assertEqual("package://cell/a.yaml", self.files_of("scene:=package://cell/a.yaml")["scene"])
        values = self.files_of("scene:=/a.yaml", "urdf_folder:=/meshes")
        self.assertEqual(("/a.yaml", "/meshes"), (values["scene"], values["urdf_folder"]))
        values = self.files_of()
        self.assertEqual(("", ""), (values["scene"], values["urdf_folder"]))

    def test_the_node_gets_the_source_of_the_text_of_the_robot(self):
        self.assertEqual("/cell/robot.urdf", self.files_of("urdf:=robot.urdf")["urdf_source"])
        values = self.files_of("urdf_command:=echo 1", "srdf_command:=echo 2")
        self.assertEqual("the output of 'echo 1'", values["urdf_source"])
        self.assertEqual("the output of 'echo 2'", values["srdf_source"])
        self.assertEqual("", self.files_of()["urdf_source"])

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

    def test_the_live_demo_runs_a_command_for_the_urdf_and_the_srdf(self):
        srdf = "srdf_command:=echo <robot><group/></robot>"
        for arguments in (["urdf_command:=echo <robot/>", srdf], [srdf]):
            config = self.load(*arguments, file="live_demo.launch")
            self.assertEqual(config.params["/robot_description_semantic"].value, "<robot><group/></robot>\n")

    def test_replicas_follow_the_leader_with_its_robot_and_settings(self):
        def followed(*arguments):
            config = self.load("urdf:=/robot/a.urdf", *arguments, file="replicas.launch")
            self.assertIn("/robot_description", config.params)
            return {node.name: config.params[f"/{node.name}/follow"].value for node in config.nodes}, config.params

        with unittest.mock.patch("roslaunch.loader.open", unittest.mock.mock_open(read_data="<robot/>"), create=True):
            for count in (0, 1, 12):
                expected = {"cell": "", **{f"cell_{i + 1}": "cell" for i in range(count)}}
                self.assertEqual(expected, followed(f"replicas:={count}", "name:=cell")[0])
            _, params = followed("scene:=/a.yaml", "device:=cpu", "packages:={a: /b}")
            for name, same in (("device", "cpu"), ("packages/a", "/b"), ("urdf_folder", "/robot")):
                for node in ("planning_scene", "planning_scene_3"):
                    self.assertEqual(same, params[f"/{node}/{name}"].value, f"{node}: {name}")
            self.assertEqual("", params["/planning_scene_3/scene"].value, "the scene comes from the leader")


if __name__ == "__main__":
    unittest.main()
