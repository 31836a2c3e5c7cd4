"""A unity build compiles several files as one. So a name of an unnamed namespace may occur only once in a library."""
import collections
import re
import unittest

from folders import ROOT

UNNAMED = re.compile(r"^namespace\n\{\n(.*?)^\}  // namespace\n", re.S | re.M)
NAMES = re.compile(r"^(?:constexpr [\w:<>, ]+?[ &]|struct |class |enum class )(\w+)", re.M)


def libraries():
    """The folders that add a library or module each, and the C++ files below them that no inner library has."""
    folders = [path.parent for path in [*(ROOT / "src").rglob("CMakeLists.txt"), ROOT / "python" / "CMakeLists.txt"]
               if re.search("add_library\\(|add_module\\(", path.read_text())]
    for folder in folders:
        inner = [other for other in folders if other != folder and folder in other.parents]
        yield folder, [path for path in folder.rglob("*.cpp") if not any(i in path.parents for i in inner)]


class UnityNames(unittest.TestCase):
    def test_no_name_of_an_unnamed_namespace_occurs_twice_in_a_library(self):
        twice = []
        for folder, files in libraries():
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
