"""The folder of a run: index.json, and a folder of shard files for each scene.

A file is written under a temporary name and then renamed, so a file that is there is complete. index.json has what
defines the run; a run that goes on must have the same definition. The file `journal` notes which hardware computed a
shard, until all shards are there: then index.json gets the list of all shards, and the journal is deleted."""
from __future__ import annotations

import contextlib
import fcntl
import hashlib
import json
import os
import pathlib
from typing import Any, Callable, Dict, List, Sequence

import gpu_planning_scene as gps

FORMAT = "gpu_planning_scene.bulk 1"


class OutputFolder:
    """A context manager, which raises Error if the folder holds another run, or is in use. files: the paths of the
    shards in the folder, by number. summary_of: describes the content of a shard file, and raises ValueError if it is
    not complete."""

    def __init__(self, folder: gps.Path, definition: Dict[str, Any], files: Sequence[str],
                 summary_of: Callable[[int, bytes], Dict[str, Any]]):
        self._folder = pathlib.Path(folder)
        self._files = files
        self._summary_of = summary_of
        self._definition = {"format": FORMAT, **definition}
        self._records: Dict[int, Dict[str, Any]] = {}
        self._files_in_use = contextlib.ExitStack()

    def __enter__(self) -> OutputFolder:
        with self._files_in_use as stack:
            self._folder.mkdir(parents=True, exist_ok=True)
            lock = stack.enter_context(open(self._folder / ".lock", "ab"))
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise gps.Error(f"{self._folder}: another process writes into this folder; choose another "
                                "--out") from None
            self._check_definition()
            for path in {self._folder, *((self._folder / name).parent for name in self._files)}:
                path.mkdir(exist_ok=True)
                for rest in path.glob("*.part"):
                    rest.unlink()
            self._read_shards()
            self._journal = stack.enter_context(open(self._folder / "journal", "a", encoding="utf-8"))
            self._files_in_use = stack.pop_all()
        return self

    def __exit__(self, *_error: object) -> None:
        self._files_in_use.close()

    def _check_definition(self) -> None:
        path = self._folder / "index.json"
        if not path.exists():
            unknown = sorted(each.name for each in self._folder.iterdir()
                             if each.name != ".lock" and each.suffix != ".part")
            if unknown:
                raise gps.Error(f"{self._folder}: the folder has no index.json, but other files ({unknown[0]}); choose "
                                "an empty folder")
            self._write(path, _json(self._definition))
            return
        try:
            before = json.loads(path.read_text(encoding="utf-8"))
        except ValueError:
            raise gps.Error(f"{path}: not an index of a run; choose another --out") from None
        other = [key for key, value in self._definition.items() if before.get(key) != value]
        if other:
            raise gps.Error(f"{path}: the folder holds a run with another {' and '.join(other)}; choose another --out, "
                            "or delete the folder")

    def _read_shards(self) -> None:
        for number, name in enumerate(self._files):
            try:
                self._note(number, (self._folder / name).read_bytes())
            except (FileNotFoundError, ValueError):  # not there, or cut off when the machine stopped
                pass

    def _note(self, number: int, content: bytes) -> None:
        self._records[number] = {"file": self._files[number], **self._summary_of(number, content),
                                 "sha256": hashlib.sha256(content).hexdigest()}

    @property
    def missing(self) -> List[int]:
        """The numbers of the shards that are not there."""
        return [number for number in range(len(self._files)) if number not in self._records]

    @property
    def records(self) -> List[Dict[str, Any]]:
        """The descriptions of the shards that are there."""
        return [self._records[number] for number in sorted(self._records)]

    def write(self, number: int, content: bytes, hardware: str, compared: bool) -> None:
        """Adds a shard. compared: two workers have given its answer."""
        self._journal.write(json.dumps([number, hardware, compared]) + "\n")
        self._journal.flush()
        self._write(self._folder / self._files[number], content)
        self._note(number, content)

    def discard(self, hardware: Sequence[str]) -> int:
        """Deletes the shards that this hardware computed alone, also in earlier processes. Returns their number."""
        alone = {}
        for line in (self._folder / "journal").read_text(encoding="utf-8").splitlines():
            try:
                number, by, compared = json.loads(line)
            except ValueError:  # cut off when a process ended; its shard was not written
                continue
            alone[number] = by in hardware and not compared
        numbers = [number for number, is_alone in alone.items() if is_alone and number in self._records]
        for number in numbers:
            (self._folder / self._files[number]).unlink()
            del self._records[number]
        return len(numbers)

    def finish(self) -> None:
        """Writes the list of all shards into the index."""
        self._write(self._folder / "index.json", _json({**self._definition, "shards": self.records}))
        (self._folder / "journal").unlink()

    def _write(self, path: pathlib.Path, content: bytes) -> None:
        part = path.with_name(path.name + ".part")
        part.write_bytes(content)
        os.replace(part, path)


def _json(value: Dict[str, Any]) -> bytes:
    return (json.dumps(value, indent=1) + "\n").encode()
