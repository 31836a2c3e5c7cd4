#!/usr/bin/python3
"""A model of the time that GPUs need, from the work that the simulated device counts; see docs/gpu.md.

    gpu_model.py BUILD TABLES [--states N]

Runs state_costs of the folder BUILD for three scenes and keeps its tables in the folder TABLES. Tables that are there
are used again. Prints tables (Markdown): the work of a state, the time of a part of a batch by reason with the
predicted states per second, and the same after changes of the program.
"""
import argparse
import collections
import os
import subprocess

SCENES = ["kr5", "ur5_cage", "drchubo_corridor"]
BATCHES = {"16k": 1 << 14, "262k": 1 << 18, "1M": 1 << 20}
# States that the breadth-first traversal checks, only to count its dispatches.
BREADTH_FIRST_STATES = 256
DEFAULT_PART = 131072  # BatchCheckerOptions::max_batch
SLICE = 524288         # kLargestSlice of batch_size.h: within it, the host works beside the device
COUNTED_STATES = 16384

# Assumptions, the same for both GPUs.
QUOTIENT = 10            # instructions of a division or square root
ACCESS = 4               # instructions of an access: addresses, the access, the use of its words
ISSUE = 0.25             # share of the cycles in which a scheduler issues an instruction
OPERATION_CYCLES = 4     # of an operation on the longest path
ACCESS_CYCLES = 125      # of an access on it: 500 cycles, four of them at the same time
SECTOR_BYTES = 32
ATOMIC_SECONDS = 1e-9    # of atomics on one address
DISPATCH_SECONDS = 5e-6  # with its barrier
WAIT_SECONDS = 15e-6
HOST_SECONDS = 8e-9      # of a state, on two cores
EXACT_SECONDS = 10e-6    # of an undecided state, on two cores

# lanes: float operations in a cycle, without fused ones. cache, upload: bytes per second of the L2 cache and over PCIe.
Gpu = collections.namedtuple("Gpu", "name lanes hertz cycles_of_double cache upload")
GPUS = [Gpu("H200", 132 * 128, 1.98e9, 2, 5e12, 50e9),
        Gpu("RTX 4060 Laptop", 24 * 128, 2.0e9, 64, 1e12, 12e9)]

# Changes of the program, each in addition to those before it: factors, and the least busy share of a warp in the
# traversals.
Changes = collections.namedtuple("Changes", "title path busy work dispatches atomics host",
                                 defaults=(1, 0, 1, 1, 1, 1))
STEPS = [
    ("as it is", {}),
    ("work groups share traversals: an eighth of the path, 70 % busy",
     {"path": 1 / 8, "busy": 0.7}),
    ("half of the dispatches", {"dispatches": 1 / 2}),
    ("an eighth of the atomics: one for a warp", {"atomics": 1 / 8}),
    ("eight cores for the host instead of two", {"host": 1 / 4}),
    ("half of the operations of traversals", {"work": 1 / 2}),
]


def all_changes():
    """The steps with those before them."""
    sums, made = {}, []
    for title, step in STEPS:
        sums.update(step)
        made.append(Changes(title, **sums))
    return made


def tables_of(build, folder, scene, states, traversal):
    """The tables that state_costs prints: lists of rows, which map a column to a number."""
    path = os.path.join(folder, f"{scene}.{traversal}.{states}.tsv")
    if not os.path.exists(path):
        found = subprocess.run(["find", build, "-name", "state_costs", "-type", "f"], check=True, text=True,
                               stdout=subprocess.PIPE).stdout.split()
        text = subprocess.run([found[0], scene, str(states), traversal], check=True, text=True,
                              stdout=subprocess.PIPE).stdout
        os.makedirs(folder, exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    tables = []
    with open(path, encoding="utf-8") as file:
        for block in file.read().strip().split("\n\n"):
            header, *lines = [line.split("\t") for line in block.split("\n")]
            tables.append([dict(zip(header, [int(cell) if cell.isdigit() else cell for cell in line]))
                           for line in lines])
    return tables


class Scene:
    """The work of one part of a batch."""

    def __init__(self, build, folder, name, states):
        self.name = name
        self.programs, host, checked = tables_of(build, folder, name, states, "work_queue")
        self.all = self.programs.pop()
        self.host = host[0]
        self.checked = checked[0]
        self.states = states
        self.parts = self.host["waits"]
        self.breadth_first = tables_of(build, folder, name, BREADTH_FIRST_STATES, "breadth_first")

    def a_state(self, *columns):
        """The sum of columns of all programs, for one state."""
        return sum(self.all[column] for column in columns) / self.states

    def dispatches(self):
        return self.all["dispatches"] / self.parts

    def breadth_first_dispatches(self):
        programs, host, _ = self.breadth_first
        return programs[-1]["dispatches"] / host[0]["waits"]


def accesses(row):
    return row["fetches"] + row["loads"] + row["stores"] + row["atomics"]


def terms(scene, gpu, states, changes):
    """Seconds that one part of `states` states needs, by reason. Kernels follow each other. Of each kernel, the time is
    what takes longest (instructions, doubles, L2 cache, atomics), plus its longest path (the bound of R. L. Graham:
    Bounds for Certain Multiprocessing Anomalies, 1966)."""
    reasons = collections.Counter()
    share = states / scene.states
    rate = gpu.lanes * gpu.hertz
    for row in scene.programs:
        is_queue = "Traversal by work queues" in row["program"]
        busy = max(row["steps"] / max(1, row["steps of warps"]), changes.busy if is_queue else 0)
        work = share * (changes.work if is_queue else 1)
        instructions = row["floats"] + row["doubles"] + QUOTIENT * row["quotients"] + \
            ACCESS * (accesses(row) + row["shared"])
        full = {"instructions": instructions / busy / rate / ISSUE,
                "doubles": row["doubles"] / busy * gpu.cycles_of_double / rate,
                "L2 cache": row["sectors"] * SECTOR_BYTES / gpu.cache,
                "atomics": row["atomics"] * changes.atomics * ATOMIC_SECONDS}
        longest = max(full, key=full.get)
        reasons[longest] += work * full[longest]
        path = row["longest operations"] * OPERATION_CYCLES + row["longest accesses"] * ACCESS_CYCLES
        reasons["longest path"] += path / scene.parts / gpu.hertz * (changes.path if is_queue else 1)
    reasons["dispatches"] = scene.dispatches() * changes.dispatches * DISPATCH_SECONDS
    reasons["wait"] = WAIT_SECONDS
    reasons["upload"] = states / scene.states * scene.host["uploaded bytes"] / gpu.upload
    undecided = scene.checked["undecided"] / scene.states
    reasons["host"] = states * (HOST_SECONDS + undecided * EXACT_SECONDS) * changes.host
    return reasons


BESIDE = ("host", "upload")  # they work on the next part while the device works on this one


def batch_seconds(scene, gpu, states, changes):
    """The time of a batch, and what takes most of it."""
    if states > SLICE:
        seconds, reason = batch_seconds(scene, gpu, SLICE, changes)
        return seconds * states / SLICE, reason
    part = min(DEFAULT_PART, states)
    reasons = terms(scene, gpu, part, changes)
    beside = max(reasons[name] for name in BESIDE)
    device = sum(seconds for name, seconds in reasons.items() if name not in BESIDE)
    seconds = sum(reasons[name] for name in BESIDE) + max(device, beside) * (states / part - 1) + device
    bounds = [name for name in reasons if (name in BESIDE) == (beside > device)]
    return seconds, max(bounds, key=reasons.get)


def print_table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + " --- |" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def number(value):
    """With two or three digits."""
    return f"{value:,.0f}" if value >= 10 else f"{value:.1f}" if value >= 1 else f"{value:.2g}"


def print_work(scenes):
    """What one state needs."""
    def busy(scene):
        return f"{100 * scene.all['steps'] / scene.all['steps of warps']:.0f} %"
    lines = [
        ("float operations", lambda s: number(s.a_state("floats"))),
        ("divisions, square roots", lambda s: number(s.a_state("quotients"))),
        ("double operations", lambda s: number(s.a_state("doubles"))),
        ("fetches of texels", lambda s: number(s.a_state("fetches"))),
        ("loads; stores", lambda s: number(s.a_state("loads")) + "; " + number(s.a_state("stores"))),
        ("atomics", lambda s: number(s.a_state("atomics"))),
        ("bytes of these accesses; bytes of their sectors", lambda s: number(s.a_state("bytes")) + "; " +
         number(SECTOR_BYTES * s.a_state("sectors"))),
        ("accesses to shared memory", lambda s: number(s.a_state("shared"))),
        ("busy invocations of a warp", busy),
        ("bytes up; down", lambda s: number(s.host["uploaded bytes"] / s.states) + "; " +
         number(s.host["downloaded bytes"] / s.states)),
        ("undecided, of a million", lambda s: number(1e6 * s.checked["undecided"] / s.states)),
        ("of a part: dispatches (`breadth_first`)",
         lambda s: f"{number(s.dispatches())} ({number(s.breadth_first_dispatches())})"),
        ("of a part: calls of OpenGL", lambda s: number(s.host["host calls"] / s.parts)),
        ("of a part: longest path, operations; accesses", lambda s: number(s.all["longest operations"] / s.parts) +
         "; " + number(s.all["longest accesses"] / s.parts)),
    ]
    print_table(["for a state"] + [scene.name for scene in scenes],
                [[title] + [value(scene) for scene in scenes] for title, value in lines])


def print_times(scenes):
    """The terms of a part of 16,384 states in microseconds, and the millions of states per second of batches."""
    as_it_is = all_changes()[0]
    names = ["instructions", "doubles", "L2 cache", "atomics", "longest path", "dispatches", "host", "upload"]
    rows = []
    for gpu in GPUS:
        for scene in scenes:
            reasons = terms(scene, gpu, COUNTED_STATES, as_it_is)
            rows.append([f"{gpu.name}, {scene.name}"] + [number(1e6 * reasons[name]) for name in names] +
                        [number(rate(scene, gpu, states, as_it_is)[0]) for states in BATCHES.values()])
    print_table(["", *names, *BATCHES], rows)


def rate(scene, gpu, states, changes):
    """Millions of states per second, and what bounds them."""
    seconds, reason = batch_seconds(scene, gpu, states, changes)
    return states / seconds / 1e6, reason


def print_changes(scenes):
    """The same on the first GPU with more and more changes."""
    sizes = ["16k", "262k"]
    print_table(["change"] + [f"{scene.name}, {size}" for scene in scenes for size in sizes],
                [[changes.title] + ["{} ({})".format(number(millions), reason) for scene in scenes for size in sizes
                                    for millions, reason in [rate(scene, GPUS[0], BATCHES[size], changes)]]
                 for changes in all_changes()])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("tables")
    parser.add_argument("--states", type=int, default=COUNTED_STATES)
    arguments = parser.parse_args()
    scenes = [Scene(arguments.build, arguments.tables, name, arguments.states) for name in SCENES]
    print_work(scenes)
    print_times(scenes)
    print_changes(scenes)


if __name__ == "__main__":
    main()
