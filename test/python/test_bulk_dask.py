"""Bulk runs on a Dask cluster of worker processes: the same bytes as on this machine alone, workers that are killed,
that hang or lie, scenes that travel once; and the functions on Dask arrays."""
import asyncio
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

try:
    import dask
    import dask.array
    import distributed
except ImportError as error:
    raise unittest.SkipTest(f"Dask is not installed: {error}") from None

import gpu_planning_scene as gps
import gpu_planning_scene.dask as gps_dask
from bulk_runs import ARM_OPTIONS, bulk, content, shards, started_bulk, wait_for_shards
from gpu_planning_scene.bulk import RobotBundle, SceneBundle
from gpu_planning_scene.bulk.cluster import DaskRunner
from robots import ARM, ARM_SCENE, ROOT, Case, arm, arm_scene
from test_document import programs

CONFIGURATION = {"distributed.worker.daemon": True, "distributed.logging.distributed": "critical",
                 "distributed.logging.bokeh": "critical", "distributed.admin.tick.limit": "60s"}


def flip_one_answer():
    """Makes this worker process lie about one state of each shard."""
    import gpu_planning_scene.bulk.work as work  # pylint: disable=import-outside-toplevel
    right = work.perform

    def lie(*arguments):
        answer = right(*arguments)
        return work.Answer(bytes([answer.data[0] ^ 1]) + answer.data[1:], answer.hardware)

    work.perform = lie


def hang():
    """Makes this worker process hang in each shard."""
    import gpu_planning_scene.bulk.work as work  # pylint: disable=import-outside-toplevel
    work.perform = lambda *_: time.sleep(1000)


def slow_down():
    """Makes this worker process take at least 30 ms for each shard, so that it can be killed before the run ends."""
    import gpu_planning_scene.bulk.work as work  # pylint: disable=import-outside-toplevel
    right = work.perform

    def perform(*arguments):
        time.sleep(0.03)
        return right(*arguments)

    work.perform = perform


def loads():
    """How often this worker process has loaded a scene."""
    import gpu_planning_scene.bulk.bundle as bundle  # pylint: disable=import-outside-toplevel
    return getattr(bundle, "loads", 0)


def count_loads():
    import gpu_planning_scene.bulk.bundle as bundle  # pylint: disable=import-outside-toplevel
    right = bundle.SceneBundle.load

    def load(self, robot):
        bundle.loads = loads() + 1
        return right(self, robot)

    bundle.SceneBundle.load = load


class Cluster(Case):
    """A cluster with two worker processes. The runs have few states, because a checker makes proofs after 20,000 states
    of its scene, which takes longer than the checks. The test itself replaces workers that have ended, because Dask's
    nannies sometimes fail to do so on a busy machine."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.out = self.folder / "out"
        self.replace_workers()
        self.wait_for_workers()

    @classmethod
    def setUpClass(cls):
        dask.config.set(CONFIGURATION)
        cls.scratch = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, cls.scratch, ignore_errors=True)
        cls.cluster = distributed.LocalCluster(n_workers=0, threads_per_worker=1, dashboard_address="127.0.0.1:0")
        cls.addClassCleanup(cls.cluster.close)
        cls.processes = []
        cls.addClassCleanup(cls.end_workers)
        cls.client = distributed.Client(cls.cluster)
        cls.addClassCleanup(cls.client.close)

    @classmethod
    def end_workers(cls):
        for process in cls.processes:
            process.kill()
            process.wait()

    def replace_workers(self):
        """Starts worker processes, so that there are two."""
        command = [sys.executable, "-B", "-m", "distributed.cli.dask_worker", self.cluster.scheduler_address, "--host",
                   "127.0.0.1", "--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", self.scratch]
        self.processes[:] = [each for each in self.processes if each.poll() is None]
        while len(self.processes) < 2:
            self.processes.append(subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))

    def worker_of_process(self):
        """The addresses of the workers by process id."""
        return {pid: worker for worker, pid in self.client.run(os.getpid, on_error="ignore").items()}

    def wait_for_workers(self):
        """Waits until the workers are those of the two processes."""
        deadline = time.monotonic() + 200
        while set(self.worker_of_process()) != {each.pid for each in self.processes}:
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)

    def workers(self):
        return sorted(self.client.nthreads())

    def patch(self, function, worker):
        """Runs a function in a worker process, which is ended after the test."""
        pid = self.client.run(os.getpid, workers=[worker])[worker]
        self.client.run(function, workers=[worker])
        process, = [each for each in self.processes if each.pid == pid]
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)

    def options(self, *options):
        return [*ARM_OPTIONS, "--scheduler", self.cluster.scheduler_address, *options]

    def whole(self, *options):
        """The files of the same run on this machine alone."""
        status, line, _ = bulk(*ARM_OPTIONS, "--out", self.folder / "whole", *options)
        self.assertEqual(0, status, line)
        return content(self.folder / "whole")

    def succeed(self, *options):
        """The summary of a run on the cluster, into the folder `out`."""
        status, line, warnings = bulk(*self.options(*options, "--out", self.out))
        self.assertEqual((0, ""), (status, warnings), line)
        return line

    def test_of_errors_that_nobody_has_read_only_timeouts_are_not_reported(self):
        async def forget(*errors):
            runner = DaskRunner(self.cluster.scheduler_address, arm(), "cpu", None)
            await runner.open()
            for error in errors:
                asyncio.get_running_loop().create_future().set_exception(error)
            await runner.close()

        with self.assertLogs("asyncio", "ERROR") as logged:
            asyncio.run(forget(asyncio.TimeoutError(), ValueError("forgotten")))
        self.assertEqual(1, len(logged.records), logged.output)
        self.assertIn("forgotten", str(logged.records[0].exc_info[1]))

    def test_a_warning_of_a_worker_is_shown(self):
        states = np.zeros((40, len(arm().variables)))
        states[:, 0] = 90.0
        np.save(self.folder / "degrees.npy", states)
        status, line, warnings = bulk(*self.options("--states", self.folder / "degrees.npy", "--shard", 10,
                                                    "--out", self.out))
        self.assertEqual(0, status, line)
        self.assertEqual(1, warnings.count("90 degrees are"), warnings)

    def test_the_cluster_and_this_machine_write_the_same_bytes(self):
        run = ["--random", 4000, "--shard", 250, "--seed", 3]
        expected = self.whole(*run)
        self.assertIn("16 shards computed twice", self.succeed(*run, "--check-twice", 1))
        self.assertTrue(expected == content(self.out))
        # One worker is enough. It is a thread of this process.
        with distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=False,
                                      dashboard_address="127.0.0.1:0") as one:
            status, line, _ = bulk(*ARM_OPTIONS, *run, "--scheduler", one.scheduler_address, "--out",
                                   self.folder / "one")
        self.assertEqual(0, status, line)
        self.assertTrue(expected == content(self.folder / "one"))

    def test_states_of_a_file_travel_to_the_workers(self):
        np.save(self.folder / "states.npy", arm().random_states(4000, seed=4))
        run = ["--states", self.folder / "states.npy", "--shard", 250]
        self.succeed(*run)
        self.assertTrue(self.whole(*run) == content(self.out))

    def test_plans_are_the_same_on_the_cluster(self):
        scene = arm_scene()
        states = scene.robot.random_states(300, seed=9)
        free = states[gps.StateChecker(scene, device="cpu").check(states).valid][:12]
        free[6:, 6] = free[:6, 6]  # not in the group
        np.savez(self.folder / "problems.npz", start=free[:6], goal=free[6:])
        run = ["--plans", self.folder / "problems.npz", "--group", "arm", "--shard", 1, "--max-rounds", 200]
        self.succeed(*run, "--check-twice", 1)
        self.assertTrue(self.whole(*run) == content(self.out))

    def test_killed_workers_lose_and_double_no_state(self):
        run = ["--random", 6000, "--shard", 100, "--seed", 5]
        expected = self.whole(*run)
        for worker in self.workers():
            self.patch(slow_down, worker)
        process = started_bulk(*self.options(*run, "--out", self.out))
        kills = 0
        while process.poll() is None:
            time.sleep(0.02)
            if kills < 2 and len(shards(self.out)) > 5 + 20 * kills:
                for pid in list(self.worker_of_process())[:1]:
                    os.kill(pid, signal.SIGKILL)
                    kills += 1
            self.replace_workers()
        out, err = process.communicate()
        self.assertEqual(0, process.returncode, err)
        self.assertGreater(kills, 0)
        # A worker that was killed before the program knew it is not lost.
        lost = len([line for line in err.splitlines() if " is lost" in line])
        self.assertTrue(1 <= lost <= kills, err)
        self.assertIn(f"{lost} workers lost", out)
        self.assertTrue(expected == content(self.out))

    def test_a_worker_that_hangs_is_named_and_loses_no_state(self):
        run = ["--random", 6000, "--shard", 300, "--timeout", 5, "--check-twice", 0]
        hung = self.workers()[0]
        self.patch(hang, hung)
        status, line, warnings = bulk(*self.options(*run, "--out", self.out))
        self.assertEqual(0, status, line)
        self.assertEqual(f"warning: worker {hung} is left out: it did not answer for 5 s\n", warnings)
        self.assertTrue(self.whole(*run) == content(self.out))

    def test_a_worker_that_lies_is_named_and_its_shards_are_deleted(self):
        run = ["--random", 6000, "--shard", 100]
        liar = self.workers()[1]
        self.patch(flip_one_answer, liar)
        status, line, _ = bulk(*self.options(*run, "--out", self.out))
        self.assertEqual(1, status)
        self.assertRegex(line, f"^wrong answers of worker {liar} .*arm_scene.yaml, states [0-9]+ to [0-9]+ has other "
                         "answers on another worker and in this process; [0-9]+ shards of this hardware were deleted; ")
        expected = self.whole(*run)
        for path, data in content(self.out).items():
            if path.endswith(".npy"):
                self.assertEqual(expected[path], data)

    def test_a_killed_run_goes_on_on_the_cluster(self):
        run = ["--random", 6000, "--shard", 100, "--seed", 5]
        process = started_bulk(*self.options(*run, "--out", self.out))
        wait_for_shards(self.out, 5, process)
        process.kill()
        process.communicate()
        finished = {each: each.stat().st_ino for each in shards(self.out)}
        self.assertTrue(5 <= len(finished) < 60, len(finished))
        self.assertIn(f"; {60 - len(finished)} of 60 shards computed now", self.succeed(*run))
        self.assertEqual(finished, {each: each.stat().st_ino for each in finished})
        self.assertTrue(self.whole(*run) == content(self.out))

    def test_a_scene_travels_once_to_each_worker(self):
        scenes = self.folder / "scenes"
        scenes.mkdir()
        for name in ("a.yaml", "b.yaml"):
            (scenes / name).write_text(f"name: {name}\n" + ARM_SCENE.read_text())
        self.client.run(count_loads)
        before = self.client.run(loads)
        sent = {}

        def watch():
            while not self.ended:
                for key, holders in self.client.who_has().items():
                    if "gpu_planning_scene-" in key:
                        sent[key] = set(holders)
                time.sleep(0.02)

        self.ended = False
        thread = threading.Thread(target=watch)
        thread.start()
        try:
            self.succeed("--scene", scenes, "--random", 6000, "--shard", 300, "--check-twice", 0)
        finally:
            self.ended = True
            thread.join()
        # The scenes come one after the other, so that a worker loads each of them once.
        counts = [count - before[worker] for worker, count in self.client.run(loads).items()]
        self.assertEqual(2, max(counts))
        robot = RobotBundle.from_files(ARM, ARM.with_suffix(".srdf"))
        digests = {f"gpu_planning_scene-{SceneBundle.from_file(scenes / name, robot.load()).digest}"
                   for name in ("a.yaml", "b.yaml")} | {f"gpu_planning_scene-{robot.digest}"}
        self.assertEqual(digests, set(sent))
        self.assertTrue(all(1 <= len(holders) <= 2 for holders in sent.values()))

    def test_functions_on_arrays_have_the_answers_of_a_run(self):
        robot = RobotBundle.from_files(ARM, ARM.with_suffix(".srdf"))
        scene = SceneBundle.from_file(ARM_SCENE, robot.load())
        states = gps_dask.random_states(robot, scene, 8000, seed=3, chunk=3000)
        valid = gps_dask.check_states(states, robot, scene, device="cpu")
        self.assertEqual(((8000, 7), (8000,), bool), (states.shape, valid.shape, valid.dtype))
        computed_states, computed = dask.compute(states, valid)  # on the cluster, the newest client
        self.whole("--random", 8000, "--seed", 3, "--with-states")
        rows = np.load(shards(self.folder / "whole")[0])
        np.testing.assert_array_equal(rows["state"], computed_states)
        np.testing.assert_array_equal(rows["valid"], computed)
        columns = dask.array.from_array(rows["state"], chunks=(5000, 2))
        for scheduler in ("threads", "synchronous"):
            np.testing.assert_array_equal(
                rows["valid"], gps_dask.check_states(columns, robot, scene, device="cpu").compute(scheduler=scheduler))
        group = gps.StateChecker(arm_scene(), device="cpu").check(rows["state"], "gripper").valid
        np.testing.assert_array_equal(
            group, gps_dask.check_states(states, robot, scene, "gripper", "cpu").compute(scheduler="threads"))

    def test_the_program_of_the_document_prints_what_its_comment_says(self):
        program, = programs(ROOT / "docs" / "bulk.md")
        answer = subprocess.run([sys.executable, "-B", "-c", program], cwd=ROOT, capture_output=True, text=True,
                                timeout=200, check=False)
        self.assertEqual((0, ""), (answer.returncode, answer.stderr))
        self.assertEqual([line.partition("# prints: ")[2] for line in program.splitlines() if "# prints: " in line],
                         answer.stdout.splitlines())

    def test_wrong_arrays_are_one_line(self):
        robot = RobotBundle.from_files(ARM, ARM.with_suffix(".srdf"))
        scene = SceneBundle.from_file(ARM_SCENE, robot.load())
        self.assert_one_line(gps.Error, "the shape is", gps_dask.check_states, dask.array.zeros(7), robot, scene)
        wide = gps_dask.check_states(dask.array.zeros((3, 8)), robot, scene, device="cpu")
        self.assert_one_line(gps.Error, "the shape is", wide.compute, scheduler="synchronous")
        self.assertEqual((0, 7), gps_dask.random_states(robot, scene, 0, seed=1).shape)

    def test_a_missing_scheduler_is_one_line(self):
        status, line, _ = bulk(*ARM_OPTIONS, "--out", self.out, "--random", 3, "--scheduler", "tcp://127.0.0.1:9",
                               "--timeout", 1)
        self.assertEqual(1, status)
        self.assertRegex(line, "^tcp://127.0.0.1:9: no scheduler answers .[^\n]*$")


if __name__ == "__main__":
    unittest.main()
