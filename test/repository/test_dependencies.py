"""The Debian packages that the scripts install match the rosdep keys of package.xml."""
import re
import unittest
import xml.etree.ElementTree

from folders import ROOT, SCRIPTS


def listed():
    """The Debian package, rosdep key and reason in each line of dependencies.txt."""
    lines = (SCRIPTS / "dependencies.txt").read_text().splitlines()
    return [line.split(maxsplit=2) for line in lines if line and not line.startswith("#")]


# The Debian packages of ROS commands.
COMMANDS = {
    "rosbag": "python3-rosbag",
    "roslaunch": "python3-roslaunch",
    "rosnode": "python3-rosnode",
    "rosparam": "python3-rosparam",
    "rosrun": "rosbash",
    "rosservice": "python3-rosservice",
    "rostopic": "python3-rostopic",
}


def ros_commands():
    """The ROS commands that the documents print, in the form (file, command)."""
    files = [ROOT / "README.md", *(ROOT / "docs").glob("*.md"), ROOT / "config" / "scene.rviz"]
    for path in files + list((ROOT / "launch").iterdir()):
        # In a document, a command is an indented line. In the other files, it is an indented line of a comment.
        for command in re.findall(r"^#?\s+(ros[a-z]+) ", path.read_text(encoding="utf-8"), flags=re.MULTILINE):
            if command != "rosdep":  # printed for Ubuntu, where dependencies.txt is not used
                yield path.name, command


class Dependencies(unittest.TestCase):
    def test_each_ros_command_of_the_documents_is_in_a_listed_package(self):
        packages = {fields[0] for fields in listed()}
        found = list(ros_commands())
        self.assertIn(("node.md", "rosservice"), found)
        self.assertIn(("scene.rviz", "roslaunch"), found)
        for file, command in found:
            self.assertIn(COMMANDS[command], packages, f"{file} prints a command with {command}")

    def test_each_package_has_a_key_and_a_reason(self):
        for fields in listed():
            self.assertEqual(len(fields), 3, fields)

    def test_no_package_is_listed_twice(self):
        packages = [fields[0] for fields in listed()]
        self.assertEqual(sorted(set(packages)), sorted(packages))

    def test_keys_are_those_of_package_xml(self):
        keys = {fields[1] for fields in listed()} - {"-"}
        package = xml.etree.ElementTree.parse(ROOT / "package.xml").getroot()
        # Noetic has its own packages of some libraries, under other keys. MoveIt is optional.
        declared = {element.text for element in package
                    if element.tag.endswith("depend") and
                    element.get("condition") not in ("$ROS_DISTRO == noetic", "$WITH_MOVEIT == 1")}
        self.assertEqual(keys, declared)

    def test_only_moveit_is_optional(self):
        package = xml.etree.ElementTree.parse(ROOT / "package.xml").getroot()
        self.assertEqual(["moveit_core", "moveit_msgs"], [element.text for element in package
                                           if "WITH_MOVEIT" in element.get("condition", "")])

    def test_catkin_packages_that_cmake_asks_for_are_declared(self):
        text = (ROOT / "cmake" / "ros.cmake").read_text()
        components = text.split("find_package(catkin REQUIRED COMPONENTS", 1)[1].split(")", 1)[0].split()
        self.assertLessEqual(set(components), {fields[1] for fields in listed()})

    def test_version_is_the_same_everywhere(self):
        version = xml.etree.ElementTree.parse(ROOT / "package.xml").getroot().findtext("version")
        self.assertIn(f"project(gpu_planning_scene VERSION {version} ", (ROOT / "CMakeLists.txt").read_text())
        self.assertIn(version, (ROOT / "CHANGELOG.rst").read_text())


if __name__ == "__main__":
    unittest.main()
