"""`pip install --no-build-isolation .` builds the Python module without ROS, and needs no network: CMake compiles the
libraries and the extension module, and installs them into the folder of the package. catkin does not use this file."""
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        package = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve().parent
        build = pathlib.Path(self.build_temp).resolve()
        options = {
            "CMAKE_BUILD_TYPE": "Release",
            "CMAKE_INSTALL_PREFIX": package,
            "CMAKE_UNITY_BUILD": "ON",  # reads large headers once for several files
            "PYTHON_EXECUTABLE": sys.executable,
            "GPU_PLANNING_SCENE_WHEEL": "ON",
        }
        subprocess.run(["cmake", "-S", ROOT, "-B", build, *(f"-D{name}={value}" for name, value in options.items())],
                       check=True)
        subprocess.run(["cmake", "--build", build, "--target", "gpu_planning_scene_python", "--parallel",
                        str(os.cpu_count())], check=True)
        subprocess.run(["cmake", "--install", build], check=True)


setup(
    name="gpu_planning_scene",
    version=xml.etree.ElementTree.parse(ROOT / "package.xml").getroot().findtext("version"),
    description="Checks thousands of robot states for collision at once",
    license="BSD-3-Clause",
    package_dir={"": "python"},
    packages=["gpu_planning_scene", "gpu_planning_scene.bulk"],
    package_data={"gpu_planning_scene": ["py.typed", "__init__.pyi"]},
    ext_modules=[Extension("gpu_planning_scene._core", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
    install_requires=["numpy"],
    extras_require={"dask": ["dask", "distributed"], "parquet": ["pyarrow"]},
    python_requires=">=3.8",
    zip_safe=False,
)
