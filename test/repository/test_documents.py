"""The documents name only files that exist."""
import re
import unittest

from folders import ROOT

# A path in backticks counts if it begins with one of these folders.
FOLDERS = "bench|cmake|config|docs|examples|include|launch|msg|python|scripts|shaders|src|srv|test"


def documents():
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]


def missing(text, folder):
    """The paths in backticks and the targets of links that do not exist. Links are relative to `folder`."""
    paths = re.findall(rf"`((?:{FOLDERS})/[\w./*-]*)`", text)
    links = [link for link in re.findall(r"\]\(([^)#]+)[^)]*\)", text) if "://" not in link]
    return [path for path in paths if not any(ROOT.glob(path.rstrip("/")))] + \
        [link for link in links if not (folder / link).exists()]


class Documents(unittest.TestCase):
    def test_name_only_files_that_exist(self):
        wrong = [f"{path.relative_to(ROOT)}: {name}"
                 for path in documents() for name in missing(path.read_text(), path.parent)]
        self.assertEqual([], wrong)

    def test_a_file_that_does_not_exist_is_found(self):
        self.assertEqual(["src/none.cpp", "none.md"],
                         missing("`src/none.cpp` `src/scene/files/read_*.cpp` [a](none.md#b) [c](README.md)", ROOT))


if __name__ == "__main__":
    unittest.main()
