"""The content of shard files: verdicts as .npy or Parquet, plans as .npz."""
from __future__ import annotations

import io
import zipfile
from typing import Any, Dict, List, Optional

import numpy as np

import gpu_planning_scene as gps


class VerdictFiles:
    """Verdicts of states: an .npy file with an array of bool, or with the fields `state` and `valid`; or a Parquet
    table with the columns `valid` and, with the states, one for each variable."""

    def __init__(self, suffix: str, names: List[str], has_states: bool):
        """suffix: ".npy" or ".parquet". names: of the robot's variables. Raises Error without pyarrow."""
        self.suffix = suffix
        self._names = names
        self._has_states = has_states
        if suffix == ".parquet":
            try:
                import pyarrow.parquet  # pylint: disable=import-outside-toplevel
            except ImportError:
                raise gps.Error("Parquet files need the Python package pyarrow, which is not installed; use --format "
                                "npy") from None
            self._arrow, self._parquet = pyarrow, pyarrow.parquet

    def content(self, valid: np.ndarray, states: Optional[np.ndarray]) -> bytes:
        """The file of verdicts, shape (n,), and of states, shape (n, variables)."""
        file = io.BytesIO()
        if self.suffix == ".parquet":
            columns = {} if states is None else dict(zip(self._names, np.ascontiguousarray(states.T)))
            self._parquet.write_table(self._arrow.table({**columns, "valid": valid}), file)
        elif states is None:
            np.save(file, valid)
        else:
            rows = np.empty(len(valid), dtype=[("state", float, (len(self._names),)), ("valid", bool)])
            rows["state"], rows["valid"] = states, valid
            np.save(file, rows)
        return file.getvalue()

    def summary(self, count: int, content: bytes) -> Dict[str, Any]:
        """The numbers of all states and of valid ones. Raises ValueError unless the file has `count` states."""
        if self.suffix == ".parquet":
            try:
                valid = self._parquet.read_table(io.BytesIO(content), columns=["valid"])["valid"].to_numpy()
            except self._arrow.ArrowException as error:
                raise ValueError(str(error)) from None
        else:
            try:
                rows = np.load(io.BytesIO(content), allow_pickle=False)
            except EOFError as error:
                raise ValueError(str(error)) from None
            valid = rows["valid"] if self._has_states else rows
        if valid.shape != (count,):
            raise ValueError("another number of states")
        return {"states": count, "valid": int(np.count_nonzero(valid))}


class PlanFiles:
    """Plans: the .npz files that work.PlanTask makes."""

    suffix = ".npz"

    @staticmethod
    def summary(count: int, content: bytes) -> Dict[str, Any]:
        """The numbers of all problems and of solved ones. Raises ValueError unless the file has `count` problems."""
        try:
            with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
                status, ends, waypoints = (arrays[name] for name in ("status", "ends", "waypoints"))
        except (zipfile.BadZipFile, KeyError, EOFError) as error:
            raise ValueError(str(error)) from None
        if status.shape != (count,) or len(waypoints) != (ends[-1] if count else 0):
            raise ValueError("another number of problems")
        return {"problems": count, "solved": int(np.count_nonzero(status == gps.PlanningStatus.SOLVED.value))}
