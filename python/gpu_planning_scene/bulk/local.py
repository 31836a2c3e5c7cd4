"""Runs shards on the devices of this machine: a thread for each device. A check uses all cores by itself and releases
Python's lock, so more processes would gain nothing, and the scenes need not be copied."""
from __future__ import annotations

import asyncio
import queue
import threading
from typing import Callable, List, Sequence, Set

import gpu_planning_scene as gps
from gpu_planning_scene.bulk import work
from gpu_planning_scene.bulk.bundle import RobotBundle
from gpu_planning_scene.bulk.runner import Runner, Shard


def devices_of_this_machine() -> List[str]:
    """The GPUs, or, without one, "auto"."""
    return [str(device.index) for device in gps.list_devices() if not device.software] or ["auto"]


class LocalRunner(Runner):
    """shard_of: the scene and the task of a shard, by its number."""

    slots = 2  # a shard that waits while the answer of another one is written

    def __init__(self, robot: RobotBundle, devices: Sequence[str], shard_of: Callable[[int], Shard]):
        for device in devices:
            if devices.count(device) > 1:
                raise gps.Error(f"the device '{device}' is given twice")
        self._robot = robot
        self._shard_of = shard_of
        self._queues = {device: queue.SimpleQueue() for device in devices}

    async def open(self) -> None:
        loop = asyncio.get_running_loop()
        for device, jobs in self._queues.items():
            # A thread that hangs in a device must not keep the process alive.
            threading.Thread(target=self._work, args=(device, jobs, loop), daemon=True).start()

    async def close(self) -> None:
        for jobs in self._queues.values():
            jobs.put(None)

    async def workers(self) -> Set[str]:
        return set(self._queues)

    async def run(self, worker: str, number: int) -> work.Answer:
        answer = asyncio.get_running_loop().create_future()
        self._queues[worker].put((*self._shard_of(number), answer))
        return await answer

    def _work(self, device: str, jobs: queue.SimpleQueue, loop: asyncio.AbstractEventLoop) -> None:
        for scene, task, answer in iter(jobs.get, None):
            if answer.cancelled():
                continue
            try:
                outcome, give = work.perform(self._robot, scene, task, device), answer.set_result
            except Exception as error:  # pylint: disable=broad-except
                outcome, give = error, answer.set_exception
            try:
                loop.call_soon_threadsafe(_unless_cancelled, answer, give, outcome)
            except RuntimeError:  # the run has ended, and its loop is closed
                return


def _unless_cancelled(answer: asyncio.Future, give: Callable[[object], None], outcome: object) -> None:
    if not answer.done():
        give(outcome)
