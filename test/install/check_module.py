"""check_module.py PREFIX URDF MESH: the installed Python module and the messages of the same name are one package, and the
module uses the installed libraries and the installed reader of mesh files. MESH: a cube."""
import pathlib
import sys

from gpu_planning_scene._client import Client
from gpu_planning_scene.srv import CheckStates, CheckStatesRequest

import gpu_planning_scene as gps

prefix, urdf, cube = sys.argv[1:]
robot = gps.RobotModel.from_files(urdf)
result = gps.StateChecker(gps.PlanningScene(robot), device="cpu").check(robot.default_state())
assert result.valid.tolist() == [True], result.valid
assert len(gps.Mesh.from_file(cube).triangles) == 12
assert CheckStates._request_class is CheckStatesRequest
assert pathlib.Path(gps.__file__).resolve().is_relative_to(pathlib.Path(prefix).resolve()), gps.__file__
assert Client.__module__ == "gpu_planning_scene._client"
libraries = {line.split()[-1] for line in open("/proc/self/maps") if "libgpu_planning_scene" in line}
assert any("_client.so" in library for library in libraries), libraries
for library in libraries:
    assert pathlib.Path(library).is_relative_to(pathlib.Path(prefix).resolve()), library
for name in ("py.typed", "__init__.pyi", "dask.py", "bulk/__main__.py", "bulk/work.py"):
    assert (pathlib.Path(gps.__file__).parent / name).exists(), name
