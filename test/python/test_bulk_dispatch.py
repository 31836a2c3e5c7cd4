"""The dispatcher of bulk runs with simulated workers: which shards are delivered, and which errors end a run."""
import asyncio
import itertools
import unittest
from unittest import mock

import gpu_planning_scene as gps
from gpu_planning_scene.bulk import dispatch
from gpu_planning_scene.bulk.runner import Runner, WorkerLost
from gpu_planning_scene.bulk.work import Answer
from robots import Case


def right_answer(number):
    return b"answer %d" % number


class Workers(Runner):
    """behaviours: by the name of a worker, an asynchronous function from (number, how many shards the worker was given
    before) to the data of an answer."""

    def __init__(self, **behaviours):
        self.behaviours = behaviours
        self.given = []  # pairs (worker, number)
        self.most_at_once = 0
        self._at_once = 0

    async def workers(self):
        return set(self.behaviours)

    async def run(self, worker, number):
        before = sum(name == worker for name, _ in self.given)
        self.given.append((worker, number))
        self._at_once += 1
        self.most_at_once = max(self.most_at_once, self._at_once)
        try:
            await asyncio.sleep(0)
            return Answer(await self.behaviours.get(worker, hanging)(number, before), f"hardware of {worker}")
        finally:
            self._at_once -= 1


async def honest(number, _before):
    return right_answer(number)


async def slow(number, _before):
    await asyncio.sleep(0.05)
    return right_answer(number)


async def hanging(_number, _before):
    await asyncio.sleep(1000)


def ending_at(shard_count, cluster):
    """A worker that ends while it has its shard_count-th shard, and leaves the cluster."""
    async def behaviour(number, before):
        if before + 1 >= shard_count:
            cluster().behaviours.pop("b", None)
            await asyncio.sleep(1000)
        return right_answer(number)
    return behaviour


def raising(error):
    async def behaviour(_number, _before):
        raise error
    return behaviour


class Dispatch(Case):
    def setUp(self):
        for name, value in (("POLL_SECONDS", 0.01), ("PATIENCE_SECONDS", 0.1)):
            patch = mock.patch.object(dispatch, name, value)
            patch.start()
            self.addCleanup(patch.stop)

    def run_shards(self, cluster, count=40, check_twice=0.0, timeout=100.0, may_be_wrong=False):
        self.delivered, self.compared, self.lines = [], set(), []

        def deliver(number, answer, compared):
            self.assertTrue(may_be_wrong or answer.data == right_answer(number))
            self.delivered.append(number)
            if compared:
                self.compared.add(number)

        async def limited():
            await asyncio.wait_for(self.dispatcher.run(), 60)

        self.dispatcher = dispatch.Dispatcher(cluster, range(count), deliver, right_answer,
                                              dispatch.DispatchOptions(timeout, check_twice), warn=self.lines.append)
        asyncio.run(limited())

    def assert_each_once(self, count=40):
        self.assertEqual(list(range(count)), sorted(self.delivered))

    def test_each_shard_is_delivered_once(self):
        for names in ("a", "ab", "abcdefg"):
            cluster = Workers(**dict.fromkeys(names, honest))
            self.run_shards(cluster)
            self.assert_each_once()
            self.assertEqual(set(names), {name for name, _ in cluster.given})
            self.assertEqual(40, len(cluster.given))
            self.assertLessEqual(cluster.most_at_once, Runner.slots * len(names))

    def test_the_shards_of_a_lost_worker_go_to_others(self):
        for shard_count in (1, 2, 5):
            cluster = Workers(a=honest)
            cluster.behaviours["b"] = ending_at(shard_count, lambda: cluster)
            self.run_shards(cluster)
            self.assert_each_once()
            self.assertEqual(["worker b is lost"], self.lines)
            self.assertEqual(1, self.dispatcher.lost_workers)

    def test_a_worker_that_comes_later_gets_shards(self):
        cluster = Workers()

        async def calling(number, before):
            cluster.behaviours.setdefault("b", honest)
            return await slow(number, before)

        cluster.behaviours["a"] = calling
        self.run_shards(cluster)
        self.assert_each_once()
        self.assertIn("b", {name for name, _ in cluster.given})

    def test_a_shard_whose_task_ends_with_its_worker_is_tried_again(self):
        failures = itertools.count()

        async def dying_twice(number, _before):
            if number == 7 and next(failures) < 2:
                raise WorkerLost("killed")
            return right_answer(number)

        self.run_shards(Workers(a=dying_twice))
        self.assert_each_once()

    def test_a_shard_that_ends_each_worker_ends_the_run(self):
        cluster = Workers(a=raising(WorkerLost("killed")), b=raising(WorkerLost("killed")))
        self.assert_one_line(gps.Error, "^shard [0-9]+: 10 workers were lost while they had it", self.run_shards,
                             cluster)

    def test_a_worker_that_hangs_is_left_out(self):
        cluster = Workers(a=honest, b=hanging)
        self.run_shards(cluster, timeout=0.2)
        self.assert_each_once()
        self.assertEqual(["worker b is left out: it did not answer for 0.2 s"], self.lines)
        self.assertLessEqual(sum(name == "b" for name, _ in cluster.given), Runner.slots)

    def test_a_late_answer_of_a_worker_that_was_left_out_is_not_used(self):
        async def late(number, _before):
            await asyncio.sleep(0.5)
            return right_answer(number)

        self.run_shards(Workers(a=slow, b=late), timeout=0.2)
        self.assert_each_once()
        self.assertEqual(1, len(self.lines))

    def test_a_run_without_workers_ends(self):
        self.assert_one_line(gps.Error, "^no worker is left; none came for 0.1 s", self.run_shards, Workers(),
                             timeout=0.1)
        self.assert_one_line(gps.Error, "^no worker is left; all of them", self.run_shards, Workers(a=hanging),
                             timeout=0.1)

    def test_a_worker_that_lost_its_device_is_left_out(self):
        self.run_shards(Workers(a=honest, b=raising(gps.DeviceLost("the device is lost"))))
        self.assert_each_once()
        self.assertEqual(["worker b is left out: the device is lost"], self.lines)

    def test_a_device_that_is_opened_anew_loses_no_shard(self):
        async def once(number, before):
            if before == 3:
                raise gps.DeviceLost("the device is lost")
            return right_answer(number)

        self.run_shards(Workers(a=once))
        self.assert_each_once()
        self.assertEqual([], self.lines)

    def test_a_wrong_input_ends_the_run(self):
        async def with_bad_shard(number, _before):
            if number == 5:
                raise gps.Error("state 3: the value is not finite")
            return right_answer(number)

        for names in ("a", "ab"):
            self.assert_one_line(gps.Error, "^shard 5: state 3: the value is not finite$", self.run_shards,
                                 Workers(**dict.fromkeys(names, with_bad_shard)))

    def test_a_worker_without_the_package_is_left_out(self):
        for slots in (1, 2):
            cluster = Workers(a=slow, b=raising(ModuleNotFoundError("No module named 'x'\nmore")))
            cluster.slots = slots
            self.run_shards(cluster, count=8)
            self.assert_each_once(8)
            self.assertEqual(["worker b is left out: ModuleNotFoundError: No module named 'x'"], self.lines)

    def test_sampled_shards_are_computed_by_two_workers(self):
        for share, least in ((1.0, 40), (0.25, 10), (0.01, 3)):  # at least the first shard of each worker
            cluster = Workers(a=honest, b=honest, c=honest)
            self.run_shards(cluster, check_twice=share)
            self.assert_each_once()
            workers_of = {number: {name for name, other in cluster.given if other == number} for number in range(40)}
            self.assertEqual(self.compared, {number for number, names in workers_of.items() if len(names) == 2})
            self.assertGreaterEqual(len(self.compared), least)
            self.assertEqual(len(self.compared), self.dispatcher.checked_twice)
            self.assertEqual(40 + len(self.compared), len(cluster.given))
            self.assertLessEqual(len(self.compared), 40 * share + 3)

    def test_a_worker_with_wrong_answers_is_named(self):
        def lying(always):
            async def behaviour(number, before):
                return b"lie" if always or before == 9 else right_answer(number)
            return behaviour

        for always, share in ((True, 0.01), (False, 1.0)):
            for liar in "abc":
                cluster = Workers(**{name: lying(always) if name == liar else honest for name in "abc"})
                with self.assertRaises(dispatch.WorkerIsWrong) as raised:
                    self.run_shards(cluster, check_twice=share, may_be_wrong=True)
                self.assertRegex(str(raised.exception),
                                 rf"^wrong answers of worker {liar} \(hardware of {liar}\): shard ")
                self.assertNotIn("\n", str(raised.exception))
                self.assertEqual([f"hardware of {liar}"], raised.exception.hardware)

    def test_a_sampled_shard_is_delivered_although_the_second_worker_is_lost(self):
        cluster = Workers(a=honest)
        cluster.behaviours["b"] = ending_at(2, lambda: cluster)
        self.run_shards(cluster, check_twice=1.0)
        self.assert_each_once()
        self.assertGreater(self.dispatcher.not_compared, 0)

    def test_one_worker_compares_nothing_and_does_not_wait(self):
        self.run_shards(Workers(a=honest), check_twice=1.0)
        self.assert_each_once()
        self.assertEqual((set(), 0), (self.compared, self.dispatcher.not_compared))

    def test_a_scheduler_that_does_not_answer_ends_the_run(self):
        class Silent(Workers):
            async def workers(self):
                await asyncio.sleep(1000)

        class Gone(Workers):
            async def workers(self):
                raise OSError("Connection refused")

        self.assert_one_line(gps.Error, "^the scheduler does not answer", self.run_shards, Silent(), timeout=0.1)
        self.assert_one_line(gps.Error, "^the scheduler does not answer any more .Connection", self.run_shards, Gone())


if __name__ == "__main__":
    unittest.main()
