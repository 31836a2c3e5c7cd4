"""The bundle for another machine is made from this build. It is small and complete, and does not use the build tree."""

import csv
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from folders import SCRIPTS

PROGRAMS = ("benchmark", "check_states", "generate_acm", "exactness", "literature", "planning_study", "read_mesh", "stability")


class BundleTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="gpu_planning_scene_bundle_")
        cls.bundle = os.path.join(cls.folder.name, "bundle")
        subprocess.run(
            [SCRIPTS / "bundle", "--from", BUILD, "--robots", ROBOTS, cls.bundle],
            check=True,
            timeout=300,
            env={**os.environ, "BUNDLE_MAX_BYTES": "300000000" if SANITIZED else "64000000"},
        )

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def files(self, folder):
        for path, _, names in os.walk(os.path.join(self.bundle, folder)):
            yield from (os.path.join(path, name) for name in names)

    def run_program(self, *arguments, **environment):
        return subprocess.run(
            [os.path.join(self.bundle, "run"), *arguments],
            capture_output=True,
            text=True,
            timeout=300,
            cwd="/",
            env={
                "PATH": "/usr/bin:/bin",
                "HOME": self.folder.name,
                "ASAN_OPTIONS": "detect_leaks=0",
                **environment,
            },
        )

    def test_is_under_64_megabytes(self):
        size = sum(os.path.getsize(path) for path in self.files(""))
        self.assertLess(size, 300e6 if SANITIZED else 64e6)

    def test_a_run_that_failed_leaves_no_bundle_and_hinders_no_other(self):
        again = os.path.join(self.folder.name, "again")
        command = [SCRIPTS / "bundle", "--from", BUILD, "--robots", ROBOTS, again]
        for _ in range(2):
            result = subprocess.run(
                command, capture_output=True, text=True, timeout=300, env={**os.environ, "BUNDLE_MAX_BYTES": "1000"}
            )
            self.assertEqual(result.returncode, 1)
            self.assertIn("the limit is", result.stderr)
            self.assertFalse(os.path.exists(again))

    def test_no_library_is_found_where_it_was_built(self):
        libraries = ":".join(os.path.join(self.bundle, folder) for folder in ("lib", "lib/common"))
        for path in [*self.files("bin"), *self.files("lib")]:
            if "/glibc/" in path:
                continue
            found = subprocess.run(
                ["ldd", path], capture_output=True, text=True, env={"PATH": "/usr/bin:/bin", "LD_LIBRARY_PATH": libraries}
            ).stdout
            self.assertNotIn("not found", found, path)
            self.assertNotIn(BUILD, found, path)
            dynamic = subprocess.run(["readelf", "--dynamic", path], capture_output=True, text=True).stdout
            self.assertNotIn("RUNPATH", dynamic, path)
            self.assertNotIn("RPATH", dynamic, path)

    def test_drivers_stay_the_machines(self):
        """The bundle has no drivers of its own. lib/dispatch comes after the machine's folders in the search order."""
        for path in self.files("lib"):
            if "/dispatch/" not in path:
                self.assertNotRegex(os.path.basename(path), "^lib(EGL|GL|OpenGL|drm|gbm|X11|xcb|wayland)")
            self.assertNotIn("mesa", path.lower())

    def test_every_program_starts(self):
        for program in os.listdir(os.path.join(self.bundle, "bin")):
            result = self.run_program(program, "--help")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(program, result.stdout)

    def test_programs_start_with_the_bundled_loader(self):
        """The loader is used on a machine whose glibc is older."""
        libraries = ":".join(os.path.join(self.bundle, folder) for folder in ("lib/glibc", "lib", "lib/common"))
        loader = next(path for path in self.files("lib/glibc") if "/ld-linux" in path)
        result = subprocess.run(
            [loader, "--library-path", libraries, os.path.join(self.bundle, "bin/benchmark"), "--help"],
            capture_output=True,
            text=True,
            timeout=300,
            env={"PATH": "/usr/bin:/bin", "ASAN_OPTIONS": "detect_leaks=0"},
        )
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_shaders_and_scenes_are_its_own(self):
        scene = os.path.join(self.bundle, "config/demo/kr5_scene.yaml")
        robot = os.path.join(self.bundle, "data/urdf/KR5/KR5 sixx R650.urdf")
        if not os.path.exists(robot):
            self.skipTest("Debian's dart-doc is not here")
        result = self.run_program(
            "check_states", "--urdf", robot, "--scene", scene, "--random", "16", GPU_PLANNING_SCENE_PROGRAM_CACHE="off"
        )
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_the_planning_study_has_its_problems(self):
        if not os.path.isdir(os.path.join(self.bundle, "data/problems")):
            self.skipTest("../shared is not here")
        out = os.path.join(self.folder.name, "planning")
        result = self.run_program(
            *("planning_study", "--out", out, "--problems", "1", "--seconds", "2"), GPU_PLANNING_SCENE_PROGRAM_CACHE="off"
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(os.path.join(out, "planning.csv"), newline="") as table:
            methods = {(row["rule"], row["method"]) for row in csv.DictReader(table)}
        self.assertEqual(len(methods), 8)
        self.assertTrue(os.path.exists(os.path.join(self.bundle, "draw_planning.py")))

    def test_an_unknown_program_is_named_with_those_that_there_are(self):
        result = self.run_program("benchmrak")
        self.assertEqual(result.returncode, 2)
        self.assertIn("benchmark", result.stderr)


class BundleWithoutABuildTest(unittest.TestCase):
    """scripts/bundle DIR builds the programs first. Here cmake is a stand-in whose programs are copies of `true`."""

    def test_builds_all_programs(self):
        folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        repository = folder / "repository"
        for part in ("scripts", "shaders", "config"):
            shutil.copytree(SCRIPTS.parent / part, repository / part)
        shutil.copy(SCRIPTS.parent / "LICENSE", repository)
        (repository / "scripts/install_dependencies").write_text("#!/bin/sh\n")
        calls = folder / "calls"
        # An exported function of bash, because the script puts the system's programs before those of the caller's PATH.
        stand_in = f"""() {{
          [[ "$1" != -P ]] || {{ command cmake "$@"; return; }}
          echo "$*" >> '{calls}'
          [[ "$*" != *--target* ]] || {{ echo 'unknown target'; return 1; }}
          [[ "$1" != --build ]] || for name in {" ".join(PROGRAMS)}; do cp /usr/bin/true "$2/$name"; done
        }}"""
        result = subprocess.run(
            [repository / "scripts/bundle", "--robots", folder, folder / "bundle"],
            capture_output=True,
            text=True,
            timeout=300,
            env={**os.environ, "BASH_FUNC_cmake%%": stand_in},
        )
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        configured, built = calls.read_text().splitlines()
        self.assertIn("-DCMAKE_BUILD_TYPE=Release", configured)
        self.assertRegex(built, f"^--build {repository}/build/bundle --parallel [0-9]+$")  # no --target
        self.assertEqual(sorted(os.listdir(folder / "bundle/bin")), sorted(PROGRAMS))


class ReportTest(unittest.TestCase):
    """The report of a bundle whose programs are stand-ins."""

    def report(self, stand_in):
        folder = tempfile.TemporaryDirectory(prefix="gpu_planning_scene_report_")
        self.addCleanup(folder.cleanup)
        bundle = pathlib.Path(folder.name)
        shutil.copy(SCRIPTS / "lib/bundle/report", bundle)
        (bundle / "run").write_text("#!/bin/sh\n" + stand_in)
        (bundle / "run").chmod(0o755)
        (bundle / "data/problems").mkdir(parents=True)
        command = [bundle / "report", bundle / "out", "--device", "1"]
        result = subprocess.run(command, capture_output=True, text=True, timeout=300)
        self.again = subprocess.run(command, capture_output=True, text=True, timeout=300)
        return result.returncode, (bundle / "out/report.txt").read_text()

    def test_has_the_output_of_each_program_for_the_device(self):
        status, report = self.report('echo "device: llvmpipe (a test), seed 1"; echo "output of $*"')
        self.assertEqual(status, 0, report)
        self.assertRegex(report.split("== stability")[0], "device: llvmpipe .a test., seed 1\nwarning: no GPU was used")
        for program in ("stability --quick", "exactness --quick"):
            self.assertIn(f"output of {program} --device 1\n", report)
        for program in ("benchmark --quick", "benchmark --parts throughput,kernels", "planning_study"):
            self.assertRegex(report, f"output of {program} .*--device 1\n")
        self.assertEqual(report.count(" passed "), 5, report)
        self.assertEqual(self.again.returncode, 2)
        self.assertIn("exists; name another folder", self.again.stderr)

    def test_names_the_programs_that_failed_or_took_too_long(self):
        status, report = self.report('case $1 in exactness) exit 1 ;; benchmark) exit 124 ;; esac')
        self.assertEqual(status, 1)
        self.assertRegex(report, "exactness +failed with exit status 1")
        self.assertRegex(report, "benchmark +stopped after 60 s")
        self.assertRegex(report, "rates +stopped after 110 s")
        self.assertRegex(report, "planning_study +passed")


if __name__ == "__main__":
    BUILD, ROBOTS, sanitized = sys.argv[1:]
    SANITIZED = sanitized == "1"
    unittest.main(argv=sys.argv[:1])
