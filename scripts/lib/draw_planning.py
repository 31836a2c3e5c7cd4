"""draw_planning.py DIR: draws DIR/planning.svg from DIR/planning.csv. The chart shows for each method how many problems
it solves within a time, with one panel per motion rule."""

import csv
import pathlib
import sys

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "planning"
from matplotlib import pyplot  # noqa: E402

COLOURS = {
    "batch planner": "#1b7837",
    "RRTConnect, our validator": "#2166ac",
    "RRTConnect, FCL": "#b2182b",
}
TITLES = {"bound": "proven between samples", "samples": "samples alone"}


def main():
    folder = pathlib.Path(sys.argv[1])
    with open(folder / "planning.csv", newline="") as table:
        rows = list(csv.DictReader(table))
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


main()
