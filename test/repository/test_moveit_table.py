"""The table of scripts/moveit_suite: no failure of this package's parts is hidden."""
import json
import pathlib
import subprocess
import tempfile
import unittest

from folders import SCRIPTS


def suite(name, *tests):
    """A suite in GoogleTest's form: each test is its name and whether it failed."""
    return {"name": name, "testsuite": [
        {"name": test, "result": "COMPLETED", "failures": [{"failure": ""}] if failed else []}
        for test, failed in tests]}


class MoveItTable(unittest.TestCase):
    def table(self, programs):
        """The script's exit status and output. `programs`: the suites of each program, None if it left no results."""
        with tempfile.TemporaryDirectory() as folder:
            for name, suites in programs.items():
                (pathlib.Path(folder) / f"{name}.log").write_text("")
                if suites is not None:
                    (pathlib.Path(folder) / f"{name}.json").write_text(json.dumps({"testsuites": suites}))
            done = subprocess.run(["/usr/bin/python3", str(SCRIPTS / "lib" / "moveit_table.py"), folder],
                                  capture_output=True, text=True, check=False)
            return done.returncode, done.stdout

    def test_failures_of_other_detectors_do_not_count(self):
        status, text = self.table({"FCL.tests": [suite("Suite", ("A", True))],
                                   "gpu_planning_scene.tests": [suite("Suite", ("A", False))]})
        self.assertEqual(status, 0, text)
        self.assertRegex(text, r"Suite\.A +failed +- +passed")

    def test_a_failure_of_ours_counts(self):
        status, text = self.table({"gpu_planning_scene.tests": [suite("Suite", ("A", True), ("B", False))]})
        self.assertEqual(status, 1, text)
        self.assertRegex(text, "passed .* 1 of 2")

    def test_one_parameter_that_fails_is_enough(self):
        for outcomes in ((True, False), (False, True)):
            tests = [(f"A/{i}", failed) for i, failed in enumerate(outcomes)]
            status, text = self.table({"gpu_planning_scene.tests": [suite("Seeds/Suite", *tests)]})
            self.assertEqual(status, 1, text)

    def test_a_program_that_ends_without_results_counts(self):
        programs = {"gpu_planning_scene.tests": [suite("Suite", ("A", False))], "gpu_planning_scene.crash": None}
        status, text = self.table(programs)
        self.assertEqual(status, 1, text)
        self.assertIn("gpu_planning_scene.crash ended without results", text)

    def test_a_program_without_tests_counts(self):
        programs = {"gpu_planning_scene.tests": [suite("Suite", ("A", False))], "gpu_planning_scene.empty": []}
        self.assertEqual(self.table(programs)[0], 1)

    def test_results_in_xml_count(self):
        for failure, expected in (("", 0), ("<failure message='no'/>", 1)):
            with tempfile.TemporaryDirectory() as folder:
                (pathlib.Path(folder) / "gpu_planning_scene.rostest.log").write_text("")
                (pathlib.Path(folder) / "gpu_planning_scene.rostest.xml").write_text(
                    "<testsuites><testsuite name='Following'><testcase name='A' result='completed'>" + failure +
                    "</testcase></testsuite></testsuites>")
                done = subprocess.run(["/usr/bin/python3", str(SCRIPTS / "lib" / "moveit_table.py"), folder],
                                      capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, expected, done.stdout)
            self.assertRegex(done.stdout, r"Following\.A .*" + ("failed" if failure else "passed"))


if __name__ == "__main__":
    unittest.main()
