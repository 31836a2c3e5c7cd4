"""The states of shards. A source knows all states; a slice has those of one shard and travels to the worker."""
from __future__ import annotations

import csv
import dataclasses
import hashlib
import io
import os
import pathlib
import warnings
from typing import Any, Dict, Iterator, List, Optional, Set, Tuple, Union

import numpy as np

import gpu_planning_scene as gps

Base = Optional[np.ndarray]  # the current state of the scene, shape (variables,)

# Random states are drawn in blocks. Each block has a seed of its own, so that a state depends only on the seed of the
# run and on its index, and not on the size of the shards.
BLOCK = 4096
# Random states that are checked at once. Their memory is used again for the next ones: new memory costs a page fault for
# each 4 KB, because Dask's workers give freed memory back to the system at once.
PART = 16 * BLOCK


@dataclasses.dataclass(frozen=True)
class RandomSlice:
    """The random states with the indices first, ..., first + count - 1."""
    seed: int
    first: int
    count: int
    moves_base: bool  # planar and floating joints get random values too

    def states(self, robot: gps.RobotModel, base: Base) -> np.ndarray:
        """Shape (count, variables)."""
        states = np.empty((self.count, len(robot.variables)))
        self._draw(robot, base, self.first, states)
        return states

    def parts(self, robot: gps.RobotModel, base: Base) -> Iterator[np.ndarray]:
        """The same states in arrays of up to PART rows. Each array has the memory of the one before."""
        states = np.empty((min(PART, self.count), len(robot.variables)))
        for done in range(0, self.count, PART):
            part = states[:min(PART, self.count - done)]
            self._draw(robot, base, self.first + done, part)
            yield part

    def _draw(self, robot: gps.RobotModel, base: Base, first: int, out: np.ndarray) -> None:
        """Draws the states with the indices first, first + 1, ... into the rows of `out`."""
        start = None if self.moves_base else base
        done = 0
        while done < len(out):
            block, skipped = divmod(first + done, BLOCK)
            seed = block_seed(self.seed, block)
            rows = out[done:done + BLOCK - skipped]
            if skipped:
                rows[:] = robot.random_states(skipped + len(rows), seed=seed, base=start,
                                              moves_base=self.moves_base)[skipped:]
            else:
                robot.random_states(len(rows), seed=seed, base=start, out=rows, moves_base=self.moves_base)
            done += len(rows)


@dataclasses.dataclass(frozen=True)
class ArraySlice:
    """States of a file. Variables that are not among `names` have their values from the scene."""
    names: Optional[Tuple[str, ...]]  # of the columns; None: all variables of the robot
    values: np.ndarray  # shape (count, columns)

    def states(self, robot: gps.RobotModel, base: Base) -> np.ndarray:
        """Shape (count, variables). Raises Error if a variable has no value."""
        if self.names is None:
            return np.ascontiguousarray(self.values, dtype=float)
        columns = [robot.variable_index(name) for name in self.names]
        with_default = _variables_with_default(robot)
        missing = [name for name in robot.variable_names if name not in self.names and name not in with_default]
        if missing and base is None:
            raise gps.Error(f"no value for {', '.join(missing)}: the table has no such column, and the scene has no "
                            "robot_state")
        assumed = [name for name in robot.variable_names if name not in self.names and name in with_default]
        if assumed and base is None:
            warnings.warn(f"no value for {', '.join(assumed)}: the table has no such column, and the scene has no "
                          "robot_state; the default values are used")
        states = np.empty((len(self.values), len(robot.variables)))
        states[:] = robot.default_state() if base is None else base
        states[:, columns] = self.values
        return states

    def parts(self, robot: gps.RobotModel, base: Base) -> Iterator[np.ndarray]:
        """The same states in one array, so that messages about wrong values count the states of the slice."""
        yield self.states(robot, base)


def _variables_with_default(robot: gps.RobotModel) -> Set[str]:
    """The variables that need no value: those of the virtual joint and of passive joints, as in the tool check_states."""
    names = set()
    for joint in robot.joints:
        if (joint.parent_link < 0 or joint.passive) and not joint.mimic and joint.first_variable >= 0:
            name = robot.variable_names[joint.first_variable]
            names |= {other for other in robot.variable_names
                      if other == name or other.startswith(joint.name + "/")}
    return names


Slice = Union[RandomSlice, ArraySlice]


class RandomStates:
    """count random states. moves_base: planar and floating joints get random values too."""

    def __init__(self, count: int, seed: int, moves_base: bool = False):
        self.count = count
        self._seed = seed
        self._moves_base = moves_base

    def identity(self) -> Dict[str, Any]:
        return {"random": self.count, "seed": self._seed, "random_base": self._moves_base}

    def slice(self, first: int, count: int) -> RandomSlice:
        return RandomSlice(self._seed, first, count, self._moves_base)


class ArrayFile:
    """The states of an .npy file, shape (n, variables)."""

    def __init__(self, path: gps.Path, robot: gps.RobotModel):
        self._file = UnchangedFile(path)
        try:
            self._array = np.load(path, mmap_mode="r", allow_pickle=False)
        except (ValueError, EOFError) as error:
            raise gps.Error(f"{path}: not an .npy file of numbers ({first_line(error)})") from None
        width = len(robot.variables)
        if self._array.dtype.kind not in "iuf" or self._array.ndim != 2 or self._array.shape[1] != width:
            raise gps.Error(f"{path}: the array has shape {self._array.shape} and type {self._array.dtype}; states "
                            f"need numbers of shape (n, {width}): {', '.join(robot.variable_names)}")
        self.count = len(self._array)

    def identity(self) -> Dict[str, Any]:
        return {"sha256": self._file.digest(), "states": self.count}

    def slice(self, first: int, count: int) -> ArraySlice:
        values = np.array(self._array[first:first + count], dtype=float, order="C")
        self._file.check()
        return ArraySlice(None, values)


class TableFile:
    """The states of a .csv file: a line with names of variables, then a line for each state."""

    def __init__(self, path: gps.Path, robot: gps.RobotModel, rows_per_mark: int = 4096):
        self._path = path
        self._rows_per_mark = rows_per_mark
        self._file = UnchangedFile(path)
        self._marks: List[int] = []  # the offset of each rows_per_mark-th row
        self._digest = hashlib.sha256()
        self.count = 0
        with open(path, "rb") as file:
            header = file.readline()
            self._names = self._names_of(header, robot)
            self._digest.update(header)
            offset = len(header)
            for line in file:
                if self.count % rows_per_mark == 0:
                    self._marks.append(offset)
                self._digest.update(line)
                offset += len(line)
                self.count += 1

    def _names_of(self, header: bytes, robot: gps.RobotModel) -> Tuple[str, ...]:
        try:
            names = [name.strip() for name in next(csv.reader([header.decode("utf-8-sig")]), [])]
        except (UnicodeDecodeError, csv.Error) as error:
            raise gps.Error(f"{self._path}:1: {first_line(error)}") from None
        for i, name in enumerate(names):
            if name not in robot.variable_names or name in names[:i]:
                raise gps.Error(f"{self._path}:1: column {i + 1}: '{name}' is not a variable of the robot, or is given "
                                f"twice; its variables are {', '.join(robot.variable_names)}")
        if not names:
            raise gps.Error(f"{self._path}:1: the first line must name the variables")
        return tuple(names)

    def identity(self) -> Dict[str, Any]:
        return {"sha256": self._digest.hexdigest(), "states": self.count}

    def slice(self, first: int, count: int) -> ArraySlice:
        mark = first // self._rows_per_mark
        with open(self._path, "rb") as file:
            file.seek(self._marks[mark])
            for _ in range(first - mark * self._rows_per_mark):
                file.readline()
            lines = [file.readline() for _ in range(count)]
        self._file.check()
        return ArraySlice(self._names, self._numbers(lines, first + 2))

    def _numbers(self, lines: List[bytes], number: int) -> np.ndarray:
        """The values of lines of the file; `number` is that of the first line."""
        try:
            values = np.loadtxt(io.BytesIO(b"".join(lines)), delimiter=",", ndmin=2, comments=None)
            if values.shape == (len(lines), len(self._names)):
                return values
        except ValueError:
            pass
        for i, line in enumerate(lines):  # find the line at fault
            cells = line.decode("utf-8", "replace").strip().split(",")
            where = f"{self._path}:{number + i}"
            if len(cells) != len(self._names):
                raise gps.Error(f"{where}: {len(cells)} values for {len(self._names)} variables")
            for cell in cells:
                try:
                    float(cell)
                except ValueError:
                    raise gps.Error(f"{where}: '{cell}' is not a number") from None
        raise gps.Error(f"{self._path}:{number}: these lines are not numbers that are separated by commas")


class UnchangedFile:
    """Finds changes of a file during a run."""

    def __init__(self, path: gps.Path):
        self._path = pathlib.Path(path)
        self._stamp = self._now()

    def _now(self) -> Tuple[int, int, int]:
        found = os.stat(self._path)
        return found.st_size, found.st_mtime_ns, found.st_ino

    def check(self) -> None:
        if self._now() != self._stamp:
            raise gps.Error(f"{self._path}: the file was changed during the run; start again with another --out")

    def digest(self) -> str:
        """The SHA-256 of the content, in hexadecimal."""
        total = hashlib.sha256()
        with open(self._path, "rb") as file:
            for part in iter(lambda: file.read(1 << 20), b""):
                total.update(part)
        return total.hexdigest()


Source = Union[RandomStates, ArrayFile, TableFile]


def block_seed(seed: int, block: int) -> int:
    """64 bits for the generator of a block of random states."""
    return int.from_bytes(hashlib.sha256(f"{seed} {block}".encode()).digest()[:8], "little")


def first_line(error: BaseException) -> str:
    """The first line of a message, or the name of the error if it has none."""
    lines = str(error).strip().splitlines()
    return lines[0] if lines else type(error).__name__
