#!/usr/bin/python3
"""Prints 'N passed, N failed, N skipped' for a JUnit file of ctest.

usage: count_tests.py JUNIT_FILE REPORTS MORE_FAILED

REPORTS is the folder of GoogleTest's XML reports. A report has the name of a ctest test that runs one suite. The cases
of the report are counted instead of the suite. MORE_FAILED is added to the number of failed tests.
"""
import collections
import pathlib
import sys
import xml.etree.ElementTree

OUTCOMES = ("passed", "failed", "skipped")


def of_suite(report, suite_passed):
    """Outcomes of the cases. If the program crashes or leaks after the last case, the suite fails although each case
    has passed."""
    outcomes = []
    for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase"):
        if case.get("status") == "notrun":
            continue  # disabled
        if case.find("failure") is not None:
            outcomes.append("failed")
        else:
            outcomes.append("skipped" if case.get("result") == "skipped" else "passed")
    if not suite_passed and "failed" not in outcomes:
        outcomes.append("failed")
    return outcomes


def of_test(case):
    """Outcome of a ctest test."""
    skipped = case.find("skipped")
    if case.get("status") == "run":
        return "passed"
    if case.get("status") == "disabled" or (skipped is not None and skipped.get("message", "").startswith("SKIP_")):
        return "skipped"
    return "failed"


def main(junit, reports, more_failed):
    count = dict.fromkeys(OUTCOMES, 0)
    count["failed"] += int(more_failed)
    cases = list(xml.etree.ElementTree.parse(junit).getroot().iter("testcase"))
    for name, times in collections.Counter(case.get("name") for case in cases).items():
        if times > 1:
            sys.exit(f"two programs have tests named {name}: rename one suite, because one report replaces the other")
    for case in cases:
        report = pathlib.Path(reports) / (case.get("name").replace("/", ".") + ".xml")
        for outcome in of_suite(report, of_test(case) == "passed") if report.exists() else [of_test(case)]:
            count[outcome] += 1
    print(", ".join(f"{number} {outcome}" for outcome, number in count.items()))


if __name__ == "__main__":
    main(*sys.argv[1:])
