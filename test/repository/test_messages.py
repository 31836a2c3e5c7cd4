"""Names of messages and services. Each one is a class of C++, and Xlib defines some short words as macros."""
import unittest

from folders import ROOT

# From X11/X.h and X11/Xlib.h: `#define Status int` before our header would break the build of a GUI program.
XLIB = {"Always", "Bool", "Complex", "Convex", "CursorShape", "Expose", "False", "None", "Nonconvex", "Status", "Success",
        "True", "Unsorted"}


class Messages(unittest.TestCase):
    def test_no_name_is_a_macro_of_xlib(self):
        names = {path.stem for folder in ("msg", "srv") for path in (ROOT / folder).iterdir()}
        self.assertGreater(len(names), 30)
        self.assertEqual(set(), names & XLIB)

    def test_no_status_is_zero(self):
        """0 is the value of a response that no node has filled in."""
        for path in (ROOT / "msg" / "AnswerStatus.msg", ROOT / "srv" / "PlanMotion.srv", ROOT / "srv" / "ComputeIk.srv"):
            values = [line.split("=")[1].strip() for line in path.read_text().splitlines()
                      if line.startswith("uint8 ") and "=" in line]
            self.assertGreater(len(values), 2, path.name)
            self.assertEqual(len(values), len(set(values)), path.name)
            self.assertNotIn("0", values, path.name)


if __name__ == "__main__":
    unittest.main()
