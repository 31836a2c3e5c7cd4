"""All C++ is laid out as .clang-format says."""
import shutil
import subprocess
import unittest

from repository import ROOT

FOLDERS = ["include", "src", "test", "bench"]


class CodeFormat(unittest.TestCase):
    @unittest.skipUnless(shutil.which("clang-format"), "clang-format is not installed")
    def test_is_that_of_clang_format(self):
        files = [str(path) for folder in FOLDERS for path in (ROOT / folder).rglob("*") if path.suffix in (".h", ".cpp")]
        self.assertTrue(files)
        result = subprocess.run(["clang-format", "--dry-run", "-Werror"] + files, capture_output=True, text=True)
        wrong = sorted({line.split(":")[0] for line in result.stderr.splitlines() if "error:" in line})
        self.assertEqual(wrong, [], "run clang-format -i on these")


if __name__ == "__main__":
    unittest.main()
