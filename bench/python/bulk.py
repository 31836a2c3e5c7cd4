#!/usr/bin/python3
"""bulk.py URDF SCENE [--package NAME=DIR] [--states N] [--shard N] [--kill-seconds S] [--only NAME]: what bulk checking
on a Dask cluster costs, and whether it survives.

    scheduler   the rate on 1, 2 and 4 worker processes, against the same shards in one process without Dask; and the
                efficiency of 64 workers, by a model from measured times
    kills       one worker process is killed every few seconds; the output is compared byte by byte
    liar        a worker lies about one of 10^6 states; it must be named
    resume      the whole run is killed and started again

The load of the machine changes the rates, so the processor time of all processes of a run is compared with that of the
same shards without Dask. Idle processes of Dask take processor time too; it counts apart, as a share of the machine,
because it grows with the time that the run takes on a busy machine."""
import argparse
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

from gpu_planning_scene.bulk import work
from gpu_planning_scene.bulk.bundle import RobotBundle, SceneBundle
from gpu_planning_scene.bulk.states import RandomSlice

SEED = 1


class Bench:
    def __init__(self, arguments, folder):
        self.arguments = arguments
        self.folder = folder
        packages = dict(each.split("=", 1) for each in arguments.package)
        self.robot = RobotBundle.from_files(arguments.urdf, packages=packages)
        self.scene = SceneBundle.from_file(arguments.scene, self.robot.load(), packages)
        self.command = [sys.executable, "-m", "gpu_planning_scene.bulk", "--urdf", arguments.urdf, "--scene",
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
        """The last line of a run, and its seconds."""
        begin = time.perf_counter()
        answer = subprocess.run(words, check=True, capture_output=True, text=True)
        return answer.stdout.strip(), time.perf_counter() - begin

    def content(self, out):
        return {path.name: path.read_bytes() for path in sorted((self.folder / out).rglob("*")) if path.is_file()}

    def task(self, number):
        first = number * self.arguments.shard
        return work.CheckTask(RandomSlice(SEED, first, self.arguments.shard, False), "")

    def direct(self, count):
        """Shards in this process, without Dask and without files: seconds, and seconds of processor time."""
        work.perform(self.robot, self.scene, self.task(0), "cpu")
        begin = time.perf_counter(), time.process_time()
        for number in range(count):
            work.perform(self.robot, self.scene, self.task(number), "cpu")
        return time.perf_counter() - begin[0], time.process_time() - begin[1]

    def on_cluster(self, cluster, client, states, out):
        """The same for a run: the time in which it had workers, and the processor time of all its processes."""
        before = processor_seconds(client)
        line, _ = self.run(*self.options(cluster, states, out, "--check-twice", "0"))
        rate = float(re.search("([0-9,]+) states/s", line)[1].replace(",", ""))
        return states / rate, processor_seconds(client) - before

    def idle(self, client, seconds=10):
        """Processor time that the cluster uses in a second while it does nothing."""
        before = processor_seconds(client), time.perf_counter()
        time.sleep(seconds)
        return (processor_seconds(client) - before[0]) / (time.perf_counter() - before[1])

    def scheduler(self):
        count = self.arguments.states // self.arguments.shard
        states = count * self.arguments.shard
        print("workers  without Dask: seconds, processor seconds  with Dask: the same  share of the rate  cost in "
              "processor time: of the work, of Dask's idle processes")
        used = []
        for workers in (1, 2, 4):
            with self.cluster(workers) as cluster, distributed.Client(cluster) as client:
                # First, each worker prepares the scene. The second run shows what the program needs to start.
                self.on_cluster(cluster, client, 2 * workers * self.arguments.shard, "start")
                start = self.on_cluster(cluster, client, 64, "start")[1]
                idle = self.idle(client)
                pairs = []
                for _ in range(self.arguments.repeats):
                    direct = self.direct(count)
                    pairs.append((*direct, *self.on_cluster(cluster, client, states, f"scheduler {workers}")))
            wall, base, wall_dask, base_dask = (statistics.median(each) for each in zip(*pairs))
            used.append(base)
            print(f"{workers:7}  {wall:.1f} {base:.1f}  {wall_dask:.1f} {base_dask:.1f}  {wall / wall_dask:.3f}  "
                  f"{(base_dask - start - idle * wall_dask) / base - 1:.1%}  {idle / os.cpu_count():.1%}")
        contents = [self.content(f"scheduler {workers}") for workers in (1, 2, 4)]
        print("the outputs have the same bytes:", contents[0] == contents[1] == contents[2])
        self.model(states / min(used) * os.cpu_count())

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
        whole, _ = self.run(*self.options_here(states, "whole"))
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
            line, _ = self.run(*words)
        kept = all(path.stat().st_ino == inode for path, inode in finished.items())
        print(f"{whole}\n{line}\nthe finished shards were not written again: {kept}")
        print("the output has the same bytes:", self.content("whole") == self.content("resume"))

    def shards(self, out):
        return sorted((self.folder / out).glob("*/*.npy"))


def processor_seconds(client):
    """Of the workers, of the scheduler, which is in this process, and of all programs that have ended."""
    return sum(client.run(time.process_time).values()) + time.process_time() + sum(os.times()[2:4])


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
    parser.add_argument("--repeats", type=int, default=3)
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
