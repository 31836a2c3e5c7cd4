"""A robot and a scene with the content of all their files, so that a worker on another machine needs no file."""
from __future__ import annotations

import contextlib
import dataclasses
import hashlib
import os
import pathlib
import tempfile
import threading
import warnings
from typing import Callable, Dict, Iterator, Optional, Tuple

import gpu_planning_scene as gps


@dataclasses.dataclass(frozen=True)
class File:
    """A mesh or octomap file."""
    uri: str  # as the URDF or the scene names it
    suffix: str  # for example ".stl"; the library reads the format from it
    content: bytes


@dataclasses.dataclass(frozen=True)
class RobotBundle:
    """A robot. `digest`: the SHA-256 of the content, in hexadecimal."""
    urdf: str
    srdf: str  # empty: none
    planning: str  # the text of a file with joint_limits; empty: none
    files: Tuple[File, ...]
    digest: str

    @staticmethod
    def from_files(urdf: gps.Path, srdf: Optional[gps.Path] = None,
                   packages: gps.Packages = None, planning: Optional[gps.Path] = None) -> RobotBundle:
        """Reads a robot. The arguments are those of gpu_planning_scene.RobotModel.from_files. Raises its errors."""
        found = _FoundFiles(os.path.dirname(os.path.abspath(urdf)), packages)
        # pylint: disable-next=protected-access
        _robot, *texts = gps.RobotModel._from_files_with_texts(urdf, srdf, packages, found, planning)
        texts.append(_text(planning) if planning else "")
        files = found.read()
        return RobotBundle(*texts, files, _digest(*texts, *_parts(files)))

    def load(self) -> gps.RobotModel:
        """The robot, from the content alone."""
        with _unpacked(self.files) as path_of:
            return gps.RobotModel.from_xml(self.urdf, self.srdf, files=path_of, planning=self.planning)


@dataclasses.dataclass(frozen=True)
class SceneBundle:
    """A scene of a robot. `name`: of its file. `digest`: the SHA-256 of the content, in hexadecimal."""
    name: str
    text: str
    files: Tuple[File, ...]
    digest: str

    @staticmethod
    def from_file(path: gps.Path, robot: gps.RobotModel, packages: gps.Packages = None) -> SceneBundle:
        """Reads a scene file. The arguments are those of gpu_planning_scene.load_scene_file. Raises its errors."""
        path = pathlib.Path(path)
        found = _FoundFiles(path.resolve().parent, packages)
        gps.load_scene_file(path, robot, packages=packages, files=found)
        text = _text(path)
        files = found.read()
        return SceneBundle(path.name, text, files, _digest(path.suffix, text, *_parts(files)))

    def load(self, robot: gps.RobotModel) -> gps.PlanningScene:
        """The scene, from the content alone."""
        with _unpacked(self.files) as path_of:
            return gps.load_scene_text(self.text, robot, name=self.name, files=path_of)


class _FoundFiles:
    """An argument `files` of the loaders that finds files as usual and notes them."""

    def __init__(self, folder: gps.Path, packages: gps.Packages):
        self._folder = folder
        self._packages = packages
        self._paths: Dict[str, str] = {}

    def __call__(self, uri: str) -> str:
        if uri not in self._paths:
            self._paths[uri] = gps.resolve_uri(uri, self._folder, self._packages)
        return self._paths[uri]

    def read(self) -> Tuple[File, ...]:
        return tuple(File(uri, pathlib.Path(path).suffix, pathlib.Path(path).read_bytes())
                     for uri, path in sorted(self._paths.items()))


FILTERING = threading.Lock()  # the filters of warnings are those of the whole process


@contextlib.contextmanager
def _unpacked(files: Tuple[File, ...]) -> Iterator[Callable[[str], str]]:
    """A function from a URI to a path. The warnings of the files were shown when the bundle was made."""
    with tempfile.TemporaryDirectory(prefix="gpu_planning_scene_") as folder, FILTERING, warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        paths = {}
        for i, file in enumerate(files):
            paths[file.uri] = os.path.join(folder, f"{i}{file.suffix}")
            pathlib.Path(paths[file.uri]).write_bytes(file.content)
        yield paths.__getitem__


def _text(path: gps.Path) -> str:
    try:
        return pathlib.Path(path).read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise gps.Error(f"{path}: the file is not UTF-8; save it in this encoding") from None


def _parts(files: Tuple[File, ...]) -> Iterator[object]:
    for file in files:
        yield from (file.uri, file.suffix, file.content)


def _digest(*parts: object) -> str:
    """The SHA-256 of texts and bytes. Their lengths keep them apart."""
    total = hashlib.sha256()
    for part in parts:
        data = part if isinstance(part, bytes) else str(part).encode()
        total.update(len(data).to_bytes(8, "little") + data)
    return total.hexdigest()
