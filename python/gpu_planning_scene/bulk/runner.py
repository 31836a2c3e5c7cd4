"""What a dispatcher needs of the machines that run shards: local.LocalRunner and cluster.DaskRunner."""
from __future__ import annotations

from typing import Set, Tuple

from gpu_planning_scene.bulk import work
from gpu_planning_scene.bulk.bundle import SceneBundle

Shard = Tuple[SceneBundle, work.Task]


class WorkerLost(Exception):
    """The worker ended before it answered."""


class Runner:
    """Workers, by name. All functions are called in one event loop."""

    slots = 2  # shards that a worker has at once; one of them waits

    async def open(self) -> None:
        """Connects. Raises gpu_planning_scene.Error."""

    async def close(self) -> None:
        """Disconnects. Answers that are still awaited may never come."""

    async def workers(self) -> Set[str]:
        """The workers that are there now."""
        raise NotImplementedError

    async def run(self, worker: str, number: int) -> work.Answer:
        """The answer of a shard. Raises WorkerLost, and the errors of work.perform."""
        raise NotImplementedError
