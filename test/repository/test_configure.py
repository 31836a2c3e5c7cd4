"""CMake configures the package without a warning."""
import subprocess
import tempfile
import unittest

from folders import ROOT


class Configure(unittest.TestCase):
    def test_prints_no_warning(self):
        with tempfile.TemporaryDirectory() as folder:
            options = ["-G", "Ninja", "-DPYTHON_EXECUTABLE=/usr/bin/python3", "-DBUILD_TESTING=OFF",
                       "-DGPU_PLANNING_SCENE_BENCH=OFF"]
            answer = subprocess.run(["cmake", "-S", str(ROOT), "-B", folder, *options], capture_output=True, text=True,
                                    timeout=500, check=False)
        self.assertEqual(0, answer.returncode, answer.stderr)
        # catkin's own scripts have warnings of Python.
        self.assertNotIn("CMake Warning", answer.stderr)
        self.assertNotIn("CMake Deprecation", answer.stderr)


if __name__ == "__main__":
    unittest.main()
