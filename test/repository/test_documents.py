"""The documents name only files and sections that exist."""
import re
import unittest

from folders import ROOT

# A path in backticks counts if it begins with one of these folders.
FOLDERS = "bench|cmake|config|docs|examples|include|launch|msg|python|scripts|shaders|src|srv|test"


def documents():
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md")),
            *sorted((ROOT / "bench").glob("*.md"))]


def sections(text):
    """The names by which links find the sections of a document."""
    titles = re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", text, flags=re.S | re.M), re.M)
    return {re.sub(r"[^\w\- ]", "", re.sub(r"\[(.*?)\]\(.*?\)", r"\1", title)).strip().lower().replace(" ", "-")
            for title in titles}


def missing_sections(text, path):
    """The links to sections that do not exist, in a document with this text and path."""
    links = [link for link in re.findall(r"\]\(([^)\s]*#[^)\s]+)\)", text) if "://" not in link]
    return [link for link in links for file, section in [link.split("#")] if not file or (path.parent / file).exists()
            if section not in sections((path.parent / file).read_text() if file else text)]


def missing(text, folder):
    """The paths in backticks and the targets of links that do not exist. Links are relative to `folder`."""
    paths = re.findall(rf"`((?:{FOLDERS})/[\w./*-]*)`", text)
    links = [link for link in re.findall(r"\]\(([^)#]+)[^)]*\)", text) if "://" not in link]
    return [path for path in paths if not any(ROOT.glob(path.rstrip("/")))] + \
        [link for link in links if not (folder / link).exists()]


class Documents(unittest.TestCase):
    def test_name_only_files_and_sections_that_exist(self):
        wrong = [f"{path.relative_to(ROOT)}: {name}" for path in documents()
                 for name in missing(path.read_text(), path.parent) + missing_sections(path.read_text(), path)]
        self.assertEqual([], wrong)

    def test_a_file_that_does_not_exist_is_found(self):
        self.assertEqual(["src/none.cpp", "none.md"],
                         missing("`src/none.cpp` `src/scene/files/read_*.cpp` [a](none.md#b) [c](README.md)", ROOT))

    def test_a_section_that_does_not_exist_is_found(self):
        text = "# A `b`: c, d\n[x](#a-b-c-d) [y](#a-b) [z](README.md#gpu_planning_scene) [w](README.md#none)"
        self.assertEqual(["#a-b", "README.md#none"], missing_sections(text, ROOT / "x.md"))

    def test_results_and_notes_are_no_diaries(self):
        for name in ("RESULTS.md", "NOTES.md"):
            self.assertLessEqual(len((ROOT / "bench" / name).read_text().splitlines()), 400, name)


if __name__ == "__main__":
    unittest.main()
