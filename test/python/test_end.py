"""The end of a process waits for no proof, although it could take minutes to make one."""
import os
import pathlib
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest

import numpy as np

import gpu_planning_scene as gps

SOON = 2.0  # seconds, also on a busy machine
TRIANGLES = 6000
# The inner shell turns within the outer one, and their joint table has no easy cell. The two balls collide in all states
# that are checked, so that these checks are fast.
SHELLS = """<robot name="shells">
  <link name="outside"><collision><geometry><mesh filename="outer.obj"/></geometry></collision></link>
  <link name="ring"/>
  <link name="inside"><collision><geometry><mesh filename="inner.obj"/></geometry></collision></link>
  <link name="first"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="second"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="turn" type="continuous"><parent link="outside"/><child link="ring"/><axis xyz="0 0 1"/></joint>
  <joint name="tilt" type="continuous"><parent link="ring"/><child link="inside"/><axis xyz="0 1 0"/></joint>
  <joint name="hold" type="fixed"><parent link="outside"/><child link="first"/><origin xyz="2 0 0"/></joint>
  <joint name="lift" type="prismatic"><parent link="outside"/><child link="second"/><origin xyz="2 0 0"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
</robot>"""


def shell(radius):
    """The text of an OBJ file: a sphere without its last rows of triangles."""
    rows = int(np.sqrt(TRIANGLES / 4))
    columns = 2 * rows
    along, around = np.meshgrid(np.linspace(0.0, np.pi, rows + 1),
                                np.linspace(0.0, 2 * np.pi, columns, endpoint=False), indexing="ij")
    points = radius * np.stack([np.sin(along) * np.cos(around), np.sin(along) * np.sin(around), np.cos(along)], axis=-1)
    lines = [f"v {x:.9f} {y:.9f} {z:.9f}" for x, y, z in points.reshape(-1, 3)]
    for row in range(1, rows - 2):
        for column in range(columns):
            right = (column + 1) % columns
            a, b, c, d = (1 + row * columns + column, 1 + (row + 1) * columns + column, 1 + (row + 1) * columns + right,
                          1 + row * columns + right)
            lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    return "\n".join(lines) + "\n"


def make_proofs(folder):
    """The child process: checks states until a table is being made. Prints the time of its end."""
    robot = gps.RobotModel.from_files(pathlib.Path(folder, "shells.urdf"))
    robot = robot.with_solids({"outside": "surface", "inside": "surface"})
    checker = gps.StateChecker(gps.PlanningScene(robot), device="cpu")
    states = robot.random_states(25000, seed=1)
    states[:, robot.variable_names.index("lift")] = 0.0
    assert not checker.check(states).valid.any()
    end = time.monotonic() + 60.0
    while all(stage.by == "the exact checker alone" for stage in checker.report().decided):
        assert time.monotonic() < end, "there are no balls, after which the tables come"
        time.sleep(0.01)
        checker.check(states[:256])
    print(time.monotonic(), flush=True)


class End(unittest.TestCase):
    def test_a_forked_child_ends(self):
        program = textwrap.dedent(f"""
            import os, sys
            sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
            import gpu_planning_scene as gps
            from robots import arm_scene
            checker = gps.StateChecker(arm_scene(), device="cpu")
            states = checker.scene.robot.random_states(2000, seed=1)
            valid = checker.check(states).valid.tolist()
            child = os.fork()
            if child == 0:
                own = gps.StateChecker(arm_scene(), device="cpu")
                found = [each.check(states[:100]).valid.tolist() for each in (checker, own)]
                sys.exit(0 if found == [valid[:100]] * 2 else 1)
            sys.exit(os.WEXITSTATUS(os.waitpid(child, 0)[1]))
        """)
        subprocess.run([sys.executable, "-c", program], check=True, timeout=100)

    def test_python_ends_soon_while_a_table_is_made(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "shells.urdf").write_text(SHELLS, encoding="utf-8")
            pathlib.Path(folder, "outer.obj").write_text(shell(0.3), encoding="utf-8")
            pathlib.Path(folder, "inner.obj").write_text(shell(0.29), encoding="utf-8")
            ended = subprocess.run([sys.executable, "-B", __file__, folder], check=True, stdout=subprocess.PIPE,
                                   text=True, timeout=250)
            self.assertLess(time.monotonic() - float(ended.stdout), SOON)


if __name__ == "__main__":
    if len(sys.argv) == 2 and os.path.isdir(sys.argv[1]):
        make_proofs(sys.argv[1])
    else:
        unittest.main()
