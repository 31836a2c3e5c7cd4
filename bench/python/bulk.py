#!/usr/bin/python3
"""bulk.py URDF SCENE [--package NAME=DIR] [--states N] [--shard N] [--repeats N] [--workers N ...] [--kill-seconds S]
[--only NAME]: what bulk checking on a Dask cluster costs, and whether it survives.

    scheduler   the rate on 1, 2 and 4 worker processes, against the same run without Dask; and the efficiency of 64
                workers, by a model from measured times. With 5 repeats, it takes about 4 minutes without other load
    kills       one worker process is killed every few seconds; the output is compared byte by byte
    liar        a worker lies about one of 10^6 states; it must be named
    resume      the whole run is killed and started again

The load of the machine changes the rates, so the processor times are printed too."""
import argparse
import contextlib
import json
import os
import pathlib
import random
import re
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time

import dask
import distributed
import numpy as np

from gpu_planning_scene.bulk import command_line

SEED = 1
PROGRAM = [sys.executable, "-m", "gpu_planning_scene.bulk"]


class Processes:
    """A scheduler and workers as docs/bulk.md starts them. Each has a process group for all of its processes. In
    sessions of their own, they would get another share of the processors where the kernel has autogroups."""

    def __init__(self, folder, workers):
        self.folder = folder
        self.workers = workers
        self.groups = []

    def __enter__(self):
        file = self.folder / "scheduler.json"
        file.unlink(missing_ok=True)
        self._start("dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--dashboard-address", "127.0.0.1:0",
                    "--scheduler-file", file)
        while not file.exists() or not file.read_text():
            time.sleep(0.05)
        self.scheduler_address = json.loads(file.read_text())["address"]
        for _ in range(self.workers):
            self._start("dask_worker", self.scheduler_address, "--host", "127.0.0.1", "--nthreads", "1",
                        "--no-dashboard", "--local-directory", self.folder)
        with distributed.Client(self.scheduler_address) as client:
            client.wait_for_workers(self.workers)
        return self

    def _start(self, program, *options):
        self.groups.append(subprocess.Popen([sys.executable, "-m", f"distributed.cli.{program}", *map(str, options)],
                                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                              preexec_fn=os.setpgrp))

    def __exit__(self, *_error):
        for group in self.groups:
            os.killpg(group.pid, signal.SIGKILL)
            group.wait()

    @contextlib.contextmanager
    def stopped(self):
        """All processes stand still."""
        for group in self.groups:
            os.killpg(group.pid, signal.SIGSTOP)
        try:
            yield
        finally:
            for group in self.groups:
                os.killpg(group.pid, signal.SIGCONT)

    def processor_seconds(self):
        """Of the scheduler, and of all workers with their nannies."""
        used = dict.fromkeys((group.pid for group in self.groups), 0.0)
        for path in pathlib.Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = path.read_text().rpartition(")")[2].split()
            except OSError:  # the process has ended
                continue
            if int(fields[2]) in used:
                used[int(fields[2])] += (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
        scheduler, *workers = used.values()
        return scheduler, sum(workers)


class Bench:
    def __init__(self, arguments, folder):
        self.arguments = arguments
        self.folder = folder
        self.command = [*PROGRAM, "--urdf", arguments.urdf, "--scene",
                        arguments.scene, "--device", "cpu", "--shard", str(arguments.shard), "--seed", str(SEED)]
        for package in arguments.package:
            self.command += ["--package", package]

    def cluster(self, workers):
        return distributed.LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address="127.0.0.1:0")

    def options(self, cluster, states, out, *more):
        shutil.rmtree(self.folder / out, ignore_errors=True)
        return [*self.command, "--random", str(states), "--out", str(self.folder / out), "--scheduler",
                cluster.scheduler_address, *more]

    def run(self, *words):
        """The last line of a run."""
        return subprocess.run(words, check=True, capture_output=True, text=True).stdout.strip()

    def content(self, out):
        return {path.name: path.read_bytes() for path in sorted((self.folder / out).rglob("*")) if path.is_file()}

    def here(self, states, out):
        """A run without Dask in this process, which keeps its checker as workers do. Returns the seconds in which it
        has workers, and the processor seconds."""
        before = time.process_time()
        status, line = command_line.execute(self.options_here(states, out)[len(PROGRAM):])
        if status != 0:
            raise RuntimeError(line)
        return states / rate_of(line), time.process_time() - before

    def there(self, cluster, states, out):
        """The same for a run on a cluster, and the processor seconds of the scheduler and of the workers."""
        before = sum(os.times()[2:4]), *cluster.processor_seconds()
        line = self.run(*self.options(cluster, states, out, "--check-twice", "0"))
        after = sum(os.times()[2:4]), *cluster.processor_seconds()
        return states / rate_of(line), *(end - begin for begin, end in zip(before, after))

    def scheduler(self):
        """Runs with and without Dask take turns. The processes of Dask are stopped meanwhile, because they use
        processor time even if they have no work."""
        states = self.arguments.states // self.arguments.shard * self.arguments.shard
        print("workers  seconds without Dask, with Dask  share of the rate (least, most)  processor seconds without "
              "Dask; with Dask: program, scheduler, workers")
        rates = []
        for workers in self.arguments.workers:
            out = f"scheduler {workers}"
            with Processes(self.folder, workers) as cluster:
                rows = []
                for _ in range(self.arguments.repeats + 1):
                    with cluster.stopped():
                        here = self.here(states, "without Dask")
                    there = self.there(cluster, states, out)
                    rows.append((here[0], there[0], here[0] / there[0], here[1], *there[1:]))
            columns = list(zip(*rows[1:]))  # in the first run, the processes prepare the scene
            median = [statistics.median(column) for column in columns]
            rates.append(states / median[0])
            print(f"{workers:7}  {median[0]:.2f}, {median[1]:.2f}  {median[2]:.3f} ({min(columns[2]):.3f}, "
                  f"{max(columns[2]):.3f})  {median[3]:.1f}; {median[4]:.1f}, {median[5]:.2f}, {median[6]:.1f}",
                  flush=True)
        names = ["without Dask", *(f"scheduler {workers}" for workers in self.arguments.workers)]
        contents = [self.content(name) for name in names]
        print("the outputs have the same bytes:", all(each == contents[0] for each in contents))
        self.model(max(rates))

    def model(self, rate):
        """What the program and the scheduler do for each shard: the processor time of runs with shards of 64 states.
        Each is one process, so it limits the number of shards a second, whatever the number of workers."""
        used = []
        with self.cluster(2) as cluster:  # its scheduler is in this process
            for count in (200, 2200):
                words = self.options(cluster, 64 * count, "model", "--check-twice", "0", "--shard", "64")
                before = time.process_time(), sum(os.times()[2:4])
                self.run(*words)
                used.append((time.process_time() - before[0], sum(os.times()[2:4]) - before[1]))
        scheduler, program = ((many - few) / 2000 for few, many in zip(*used))
        print(f"processor time for each shard: program {1e3 * program:.2f} ms, scheduler {1e3 * scheduler:.2f} ms")
        busiest = max(program, scheduler)
        for shard in (self.arguments.shard, 8 * self.arguments.shard):
            for workers in (4, 64, 256):
                # n workers want n shards in each time of one shard; the busiest process serves 1 / busiest shards a
                # second. It delays an answer by the mean wait of a queue M/D/1. A worker has a second shard meanwhile.
                seconds = shard / rate
                load = workers * busiest / seconds
                wait = busiest * (1 + load / (2 * (1 - load))) if load < 1 else float("inf")
                efficiency = min(1.0, 1 / load, seconds / wait if wait < float("inf") else 1.0)
                print(f"model: {workers} workers at {rate:.0f} states/s, shards of {shard} ({seconds:.3f} s): load "
                      f"{load:.1%}, wait {1e3 * wait:.1f} ms, efficiency {efficiency:.3f}")

    def worker(self, cluster):
        """A worker process without a nanny, which may not survive kills while its worker starts."""
        return subprocess.Popen([sys.executable, "-m", "distributed.cli.dask_worker", cluster.scheduler_address,
                                 "--host", "127.0.0.1", "--nthreads", "1", "--no-nanny", "--no-dashboard",
                                 "--local-directory", str(self.folder)], stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL)

    def kills(self):
        seconds, states = self.arguments.kill_seconds, self.arguments.kill_states or self.arguments.states
        self.run(*self.options_here(states, "whole"))
        chance = random.Random(SEED)
        with self.cluster(0) as cluster, distributed.Client(cluster) as client:
            workers = [self.worker(cluster) for _ in range(3)]
            process = subprocess.Popen(self.options(cluster, states, "kills"), stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, text=True)
            begin, killed, after = time.monotonic(), 0, 0.0
            while process.poll() is None:
                time.sleep(0.1)
                passed = time.monotonic() - begin
                pids = client.run(os.getpid, on_error="ignore").values() if after < passed < seconds else ()
                if pids:
                    os.kill(chance.choice(sorted(pids)), signal.SIGKILL)
                    killed += 1
                    after = passed + chance.uniform(2, 6)
                workers = [self.worker(cluster) if each.poll() is not None else each for each in workers]
            out, err = process.communicate()
            for each in workers:
                each.kill()
                each.wait()
        print(f"{killed} workers killed within {min(seconds, passed):.0f} s of {passed:.0f} s; exit status "
              f"{process.returncode}; {out.strip() or err.strip()}")
        print("the output has the same bytes:", self.content("whole") == self.content("kills"))

    def options_here(self, states, out):
        shutil.rmtree(self.folder / out, ignore_errors=True)
        return [*self.command, "--random", str(states), "--out", str(self.folder / out)]

    def liar(self):
        states = self.arguments.states
        with self.cluster(2) as cluster, distributed.Client(cluster) as client:
            for share, runs in (("1", 1), ("0.01", self.arguments.liar_runs)):
                found = 0
                for run in range(runs):
                    worker = sorted(client.nthreads())[0]
                    client.run(lie, self.arguments.shard, run, workers=[worker])
                    answer = subprocess.run(self.options(cluster, states, "liar", "--check-twice", share), check=False,
                                            capture_output=True, text=True)
                    named = f"wrong answers of worker {worker} " in answer.stderr
                    found += named and answer.returncode == 1
                    if run == 0:
                        print(answer.stderr.strip() or answer.stdout.strip())
                wrong = states / 2 / 1e6
                print(f"--check-twice {share}: the liar was named in {found} of {runs} runs of {states} states; about "
                      f"{wrong:.1f} lies in a run, expected share {1 - (1 - float(share)) ** wrong:.2f}")

    def resume(self):
        states = self.arguments.states
        whole = self.run(*self.options_here(states, "whole"))
        with self.cluster(2) as cluster:
            words = self.options(cluster, states, "resume")
            for part in (0.2, 0.6):
                process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                wanted = part * states / self.arguments.shard
                while process.poll() is None and len(self.shards("resume")) < wanted:
                    time.sleep(0.02)
                process.send_signal(signal.SIGKILL)
                process.wait()
                print(f"killed with {len(self.shards('resume'))} shards")
            finished = {path: path.stat().st_ino for path in self.shards("resume")}
            line = self.run(*words)
        kept = all(path.stat().st_ino == inode for path, inode in finished.items())
        print(f"{whole}\n{line}\nthe finished shards were not written again: {kept}")
        print("the output has the same bytes:", self.content("whole") == self.content("resume"))

    def shards(self, out):
        return sorted((self.folder / out).glob("*/*.npy"))


def rate_of(line):
    """The rate in the last line of a run, in states a second."""
    return float(re.search("([0-9,]+) states/s", line)[1].replace(",", ""))


def lie(shard, seed):
    """Makes this worker process lie about one of 10^6 states."""
    import gpu_planning_scene.bulk.work as module  # pylint: disable=import-outside-toplevel
    right = getattr(module, "right", module.perform)
    module.right = right
    chance = np.random.default_rng(seed)

    def perform(*arguments):
        answer = right(*arguments)
        lies = np.flatnonzero(chance.random(shard) < 1e-6)
        data = bytearray(answer.data)
        for state in lies:
            if state // 8 < len(data):
                data[state // 8] ^= 128 >> state % 8
        return module.Answer(bytes(data), answer.hardware)

    module.perform = perform


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("urdf")
    parser.add_argument("scene")
    parser.add_argument("--package", action="append", default=[])
    parser.add_argument("--states", type=int, default=10**7)
    parser.add_argument("--shard", type=int, default=524288)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2, 4], help="worker processes")
    parser.add_argument("--kill-seconds", type=float, default=60.0)
    parser.add_argument("--kill-states", type=int, help="so many that the run takes longer than --kill-seconds")
    parser.add_argument("--liar-runs", type=int, default=3)
    parser.add_argument("--only", choices=("scheduler", "kills", "liar", "resume"))
    arguments = parser.parse_args()
    dask.config.set({"distributed.worker.daemon": True, "distributed.logging.distributed": "critical"})
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(arguments, pathlib.Path(folder))
        print(json.dumps({"dask": dask.__version__, "cores": os.cpu_count(), "shard": arguments.shard}))
        for name in ("scheduler", "kills", "liar", "resume"):
            if arguments.only in (None, name):
                print(f"== {name}")
                getattr(bench, name)()


if __name__ == "__main__":
    main()
