"""The hash in the keys of proofs on disk changes with each change of the code that makes proofs, not with comments."""
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from folders import ROOT


def patterns():
    """The sources of proofs, as patterns of files relative to src/collision."""
    text = (ROOT / "src" / "collision" / "CMakeLists.txt").read_text()
    return re.search(r"file\(GLOB proof_sources CONFIGURE_DEPENDS ([^)]*)\)", text).group(1).split()


def hash_in(folder, sources):
    """The hash of files in folder/src, which may include files from folder/src and folder/include."""
    target = folder / "made.txt"
    options = ["-DSOURCES=" + ";".join(str(source) for source in sources), f"-DFILE={target}",
               f"-DROOTS={folder / 'src'};{folder / 'include'}", "-P", str(ROOT / "cmake" / "proof_sources.cmake")]
    subprocess.run(["cmake", *options], check=True, capture_output=True, text=True)
    return re.search(r'kProofSources = "([0-9a-f]{64})"', target.read_text()).group(1)


def hash_of(files, sources=None):
    """The hash of files by name. `sources`: the names of those that are not only included."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for file, text in files.items():
            path = folder / "src" / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return hash_in(folder, [folder / "src" / file for file in sources or files])


class ProofSources(unittest.TestCase):
    def expect(self, is_equal, before, after):
        self.assertEqual(is_equal, hash_of({"a.cpp": before}) == hash_of({"a.cpp": after}), f"{before!r}, {after!r}")

    def test_the_hash_changes_with_each_file(self):
        first = hash_of({"a.cpp": "a\n", "b.cpp": "b\n"})
        self.assertEqual(first, hash_of({"b.cpp": "b\n", "a.cpp": "a\n"}))
        for other in ({"a.cpp": "a;\n", "b.cpp": "b\n"}, {"a.cpp": "a\n", "b.cpp": "c\n"}, {"a.cpp": "a\n"},
                      {"a.cpp": "a\nb\n", "b.cpp": ""}):
            self.assertNotEqual(first, hash_of(other))

    def test_comments_blank_lines_and_indentation_do_not_count(self):
        for before, after in (
                ("a;\n", "// new\na;\n"), ("// a \"b\nc;\n", "// it's\nc;\n"), ("a;\n", "a;  // it's \"new\"\n"),
                ("a = b / c;  // old\n", "a = b / c;  ///< new // twice\n"), ("a;\n\n\n  b;\n", "a;\nb;  \n"),
                ("f(int /*old*/);\n", "f(int /*new*/);\n"), ("s = \"a // b\";  // old\n", "s = \"a // b\";\n"),
                ("s = \"\\\" // b\";  // old\n", "s = \"\\\" // b\";\n"), ("n = 10'000;  // old\n", "n = 10'000;\n")):
            self.expect(True, before, after)

    def test_all_code_counts(self):
        for before, after in (
                ("a;\n", "//a;\n"), ("ab;\n", "a b;\n"), ("a / b;\n", "a // b;\n"),
                ("s = \"a // b\";\n", "s = \"a // c\";\n"), ("s = \"\\\" // b\";\n", "s = \"\\\" // c\";\n"),
                ("s = \"a\" \"// b\";\n", "s = \"a\" \"// c\";\n"),
                ("c = '\"'; s = \"// b\";\n", "c = '\"'; s = \"// c\";\n"),
                ("s = R\"(\n// b\n)\";\n", "s = R\"(\n// c\n)\";\n"), ("s = R\"(\n a)\";\n", "s = R\"(\na)\";\n"),
                ("/*\n// */ a;\n", "/*\n// */ b;\n"), ("/* // */ a;\n", "/* // */ b;\n"),
                ("/*\n/* x */ a;\n", "/*\n/* x */ b;\n"),
                ("s = \"/*\"; b; t = \"*/\";\n", "s = \"/*\"; c; t = \"*/\";\n"),
                ("// a \\\nb;\nc;\n", "// a\nb;\nc;\n"), ("s = \"\\\n// b \\\n\";\n", "s = \"\\\n// c \\\n\";\n")):
            self.expect(False, before, after)

    def test_included_files_count(self):
        files = {"a.cpp": '#include "room/a.h"\n', "room/a.h": '#include "b.h"\n', "b.h": "b;\n", "c.h": "c;\n"}
        first = hash_of(files, ["a.cpp"])
        self.assertEqual(first, hash_of({**files, "c.h": "d;\n", "b.h": "b;  // new\n"}, ["a.cpp"]))
        self.assertNotEqual(first, hash_of({**files, "b.h": "d;\n"}, ["a.cpp"]))

    def test_a_file_that_is_not_found_is_an_error(self):
        with self.assertRaises(subprocess.CalledProcessError) as context:
            hash_of({"a.cpp": '#include "none.h"\n'})
        self.assertIn("none.h", context.exception.stderr)

    def test_the_rooms_that_make_proofs_are_hashed(self):
        for room in ("trees", "exact", "proofs", "geometry", "problem", "../base", "../model"):
            self.assertIn(f"{room}/*.cpp", patterns())
            self.assertIn(f"{room}/*.h", patterns())

    def test_no_comment_of_the_sources_counts(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for part in ("src", "include"):
                shutil.copytree(ROOT / part, folder / part)
            sources = sorted({path for pattern in patterns() for path in (folder / "src" / "collision").glob(pattern)})
            self.assertGreater(len(sources), 100)
            first = hash_in(folder, sources)
            for path in folder.rglob("*.*"):
                if path.suffix in (".h", ".cpp"):
                    lines = [line if '"' in line else line.replace("//", "// new ")
                             for line in path.read_text().splitlines()]
                    path.write_text("\n".join(lines) + "\n\n")
            self.assertEqual(first, hash_in(folder, sources))
            header = folder / "include" / "gpu_planning_scene" / "planning_scene.h"  # in none of the rooms
            header.write_text(header.read_text().replace("struct", "class", 1))
            self.assertNotEqual(first, hash_in(folder, sources))


if __name__ == "__main__":
    unittest.main()
