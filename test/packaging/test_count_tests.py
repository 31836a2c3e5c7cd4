"""The last line of ./scripts/test counts the results of ctest. A test that did not run does not count as passed."""
import pathlib
import subprocess
import tempfile
import unittest

from repository import SCRIPTS

JUNIT = """<testsuite tests="6">
  <testcase name="a" status="run"/>
  <testcase name="b" status="run"/>
  <testcase name="c" status="fail"><failure message=""/></testcase>
  <testcase name="d" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/></testcase>
  <testcase name="e" status="notrun"><skipped message="Unable to find executable"/></testcase>
  <testcase name="f" status="disabled"/>
</testsuite>"""


class CountTests(unittest.TestCase):
    def count(self, more_failed):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "tests.xml"
            path.write_text(JUNIT)
            command = ["/usr/bin/python3", str(SCRIPTS / "lib" / "count_tests.py"), str(path), more_failed]
            return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    def test_a_program_that_is_missing_failed(self):
        self.assertEqual(self.count("0"), "2 passed, 2 failed, 2 skipped\n")

    def test_other_failures_are_added(self):
        self.assertEqual(self.count("1"), "2 passed, 3 failed, 2 skipped\n")


if __name__ == "__main__":
    unittest.main()
