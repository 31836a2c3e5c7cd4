"""Shards of bulk runs as Parquet tables. Debian has no pyarrow: without it, only the error is tested."""
import pathlib
import tempfile
import unittest

import numpy as np

from bulk_runs import ARM_OPTIONS, bulk, content, shards
from robots import arm

try:
    import pyarrow.parquet
except ImportError:
    pyarrow = None


class Parquet(unittest.TestCase):
    def run_in(self, folder, *options):
        return bulk(*ARM_OPTIONS, "--random", 250, "--shard", 100, "--out", folder, *options)

    @unittest.skipIf(pyarrow is None, "pyarrow is not installed")
    def test_tables_have_the_states_and_verdicts_of_arrays(self):
        with tempfile.TemporaryDirectory() as folder:
            arrays, tables, again = (pathlib.Path(folder, name) for name in ("arrays", "tables", "again"))
            for out, options in ((arrays, []), (tables, ["--format", "parquet"]), (again, ["--format", "parquet"])):
                status, line, _ = self.run_in(out, "--with-states", *options)
                self.assertEqual(0, status, line)
            for array, table in zip(shards(arrays), shards(tables)):
                rows, columns = np.load(array), pyarrow.parquet.read_table(table)
                self.assertEqual([*arm().variable_names, "valid"], columns.column_names)
                np.testing.assert_array_equal(rows["valid"], columns["valid"].to_numpy())
                for i, name in enumerate(arm().variable_names):
                    np.testing.assert_array_equal(rows["state"][:, i], columns[name].to_numpy())
            self.assertTrue(content(tables) == content(again))

    @unittest.skipUnless(pyarrow is None, "pyarrow is installed")
    def test_without_pyarrow_there_is_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            status, line, _ = self.run_in(pathlib.Path(folder, "out"), "--format", "parquet")
        self.assertEqual((1, "Parquet files need the Python package pyarrow, which is not installed; use --format npy"),
                         (status, line))


if __name__ == "__main__":
    unittest.main()
