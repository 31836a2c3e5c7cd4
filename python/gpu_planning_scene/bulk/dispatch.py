"""Gives shards to workers until each shard has one answer.

A shard whose worker is lost or hangs goes to another worker; only the first answer of a shard is delivered. Of each
worker, the first shard and then every n-th shard is computed by a second worker too. If the two answers differ, this
process computes the shard itself, and names the worker that is wrong. Own method."""
from __future__ import annotations

import asyncio
import collections
import dataclasses
import time
from typing import Callable, Deque, Dict, List, Optional, Sequence, Set, Tuple

import gpu_planning_scene as gps
from gpu_planning_scene.bulk.runner import Runner, WorkerLost
from gpu_planning_scene.bulk.states import first_line
from gpu_planning_scene.bulk.work import Answer

MAX_LOSSES = 10  # of workers, while they have the same shard
MAX_ERRORS = 3  # of the same shard, or of a worker, in a row
POLL_SECONDS = 1.0  # between looks at the workers
PATIENCE_SECONDS = 10.0  # at the end, for a second worker that compares answers


@dataclasses.dataclass(frozen=True)
class DispatchOptions:
    """timeout: seconds; a worker without an answer for so long is given up, and so is a run without workers.
    check_twice: the share of the shards that two workers compute, from 0 to 1."""
    timeout: float = 600.0
    check_twice: float = 0.01


class WorkerIsWrong(gps.Error):
    """Workers gave wrong answers. hardware: that of these workers."""

    def __init__(self, message: str, hardware: Sequence[str]):
        super().__init__(message)
        self.hardware = list(hardware)


@dataclasses.dataclass
class _Job:
    """A shard on its way. answer, worker: of the first of two workers, once it has answered."""
    number: int
    losses: int = 0
    errors: int = 0
    answer: Optional[Answer] = None
    worker: str = ""
    failed_on: Set[str] = dataclasses.field(default_factory=set)


@dataclasses.dataclass
class _Worker:
    """What is known of a worker. since: the time of its last answer, or of its first shard after a pause."""
    answers: int = 0
    errors: int = 0
    since: float = 0.0
    given_up: bool = False
    running: Dict[asyncio.Task, _Job] = dataclasses.field(default_factory=dict)


class Dispatcher:
    """deliver: gets the number and the answer of each shard, and whether two workers agree on it. referee: computes a
    shard in this process. label: the name of a shard in messages. warn: gets lines about lost workers."""

    def __init__(self, runner: Runner, numbers: Sequence[int], deliver: Callable[[int, Answer, bool], None],
                 referee: Callable[[int], bytes], options: DispatchOptions = DispatchOptions(),
                 label: Callable[[int], str] = "shard {}".format, warn: Callable[[str], None] = lambda line: None):
        self._runner = runner
        self._fresh: Deque[_Job] = collections.deque(_Job(number) for number in numbers)
        self._second: List[_Job] = []  # these wait for a second worker
        self._deliver = deliver
        self._referee = referee
        self._options = options
        self._label = label
        self._warn = warn
        self._workers: Dict[str, _Worker] = collections.defaultdict(_Worker)
        self._live: Set[str] = set()
        self._progress_at = 0.0  # time of the last answer, or of the last look at which there was a worker
        self._alone_since = 0.0  # time since which shards only wait for a second worker
        self.lost_workers = 0
        self.checked_twice = 0
        self.not_compared = 0  # sampled shards for which no second worker came

    @property
    def live_workers(self) -> int:
        """The number of workers that are there and not given up."""
        return len(self._live)

    async def run(self) -> None:
        """Returns when all shards are delivered. Raises WorkerIsWrong, and Error if a shard cannot be computed."""
        self._progress_at = time.monotonic()
        looked_at = -POLL_SECONDS
        try:
            while self._fresh or self._second or self._tasks():
                if time.monotonic() - looked_at >= POLL_SECONDS:
                    await self._look_at_workers()
                    looked_at = time.monotonic()
                self._start_shards()
                await self._take_answers()
                self._finish_without_second_worker()
        finally:
            for task in self._tasks():
                task.cancel()

    def _tasks(self) -> List[asyncio.Task]:
        return [task for worker in self._workers.values() for task in worker.running]

    async def _look_at_workers(self) -> None:
        try:
            present = await asyncio.wait_for(self._runner.workers(), self._options.timeout)
        except (OSError, asyncio.TimeoutError) as error:
            raise gps.Error(f"the scheduler does not answer any more ({first_line(error)}); start the same command "
                            "again to go on") from None
        now = time.monotonic()
        for name, worker in list(self._workers.items()):
            if name not in present:
                if name in self._live:
                    self._give_up(name, f"worker {name} is lost")
                del self._workers[name]  # a new process may get the address of the old one
            elif worker.running and now - worker.since > self._options.timeout:
                self._give_up(name, f"worker {name} is left out: it did not answer for {self._options.timeout:g} s")
        self._live = {name for name in present if not self._workers[name].given_up}
        if self._live:
            self._progress_at = now
        elif present or now - self._progress_at > self._options.timeout:
            raise gps.Error("no worker is left; " + (
                "all of them failed or did not answer" if present else
                f"none came for {self._options.timeout:g} s") + "; start the same command again to go on")

    def _give_up(self, name: str, line: str) -> None:
        """Takes all shards from a worker."""
        worker = self._workers[name]
        worker.given_up = True
        self._live.discard(name)
        self.lost_workers += 1
        self._warn(line)
        for task, job in list(worker.running.items()):
            task.cancel()
            self._lost(job, line)
        worker.running.clear()

    def _start_shards(self) -> None:
        for name in sorted(self._live, key=lambda each: len(self._workers[each].running)):
            worker = self._workers[name]
            while len(worker.running) < self._runner.slots:
                job = self._next_job(name)
                if job is None:
                    break
                if not worker.running:
                    worker.since = time.monotonic()
                worker.running[asyncio.ensure_future(self._runner.run(name, job.number))] = job

    def _next_job(self, name: str) -> Optional[_Job]:
        for jobs in (self._second, self._fresh):
            for i, job in enumerate(jobs):
                others = self._live - job.failed_on - {job.worker}
                if job.worker != name and (name not in job.failed_on or not others):
                    del jobs[i]
                    return job
        return None

    async def _take_answers(self) -> None:
        tasks = self._tasks()
        if not tasks:
            await asyncio.sleep(0.05)
            return
        done, _ = await asyncio.wait(tasks, timeout=POLL_SECONDS, return_when=asyncio.FIRST_COMPLETED)
        for name, worker in self._workers.items():
            for task in [each for each in worker.running if each in done]:
                if task in worker.running:  # and not taken away because of the answer before
                    self._take(name, worker.running.pop(task), task)

    def _take(self, name: str, job: _Job, task: asyncio.Task) -> None:
        worker = self._workers[name]
        worker.since = time.monotonic()
        try:
            answer = task.result()
        except (WorkerLost, asyncio.CancelledError) as error:
            self._lost(job, f"worker {name}: {first_line(error)}")
        except Exception as error:  # pylint: disable=broad-except
            self._failed(name, job, error)
        else:
            worker.errors = 0
            self._answered(name, job, answer)

    def _lost(self, job: _Job, line: str) -> None:
        job.losses += 1
        if job.losses >= MAX_LOSSES:
            raise gps.Error(f"{self._label(job.number)}: {job.losses} workers were lost while they had it; the last "
                            f"one: {line}")
        self._again(job)

    def _failed(self, name: str, job: _Job, error: Exception) -> None:
        worker = self._workers[name]
        text = first_line(error) if isinstance(error, gps.Error) else f"{type(error).__name__}: {first_line(error)}"
        worker.errors += 1
        job.failed_on.add(name)
        if isinstance(error, gps.DeviceLost):
            self._lost(job, f"worker {name}: {text}")
        else:
            job.errors += 1
            if job.errors >= MAX_ERRORS:
                raise gps.Error(f"{self._label(job.number)}: {text}")
            self._again(job)
        if worker.errors >= MAX_ERRORS:
            self._give_up(name, f"worker {name} is left out: {text}")

    def _again(self, job: _Job) -> None:
        if job.answer is not None:
            self._second.append(job)
        else:
            self._fresh.appendleft(job)

    def _answered(self, name: str, job: _Job, answer: Answer) -> None:
        worker = self._workers[name]
        if job.answer is not None:
            if job.answer.data != answer.data:
                self._judge(job, [(job.worker, job.answer), (name, answer)])
            self.checked_twice += 1
            self._deliver(job.number, job.answer, True)
            return
        worker.answers += 1
        share = self._options.check_twice
        is_sampled = share > 0 and (worker.answers == 1 or int(worker.answers * share) > int(
            (worker.answers - 1) * share))
        if is_sampled and len(self._live) > 1:
            job.answer, job.worker = answer, name
            self._second.append(job)
        else:
            self._deliver(job.number, answer, False)

    def _judge(self, job: _Job, answers: List[Tuple[str, Answer]]) -> None:
        right = self._referee(job.number)
        wrong = [(name, answer) for name, answer in answers if answer.data != right]
        names = " and ".join(f"{name} ({answer.hardware})" for name, answer in wrong)
        raise WorkerIsWrong(f"wrong answers of worker {names}: {self._label(job.number)} has other answers on another "
                            "worker and in this process", [answer.hardware for _, answer in wrong])

    def _finish_without_second_worker(self) -> None:
        """Delivers sampled shards at the end if no second worker comes."""
        if self._fresh or self._tasks() or not self._second:
            self._alone_since = time.monotonic()
        elif time.monotonic() - self._alone_since > PATIENCE_SECONDS:
            for job in self._second:
                self.not_compared += 1
                self._deliver(job.number, job.answer, False)
            self._second.clear()
