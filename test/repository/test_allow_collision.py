"""The entries that allow_collision.py sets in an allowed collision matrix."""
import importlib.util
import types
import unittest

from folders import SCRIPTS

spec = importlib.util.spec_from_file_location("allow_collision", SCRIPTS / "allow_collision.py")
allow_collision = importlib.util.module_from_spec(spec)
spec.loader.exec_module(allow_collision)


def row_of(values):
    return types.SimpleNamespace(enabled=values)


class AllowCollision(unittest.TestCase):
    def setUp(self):
        self.matrix = types.SimpleNamespace(
            entry_names=["base", "hand"], entry_values=[row_of([False, True]), row_of([True, False])],
            default_entry_names=["cloud", "cable"], default_entry_values=[True, False])

    def set_entry(self, first, second, is_allowed):
        allow_collision.set_entry(self.matrix, first, second, is_allowed, row_of)

    def entry(self, first, second):
        i, j = self.matrix.entry_names.index(first), self.matrix.entry_names.index(second)
        self.assertEqual(self.matrix.entry_values[i].enabled[j], self.matrix.entry_values[j].enabled[i])
        return self.matrix.entry_values[i].enabled[j]

    def test_only_the_entry_of_the_two_bodies_changes(self):
        self.set_entry("box", "hand", True)
        self.assertTrue(self.entry("box", "hand"))
        self.assertFalse(self.entry("box", "base"))
        self.assertTrue(self.entry("base", "hand"))
        self.set_entry("hand", "box", False)
        self.assertFalse(self.entry("box", "hand"))

    def test_a_new_row_keeps_the_defaults_of_its_body(self):
        self.set_entry("cloud", "hand", False)
        self.assertTrue(self.entry("cloud", "base"), "the cloud may touch everything else")
        self.assertFalse(self.entry("cloud", "hand"))
        self.set_entry("cable", "hand", True)
        self.assertFalse(self.entry("cable", "cloud"), "each of the two must allow it")

    def test_a_star_sets_the_default_of_the_other_body(self):
        allow_collision.set_default(self.matrix, "floor", True)
        allow_collision.set_default(self.matrix, "cable", True)
        self.assertEqual(self.matrix.default_entry_names, ["cloud", "cable", "floor"])
        self.assertEqual(self.matrix.default_entry_values, [True, True, True])
        self.assertEqual(self.matrix.entry_names, ["base", "hand"])


if __name__ == "__main__":
    unittest.main()
