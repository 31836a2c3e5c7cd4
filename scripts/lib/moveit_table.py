"""Prints a table of the results of scripts/moveit_suite: a row for each test, a column for each detector."""
import json
import pathlib
import sys
import xml.etree.ElementTree

OURS = "gpu_planning_scene"
OUTCOMES = ["passed", "skipped", "failed"]  # a test that runs with several parameters has the last one that occurs
DETECTORS = ["FCL", "Bullet", OURS]


def outcome(test):
    """passed, failed or skipped; a test that GoogleTest made itself for a suite without instances is no test."""
    if test.get("failures"):
        return "failed"
    return "skipped" if test.get("result") == "SKIPPED" else "passed"


def suites_of(log):
    """The suites of a program in the form of GoogleTest's JSON; rostest lets GoogleTest write XML."""
    if log.with_suffix(".json").exists():
        return json.loads(log.with_suffix(".json").read_text())["testsuites"]
    if not log.with_suffix(".xml").exists():
        return []
    return [{"name": suite.get("name"), "testsuite": [
        {"name": test.get("name"), "failures": test.findall("failure"), "result": test.get("result", "").upper()}
        for test in suite.iter("testcase")]}
            for suite in xml.etree.ElementTree.parse(log.with_suffix(".xml")).iter("testsuite")]


def read(folder):
    """The outcomes in the form {(suite, test): {detector: outcome}}, and the programs that ended without results."""
    table, broken = {}, []
    for log in sorted(folder.glob("*.log")):
        suites = suites_of(log)
        if not suites:
            broken.append(log.name[:-len(".log")])
        detector = log.name.split(".")[0]
        for suite in suites:
            if suite["name"] == "GoogleTestVerification":
                continue
            parts = suite["name"].split("/")
            name = parts[1] if len(parts) > 1 else parts[0]
            for test in suite["testsuite"]:
                key = (name, test["name"].split("/")[0])
                column = test.get("value_param", "").strip('"') or detector
                row = table.setdefault(key, {})
                column = column if column in DETECTORS else detector
                row[column] = max(row.get(column, "passed"), outcome(test), key=OUTCOMES.index)
    return table, broken


def main():
    table, broken = read(pathlib.Path(sys.argv[1]))
    columns = DETECTORS + sorted({name for row in table.values() for name in row} - set(DETECTORS))
    width = max(len(f"{suite}.{test}") for suite, test in table)
    print(f"{'':{width}}  " + "  ".join(f"{name:18}" for name in columns))
    for (suite, test), row in table.items():
        print(f"{suite + '.' + test:{width}}  " + "  ".join(f"{row.get(name, '-'):18}" for name in columns))
    counts = [f"{sum(row.get(name) == 'passed' for row in table.values())} of "
              f"{sum(name in row for row in table.values())}" for name in columns]
    print(f"{'passed':{width}}  " + "  ".join(f"{count:18}" for count in counts))
    for name in broken:
        print(f"{name} ended without results, see {sys.argv[1]}/{name}.log")
    failed = any(row.get(OURS) == "failed" for row in table.values())
    sys.exit(1 if failed or any(name.startswith(OURS) for name in broken) else 0)


if __name__ == "__main__":
    main()
