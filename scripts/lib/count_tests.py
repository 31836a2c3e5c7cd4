#!/usr/bin/python3
"""count_tests.py FILE N: prints 'N passed, N failed, N skipped' for a JUnit file of ctest, with N more failures."""
import sys
import xml.etree.ElementTree


def main(path, more_failed):
    count = {"passed": 0, "failed": int(more_failed), "skipped": 0}
    for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
        skipped = case.find("skipped")
        if case.get("status") == "run":
            count["passed"] += 1
        elif case.get("status") == "disabled" or (
            skipped is not None and skipped.get("message", "").startswith("SKIP_")
        ):
            count["skipped"] += 1
        else:
            count["failed"] += 1
    print(", ".join(f"{number} {outcome}" for outcome, number in count.items()))


if __name__ == "__main__":
    main(*sys.argv[1:])
