"""StateChecker: answers, layouts of arrays, devices, reports, errors, threads, memory, Ctrl-C."""
import contextlib
import ctypes
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
from unittest import mock

import numpy as np

import gpu_planning_scene as gps
from robots import Case, KR5, KR5_SCENE, ROOT, SANITIZED, arm_scene, kr5_scene, rail
from signals import pressed_during_a_call


def answers_of_the_tool(count, seed, device):
    """The rows (valid, body_1, body_2) of the tool check_states."""
    with tempfile.NamedTemporaryFile(suffix=".csv") as out:
        subprocess.run(
            [os.environ["GPS_CHECK_STATES"], "--urdf", KR5, "--package", f"KR5={KR5.parent}", "--scene", KR5_SCENE,
             "--random", str(count), "--seed", str(seed), "--device", device, "--out", out.name],
            check=True, capture_output=True, timeout=200)
        lines = out.read().decode().splitlines()[1:]
    return [line.split(",") for line in lines]


def memory_in_use():
    """Bytes that malloc has given to this process."""
    process = ctypes.CDLL(None)
    if SANITIZED:
        allocated = getattr(process, "__sanitizer_get_current_allocated_bytes")
        allocated.restype = ctypes.c_size_t
        return allocated()
    has_new = hasattr(process, "mallinfo2")  # since glibc 2.33

    class Information(ctypes.Structure):
        _fields_ = [(name, ctypes.c_size_t if has_new else ctypes.c_int) for name in
                    "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost".split()]

    mallinfo = process.mallinfo2 if has_new else process.mallinfo
    mallinfo.restype = Information
    information = mallinfo()
    return information.uordblks + information.hblkhd


@contextlib.contextmanager
def many_states():
    """States of the rail in a file without content. Their check takes seconds."""
    with tempfile.TemporaryFile() as file:
        file.truncate(10**8 * 8)
        yield np.memmap(file, dtype=float, mode="r", shape=(10**8, 1))


class StateChecker(Case):
    def test_answers_are_those_of_the_tool(self):
        scene = kr5_scene()
        states = scene.robot.random_states(3000, seed=7, base=scene.robot.default_state())
        expected = answers_of_the_tool(3000, 7, "cpu")
        devices = ["cpu"]
        if any(device.software for device in gps.list_devices()):
            devices.append("software")
        else:
            print("without the device 'software': this machine has no software renderer", file=sys.stderr)
        for device in devices:
            result = gps.StateChecker(scene, device=device).check(states)
            self.assertEqual([row[0] == "1" for row in expected], result.valid.tolist())
            self.assertTrue(500 < result.valid.sum() < 2500)
            for valid, pair in zip(result.valid, result.colliding):
                self.assertEqual(valid, pair[0] < 0)
                self.assertTrue(pair[0] == pair[1] == -1 or pair[0] < pair[1])

    def test_each_colliding_pair_collides_alone(self):
        scene = kr5_scene()
        states = scene.robot.random_states(300, seed=8)
        result = gps.StateChecker(scene, device="cpu").check(states)
        pairs = {tuple(pair) for pair in result.colliding[~result.valid]}
        self.assertGreater(len(pairs), 3)
        for pair in pairs:
            alone = scene.copy()
            for first in alone.body_names:
                for second in alone.body_names:
                    if first != second:
                        alone.allowed_collisions.set_entry(first, second, True)
            alone.allowed_collisions.set_entry(*(scene.body_name(body) for body in pair), False)
            found = np.all(result.colliding == pair, axis=1)
            self.assertFalse(gps.StateChecker(alone, device="cpu").check(states[found]).valid.any())

    def test_answers_do_not_depend_on_the_layout_of_the_states(self):
        scene = arm_scene()
        checker = gps.StateChecker(scene, device="cpu")
        states = scene.robot.random_states(500, seed=2).astype(np.float32).astype(float)
        expected = checker.check(states).valid.tolist()
        self.assertIn(True, expected)
        self.assertIn(False, expected)
        wide = np.zeros((500, 2 * states.shape[1]))
        wide[:, ::2] = states
        unaligned = np.frombuffer(b"x" + states.tobytes(), dtype=float, offset=1).reshape(states.shape)
        for same in (np.asfortranarray(states), wide[:, ::2], states.astype(np.float32), states.tolist(),
                     states.astype(">f8"), unaligned):
            self.assertEqual(expected, checker.check(same).valid.tolist())
        self.assertEqual(expected[::-1], checker.check(states[::-1]).valid.tolist())
        frozen = states.copy()
        frozen.setflags(write=False)
        self.assertEqual(expected, checker.check(frozen).valid.tolist())
        self.assertEqual(expected, checker.check(states.copy(order="C")).valid.tolist())

    def test_one_state_and_no_state_are_batches(self):
        checker = gps.StateChecker(arm_scene(), device="cpu")
        state = checker.scene.current_state
        self.assertEqual([True], checker.check(state).valid.tolist())
        self.assertEqual(1, len(checker.check(state)))
        empty = checker.check(np.empty((0, len(state))))
        self.assertEqual(((0,), (0, 2), 0), (empty.valid.shape, empty.colliding.shape, len(empty)))

    def test_arrays_outlive_their_result(self):
        checker = gps.StateChecker(arm_scene(), device="cpu")
        states = checker.scene.robot.random_states(1000, seed=3)
        valid, colliding = checker.check(states).valid, checker.check(states).colliding
        expected = valid.copy()
        for _ in range(20):
            checker.check(states[::-1])
        np.testing.assert_array_equal(expected, valid)
        np.testing.assert_array_equal(expected, colliding[:, 0] < 0)
        self.assertEqual((np.dtype(bool), np.dtype(np.int32)), (valid.dtype, colliding.dtype))

    def test_ctrl_c_ends_a_check_of_many_states(self):
        checker = gps.StateChecker(gps.PlanningScene(rail()), device="cpu")
        with many_states() as states, self.assertRaises(KeyboardInterrupt), pressed_during_a_call():
            checker.check(states)
        self.assertEqual([True], checker.check([0.0]).valid.tolist())

    def test_long_calls_in_parts_give_the_same_answers(self):
        scene = arm_scene()
        states = scene.robot.random_states(20000, seed=4)
        whole = gps.StateChecker(scene, device="cpu").check(states)
        self.assertEqual(20000, len(whole))
        checker = gps.StateChecker(scene, device="cpu")
        parts = [checker.check(part) for part in np.array_split(states, 7)]
        np.testing.assert_array_equal(np.concatenate([part.valid for part in parts]), whole.valid)
        self.assertEqual(whole.valid.tolist(), (whole.colliding[:, 0] < 0).tolist())
        self.assertGreater(whole.seconds, 0.0)

    def test_a_group_checks_only_what_it_moves(self):
        scene = arm_scene()
        checker = gps.StateChecker(scene, device="cpu")
        states = scene.robot.random_states(2000, seed=5)
        for group in scene.robot.groups:
            report = checker.report(group.name)
            result = checker.check(states, group.name)
            moved = set(group.moved_links)
            carried = {len(scene.robot.links) + len(scene.objects) + i for i, each in enumerate(scene.attached)
                       if each.link in moved}
            self.assertTrue(all(set(pair) & (moved | carried) for pair in result.colliding[~result.valid].tolist()))
            self.assertGreaterEqual(report.pairs_outside_group, 0)
        self.assertTrue(any(checker.report(group.name).pairs_outside_group for group in scene.robot.groups))

    def test_values_beyond_the_limits_get_a_warning(self):
        scene = arm_scene()
        checker = gps.StateChecker(scene, device="cpu")
        states = scene.robot.random_states(3, seed=5)
        states[1, 2] = 45.0
        message = "row 1: joint '.*' is 45, outside its limits .*; values are in radians, and 45 degrees are 0.785398 rad$"
        with self.assertWarnsRegex(UserWarning, "^states: " + message):
            checker.check(states)
        with self.assertWarnsRegex(UserWarning, "^ends: " + message):
            gps.MotionChecker(checker).check(states[[0, 0]], states[:2])

    def test_the_report_counts_the_pairs(self):
        scene = gps.PlanningScene(rail())
        scene.add_object("post", gps.Sphere(0.1), [1, 0, 0])
        scene.add_object("far", gps.Sphere(0.1), [0, 50, 0])
        report = gps.StateChecker(scene, device="cpu").report()
        self.assertEqual((0, 1, 1), (report.self_pairs, report.world_pairs, report.unreachable_world_pairs))
        self.assertIsNone(report.always_colliding)
        scene.add_object("around", gps.Box([100, 1, 1]))
        self.assertIn([1, 4], [list(pair) for pair in
                               gps.StateChecker(scene, device="cpu").report().colliding_in_samples])

    def test_a_new_scene_is_checked_and_the_old_one_is_a_copy(self):
        scene = gps.PlanningScene(rail())
        checker = gps.StateChecker(scene, device="cpu")
        scene.add_object("post", gps.Sphere(0.1))
        scene.revision = 5
        self.assertEqual((True, 0), (checker.check([0.0]).valid[0], checker.check([0.0]).revision))
        checker.set_scene(scene)
        self.assertEqual((False, 5), (checker.check([0.0]).valid[0], checker.check([0.0]).revision))
        scene.remove_object("post")
        self.assertFalse(checker.check([0.0]).valid[0])
        self.assertEqual(["post"], [each.id for each in checker.scene.objects])

    def test_a_signal_handler_cannot_use_the_checker_of_the_call_that_it_interrupts(self):
        checker = gps.StateChecker(gps.PlanningScene(rail()), device="cpu")

        def handler(_number, _frame):
            checker.check([0.0])

        before = signal.signal(signal.SIGALRM, handler)
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        try:
            with many_states() as states:
                self.assert_one_line(gps.Error, "a signal handler cannot use the checker", checker.check, states)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)
        self.assertEqual([True], checker.check([0.0]).valid.tolist())

    def test_a_scene_that_is_not_valid_keeps_the_old_one(self):
        checker = gps.StateChecker(gps.PlanningScene(rail()), device="cpu")
        self.assert_one_line(gps.Error, "create a new checker for another robot", checker.set_scene, arm_scene())
        # Another robot, although it has as many variables.
        self.assert_one_line(gps.Error, "create a new checker for another robot", checker.set_scene,
                             gps.PlanningScene(rail()))
        self.assert_one_line(TypeError, "expected a PlanningScene, but got None", checker.set_scene, None)
        self.assertEqual("rail", checker.scene.robot.name)
        self.assertTrue(checker.check([0.0]).valid[0])

    def test_states_of_the_srdf_can_be_named(self):
        scene = arm_scene()
        checker = gps.StateChecker(scene, device="cpu")
        expected = np.tile(scene.current_state, (2, 1))
        for row, name in zip(expected, ("ready", "arm/extended")):
            named = scene.robot.named_state(name)
            row[named.variables] = named.values
        self.assertEqual(2, len(np.unique(expected, axis=0)))
        by_name = checker.check(["ready", "arm/extended"])
        by_value = checker.check(expected)
        np.testing.assert_array_equal(by_value.valid, by_name.valid)
        np.testing.assert_array_equal(by_value.colliding, by_name.colliding)
        self.assertEqual(1, len(checker.check("ready")))

    def test_an_unknown_state_is_an_error_that_lists_the_states(self):
        checker = gps.StateChecker(arm_scene(), device="cpu")
        self.assert_one_line(gps.Error, "^states: the SRDF has no state 'nose'; its states: .*arm/ready",
                             checker.check, ["ready", "nose"])

    def test_the_columns_of_a_table_must_be_the_variables_in_their_order(self):
        class Table:
            """As a pandas.DataFrame."""
            def __init__(self, values, columns):
                self.values, self.columns = values, columns

            def __array__(self, *_, **__):
                return self.values

        checker = gps.StateChecker(arm_scene(), device="cpu")
        names = list(checker.scene.robot.variable_names)
        states = checker.scene.robot.random_states(10, seed=1)
        valid = checker.check(states).valid.tolist()
        for columns in (names, range(len(names))):  # names, or the numbers of a table without names
            self.assertEqual(valid, checker.check(Table(states, columns)).valid.tolist())
        self.assert_one_line(gps.Error, "^states: the columns are .*in this order", checker.check,
                             Table(states[:, ::-1], names[::-1]))

    def test_wrong_states_and_groups_are_errors(self):
        checker = gps.StateChecker(gps.PlanningScene(rail()), device="cpu")
        for states in (np.zeros((3, 2)), np.zeros((2, 2, 1)), 1.0):
            self.assert_one_line(gps.Error, "^states: the shape is", checker.check, states)
        masked = np.ma.array([1.0], mask=[True])
        for states in (np.ma.array([[1.0]], mask=[[True]]), masked.view(type("Own", (np.ma.MaskedArray,), {})),
                       [masked, [0.0]], np.ones((1, 1), bool), None, [["a"]], [0.0, "a"], np.zeros((1, 1), complex), [[1.0], [1.0, 2.0]], np.array([[None]])):
            self.assert_one_line(TypeError, "^states: expected an array of numbers", checker.check, states)
        for value in (float("nan"), float("inf"), -float("inf")):
            self.assert_one_line(gps.Error, "^state 1: the value of variable 'slide'", checker.check, [[0.0], [value]])
        many = np.zeros((20000, 1))  # a call of several parts
        many[15000] = np.nan
        self.assert_one_line(gps.Error, "^state 15000: the value of variable 'slide'", checker.check, many)
        self.assert_one_line(gps.Error, "'legs'", checker.check, [0.0], "legs")
        self.assert_one_line(gps.Error, "'legs'", checker.report, "legs")
        self.assert_one_line(TypeError, r"expected a str, but got 5 \(int\)", checker.check, [0.0], 5)
        self.assertTrue(checker.check([0.0]).valid[0])

    def test_wrong_options_are_errors(self):
        scene = gps.PlanningScene(rail())
        for error, pattern, options in (
            (gps.Error, "warp drive", {"device": "warp drive"}),
            (gps.Error, "sideways", {"traversal": "sideways"}),
            (TypeError, "whole number", {"max_batch": -1}),
            (TypeError, "True or False", {"device_only": "all"}),
        ):
            self.assert_one_line(error, pattern, gps.StateChecker, scene, **options)
        self.assert_one_line(TypeError, "expected a PlanningScene", gps.StateChecker, rail())

    def test_a_device_that_builds_wrong_trees_at_a_scene_change_is_replaced_by_the_cpu(self):
        scene = gps.PlanningScene(rail())
        with tempfile.TemporaryDirectory() as folder:
            shaders = pathlib.Path(folder, "shaders")
            shutil.copytree(ROOT / "shaders", shaders)
            layout = shaders / "tree_build" / "layout_pairs.comp"
            text = layout.read_text()
            self.assertEqual(1, text.count("  place(left, "))
            # Wrong only for more than one mesh, so the scene without objects is right.
            layout.write_text(text.replace("  place(left, ", "  if (mesh_count == 1u) place(left, "))
            with mock.patch.dict(os.environ, GPU_PLANNING_SCENE_SHADERS=str(shaders)):
                checker = gps.StateChecker(scene, device_only=True)
                self.assertNotEqual("CPU", checker.device_name)
                scene.add_object("a", gps.Box([0.6, 0.6, 0.6]), [1, 0, 0])
                scene.add_object("b", gps.Box([0.8, 0.8, 0.8]), [-1, 0, 0])
                checker.set_scene(scene)  # the device takes the scene over in the background
                states = np.linspace(-3.0, 3.0, 100)[:, None]
                with self.assertWarnsRegex(UserWarning, "^the device has failed, so the CPU checks the states: the GPU "
                                                        "built wrong trees"):
                    answers = checker.check(states).valid
                self.assertEqual("CPU", checker.device_name)
                np.testing.assert_array_equal(gps.StateChecker(scene, device="cpu").check(states).valid, answers)
                self.assert_one_line(gps.Error, "^the GPU built wrong trees", gps.StateChecker, scene, device="0")

    def test_devices_are_listed_and_can_be_chosen(self):
        devices = gps.list_devices()
        self.assertTrue(devices)
        scene = gps.PlanningScene(rail())
        for device in devices:
            self.assertEqual(device.renderer, gps.StateChecker(scene, device=str(device.index)).device_name)
        self.assertEqual("CPU", gps.StateChecker(scene, device="cpu").device_name)
        self.assertEqual("", gps.StateChecker(scene, device="cpu").device_warning)

    def test_errors_are_runtime_errors(self):
        self.assertTrue(issubclass(gps.DeviceLost, gps.Error) and issubclass(gps.Error, RuntimeError))
        self.assertEqual("gpu_planning_scene.Error", f"{gps.Error.__module__}.{gps.Error.__name__}")

    def test_other_threads_of_python_run_during_a_check(self):
        # The main thread is in one call until the other thread sends the signal. With the interpreter's lock held, the
        # other thread would never send it.
        checker = gps.StateChecker(gps.PlanningScene(rail()), device="cpu")
        entered = threading.Event()

        class Slow:  # its conversion to an array is the last step before the call of the library
            def __array__(self, dtype=None, copy=None):
                entered.set()
                return states

        def interrupt():
            entered.wait()
            os.kill(os.getpid(), signal.SIGINT)

        def give_up(_number, _frame):
            raise AssertionError("the other thread did not run")

        signal.signal(signal.SIGALRM, give_up)
        interval = sys.getswitchinterval()
        sys.setswitchinterval(1000)  # Python itself does not let the other thread run before the call
        self.addCleanup(sys.setswitchinterval, interval)
        with many_states() as states:
            thread = threading.Thread(target=interrupt)
            thread.start()
            signal.alarm(60)
            with self.assertRaises(KeyboardInterrupt):
                checker.check(Slow())
            signal.alarm(0)
            thread.join()

    def test_threads_at_once_get_their_own_answers(self):
        scene = arm_scene()
        shared = gps.StateChecker(scene, device="cpu")
        batches = [scene.robot.random_states(400, seed=seed) for seed in range(8)]
        expected = [shared.check(states).valid.copy() for states in batches]
        wrong = []

        def work(number):
            own = gps.StateChecker(scene, device="cpu")
            for i in range(40):
                batch = (number + i) % len(batches)
                checker = (shared, own)[i % 2]
                if not np.array_equal(checker.check(batches[batch]).valid, expected[batch]):
                    wrong.append((number, i))

        threads = [threading.Thread(target=work, args=(number,)) for number in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([], wrong)

    def test_a_call_checks_one_scene_while_another_thread_changes_it(self):
        robot = rail()
        free, blocked = gps.PlanningScene(robot), gps.PlanningScene(robot)
        blocked.add_object("post", gps.Sphere(0.1))
        blocked.revision = 1
        checker = gps.StateChecker(free, device="cpu")
        states = np.zeros((20000, 1))
        ended = threading.Event()

        def change():
            while not ended.is_set():
                checker.set_scene(blocked)
                checker.set_scene(free)

        thread = threading.Thread(target=change)
        thread.start()
        try:
            for _ in range(50):
                result = checker.check(states)
                self.assertEqual({result.revision == 0}, set(result.valid.tolist()))
        finally:
            ended.set()
            thread.join()

    def test_many_checks_leak_no_memory(self):
        scene = arm_scene()
        state = scene.robot.random_states(1, seed=6)
        # From 20,000 states on, memory is used for proofs that are made in the background.
        checks = 10000
        checker = gps.StateChecker(scene, device="cpu")

        def check(times):
            for i in range(times):
                result = checker.check(state)
                result.valid.any()
                result.colliding.max()
                if i % 10 == 0:
                    try:
                        checker.check(state[:, :1])
                    except gps.Error:
                        pass

        check(1000)
        bytes_before = memory_in_use()
        blocks_before = sys.getallocatedblocks()
        check(checks)
        # An object that is leaked in each check has at least 16 bytes of malloc or is one block of Python. So has
        # one that is leaked in each error.
        self.assertLess(memory_in_use() - bytes_before, checks * 8 // 10)
        self.assertLess(sys.getallocatedblocks() - blocks_before, checks // 20)


if __name__ == "__main__":
    unittest.main()
