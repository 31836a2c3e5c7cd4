"""A script leaves no process and no file of its own behind, however it ends. It leaves other processes alone."""
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from folders import SCRIPTS

# A child that ignores SIGTERM and has a child of its own.
START = f"""
set -euo pipefail
source {SCRIPTS}/lib/processes.sh
grace=1
start /dev/null bash -c 'trap "" TERM; sleep 1234 & echo $! > {{folder}}/grandchild; wait'
echo $! > {{folder}}/child
until [[ -s {{folder}}/grandchild ]]; do sleep 0.05; done
echo "$temporary" > {{folder}}/temporary
touch {{folder}}/ready
"""


def is_running(pid):
    try:
        stat = pathlib.Path(f"/proc/{pid}/stat").read_text()
    except FileNotFoundError:
        return False
    return stat.rpartition(") ")[2][0] != "Z"


class Processes(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def start(self, then):
        """Runs a script that starts its processes and continues with `then`."""
        process = subprocess.Popen(
            ["bash", "-c", START.format(folder=self.folder) + then], stdin=subprocess.DEVNULL, start_new_session=True
        )
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 20
        while not (self.folder / "ready").exists():
            self.assertLess(time.monotonic(), deadline, "the script did not start its processes")
            time.sleep(0.05)
        return process

    def assert_nothing_left(self):
        for name in ("child", "grandchild"):
            pid = int((self.folder / name).read_text())
            self.assertFalse(is_running(pid), name)
        self.assertFalse(pathlib.Path((self.folder / "temporary").read_text().strip()).exists())

    def test_at_the_end(self):
        self.assertEqual(self.start("exit 0").wait(60), 0)
        self.assert_nothing_left()

    def test_on_an_error(self):
        self.assertEqual(self.start("false").wait(60), 1)
        self.assert_nothing_left()

    def test_on_ctrl_c_while_a_program_runs(self):
        process = self.start("run sleep 1234")
        os.killpg(process.pid, signal.SIGINT)
        self.assertEqual(process.wait(60), 130)
        self.assert_nothing_left()

    def test_on_terminate_while_a_program_runs(self):
        process = self.start("run sleep 1234")
        process.terminate()
        self.assertEqual(process.wait(60), 143)
        self.assert_nothing_left()

    def test_what_lost_its_parent_is_ended_too(self):
        orphan = f"run bash -c 'sleep 1234 & echo $! > {self.folder}/orphan'"
        self.assertEqual(self.start(orphan).wait(60), 0)
        self.assert_nothing_left()
        self.assertFalse(is_running(int((self.folder / "orphan").read_text())))

    def test_run_passes_on_the_exit_status(self):
        self.assertEqual(self.start('run bash -c "exit 7" || exit $?').wait(60), 7)

    def test_leaves_others_alone(self):
        other = subprocess.Popen(["sleep", "60"])
        self.addCleanup(other.wait)
        self.addCleanup(other.kill)
        self.start("exit 0").wait(60)
        self.assertTrue(is_running(other.pid))


if __name__ == "__main__":
    unittest.main()
