"""Bulk runs on this machine: verdicts, inputs, files, a killed run, plans, errors, and bundles without their files."""
import contextlib
import io
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import textwrap
import unittest

import numpy as np

import gpu_planning_scene as gps
from bulk_runs import ARM_OPTIONS, bulk, content, shards, started_bulk, wait_for_shards
from gpu_planning_scene.bulk import RobotBundle, SceneBundle
from gpu_planning_scene.bulk.run import Job, Scene
from gpu_planning_scene.bulk.shards import VerdictFiles
from gpu_planning_scene.bulk.states import BLOCK, PART, RandomSlice, RandomStates
from robots import (ARM, ARM_SCENE, EXPAND, KR5, KR5_SCENE, RAIL, RAIL_SRDF, RAIL_XACRO, ROOT, Case, arm, arm_scene,
                    kr5, kr5_scene, xacro)

TETRAHEDRON = """ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 4
property list uchar int vertex_indices
end_header
0 0 0
0.2 0 0
0 0.2 0
0 0 0.2
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
"""


def verdicts_of_the_tool(robot, states, folder, *options):
    """The verdicts of the tool check_states for states in a table."""
    table = pathlib.Path(folder, "states.csv")
    np.savetxt(table, states, delimiter=",", header=",".join(robot.variable_names), comments="", fmt="%.17g")
    answer = subprocess.run([os.environ["GPS_CHECK_STATES"], *options, "--states", table, "--device", "cpu"],
                            capture_output=True, text=True, timeout=200, check=True)
    return [line[0] == "1" for line in answer.stdout.splitlines()[1:]]


class Folder(Case):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.out = self.folder / "out"

    def succeed(self, *options):
        status, line, warnings = bulk(*options)
        self.assertEqual((0, ""), (status, warnings), line)
        return line

    def assert_error(self, pattern, *options, status=1):
        """The run ends with one line."""
        found, line, warnings = bulk(*options)
        self.assertEqual((status, ""), (found, warnings), line)
        self.assertNotIn("\n", line)
        self.assertRegex(line, pattern)

    def arm_run(self, *options):
        return self.succeed(*ARM_OPTIONS, "--out", self.out, *options)

    def verdicts(self, scene=ARM_SCENE.name):
        return np.concatenate([np.load(each) for each in shards(self.out) if each.parent.name == scene])


class Checks(Folder):
    def test_verdicts_are_those_of_the_tool(self):
        robot = kr5()
        options = ["--urdf", KR5, "--package", f"KR5={KR5.parent}", "--scene", KR5_SCENE]
        self.succeed(*options, "--device", "cpu", "--out", self.out, "--random", 3000, "--seed", 5, "--shard", 1000,
                     "--with-states")
        rows = self.verdicts(KR5_SCENE.name)
        self.assertEqual((3000, 3), (len(rows), len(shards(self.out))))
        expected = verdicts_of_the_tool(robot, rows["state"], self.folder, *options)
        np.testing.assert_array_equal(expected, rows["valid"])
        self.assertTrue(500 < sum(expected) < 2500)

    def test_the_index_describes_the_shards(self):
        line = self.arm_run("--random", 250, "--shard", 100)
        index = json.loads((self.out / "index.json").read_text())
        self.assertEqual([100, 100, 50], [each["states"] for each in index["shards"]])
        self.assertEqual([each["file"] for each in index["shards"]],
                         [str(each.relative_to(self.out)) for each in shards(self.out)])
        valid = [int(np.load(self.out / each["file"]).sum()) for each in index["shards"]]
        self.assertEqual(valid, [each["valid"] for each in index["shards"]])
        self.assertIn(f"250 states, {sum(valid)} valid; 3 of 3 shards computed now", line)
        self.assertFalse((self.out / "journal").exists())

    def test_the_order_of_the_names_is_that_of_the_shards(self):
        scenes = [Scene(SceneBundle("scene", "", (), ""), None)]
        names = Job(None, scenes, RandomStates(1000001, seed=0), 1, VerdictFiles(".npy", [], False)).names()
        self.assertLess(names[999999], names[1000000])

    def test_random_states_do_not_depend_on_the_shards(self):
        robot = arm()
        whole = RandomSlice(7, 0, 3 * BLOCK, False).states(robot, None)
        self.assertEqual((3 * BLOCK, 7), whole.shape)
        self.assertEqual(3 * BLOCK, len(np.unique(whole, axis=0)))
        for first, count in ((0, 1), (BLOCK - 1, 2), (100, 2 * BLOCK), (2 * BLOCK, BLOCK), (5, 0)):
            np.testing.assert_array_equal(whole[first:first + count],
                                          RandomSlice(7, first, count, False).states(robot, None))
        parts = [part.copy() for part in RandomSlice(7, 5, 2 * PART + 100, False).parts(robot, None)]
        self.assertEqual([PART, PART, 100], list(map(len, parts)))
        np.testing.assert_array_equal(RandomSlice(7, 5, 2 * PART + 100, False).states(robot, None), np.concatenate(parts))
        np.testing.assert_array_equal(whole[5:], np.concatenate(parts)[:3 * BLOCK - 5])
        lower, upper = np.array([(each.lower, each.upper) for each in robot.variables]).T
        self.assertTrue(((whole >= lower) & (whole <= upper)).all())
        np.testing.assert_allclose(np.ptp(whole, axis=0), upper - lower, rtol=1e-2)
        self.assertFalse((whole[:BLOCK] == RandomSlice(8, 0, BLOCK, False).states(robot, None)).any())

    def test_files_of_states_are_checked(self):
        robot, scene = arm(), arm_scene()
        states = robot.random_states(300, seed=3)
        expected = gps.StateChecker(scene, device="cpu").check(states).valid
        np.save(self.folder / "states.npy", np.asfortranarray(states))
        self.arm_run("--states", self.folder / "states.npy", "--shard", 70)
        np.testing.assert_array_equal(expected, self.verdicts())

        # Columns in another order; the missing one has its value from the scene.
        states[:, 1] = scene.current_state[1]
        expected = gps.StateChecker(scene, device="cpu").check(states).valid
        order = [6, 0, 2, 3, 4, 5]
        np.savetxt(self.folder / "states.csv", states[:, order], delimiter=",", fmt="%.17g", comments="",
                   header=",".join(robot.variable_names[i] for i in order))
        self.out = self.folder / "table"
        self.arm_run("--states", self.folder / "states.csv", "--shard", 70)
        np.testing.assert_array_equal(expected, self.verdicts())

    def test_long_tables_are_read_from_their_middle(self):
        robot, scene = arm(), arm_scene()
        states = robot.random_states(9000, seed=4)
        np.savetxt(self.folder / "states.csv", states, delimiter=",", fmt="%.17g", comments="",
                   header=",".join(robot.variable_names))
        self.arm_run("--states", self.folder / "states.csv", "--shard", 5000)
        np.testing.assert_array_equal(gps.StateChecker(scene, device="cpu").check(states).valid, self.verdicts())

    def test_all_scenes_of_a_folder_are_checked(self):
        scenes = self.folder / "scenes"
        scenes.mkdir()
        text = ARM_SCENE.read_text()
        (scenes / "a.yaml").write_text(text)
        (scenes / "b.yaml").write_text(text.replace("[0.5, 0.9, 0.24]", "[0.5, 0.9, 0.4]"))
        (scenes / "notes.txt").write_text("no scene")
        self.succeed("--urdf", ARM, "--srdf", ARM.with_suffix(".srdf"), "--scene", scenes, "--out", self.out,
                     "--random", 500, "--shard", 200, "--device", "cpu")
        robot = arm()
        counts = []
        for name in ("a.yaml", "b.yaml"):
            scene = gps.load_scene_file(scenes / name, robot)
            states = RandomSlice(0, 0, 500, False).states(robot, scene.current_state)
            expected = gps.StateChecker(scene, device="cpu").check(states).valid
            np.testing.assert_array_equal(expected, self.verdicts(name))
            counts.append(expected.sum())
        self.assertGreater(counts[0], counts[1])
        self.assertEqual({"a.yaml", "b.yaml"}, {each.parent.name for each in shards(self.out)})

    def test_a_group_leaves_out_the_other_pairs(self):
        self.arm_run("--random", 500, "--group", "gripper")
        states = RandomSlice(0, 0, 500, False).states(arm(), arm_scene().current_state)
        checker = gps.StateChecker(arm_scene(), device="cpu")
        np.testing.assert_array_equal(checker.check(states, "gripper").valid, self.verdicts())
        self.assertTrue((checker.check(states).valid != self.verdicts()).any())

    def test_the_floating_base_moves_only_on_request(self):
        (self.folder / "rail.urdf").write_text(RAIL)
        (self.folder / "rail.srdf").write_text(RAIL_SRDF.replace(
            "</robot>", '<virtual_joint name="base" type="planar" parent_frame="world" child_link="rail"/></robot>'))
        (self.folder / "scene.yaml").write_text("world: {collision_objects: []}")
        common = ["--urdf", self.folder / "rail.urdf", "--srdf", self.folder / "rail.srdf", "--scene",
                  self.folder / "scene.yaml", "--device", "cpu", "--random", 50, "--with-states"]
        for option, moves in (([], False), (["--random-base"], True)):
            self.out = self.folder / f"moves {moves}"
            self.succeed(*common, *option, "--out", self.out)
            base = self.verdicts("scene.yaml")["state"][:, :3]
            self.assertEqual(moves, bool((base != 0).any()))


class Resume(Folder):
    def test_a_killed_run_goes_on_without_a_finished_shard(self):
        options = [*ARM_OPTIONS, "--random", 100 * 180, "--shard", 180, "--seed", 2]
        self.succeed(*options, "--out", self.folder / "whole")
        run = started_bulk(*options, "--out", self.out)
        wait_for_shards(self.out, 5, run)
        run.send_signal(signal.SIGKILL)
        run.communicate(timeout=60)
        finished = {each: (each.stat().st_ino, each.stat().st_mtime_ns) for each in shards(self.out)}
        self.assertTrue(5 <= len(finished) < 100, len(finished))
        line = self.succeed(*options, "--out", self.out)
        self.assertIn(f"; {100 - len(finished)} of 100 shards computed now", line)
        self.assertEqual(finished, {each: (each.stat().st_ino, each.stat().st_mtime_ns) for each in finished})
        self.assertTrue(content(self.folder / "whole") == content(self.out))
        self.assertIn("; 0 of 100 shards computed now", self.succeed(*options, "--out", self.out))
        self.assertTrue(content(self.folder / "whole") == content(self.out))

    def test_a_shard_that_was_cut_off_is_computed_again(self):
        self.arm_run("--random", 300, "--shard", 100)
        before = content(self.out)
        whole = shards(self.out)[1].read_bytes()
        with io.BytesIO() as shorter:
            np.save(shorter, np.zeros(99, bool))
            contents = [b"", whole[:50], whole[:200], shorter.getvalue()]
        for wrong in contents:
            shards(self.out)[1].write_bytes(wrong)
            self.assertIn("; 1 of 3 shards", self.arm_run("--random", 300, "--shard", 100))
            self.assertEqual(before, content(self.out))

    def test_another_run_is_refused(self):
        self.arm_run("--random", 300)
        before = content(self.out)
        scene = self.folder / ARM_SCENE.name
        scene.write_text(ARM_SCENE.read_text().replace("0.25, 0.311", "0.26, 0.311"))
        urdf = self.folder / ARM.name
        urdf.write_text(ARM.read_text().replace("<robot", "<!-- changed --><robot", 1))
        for options, what in (
            (["--random", 301], "input"),
            (["--random", 300, "--seed", 1], "input"),
            (["--random", 300, "--group", "gripper"], "options"),
            (["--random", 300, "--with-states"], "options"),
            (["--random", 300, "--shard", 100], "shard size"),
            (["--random", 300, "--scene", scene], "scenes"),
            (["--random", 300, "--urdf", urdf], "robot"),
        ):
            self.assert_error(f"index.json: the folder holds a run with another {what}; choose another --out",
                              *ARM_OPTIONS, "--out", self.out, *options)
        self.assertEqual(before, content(self.out))

    def test_a_folder_with_other_files_is_refused(self):
        self.out.mkdir()
        (self.out / "thesis.txt").write_text("")
        self.assert_error("no index.json, but other files .thesis.txt", *ARM_OPTIONS, "--out", self.out, "--random", 3)

    def test_two_runs_do_not_share_a_folder(self):
        options = [*ARM_OPTIONS, "--random", 10**8, "--shard", 5000, "--out", self.out]
        run = started_bulk(*options)
        try:
            wait_for_shards(self.out, 1, run)
            self.assert_error("another process writes into this folder", *options)
        finally:
            run.kill()
            run.communicate()

    def test_ctrl_c_ends_a_run_with_one_line(self):
        run = started_bulk(*ARM_OPTIONS, "--random", 10**8, "--shard", 5000, "--out", self.out, "--progress")
        wait_for_shards(self.out, 1, run)
        run.send_signal(signal.SIGINT)
        out, err = run.communicate(timeout=60)
        self.assertEqual((130, ""), (run.returncode, out))
        self.assertNotIn("Traceback", err)
        self.assertEqual("gpu_planning_scene.bulk: interrupted; start the same command again to go on",
                         err.splitlines()[-1])
        self.assertRegex(err, r"\[#* *\] +0 %, [0-9,]+ states/s, [0-9:]+ left, 1 worker")


class Plans(Folder):
    def problems(self, count):
        """Pairs on both sides of the post, and one start that collides with it."""
        starts = np.tile([0.7, 0.6, 0.6, 0, 0.6, 0, 0.03], (count, 1)) + 0.03 * np.arange(count)[:, None]
        goals = np.tile([2.5, 0.6, 0.6, 0, 0.6, 0, 0.03], (count, 1)) - 0.02 * np.arange(count)[:, None]
        starts[:, 6] = goals[:, 6] = 0.03  # not in the group
        starts[1, 0] = 1.4
        np.savez(self.folder / "problems.npz", start=starts, goal=goals)
        return starts, goals

    def plan(self, out, *options):
        return self.succeed(*ARM_OPTIONS, "--plans", self.folder / "problems.npz", "--group", "arm", "--shard", 3,
                            "--out", self.folder / out, "--seed", 4, *options)

    def test_plans_solve_their_problems_and_are_repeated(self):
        starts, goals = self.problems(5)
        self.plan("a")
        files = [np.load(each) for each in shards(self.folder / "a")]
        status = np.concatenate([each["status"] for each in files])
        paths = [path for each in files for path in np.split(each["waypoints"], each["ends"][:-1])]
        self.assertEqual(5, len(paths))
        self.assertEqual(gps.PlanningStatus.START_IN_COLLISION.value, status[1])
        self.assertEqual(4, (status == gps.PlanningStatus.SOLVED.value).sum())
        self.assertTrue(all(len(path) > 2 for path, each in zip(paths, status) if each == 0))
        motions = gps.MotionChecker(gps.StateChecker(arm_scene(), device="cpu"), "arm", "bound")
        for i, path in enumerate(paths):
            if status[i] != gps.PlanningStatus.SOLVED.value:
                self.assertEqual(0, len(path))
                continue
            np.testing.assert_array_equal(starts[i], path[0])
            np.testing.assert_allclose(goals[i], path[-1], atol=1e-9)
            self.assertTrue(motions.check(path[:-1], path[1:]).valid.all())
        self.plan("b")
        self.assertTrue(content(self.folder / "a") == content(self.folder / "b"))
        self.plan("c", "--seed", 5)
        self.assertTrue(shards(self.folder / "a")[0].read_bytes() != shards(self.folder / "c")[0].read_bytes())

    def test_a_search_ends_after_its_rounds(self):
        self.problems(2)
        self.plan("out", "--max-rounds", 1)
        with np.load(shards(self.folder / "out")[0]) as arrays:
            self.assertIn(gps.PlanningStatus.NO_SOLUTION.value, arrays["status"])

    def test_wrong_problems_are_errors(self):
        options = [*ARM_OPTIONS, "--out", self.out, "--plans", self.folder / "problems.npz"]
        self.assert_error("needs --group", *options, status=2)
        self.assert_error("problems.npz", *options, "--group", "arm")
        np.savez(self.folder / "problems.npz", start=np.zeros((3, 7)), goal=np.zeros((2, 7)))
        self.assert_error("the array goal has shape .2, 7.", *options, "--group", "arm")
        self.assert_error("no group 'legs'", *options, "--group", "legs")
        np.savez(self.folder / "problems.npz", start=np.zeros((3, 7)))
        self.assert_error("not an .npz file with the arrays start and goal", *options, "--group", "arm")
        goal = np.zeros((3, 7))
        goal[1, 2] = np.nan
        np.savez(self.folder / "problems.npz", start=np.zeros((3, 7)), goal=goal)
        self.assert_error("the array goal has values that are not finite", *options, "--group", "arm")
        goal[1] = 0.01
        np.savez(self.folder / "problems.npz", start=np.zeros((3, 7)), goal=goal)
        self.assert_error("problem 1: grip differs between start and goal, but group 'arm' does not plan for it",
                          *options, "--group", "arm")


class Errors(Folder):
    def test_the_program_prints_a_summary_or_an_error(self):
        for options, status, lines in (
            (["--random", 50], 0, ["50 states, [0-9]+ valid; 1 of 1 shards .*", ""]),
            (["--random", 51], 1, ["", "gpu_planning_scene.bulk: .*another input.*"]),
            (["--random", "x"], 2, ["", "gpu_planning_scene.bulk: .*'x' is not a whole number.*"]),
        ):
            run = started_bulk(*ARM_OPTIONS, "--out", self.out, *options)
            out = run.communicate(timeout=100)
            self.assertEqual(status, run.returncode, out)
            for pattern, text in zip(lines, out):
                self.assertRegex(text, rf"\A{pattern}\n?\Z")

    def test_wrong_options_are_one_line(self):
        for pattern, *options in (
            ("required: .*--urdf", "--random", 3),
            ("one of the arguments --states --random --plans is required", *ARM_OPTIONS, "--out", self.out),
            ("'many' is not a whole number", *ARM_OPTIONS, "--out", self.out, "--random", "many"),
            ("must be at least 1", *ARM_OPTIONS, "--out", self.out, "--random", 0),
            ("2 is not from 0 to 1", *ARM_OPTIONS, "--out", self.out, "--random", 3, "--check-twice", 2),
            ("must end in .npy or .csv", *ARM_OPTIONS, "--out", self.out, "--states", "states.mat"),
            ("write NAME=DIR", *ARM_OPTIONS, "--out", self.out, "--random", 3, "--package", "x"),
            ("--random-base has no effect", *ARM_OPTIONS, "--out", self.out, "--states", "a.npy", "--random-base"),
        ):
            self.assert_error(pattern, *options, status=2)

    def test_wrong_inputs_are_one_line(self):
        names = ",".join(arm().variable_names)
        files = {
            "text.npy": "text", "short.csv": f"{names}\n1,2\n", "word.csv": f"{names}\n" + "0,0,0,0,0,0,0\n" * 3 +
            "0,0,x,0,0,0,0\n", "name.csv": "elbow,legs\n0,0\n", "empty.csv": "", "none.csv": names + "\n",
            "infinite.csv": f"{names}\n" + "0,0,0,0,0,0,0\n" * 20 + "0,0,inf,0,0,0,0\n"}
        for name, text in files.items():
            (self.folder / name).write_text(text)
        np.save(self.folder / "wide.npy", np.zeros((2, 8)))
        for name, pattern in (
            ("absent.npy", "No such file.*absent.npy"), ("text.npy", "text.npy: not an .npy file"),
            ("wide.npy", r"wide.npy: the array has shape \(2, 8\)"),
            ("short.csv", "short.csv:2: 2 values for 7 variables"),
            ("word.csv", "word.csv:5: 'x' is not a number"), ("name.csv", "name.csv:1: column 2: 'legs'"),
            ("empty.csv", "empty.csv:1: "), ("none.csv", "none.csv: the file has no states"),
            ("infinite.csv", "states 20 to 20: state 0: the value of variable 'elbow'"),
        ):
            self.assert_error(pattern, *ARM_OPTIONS, "--out", self.folder / f"out {name}", "--shard", 10, "--states",
                              self.folder / name)
        (self.folder / "empty").mkdir()
        self.assert_error("the folder has no scene file", *ARM_OPTIONS, "--scene", self.folder / "empty", "--out",
                          self.out, "--random", 3)
        self.assert_error("warp drive", *ARM_OPTIONS[:-1], "warp drive", "--out", self.out, "--random", 3)


class Document(Folder):
    def test_the_first_command_and_the_program_that_reads_its_output(self):
        text = (ROOT / "docs" / "bulk.md").read_text(encoding="utf-8")
        blocks = re.findall(r"(?:^    .*\n|^\n(?=    ))+", text, flags=re.MULTILINE)
        command, = [block for block in blocks if "--random 1000000" in block]
        program, = [textwrap.dedent(block) for block in blocks if "import pathlib" in block]
        words = shlex.split(command.replace("\\\n", " ").replace("1000000", "1000"))
        self.assertEqual(["python3", "-m", "gpu_planning_scene.bulk"], words[:3])
        (self.folder / "config").symlink_to(ROOT / "config")
        run = subprocess.run([sys.executable, "-B", *words[1:]], cwd=self.folder, capture_output=True, text=True,
                             timeout=200, check=False)
        self.assertEqual(0, run.returncode, run.stderr)
        read = subprocess.run([sys.executable, "-B", "-c", program + "print(len(valid), valid.sum())"], cwd=self.folder,
                              capture_output=True, text=True, timeout=200, check=False)
        count, good = read.stdout.split()
        self.assertIn(f"{int(count):,} states, {good} valid; ", run.stdout)


class Bundles(Folder):
    def scene_with_files(self):
        """A robot and a scene with meshes by package, relative and absolute paths, and an octomap."""
        meshes = self.folder / "parts" / "meshes"
        meshes.mkdir(parents=True)
        for name in ("base.ply", "tool.ply", "near.ply", "far.ply"):
            (meshes / name).write_text(TETRAHEDRON)
        urdf = self.folder / "parts" / "robot.urdf"
        urdf.write_text(RAIL.replace(
            '<link name="rail"/>',
            '<link name="rail"><collision><geometry><mesh filename="meshes/tool.ply"/></geometry></collision></link>'
        ).replace("</collision></link>\n  <joint", """</collision>
            <collision><origin xyz="0 1 0"/><geometry><mesh filename="package://parts/meshes/base.ply"/></geometry>
            </collision></link><joint"""))
        scene = self.folder / "parts" / "scene.yaml"
        scene.write_text(f"""world:
  collision_objects:
    - {{id: near, meshes: [{{resource: meshes/near.ply}}], mesh_poses: [{{position: [2, 0, 0]}}]}}
    - id: far
      meshes: [{{resource: "file://{meshes}/far.ply", scale: [3, 3, 3]}}]
      mesh_poses: [{{position: [-4, 0, 0]}}]
""")
        return urdf, scene, {"parts": self.folder / "parts"}

    def test_a_bundle_has_all_files(self):
        urdf, path, packages = self.scene_with_files()
        robot = gps.RobotModel.from_files(urdf, packages=packages)
        states = robot.random_states(2000, seed=1)
        expected = gps.StateChecker(gps.load_scene_file(path, robot, packages), device="cpu").check(states).valid
        self.assertEqual({True, False}, set(expected.tolist()))
        robot_bundle = RobotBundle.from_files(urdf, packages=packages)
        scene_bundle = SceneBundle.from_file(path, robot, packages)
        self.assertEqual((2, 2), (len(robot_bundle.files), len(scene_bundle.files)))
        shutil.rmtree(self.folder / "parts")
        scene = scene_bundle.load(robot_bundle.load())
        np.testing.assert_array_equal(expected, gps.StateChecker(scene, device="cpu").check(states).valid)

    def test_a_bundle_has_the_expanded_text_of_a_xacro_file(self):
        urdf = self.folder / "rail.urdf.xacro"
        urdf.write_text(RAIL_XACRO, encoding="utf-8")
        runs = self.folder / "runs"
        with xacro(f"echo \"$1\" >> '{runs}'; {EXPAND}"), contextlib.redirect_stderr(io.StringIO()) as printed:
            bundle = RobotBundle.from_files(urdf)
        self.assertEqual([str(urdf)], runs.read_text().splitlines(), "xacro runs once")
        self.assertEqual(1, len(printed.getvalue().splitlines()))
        self.assertEqual(RAIL, bundle.urdf)
        self.assertEqual("rail", bundle.load().name)

    def test_the_digest_is_that_of_the_content(self):
        urdf, path, packages = self.scene_with_files()

        def digests():
            bundle = RobotBundle.from_files(urdf, packages=packages)
            return bundle.digest, SceneBundle.from_file(path, bundle.load(), packages).digest

        robot, scene = digests()
        self.assertEqual((robot, scene), digests())
        mesh = self.folder / "parts" / "meshes" / "far.ply"
        mesh.write_text(TETRAHEDRON.replace("0 0.2 0", "0 0.3 0"))
        self.assertEqual((robot, True), (digests()[0], digests()[1] != scene))
        (self.folder / "parts" / "meshes" / "tool.ply").write_text(TETRAHEDRON.replace("0 0.2 0", "0 0.3 0"))
        self.assertNotEqual(robot, digests()[0])

    def test_the_kr5_has_its_meshes(self):
        packages = {"KR5": KR5.parent}
        kr5()
        bundle = RobotBundle.from_files(KR5, packages=packages)
        states = kr5_scene().robot.random_states(500, seed=2)
        scene = SceneBundle.from_file(KR5_SCENE, bundle.load(), packages).load(bundle.load())
        np.testing.assert_array_equal(gps.StateChecker(kr5_scene(), device="cpu").check(states).valid,
                                      gps.StateChecker(scene, device="cpu").check(states).valid)


if __name__ == "__main__":
    unittest.main()
