"""draw_planning.py DIR: draws DIR/planning.svg from DIR/planning.csv, and DIR/path_lengths.svg from
DIR/path_lengths.csv; a table that is not there is left out. The first chart shows for each method how many problems it
solves within a time, with one panel per motion rule. The second one shows for each planner the length of its paths
after a time, divided by the shortest length that any planner has found for the problem: the median over all problems.
A problem without a path counts as infinitely long."""

import collections
import csv
import math
import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "planning"})  # texts as letters, not as outlines
from matplotlib import pyplot  # noqa: E402

COLOURS = {
    "batch planner": "#1b7837",
    "batch planner, way back that is known": "#7fbf7b",
    "RRTConnect, our validator": "#2166ac",
    "RRTConnect, FCL": "#b2182b",
}
PLANNERS = {"AnytimeBatch": "#1b7837", "RRTstar": "#b2182b", "BITstar": "#2166ac", "AITstar": "#762a83"}
TITLES = {"bound": "proven between samples", "samples": "samples alone"}


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def draw_solved(folder):
    rows = rows_of(folder / "planning.csv")
    rules = [rule for rule in TITLES if any(row["rule"] == rule for row in rows)]
    figure, all_axes = pyplot.subplots(1, len(rules), figsize=(5 * len(rules), 3.6), sharey=True, squeeze=False)
    for axes, rule in zip(all_axes[0], rules):
        for method, colour in COLOURS.items():
            mine = [row for row in rows if row["rule"] == rule and row["method"] == method]
            if not mine:
                continue
            solved = sorted(float(row["seconds"]) for row in mine if row["solved"] == "1")
            shares = [100.0 * (i + 1) / len(mine) for i in range(len(solved))]
            axes.step(solved, shares, where="post", color=colour, label=method)
        axes.set_xscale("log")
        axes.set_xlabel("seconds")
        axes.set_title(TITLES[rule])
        axes.grid(True, alpha=0.3)
    all_axes[0][0].set_ylabel("problems solved, %")
    all_axes[0][0].legend(loc="lower right", fontsize="small")
    figure.tight_layout()
    figure.savefig(folder / "planning.svg", metadata={"Date": None})



def draw_lengths(folder):
    lengths = collections.defaultdict(dict)  # by planner and time, then by problem
    for row in rows_of(folder / "path_lengths.csv"):
        length = float(row["length"]) if row["length"] else math.inf
        lengths[row["planner"], float(row["seconds"])][row["problem"]] = length
    least = collections.defaultdict(lambda: math.inf)
    for some in lengths.values():
        for problem, length in some.items():
            least[problem] = min(least[problem], length)
    figure, axes = pyplot.subplots(figsize=(5, 3.6))
    for planner, colour in PLANNERS.items():
        times = sorted(seconds for name, seconds in lengths if name == planner)
        medians = [statistics.median(length / least[problem] for problem, length in lengths[planner, seconds].items()
                                     if least[problem] < math.inf) for seconds in times]
        if times:
            axes.plot(times, medians, marker=".", color=colour, label=planner)
    axes.set_xscale("log")
    axes.set_xlabel("seconds")
    axes.set_ylabel("length of the path / shortest known")
    axes.grid(True, alpha=0.3)
    axes.legend(fontsize="small")
    figure.tight_layout()
    figure.savefig(folder / "path_lengths.svg", metadata={"Date": None})


def main():
    folder = pathlib.Path(sys.argv[1])
    for table, draw in (("planning.csv", draw_solved), ("path_lengths.csv", draw_lengths)):
        if (folder / table).exists():
            draw(folder)


main()
