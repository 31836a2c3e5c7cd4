#!/usr/bin/python3
"""Shows that the simulated device finds faults: deletes one after the other each barrier() and each `precise` of the
shaders, and each bit of glMemoryBarrier at each kind of command, and runs small tasks until one of them is wrong. A call
of vectorBetween counts as a `precise`: a plain difference replaces it. A `precise` that is not found is deleted again
together with each other such `precise` of its file, because two of them often protect the same result. Prints a table
(Markdown). See docs/gpu.md.

    deletions.py BUILD [--seeds N] [--quick] [--only TEXT]
"""
import argparse
import concurrent.futures
import itertools
import os
import re
import resource
import shutil
import signal
import subprocess
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SHADERS = os.path.join(SOURCE, "shaders")
BARRIER = re.compile(r"^\s*(barrier|memoryBarrier\w*|groupMemoryBarrier)\(\);")
STATEMENTS = [
    (BARRIER, re.compile(r"\w+\(\);")),
    (re.compile(r"^\s*precise\s"), re.compile(r"precise\s")),
]
# The commands that a memory barrier precedes, by the file of the barrier. Only indirect dispatches have all bits.
COMMANDS = {
    "src/gpu/program.cpp": ["dispatch", "indirect dispatch"],
    "src/gpu/buffer.cpp": ["upload", "download", "clear", "copy"],
    "src/gpu/readback.cpp": ["readback"],
}
BITS = {"GL_TEXTURE_FETCH_BARRIER_BIT": 0x8, "GL_COMMAND_BARRIER_BIT": 0x40, "GL_BUFFER_UPDATE_BARRIER_BIT": 0x200,
        "GL_SHADER_STORAGE_BARRIER_BIT": 0x2000}
# Tasks for a folder of shaders; others try all tasks.
BATCHES = ["work_queue", "breadth_first"]
FUNCTIONS = ["transforms", "triangles", "distances", "kinematics", "arithmetic", "crossings", "containment", "solids",
             "boxes", "far_links", "half_spaces", "balls", "proofs", "turning_boxes"]
# With --quick, and for two `precise`, only the function tasks of the file are tried.
FUNCTION_OF = {
    "shaders/broad_phase/half_spaces.comp": ["half_spaces"],
    "shaders/broad_phase/self_pairs.comp": ["far_links"],
    "shaders/geometry/pose.glsl": ["transforms", "solids"],
    "shaders/geometry/triangle_distance.glsl": ["distances"],
    "shaders/geometry/triangle_error_bounds.glsl": ["triangles", "distances"],
    "shaders/geometry/triangle_pair.glsl": ["triangles", "distances"],
    "shaders/geometry/winding_number.glsl": ["crossings", "containment"],
    "shaders/problem/kinematics.glsl": ["kinematics"],
    "shaders/proofs/boxes.glsl": ["turning_boxes"],
    "shaders/proofs/covers.glsl": ["proofs", "turning_boxes"],
    "shaders/proofs/distances.glsl": ["proofs"],
    "shaders/proofs/joint_kinematics.glsl": ["turning_boxes"],
    "shaders/proofs/records.glsl": ["turning_boxes", "proofs"],
    "shaders/proofs/self_pair.glsl": ["proofs", "turning_boxes"],
    "shaders/proofs/state_proofs.glsl": ["proofs", "turning_boxes"],
    "shaders/self_test/float_arithmetic.comp": ["arithmetic"],
    "shaders/traversal/solid_leaf.glsl": ["solids"],
    "shaders/traversal/solid_nodes.glsl": ["solids"],
    "shaders/traversal/close_enough.glsl": ["boxes"],
    "shaders/tree_build/fit.glsl": ["boxes"],
}
# A run that needs more processor time than this, in seconds, does not end. A run without a deletion needs a few seconds.
MOST_SECONDS = 60


def limit_time(seeds):
    """Processor time, because a wait for a busy machine is not a fault."""
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS * seeds, MOST_SECONDS * seeds + 5))


def without_vector_between(line):
    """The line with a plain difference in place of the call of vectorBetween."""
    start = line.index("vectorBetween(")
    first = start + len("vectorBetween(")
    commas = []
    depth = 1
    end = first
    while depth > 0:
        if line[end] == "," and depth == 1:
            commas.append(end)
        depth += (line[end] in "([") - (line[end] in ")]")
        end += 1
    return f"{line[:start]}({line[commas[0] + 1:end - 1]} - ({line[first:commas[0]]})){line[end:]}"


def lines_of(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as file:
        return file.read().split("\n")


def shader_deletions():
    """Tuples (path, line, text): the line of a shader, and the line without the deleted words."""
    for folder, _, names in sorted(os.walk(os.path.join(SOURCE, "shaders"))):
        for name in sorted(names):
            path = os.path.relpath(os.path.join(folder, name), SOURCE)
            for number, line in enumerate(lines_of(path), 1):
                for statement, words in STATEMENTS:
                    if statement.search(line):
                        yield path, number, words.sub("", line, count=1)
                if "vectorBetween(" in line and not line.startswith("vec3 vectorBetween"):
                    yield path, number, without_vector_between(line)


def bit_deletions():
    """Tuples (path, line, bit, command)."""
    for folder, _, names in sorted(os.walk(os.path.join(SOURCE, "src"))):
        for name in sorted(names):
            path = os.path.relpath(os.path.join(folder, name), SOURCE)
            for number, line in enumerate(lines_of(path), 1):
                for bit in re.findall(r"GL_\w+_BARRIER_BIT", line):
                    for command in COMMANDS[path]:
                        if (bit, command) != ("GL_COMMAND_BARRIER_BIT", "dispatch"):
                            yield path, number, bit, command


class Runner:
    def __init__(self, build, seeds):
        self.programs = os.path.join(build, "devel", "lib", "gpu_planning_scene")
        self.device = os.path.join(build, "devel", "lib", "liblanes_device.so")
        self.seeds = seeds
        self.undamaged = {}

    def run_tasks(self, shaders, first, last, names, variables):
        """The task, its seed and what is wrong with these shaders and seeds; None if nothing is."""
        process = subprocess.run([os.path.join(self.programs, "lanes_workload"), shaders, f"{first}-{last}", *names],
                                 env={**os.environ, **variables}, capture_output=True, text=True,
                                 preexec_fn=lambda: limit_time(last - first + 1))
        if process.returncode == 0:
            return None
        if process.returncode == -signal.SIGXCPU:
            return ", ".join(names), str(first), f"the run does not end: it needs more than {MOST_SECONDS} s"
        if process.returncode != 1:
            raise RuntimeError(process.stderr)
        name, seed, *wrong = process.stdout.strip().split("\t")
        hangs = [line for line in wrong[1:] if "does not end" in line or "given up" in line]
        return name, seed, "; ".join([wrong[0], *hangs[:1]])

    def tasks(self, shaders, names, variables, at_once=1):
        """The same for all seeds, `at_once` of them a process, for what is right without the deletion."""
        found = None
        for first in range(1, self.seeds + 1, at_once):
            found = found or self.run_tasks(shaders, first, min(first + at_once - 1, self.seeds), names, variables)
        if not found:
            return None
        name, seed, _ = found
        if (name, seed) not in self.undamaged:
            self.undamaged[name, seed] = self.run_tasks(SHADERS, int(seed), int(seed), name.split(", "), {})
        if self.undamaged[name, seed]:
            raise RuntimeError(f"{name} is wrong without a deletion: {self.undamaged[name, seed]}")
        return found

    def without_lines(self, path, texts, search):
        """`search` for shaders in which the lines of a file, the keys of `texts`, are replaced by its values."""
        with tempfile.TemporaryDirectory() as folder:
            shaders = os.path.join(folder, "shaders")
            shutil.copytree(SHADERS, shaders)
            lines = lines_of(path)
            for number, text in texts.items():
                lines[number - 1] = text
            with open(os.path.join(folder, path), "w", encoding="utf-8") as file:
                file.write("\n".join(lines))
            return search(shaders)

    def without_barrier(self, path, number, text):
        return self.without_lines(path, {number: text}, lambda shaders: self.tasks(shaders, BATCHES, {}))

    def without_precise(self, path, texts, quick):
        def tasks(shaders, names):
            return self.tasks(shaders, names, {}, self.seeds)

        def search(shaders):
            own = FUNCTION_OF.get(path, [])
            found = tasks(shaders, own) if own else None
            if found or quick:
                return found
            others = [name for name in FUNCTIONS if name not in own]
            return tasks(shaders, others) or tasks(shaders, BATCHES)

        return self.without_lines(path, texts, search)

    def without_bit(self, bit, command):
        variables = {"GPS_LANES_IGNORE_BITS": hex(BITS[bit]), "GPS_LANES_IGNORE_BEFORE": command}
        return self.tasks(SHADERS, [*BATCHES, "buffers"], variables)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--seeds", type=int, default=20, help="seeds of each task (default 20)")
    parser.add_argument("--quick", action="store_true", help="for `precise`, only the function task of its file")
    parser.add_argument("--only", default="", help="only deletions whose line in the table contains this text")
    arguments = parser.parse_args()
    runner = Runner(arguments.build, arguments.seeds)
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        found = search(runner, pool, arguments)
    print(f"\n{sum(1 for one in found if one)} of {len(found)} deletions are found.")


def search(runner, pool, arguments):
    """Prints the table. Returns for each deletion what run_tasks does."""
    jobs = []
    for path, number, text in shader_deletions():
        line = lines_of(path)[number - 1]
        what = f"{path}:{number}: `{line.strip()}`"
        if arguments.only in what:
            job = pool.submit(runner.without_precise, path, {number: text}, arguments.quick) if not BARRIER.search(line) \
                else pool.submit(runner.without_barrier, path, number, text)
            jobs.append((what, job, (path, number, text)))
    for path, number, bit, command in bit_deletions():
        what = f"{path}:{number}: {bit} before {command}"
        if arguments.only in what:
            jobs.append((what, pool.submit(runner.without_bit, bit, command), None))
    print("| deletion | task | seed | what is wrong |\n| --- | --- | --- | --- |", flush=True)
    for what, job, _ in jobs:
        print("| " + " | ".join([what, *(job.result() or ("not found", "", ""))]) + " |", flush=True)
    missed = [deletion for _, job, deletion in jobs if deletion and deletion[0] in FUNCTION_OF and not job.result()]
    pairs = [(one[0], {one[1]: one[2], other[1]: other[2]})
             for one, other in itertools.combinations(missed, 2) if one[0] == other[0]]
    together = [(path, texts, pool.submit(runner.without_precise, path, texts, True)) for path, texts in pairs]
    for path, texts, job in together:
        lines = " and ".join(str(number) for number in texts)
        if job.result():
            print("| " + " | ".join([f"{path}:{lines} together", *job.result()]) + " |", flush=True)
    return [job.result() for _, job, _ in jobs]


if __name__ == "__main__":
    main()
