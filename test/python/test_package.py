"""The package beside ROS's messages of the same name, its type stub and its docstrings."""
import ast
import inspect
import os
import pathlib
import re
import subprocess
import sys
import unittest

import gpu_planning_scene as gps

STUB = pathlib.Path(gps.__file__).with_name("__init__.pyi")


def run(program):
    return subprocess.run([sys.executable, "-B", "-c", program], capture_output=True, text=True, timeout=100, check=False)


def stubs():
    """The classes and functions of the stub, by name."""
    tree = ast.parse(STUB.read_text())
    return {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}


def stub_parameters(function):
    """The names of the parameters, and whether they have a default."""
    arguments = function.args.args
    without = len(arguments) - len(function.args.defaults)
    return [(each.arg, i >= without) for i, each in enumerate(arguments) if each.arg != "self"]


def parameters(function):
    """The same from the first line of a docstring of pybind11: NAME(self: X, a: int, b: str = '') -> Y"""
    signature = function.__doc__.splitlines()[0].partition("(")[2].rpartition(")")[0]
    parts = re.split(r", (?=\w+: )", signature)
    return [(part.partition(":")[0], " = " in part) for part in parts if part and not part.startswith("self: ")]


def members(value):
    return {name for name in vars(value) if not name.startswith("_")}


def documented():
    """Each function and property of the package, with its name."""
    for name in gps.__all__:
        value = getattr(gps, name)
        yield name, value
        if inspect.isclass(value) and name not in ("IkStatus", "JointType", "PlanningStatus"):
            yield from ((f"{name}.{member}", getattr(value, member)) for member in members(value))


class Package(unittest.TestCase):
    @unittest.skipUnless("GPS_WITH_MESSAGES" in os.environ, "built without ROS")
    def test_messages_and_module_are_one_package(self):
        for program in (
            "from gpu_planning_scene.srv import CheckStates; import gpu_planning_scene; gpu_planning_scene.RobotModel",
            "import gpu_planning_scene; gpu_planning_scene.RobotModel; from gpu_planning_scene.msg import PlanningScene",
            "from gpu_planning_scene import RobotModel, srv",
        ):
            answer = run(program)
            self.assertEqual((0, ""), (answer.returncode, answer.stderr))

    def test_the_libraries_are_loaded_only_when_they_are_used(self):
        for program, loaded in (("import gpu_planning_scene", False), ("from gpu_planning_scene import Box", True)):
            answer = run(program + '; print("libgpu_planning_scene_collision" in open("/proc/self/maps").read())')
            self.assertEqual((f"{loaded}\n", ""), (answer.stdout, answer.stderr))

    def test_an_unknown_name_is_an_attribute_error(self):
        with self.assertRaisesRegex(AttributeError, "no attribute 'RobotModle'"):
            gps.RobotModle
        self.assertLessEqual(set(gps.__all__), set(dir(gps)))

    def test_the_package_has_all_names_of_the_module(self):
        core = sys.modules[gps.Box.__module__]
        self.assertEqual(members(core), set(gps.__all__))

    def test_the_stub_names_what_the_package_has(self):
        self.assertEqual(set(gps.__all__), set(stubs()))
        for name, stub in stubs().items():
            value = getattr(gps, name)
            if isinstance(stub, ast.FunctionDef):
                self.assertEqual(parameters(value), stub_parameters(stub), name)
                continue
            if name in ("Error", "DeviceLost"):
                continue
            found = {node.name: node for node in stub.body if isinstance(node, ast.FunctionDef)}
            fields = {node.target.id for node in stub.body if isinstance(node, ast.AnnAssign)}
            self.assertEqual(members(value), {each for each in found if not each.startswith("_")} | fields, name)
            for member, function in found.items():
                in_class = inspect.getattr_static(value, member)
                is_property = any(getattr(each, "id", getattr(each, "attr", "")) in ("property", "setter")
                                  for each in function.decorator_list)
                self.assertEqual(isinstance(in_class, property), is_property, f"{name}.{member}")
                if not is_property and not member.startswith("__"):
                    self.assertEqual(parameters(getattr(value, member)), stub_parameters(function), f"{name}.{member}")
            if "__init__" in found:
                self.assertEqual(parameters(value.__init__), stub_parameters(found["__init__"]), name)

    def test_each_class_and_function_has_a_docstring(self):
        undocumented = []
        for name, value in documented():
            text = value.__doc__ or ""
            if not isinstance(value, (property, type)):
                text = text.partition("\n")[2]  # the first line is the signature
            if not text.strip() and name.rpartition(".")[2] not in (
                    "name", "id", "group", "robot", "revision", "type", "child_link", "mimic", "states", "renderer",
                    "version", "object", "status", "planning_seconds", "simplification_seconds", "states_checked"):
                undocumented.append(name)
        self.assertEqual([], undocumented)

    def test_the_package_has_a_marker_for_type_checkers(self):
        self.assertTrue(STUB.with_name("py.typed").exists())


if __name__ == "__main__":
    unittest.main()
