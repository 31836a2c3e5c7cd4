"""test_document.py [--pictures]: runs the programs of docs/python.md, docs/watching.md and docs/distances.md and
compares their output with the comments `# prints:`. With --pictures, it writes the picture of docs/python.md into
docs/pictures.
test_bulk_dask.py runs the program of docs/bulk.md."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "docs" / "python.md"
WATCHING = ROOT / "docs" / "watching.md"
DISTANCES = ROOT / "docs" / "distances.md"
PICTURE = ROOT / "docs" / "pictures" / "python_arm.png"
PICTURES = "--pictures" in sys.argv


def programs(document=DOCUMENT):
    """The indented blocks that import the module."""
    blocks = re.findall(r"(?:^(?:    .*)?\n)+", document.read_text(encoding="utf-8"), flags=re.MULTILINE)
    texts = [re.sub("^    ", "", block, flags=re.MULTILINE).strip() + "\n" for block in blocks]
    return [text for text in texts if "import gpu_planning_scene" in text]


class Document(unittest.TestCase):
    def test_each_program_prints_what_its_comments_say(self):
        self.assertGreaterEqual(len(programs()), 6)
        self.assertEqual(len(programs(WATCHING)), 1)
        self.assertEqual(len(programs(DISTANCES)), 3)
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(ROOT / "config", pathlib.Path(folder, "config"))
            for program in programs() + programs(WATCHING) + programs(DISTANCES):
                answer = subprocess.run([sys.executable, "-B", "-W", "error", "-c", program], cwd=folder, text=True,
                                        capture_output=True, timeout=200, check=False,
                                        env={**os.environ, "MPLBACKEND": "agg"})
                with self.subTest(program):
                    self.assertEqual((0, ""), (answer.returncode, answer.stderr))
                    expected = re.findall("^# prints: (.*)$", program, flags=re.MULTILINE)
                    self.assertTrue(expected)
                    self.assertEqual(expected, answer.stdout.splitlines())
            picture = pathlib.Path(folder, "arm.png")
            self.assertGreater(picture.stat().st_size, 1000)
            if PICTURES:
                shutil.copy(picture, PICTURE)

    def test_the_first_program_has_at_most_ten_lines(self):
        lines = [line for line in programs()[0].splitlines() if line and not line.startswith("#")]
        self.assertLessEqual(len(lines), 10)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
