"""Runs of the program gpu_planning_scene.bulk in tests."""
import contextlib
import io
import pathlib
import subprocess
import sys
import time

from gpu_planning_scene.bulk import command_line
from robots import ARM, ARM_SCENE

PROGRAM = [sys.executable, "-B", "-m", "gpu_planning_scene.bulk"]
ARM_OPTIONS = ["--urdf", ARM, "--srdf", ARM.with_suffix(".srdf"), "--scene", ARM_SCENE, "--device", "cpu"]


def bulk(*options):
    """A run to its end, in this process. Returns the exit status, the last line, and the warnings."""
    with contextlib.redirect_stderr(io.StringIO()) as warnings:
        status, line = command_line.execute(list(map(str, options)))
    return status, line, warnings.getvalue()


def started_bulk(*options):
    """A run in a process of its own."""
    return subprocess.Popen([*PROGRAM, *map(str, options)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def shards(folder):
    """The shard files of a run that are there."""
    return sorted(each for each in pathlib.Path(folder).glob("*/*") if each.suffix != ".part")


def content(folder):
    """The bytes of each file of a run, by its path. The file .lock is empty."""
    return {str(each.relative_to(folder)): each.read_bytes()
            for each in sorted(pathlib.Path(folder).rglob("*")) if each.is_file()}


def wait_for_shards(folder, count, process=None):
    """Waits until the folder has so many shards."""
    deadline = time.monotonic() + 100
    while len(shards(folder)) < count:
        if time.monotonic() > deadline or (process is not None and process.poll() is not None):
            raise AssertionError(f"the run has only {len(shards(folder))} shards")
        time.sleep(0.005)
