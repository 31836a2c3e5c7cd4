"""A unity build compiles several files as one. So a name of an unnamed namespace may occur only once in a library or in
a test program."""
import collections
import re
import unittest

from folders import ROOT

UNNAMED = re.compile(r"^namespace\n\{\n(.*?)^\}  // namespace\n", re.S | re.M)
NAMES = re.compile(r"^(?:(?:constexpr|const) [\w:<>, ]+?[ &]|struct |class |enum class )(\w+)", re.M)


def libraries():
    """The folders that add a library or module each, and the C++ files below them that no inner library has."""
    folders = [path.parent for path in [*(ROOT / "src").rglob("CMakeLists.txt"), ROOT / "python" / "CMakeLists.txt"]
               if re.search("add_library\\(|add_module\\(", path.read_text())]
    for folder in folders:
        inner = [other for other in folders if other != folder and folder in other.parents]
        yield folder, [path for path in folder.rglob("*.cpp") if not any(i in path.parents for i in inner)]


def test_programs():
    """The folder and name of each test program, and its C++ files."""
    for path in sorted((ROOT / "test").rglob("CMakeLists.txt")):
        text = path.read_text()
        if "set(CMAKE_UNITY_BUILD OFF)" in text:
            continue
        for name, sources in re.findall(r"gps_add_test\((\w+)[^)]*?SOURCES([^)]*)\)", text):
            files = [source.replace("${PROJECT_SOURCE_DIR}", str(ROOT)) for source in sources.split()]
            yield path.parent / name, [path.parent / file for file in files if file.endswith(".cpp") and "$" not in file]


class UnityNames(unittest.TestCase):
    def test_no_name_of_an_unnamed_namespace_occurs_twice_in_a_library(self):
        self.assert_unique(libraries())

    def test_no_name_of_an_unnamed_namespace_occurs_twice_in_a_test_program(self):
        programs = list(test_programs())
        self.assertGreater(len(programs), 20)
        self.assert_unique(programs)

    def assert_unique(self, units):
        twice = []
        for folder, files in units:
            where = collections.defaultdict(set)
            for path in files:
                for body in UNNAMED.findall(path.read_text()):
                    for name in NAMES.findall(body):
                        where[name].add(path.name)
            twice += [f"{folder.relative_to(ROOT)}: {name} in {', '.join(sorted(names))}"
                      for name, names in where.items() if len(names) > 1]
        self.assertEqual([], twice)


if __name__ == "__main__":
    unittest.main()
