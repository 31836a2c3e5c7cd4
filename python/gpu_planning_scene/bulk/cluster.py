"""Runs shards on a Dask cluster. A robot and a scene are tasks of the graph whose keys are their digests: Dask brings
each of them to a worker once, and makes it anew if all workers that had it are lost."""
from __future__ import annotations

import asyncio
import dataclasses
import os
import threading
import uuid
import warnings
from concurrent.futures import CancelledError
from typing import Any, Callable, Dict, Optional, Set, Union

import distributed

import gpu_planning_scene as gps
from gpu_planning_scene.bulk import work
from gpu_planning_scene.bulk.bundle import FILTERING, RobotBundle, SceneBundle
from gpu_planning_scene.bulk.runner import Runner, Shard, WorkerLost
from gpu_planning_scene.bulk.states import ArraySlice, first_line

DEVICE_VARIABLE = "GPU_PLANNING_SCENE_BULK_DEVICE"  # of a worker's environment; it replaces the option --device
CONNECT_SECONDS = 20


class DaskRunner(Runner):
    """Each shard is sent to a certain worker, so that two workers can be compared."""

    slots = 2  # a shard that waits on the worker while another one is computed

    def __init__(self, address: str, robot: RobotBundle, device: str, shard_of: Callable[[int], Shard],
                 connect_seconds: float = CONNECT_SECONDS):
        self._address = address
        self._connect_seconds = connect_seconds
        self._robot = robot
        self._device = device
        self._shard_of = shard_of
        self._client: Optional[distributed.Client] = None
        self._bundles: Dict[str, distributed.Future] = {}

    async def open(self) -> None:
        # Bundles go through the scheduler only once, whatever their size.
        warnings.filterwarnings("ignore", message="Large object|Sending large graph")
        asyncio.get_running_loop().set_exception_handler(_report_unread)
        try:
            self._client = await distributed.Client(self._address, asynchronous=True,
                                                     timeout=self._connect_seconds)
        except (OSError, ValueError, asyncio.TimeoutError) as error:
            raise gps.Error(f"{self._address}: no scheduler answers ({first_line(error)})") from None

    async def close(self) -> None:
        self._bundles.clear()
        if self._client is not None:
            await self._client.close(timeout=5)

    async def workers(self) -> Set[str]:
        return set(await self._client.nthreads())

    async def run(self, worker: str, number: int) -> work.Answer:
        scene, task = self._shard_of(number)
        try:
            if isinstance(getattr(task, "states", None), ArraySlice):  # these states travel straight to their worker
                task = await self._client.scatter(task, workers=[worker], hash=False)
            future = self._client.submit(_perform, self._sent(self._robot), self._sent(scene), task, self._device,
                                         workers=[worker], pure=False, key=f"shard-{number}-{uuid.uuid4().hex}")
            answer = await future
            for text in answer.warnings:
                warnings.warn(text)  # each text once
            return answer
        except (distributed.scheduler.KilledWorker, CancelledError, OSError, asyncio.TimeoutError) as error:
            raise WorkerLost(first_line(error)) from None

    def _sent(self, bundle: Union[RobotBundle, SceneBundle]) -> distributed.Future:
        future = self._bundles.get(bundle.digest)
        if future is None or future.status in ("error", "cancelled", "lost"):
            again = "" if future is None else "-" + uuid.uuid4().hex
            future = self._client.submit(_same, bundle, key=f"gpu_planning_scene-{bundle.digest}{again}")
            self._bundles[bundle.digest] = future
        return future


def _report_unread(loop: asyncio.AbstractEventLoop, context: Dict[str, Any]) -> None:
    """Reports errors as asyncio does, except for a future that ended with a timeout and that nobody has read: a Dask
    client that is closed on a busy machine leaves such futures behind."""
    unread = context.get("message") == "Future exception was never retrieved"
    if not (unread and isinstance(context.get("exception"), asyncio.TimeoutError)):
        loop.default_exception_handler(context)


def _same(bundle: Union[RobotBundle, SceneBundle]) -> Union[RobotBundle, SceneBundle]:
    return bundle


_heard = threading.local()


def _hear_warnings() -> None:
    """Lets the warnings of each thread of this worker be collected in _heard.texts."""
    with FILTERING:
        show = warnings.showwarning
        if getattr(show, "is_hearing", False):
            return

        def hear(message: Any, *details: Any, **named: Any) -> None:
            getattr(_heard, "texts", []).append(str(message))
            show(message, *details, **named)

        hear.is_hearing = True
        warnings.showwarning = hear
        warnings.simplefilter("always", UserWarning)  # also if an earlier run had the same


def _perform(robot: RobotBundle, scene: SceneBundle, task: work.Task, device: str) -> work.Answer:
    _hear_warnings()
    _heard.texts = []
    answer = work.perform(robot, scene, task, os.environ.get(DEVICE_VARIABLE, device))
    return dataclasses.replace(answer, warnings=tuple(dict.fromkeys(_heard.texts)))
