"""The hash in the keys of proofs on disk changes with each change of the code that makes proofs."""
import pathlib
import re
import subprocess
import tempfile
import unittest

from folders import ROOT


class ProofSources(unittest.TestCase):
    def hash_of(self, files):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for file, text in files.items():
                (folder / file).write_text(text)
            sources = ";".join(str(folder / file) for file in files)
            target = folder / "made.txt"
            script = ROOT / "cmake" / "proof_sources.cmake"
            subprocess.run(["cmake", f"-DSOURCES={sources}", f"-DFILE={target}", "-P", script], check=True)
            return re.search(r'kProofSources = "([0-9a-f]{64})"', target.read_text()).group(1)

    def test_the_hash_changes_with_each_file(self):
        first = self.hash_of({"a.cpp": "a", "b.cpp": "b"})
        self.assertEqual(first, self.hash_of({"b.cpp": "b", "a.cpp": "a"}))
        for other in ({"a.cpp": "a ", "b.cpp": "b"}, {"a.cpp": "a", "b.cpp": "c"}, {"a.cpp": "a"},
                      {"a.cpp": "ab", "b.cpp": ""}):
            self.assertNotEqual(first, self.hash_of(other))

    def test_the_rooms_that_make_proofs_are_hashed(self):
        text = (ROOT / "src" / "collision" / "CMakeLists.txt").read_text()
        patterns = re.search(r"file\(GLOB proof_sources CONFIGURE_DEPENDS ([^)]*)\)", text).group(1).split()
        for room in ("exact", "filter/proofs", "geometry", "problem", "../model"):
            self.assertIn(f"{room}/*.cpp", patterns)
            self.assertIn(f"{room}/*.h", patterns)


if __name__ == "__main__":
    unittest.main()
