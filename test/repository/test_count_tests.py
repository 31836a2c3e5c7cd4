"""The last line of ./scripts/test counts what ctest and GoogleTest wrote: nothing that did not run counts as passed."""
import pathlib
import subprocess
import tempfile
import unittest

from folders import SCRIPTS

JUNIT = """<testsuite>
  <testcase name="a" status="run"/>
  <testcase name="b" status="run"/>
  <testcase name="c" status="fail"><failure message=""/></testcase>
  <testcase name="d" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/></testcase>
  <testcase name="e" status="notrun"><skipped message="Unable to find executable"/></testcase>
  <testcase name="f" status="disabled"/>
</testsuite>"""

SUITE = """<testsuite><testcase name="Seeds/Suite" status="{status}"/></testsuite>"""

REPORT = """<testsuites><testsuite name="Seeds/Suite">
  <testcase name="A" status="run" result="completed"/>
  <testcase name="B" status="run" result="completed"/>
  <testcase name="C" status="run" result="skipped"><skipped message="no robot"/></testcase>
  <testcase name="D" status="notrun" result="suppressed"/>
  {more}
</testsuite></testsuites>"""

FAILED_CASE = """<testcase name="E" status="run" result="completed"><failure message=""/></testcase>"""


class CountTests(unittest.TestCase):
    def count(self, junit, more_failed="0", reports=()):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "tests.xml"
            path.write_text(junit)
            for name, text in dict(reports).items():
                (pathlib.Path(folder) / name).write_text(text)
            command = ["/usr/bin/python3", str(SCRIPTS / "lib" / "count_tests.py"), str(path), folder, more_failed]
            return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    def test_a_program_that_is_missing_failed(self):
        self.assertEqual(self.count(JUNIT), "2 passed, 2 failed, 2 skipped\n")

    def test_other_failures_are_added(self):
        self.assertEqual(self.count(JUNIT, "1"), "2 passed, 3 failed, 2 skipped\n")

    def test_the_cases_of_a_suite_are_counted(self):
        report = {"Seeds.Suite.xml": REPORT.format(more="")}
        self.assertEqual(self.count(SUITE.format(status="run"), reports=report), "2 passed, 0 failed, 1 skipped\n")

    def test_a_failed_case_is_counted_once(self):
        report = {"Seeds.Suite.xml": REPORT.format(more=FAILED_CASE)}
        self.assertEqual(self.count(SUITE.format(status="fail"), reports=report), "2 passed, 1 failed, 1 skipped\n")

    def test_a_suite_that_leaks_after_its_last_case_failed(self):
        report = {"Seeds.Suite.xml": REPORT.format(more="")}
        self.assertEqual(self.count(SUITE.format(status="fail"), reports=report), "2 passed, 1 failed, 1 skipped\n")

    def test_a_skipped_case_that_runs_alone_is_skipped(self):
        case = '<testsuite><testcase name="Seeds/Suite.C" status="run"/></testsuite>'
        skipped = '<testsuite><testcase name="C" status="run" result="skipped"><skipped message=""/></testcase></testsuite>'
        report = {"Seeds.Suite.C.xml": skipped}
        self.assertEqual(self.count(case, reports=report), "0 passed, 0 failed, 1 skipped\n")

    def test_a_suite_that_crashes_without_a_report_failed(self):
        self.assertEqual(self.count(SUITE.format(status="fail")), "0 passed, 1 failed, 0 skipped\n")


if __name__ == "__main__":
    unittest.main()
