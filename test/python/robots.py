"""The robots and scenes of the tests."""
import contextlib
import os
import pathlib
import tempfile
import unittest

import gpu_planning_scene as gps

ROOT = pathlib.Path(__file__).resolve().parents[2]
KR5 = pathlib.Path(os.environ["GPS_DART_DATA_DIR"], "urdf", "KR5", "KR5 sixx R650.urdf")
KR5_SCENE = ROOT / "config" / "demo" / "kr5_scene.yaml"
ARM = ROOT / "config" / "demo" / "arm.urdf"
ARM_SCENE = ROOT / "config" / "demo" / "arm_scene.yaml"
SANITIZED = "GPS_SANITIZED" in os.environ
# A ball on a rail along x: at slide = 0, it is at the origin.
RAIL = """<robot name="rail">
  <link name="rail"/>
  <link name="ball"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="slide" type="prismatic">
    <parent link="rail"/><child link="ball"/><axis xyz="1 0 0"/><limit lower="-10" upper="10" effort="1" velocity="1"/>
  </joint>
</robot>"""
RAIL_XACRO = RAIL.replace('radius="0.1"', 'radius="${radius}"')  # EXPAND makes RAIL of it
EXPAND = "sed 's/${radius}/0.1/' \"$1\""
RAIL_SRDF = '<robot name="rail"><group name="all"><joint name="slide"/></group></robot>'


def kr5():
    if not KR5.exists():
        raise unittest.SkipTest("Debian's dart-doc is not here")
    return gps.RobotModel.from_files(KR5)


def kr5_scene():
    robot = kr5()
    return gps.load_scene_file(KR5_SCENE, robot, packages={"KR5": KR5.parent})


def arm():
    return gps.RobotModel.from_files(ARM, ARM.with_suffix(".srdf"))


def arm_scene():
    return gps.load_scene_file(ARM_SCENE, arm())


def rail():
    return gps.RobotModel.from_xml(RAIL, RAIL_SRDF)


@contextlib.contextmanager
def xacro(script):
    """A script with the name xacro comes first on PATH. Yields its path."""
    before = os.environ["PATH"]
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder, "xacro")
        program.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
        program.chmod(0o700)
        os.environ["PATH"] = f"{folder}:{before}"
        try:
            yield program
        finally:
            os.environ["PATH"] = before


class Case(unittest.TestCase):
    def assert_one_line(self, error, pattern, call, *arguments, **keywords):
        """The call raises this error, and its message is one line that contains the pattern."""
        with self.assertRaisesRegex(error, pattern) as raised:
            call(*arguments, **keywords)
        self.assertNotIn("\n", str(raised.exception))
