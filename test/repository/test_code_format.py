"""All C++ follows .clang-format; includes, comments of files and names of tests each follow one rule."""
import re
import shutil
import subprocess
import unittest

from folders import ROOT

FOLDERS = ["include", "src", "python", "test", "bench", "examples"]
# Paths of our own includes begin in one of these folders.
INCLUDE_FOLDERS = ["include", "src", "shaders", "python", "test", "bench"]
# The folders of src/collision whose longer files are algorithms.
ALGORITHMS = ["bounds", "contacts", "exact", "filter", "geometry", "gpu", "motion"]
LINES_OF_AN_ALGORITHM = 60
# The order of the includes of a file.
OWN_HEADER, STANDARD, LIBRARY, PROJECT = range(4)


def sources():
    return [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".h", ".cpp")]


def includes(path):
    """The included files, with their brackets or quotes."""
    return re.findall(r'(?m)^#include ([<"][^">]+[">])', path.read_text())


def kinds_of_includes(path):
    """OWN_HEADER is the first include of X.cpp or X_test.cpp if it is X.h."""
    kinds = []
    for include in includes(path):
        if include[0] == "<":
            kinds.append(LIBRARY if "/" in include or "." in include else STANDARD)
        else:
            header = re.sub("_test$", "", path.stem) + ".h"
            own = not kinds and path.suffix == ".cpp" and include[1:-1].split("/")[-1] == header
            kinds.append(OWN_HEADER if own else PROJECT)
    return kinds


def has_split_blocks(text, has_own_header):
    """Whether only empty lines separate two includes of this project. The own header is apart from the others."""
    if has_own_header:
        text = text.partition("#include ")[2]
    return re.search(r'(?m)^#include "[^"]+"\n\n+#include "', text) is not None


def comment_is_elsewhere(text):
    """Whether a comment of a whole file is not directly before its namespace. A program begins with its comment."""
    head = text.partition("\nnamespace ")[0] + "\n"
    at_the_top = text.startswith("//") and not re.search(r"(?m)^int main\(", text)
    return "\nnamespace " in text and (at_the_top or re.search(r"(?m)^//.*\n\n+\Z", head) is not None)


def has_opening_comment(text):
    """Whether a comment is directly before the namespace. It states the idea of an algorithm and its source."""
    return re.search(r"(?m)^//.*\nnamespace ", text) is not None


def wrong_names(text):
    """The names of tests and suites in a file that are not in upper camel case."""
    macros = re.findall(r"(?m)^(?:TYPED_)?TEST(?:_F|_P)?\((\w+),\s+(\w+)\)", text)
    return [name for names in macros for name in names if not re.fullmatch(r"[A-Z][A-Za-z0-9]*", name)]


def version_of(program):
    """The major version of an LLVM program. 0: it is not installed."""
    if not shutil.which(program):
        return 0
    answer = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    return int(re.search(r"version (\d+)", answer.stdout).group(1))


class CodeFormat(unittest.TestCase):
    @unittest.skipUnless(version_of("clang-format") == 14, "clang-format 14 is not installed; other versions differ")
    def test_is_that_of_clang_format(self):
        files = [str(path) for path in sources()]
        self.assertTrue(files)
        result = subprocess.run(["clang-format", "--dry-run", "-Werror"] + files, capture_output=True, text=True)
        wrong = sorted({line.split(":")[0] for line in result.stderr.splitlines() if "error:" in line})
        self.assertEqual(wrong, [], "run clang-format -i on these")

    def test_includes_in_quotes_are_files_of_this_repository_by_their_whole_paths(self):
        wrong = [
            f"{path.relative_to(ROOT)}: {include}"
            for path in sources()
            for include in includes(path)
            if include[0] == '"' and not any((ROOT / folder / include[1:-1]).is_file() for folder in INCLUDE_FOLDERS)
        ]
        self.assertEqual([], wrong)

    def test_includes_begin_with_the_own_header_then_the_standard_library_other_libraries_and_this_project(self):
        wrong = []
        for path in sources():
            kinds = kinds_of_includes(path)
            if kinds != sorted(kinds):
                wrong.append(str(path.relative_to(ROOT)))
        self.assertEqual([], wrong)

    def test_the_includes_of_this_project_form_one_block(self):
        wrong = [str(path.relative_to(ROOT)) for path in sources()
                 if has_split_blocks(path.read_text(), kinds_of_includes(path)[:1] == [OWN_HEADER])]
        self.assertEqual([], wrong)

    def test_includes_of_this_project_in_two_blocks_are_found(self):
        own, other = '#include "a.h"\n\n', '#include "b.h"\n\n#include "c.h"\n'
        self.assertTrue(has_split_blocks(own + other, True))
        self.assertTrue(has_split_blocks(other, False))
        self.assertFalse(has_split_blocks(own + '#include "b.h"\n', True))

    def test_the_comment_of_a_file_is_directly_before_its_namespace(self):
        wrong = [str(path.relative_to(ROOT)) for path in sorted((ROOT / "src").rglob("*.cpp"))
                 if comment_is_elsewhere(path.read_text())]
        self.assertEqual([], wrong)

    def test_a_comment_of_a_file_at_another_place_is_found(self):
        self.assertTrue(comment_is_elsewhere("#include <map>\n\n// The idea.\n\nnamespace a\n{\n}\n"))
        self.assertTrue(comment_is_elsewhere("// The idea.\n#include <map>\n\nnamespace a\n{\n}\n"))
        self.assertFalse(comment_is_elsewhere("#include <map>\n\n// The idea.\nnamespace a\n{\n}\n"))
        self.assertFalse(comment_is_elsewhere("// A program.\n\n#include <map>\n\nnamespace a\n{\n}\n\nint main()\n{\n}\n"))

    def test_an_algorithm_has_a_comment_with_its_idea_and_source(self):
        paths = [path for folder in ALGORITHMS for path in sorted((ROOT / "src" / "collision" / folder).rglob("*.cpp"))]
        long_files = [path for path in paths if len(path.read_text().splitlines()) > LINES_OF_AN_ALGORITHM]
        self.assertGreater(len(long_files), 40)
        wrong = [str(path.relative_to(ROOT)) for path in long_files if not has_opening_comment(path.read_text())]
        self.assertEqual([], wrong, "state the idea and its source directly before the namespace")

    def test_a_missing_comment_of_an_algorithm_is_found(self):
        self.assertTrue(has_opening_comment("#include <map>\n\n// The idea.\nnamespace a\n{\n}\n"))
        self.assertFalse(has_opening_comment("#include <map>\n\nnamespace a\n{\n// Another comment.\n}\n"))

    def test_lines_of_shaders_and_scripts_have_at_most_120_characters(self):
        # clang-format limits the lines of C++.
        paths = [path for folder in ("shaders", "scripts") for path in sorted((ROOT / folder).rglob("*"))
                 if path.is_file() and "__pycache__" not in path.parts]
        wrong = [f"{path.relative_to(ROOT)}:{number}" for path in paths
                 for number, line in enumerate(path.read_text().splitlines(), 1) if len(line) > 120]
        self.assertEqual([], wrong)

    def test_tests_and_suites_are_named_in_upper_camel_case(self):
        wrong = [f"{path.relative_to(ROOT)}: {name}"
                 for path in (ROOT / "test").rglob("*.cpp") for name in wrong_names(path.read_text())]
        self.assertEqual([], wrong)

    def test_a_wrong_name_of_a_test_or_a_suite_is_found(self):
        self.assertEqual(["isFree"], wrong_names("TEST(Box, isFree)\n"))
        self.assertEqual(["box"], wrong_names("TEST_F(box, IsFree)\n"))
        self.assertEqual(["Is_free"], wrong_names("TYPED_TEST(Box,\n           Is_free)\n"))
        self.assertEqual([], wrong_names("TEST_P(Box, IsFree)\n"))


if __name__ == "__main__":
    unittest.main()
