"""All C++ follows .clang-format, includes give whole paths, and test names are in upper camel case."""
import re
import shutil
import subprocess
import unittest

from repository import ROOT

FOLDERS = ["include", "src", "test", "bench", "examples"]


def sources():
    return [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".h", ".cpp")]


class CodeFormat(unittest.TestCase):
    @unittest.skipUnless(shutil.which("clang-format"), "clang-format is not installed")
    def test_is_that_of_clang_format(self):
        files = [str(path) for path in sources()]
        self.assertTrue(files)
        result = subprocess.run(["clang-format", "--dry-run", "-Werror"] + files, capture_output=True, text=True)
        wrong = sorted({line.split(":")[0] for line in result.stderr.splitlines() if "error:" in line})
        self.assertEqual(wrong, [], "run clang-format -i on these")

    def test_includes_give_the_path_from_src_test_or_bench(self):
        wrong = [
            f"{path.relative_to(ROOT)}: {include}"
            for path in sources()
            for include in re.findall(r'(?m)^#include "([^"]+)"', path.read_text())
            if "/" not in include and include != "shader_constants.h"
        ]
        self.assertEqual([], wrong)

    def test_tests_are_named_in_upper_camel_case(self):
        macro = re.compile(r"(?m)^(?:TYPED_)?TEST(?:_F|_P)?\((\w+),\s+(\w+)\)")
        names = [name for path in (ROOT / "test").rglob("*.cpp") for name in macro.findall(path.read_text())]
        self.assertGreater(len(names), 500)
        wrong = [f"{suite}.{name}" for suite, name in names if not re.fullmatch(r"[A-Z][A-Za-z0-9]*", suite + name)]
        self.assertEqual([], wrong)


if __name__ == "__main__":
    unittest.main()
