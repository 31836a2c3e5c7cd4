#!/usr/bin/python3
"""Draws the tables of the program `literature` as SVG: time against wrong answers, time against distance, and time
against triangles. Draws the tables of the program `benchmark` in the folder `states`: time against wrong answers in
states of robots. Writes the summary of all methods, and their times for each model, as tables in Markdown. Charts
without data are left out."""
import argparse
import collections
import csv
import math
import pathlib
import re
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "literature", "font.size": 8,
                            "axes.spines.top": False, "axes.spines.right": False, "axes.titlesize": 9})
from matplotlib import pyplot

from chart_labels import end_labels, label_points

COLOURS = {"ours": "#c1272d", "paper": "#b5179e", "trees": "#2b6cb0", "library": "#3a9d5d", "convex": "#8c6d31",
           "image space": "#6b6b6b", "exact checker": "#c1272d", "FCL": "#3a9d5d"}
SIZE = 10000  # triangles of the models whose times stand in the overview
PAIR = ("torus", "lump")  # the models of the overview and the charts: all methods are measured with them
COLUMNS = {"exact_cpu": "ours", "rapid": "RAPID", "dop18_larger": "18-DOPs", "dop24": "24-DOPs",
           "box_tree": "box trees", "convex_patches": "convex patches", "breadth_first": "breadth-first, CPU",
           "gress_zachmann": "breadth-first, device", "fcl_obb": "FCL, OBB", "opcode": "OPCODE", "gimpact": "GImpact",
           "embree": "Embree", "cgal": "CGAL", "recode_64x1": "RECODE", "cinder_64x1": "CInDeR",
           "cullide_64x1": "CULLIDE"}  # of the table of models
SCENES = {"kr5_boxes": "kr5 among 8 boxes", "ur5_cage": "ur5_robotiq in a cage",
          "drchubo_corridor": "drchubo in a corridor"}
KINDS = {"random": "random states", "near_contact": "within 1e-10 ... 1e-4 m of contact"}
LINES = ["exact_cpu", "rapid", "dop18_larger", "dop24", "box_tree", "convex_patches", "fcl_obb", "opcode",
         "breadth_first", "breadth_first_all", "gress_zachmann", "ours_breadth_first", "cinder_64x1", "cullide_64x1"]


def read(folder, name):
    path = folder / f"{name}.csv"
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def unique(rows, column):
    return list(dict.fromkeys(row[column] for row in rows))


def geometric_mean(values):
    return math.exp(sum(math.log(value) for value in values) / len(values))


def renders_on_cpu(run):
    return any(row["what"] == "device" and "llvmpipe" in row["value"] for row in run)


def robot_states(folder):
    """One row for each method, scene and kind of states, with the columns of both tables of `benchmark` and `us`: CPU
    time a state where the CPU does the work of the device too, else wall time."""
    on_cpu = renders_on_cpu(read(folder, "run"))
    rows = {(row["scene"], row["kind"], row["method"]): row for row in read(folder, "throughput")}
    for row in read(folder, "accuracy"):
        both = rows[row["scene"], row["kind"], row["method"]]
        both.update(row)
        both["us"] = float(both["cpu_us_a_state"]) if on_cpu else 1e6 / float(both["states_per_s"])
    return list(rows.values())


class Results:
    """The tables of a folder. `time_column`: CPU time where the CPU does the work of the device too, else wall time."""

    def __init__(self, folder):
        self.methods = {row["method"]: row for row in read(folder, "methods")}
        self.experiment = read(folder, "experiment")
        self.families = read(folder, "families")
        self.on_cpu = renders_on_cpu(read(folder, "run"))
        self.states = robot_states(folder / "states")
        self.time_column = "cpu_us_a_query" if self.on_cpu else "us_a_query"
        self.pair = [row for row in self.experiment if row["model"] in PAIR]
        self.samples = 0  # of the overview
        self.chosen = 0  # triangles of the overview
        self.times = self.overview_times()

    def time(self, row):
        """Microseconds a query. The clock of the CPU has steps of a microsecond for 60 queries."""
        return max(float(row[self.time_column]), 0.01)

    def size(self, row):
        """The nominal number of triangles of a made model: a power of ten."""
        return 10 ** round(math.log10(float(row["triangles"])))

    def overview_times(self):
        """Microseconds a query of each method: the geometric mean over the models and distances of one size that all
        methods were measured with. A method with fewer than half of the samples is left out."""
        sizes = {self.size(row) for row in self.pair}
        if not sizes:
            return {}
        chosen = self.chosen = min(sizes, key=lambda size: abs(math.log(size / SIZE)))
        of_method = {}
        for row in self.pair:
            if self.size(row) == chosen:
                key = (row["model"], row["protocol"], row["distance"])
                of_method.setdefault(row["method"], {})[key] = self.time(row)
        most = max(len(times) for times in of_method.values())
        of_method = {method: times for method, times in of_method.items() if 2 * len(times) >= most}
        common = set.intersection(*(set(times) for times in of_method.values()))
        self.samples = len(common)
        return {method: geometric_mean([times[key] for key in common]) for method, times in of_method.items()}

    def overview_time(self, method):
        return self.times.get(method)

    def overview_poses(self, method):
        """The number of poses at a distance that the times of the overview are means of."""
        counts = [int(row["poses"]) for row in self.pair if row["method"] == method and self.size(row) == self.chosen]
        if not counts:
            return "-"
        return f"{min(counts)}" if min(counts) == max(counts) else f"{min(counts)} to {max(counts)}"

    def growth(self, method):
        """The exponent of the time in the number of triangles, between the smallest and the largest size that the
        method was measured with; None for one size."""
        sizes = sorted({self.size(row) for row in self.pair if row["method"] == method})
        if len(sizes) < 2:
            return None
        first, last = ({(row["model"], row["protocol"], row["distance"]): self.time(row) for row in self.pair
                        if row["method"] == method and self.size(row) == size} for size in (sizes[0], sizes[-1]))
        both = [last[key] / first[key] for key in first if key in last]
        return math.log(geometric_mean(both)) / math.log(sizes[-1] / sizes[0]) if both else None

    def wrong(self, method, inside):
        """(missed, false, poses) in the hard cases, by the truth of the solids. `inside`: only the method's domain,
        and a method that claims no containment is judged by the surfaces."""
        missed = false = poses = 0
        surface_only = self.methods[method]["containment"] == "no"
        for row in self.families:
            if row["method"] != method or (inside and row["in_domain"] == "no"):
                continue
            truth = "surfaces" if inside and surface_only else "solids"
            missed += int(row[f"missed_{truth}"])
            false += int(row[f"false_{truth}"]) - int(row["within_contract"])
            poses += int(row["poses"])
        return missed, max(0, false), poses


def save(figure, out, name):
    figure.savefig(out / f"{name}.svg", bbox_inches="tight", metadata={"Date": None})
    pyplot.close(figure)


def short(title):
    return re.sub(r" x (\d+) pixels, (\d) views?", r"² x \2", title)


def share_axis(axes, shares):
    """A logarithmic axis for shares, with a line for 0. Returns the height of this line."""
    zero = 10 ** (math.floor(math.log10(min((share for share in shares if share > 0), default=1e-2))) - 0.7)
    axes.set_yscale("log")
    axes.set_ylim(zero / 2.2, 1.0)
    axes.axhline(zero, color="#999999", lw=0.6, zorder=1)
    ticks = [10.0 ** k for k in range(math.ceil(math.log10(zero) + 0.1), 1)]
    axes.set_yticks([zero] + ticks, ["0"] + [f"{100 * tick:g} %" for tick in ticks])
    axes.minorticks_off()
    axes.grid(color="#e8e8e8", lw=0.5)
    return zero


def overview(results, out):
    """Time against the share of wrong answers in the hard cases: a filled point in the domain of the method, an empty
    one in all cases."""
    points = []
    for method, info in results.methods.items():
        time = results.overview_time(method)
        if time is None or not any(row["method"] == method for row in results.families):
            continue
        shares = []
        for inside in (True, False):
            missed, false, poses = results.wrong(method, inside)
            shares.append((missed + false) / poses if poses else 0.0)
        points.append((time, shares[0], shares[1], info))
    if not points:
        return
    figure, axes = pyplot.subplots(figsize=(11, 6.5))
    zero = share_axis(axes, [share for point in points for share in point[1:3]])
    texts = []
    for time, inside, everywhere, info in points:
        colour = COLOURS[info["family"]]
        low, high = max(inside, zero), max(everywhere, zero)
        axes.plot([time, time], [low, high], color=colour, lw=0.6, alpha=0.5)
        axes.scatter([time], [high], s=20, facecolors="white", edgecolors=colour, linewidths=0.9, zorder=3)
        axes.scatter([time], [low], s=26, color=colour, zorder=4)
        texts.append((time, low, short(info["title"]), colour))
    axes.set_xscale("log")
    axes.minorticks_off()
    kind = "CPU" if results.on_cpu else "wall"
    axes.set_xlabel(f"{kind} time a query, microseconds (left is better): two copies of a model of about 10,000 "
                    f"triangles,\ngeometric mean over {results.samples} distances")
    axes.set_ylabel("wrong answers in the hard cases\nfilled: in the method's domain; empty: in all cases")
    families = unique(results.methods.values(), "family")
    for family in [name for name in COLOURS if name in families]:
        axes.scatter([], [], color=COLOURS[family], s=26, label=family)
    axes.legend(fontsize=7, frameon=False, loc="upper left", bbox_to_anchor=(0.0, 1.08), ncol=len(families))
    label_points(axes, texts)
    save(figure, out, "overview")


def line_chart(axes, results, rows, x, title, x_label):
    ends = []
    for method in [name for name in LINES if name in unique(rows, "method")]:
        points = {}
        for row in rows:
            if row["method"] == method:
                place = results.size(row) if x == "triangles" else float(row[x])
                points.setdefault(place, []).append(results.time(row))
        line = sorted((place, geometric_mean(times)) for place, times in points.items())
        info = results.methods[method]
        colour = COLOURS[info["family"]]
        axes.plot([p[0] for p in line], [p[1] for p in line], color=colour, marker="o", ms=2.5, lw=1.0)
        ends.append((line[-1][0], line[-1][1], short(info["title"]), colour))
    axes.set_yscale("log")
    axes.set_title(title)
    axes.set_xlabel(x_label)
    axes.set_ylabel(f"{'CPU' if results.on_cpu else 'wall'} time a query, microseconds")
    axes.grid(color="#e8e8e8", lw=0.5)
    return ends


def distance_chart(results, out):
    sizes = {results.size(row) for row in results.pair}
    if not sizes:
        return
    size = min(sizes, key=lambda one: abs(math.log(one / SIZE)))
    protocols = [protocol for protocol in ("turning", "clearance")
                 if len({row["distance"] for row in results.pair if row["protocol"] == protocol}) > 1]
    if not protocols:
        return
    titles = {"turning": "one copy turns and comes nearer", "clearance": "random rotations at given clearances"}
    labels = {"turning": "distance of the centres / size", "clearance": "distance of the surfaces / size"}
    figure, grid = pyplot.subplots(1, len(protocols), figsize=(6.2 * len(protocols), 4.6), squeeze=False)
    ends = []
    for axes, protocol in zip(grid.flat, protocols):
        rows = [row for row in results.pair if row["protocol"] == protocol and results.size(row) == size]
        ends.append((axes, line_chart(axes, results, rows, "distance", titles[protocol], labels[protocol])))
        if protocol == "clearance":
            axes.set_xscale("log")
    figure.tight_layout(w_pad=11)
    for axes, texts in ends:
        end_labels(axes, texts)
    save(figure, out, "distance")


def triangles_chart(results, out):
    if len({results.size(row) for row in results.pair}) < 2:
        return
    samples = collections.Counter((row["method"], results.size(row)) for row in results.pair)
    most = max(samples.values())
    rows = [row for row in results.pair if samples[row["method"], results.size(row)] == most]
    figure, axes = pyplot.subplots(figsize=(7, 4.6))
    title = "torus and lump, all distances (geometric mean)"
    ends = line_chart(axes, results, rows, "triangles", title, "triangles of each copy")
    axes.set_xscale("log")
    end_labels(axes, ends)
    save(figure, out, "triangles")


def states_chart(results, out):
    """Time a state against the share of wrong answers, for each scene and kind of states."""
    scenes, kinds = unique(results.states, "scene"), unique(results.states, "kind")
    if not scenes:
        return
    figure, grid = pyplot.subplots(len(scenes), len(kinds), figsize=(6.4 * len(kinds), 4.2 * len(scenes)),
                                   squeeze=False)
    texts = {}
    for line, scene in zip(grid, scenes):
        for axes, kind in zip(line, kinds):
            rows = [row for row in results.states if row["scene"] == scene and row["kind"] == kind]
            shares = [float(row["wrong_per_million"]) * 1e-6 for row in rows]
            zero = share_axis(axes, shares)
            axes.set_ylim(zero / 12.0, 1.0)  # room for the names of the points on the line of 0
            axes.set_xscale("log")
            axes.set_xlim(0.4 * min(row["us"] for row in rows), 4.0 * max(row["us"] for row in rows))
            axes.set_title(f"{SCENES.get(scene, scene)}: {KINDS.get(kind, kind)}")
            axes.set_xlabel(f"{'CPU' if results.on_cpu else 'wall'} time a state, microseconds (left is better)")
            axes.set_ylabel("wrong answers")
            for row, share in zip(rows, shares):
                colour = COLOURS[row["family"]]
                axes.scatter([row["us"]], [max(share, zero)], s=26, color=colour, zorder=3)
                texts.setdefault(axes, []).append((row["us"], max(share, zero), short(row["title"]), colour))
    figure.tight_layout(h_pad=2.0, w_pad=2.0)
    for axes, points in texts.items():
        label_points(axes, points)
    save(figure, out, "states")


def states_table(results):
    """Lines of a table: a row for each method, a column for each scene and kind of states."""
    columns = list(dict.fromkeys((row["scene"], row["kind"]) for row in results.states))
    if not columns:
        return []
    lines = ["", "## Robot states", "",
             f"{'CPU' if results.on_cpu else 'Wall'} microseconds a state; wrong answers as false \"free\" + false "
             "\"collision\", of the number of states. Near contact,\nwrong answers within 1e-9 m of contact are not "
             "counted. In brackets: tests of two bounding volumes a state.", "",
             f"| method | {' | '.join(f'{scene}, {kind}' for scene, kind in columns)} |",
             "| --- |" + " --- |" * len(columns)]
    for method in unique(results.states, "method"):
        cells = []
        for scene, kind in columns:
            row = next((row for row in results.states
                        if (row["scene"], row["kind"], row["method"]) == (scene, kind, method)), None)
            if row is None:
                cells.append("-")
                continue
            wrong = [int(row["wrong_free"]), int(row["wrong_collision"])]
            text = f"{wrong[0]} + {wrong[1]}" if sum(wrong) else "0"
            tests = f" [{number(float(row['node_visits_a_state']), 3)}]" if row["node_visits_a_state"] else ""
            cells.append(f"{number(row['us'])}; {text} of {row['states']}{tests}")
        title = next(row["title"] for row in results.states if row["method"] == method)
        lines.append(f"| {title} | {' | '.join(cells)} |")
    return lines


def domain(info):
    words = ["any mesh" if info["open"] == "yes" else "closed meshes" if info["concave"] == "yes" else "convex solids"]
    words.append("solids" if info["containment"] == "yes" else "surfaces only")
    return ", ".join(words)


def number(value, digits=2):
    return "-" if value is None else f"{value:.{digits}g}" if value < 100 else f"{value:,.0f}"


def write_table(results, out):
    """One row a method: a pair "in its domain / outside" for missed and for false collisions in the hard cases."""
    kind = "CPU" if results.on_cpu else "wall"
    lines = ["# All methods in the hard cases", "",
             "For people who want the numbers behind [literature.md](../literature.md), which explains the columns.",
             "",
             f"| method | source | domain | missed | false | {kind} us | poses | growth |",
             "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for method, info in results.methods.items():
        cells = []
        inside, everywhere = results.wrong(method, True), results.wrong(method, False)
        poses_outside = everywhere[2] - inside[2]
        for kind_of_error in (0, 1):
            outside = wrong_outside(results, method)[kind_of_error]
            text = f"{inside[kind_of_error]} of {inside[2]}" if inside[2] else "-"
            cells.append(text + (f"; outside {outside} of {poses_outside}" if poses_outside else ""))
        growth = results.growth(method)
        lines.append(f"| {info['title']} | {info['source']} | {domain(info)} | {cells[0]} | {cells[1]} | "
                     f"{number(results.overview_time(method))} | {results.overview_poses(method)} | "
                     f"{'-' if growth is None else f'n^{growth:.2f}'} |")
    lines += model_table(results) + fastest_table(results) + states_table(results)
    (out / "table.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


def model_table(results):
    """Lines of a table: microseconds a query for each model, as the geometric mean over all distances."""
    times = {}
    for row in results.experiment:
        of_model = times.setdefault((row["model"], int(row["triangles"])), {})
        of_model.setdefault(row["method"], []).append(results.time(row))
    if not times:
        return []
    methods = [method for method in COLUMNS if method in results.methods]
    lines = ["", "## Times by model", "",
             "Microseconds a query: the geometric mean over all distances. A dash: not measured with this model, "
             "because a\nsmaller one took too long, or because the method refuses it.", "",
             f"| model | triangles | {' | '.join(COLUMNS[method] for method in methods)} |",
             "| --- | --- |" + " --- |" * len(methods)]
    for (model, triangles), of_method in times.items():
        most = max(len(values) for values in of_method.values())
        cells = [number(geometric_mean(of_method[method])) if len(of_method.get(method, [])) == most else "-"
                 for method in methods]
        lines.append(f"| {model} | {triangles:,} | {' | '.join(cells)} |")
    return lines


def fastest_table(results):
    """Lines of a table: at each distance, how often another method is faster than the exact checker on one core."""
    samples = {}
    for row in results.experiment:
        key = (row["protocol"], float(row["distance"]), row["model"], row["triangles"])
        if row["method"] != "exact_cpu" or int(row["poses"]) > 1:
            samples.setdefault(key, {})[row["method"]] = results.time(row)
    distances = {}
    for (protocol, distance, model, triangles), times in samples.items():
        ours = times.pop("exact_cpu", None)
        others = {method: time for method, time in times.items() if results.methods[method]["family"] != "ours"}
        if ours is None or not others:
            continue
        fastest = min(others, key=others.get)
        distances.setdefault((protocol, distance), []).append((others[fastest] / ours, fastest, model, int(triangles)))
    if not distances:
        return []
    lines = ["", "## Is another method faster than ours?", "",
             "At each distance: the time of the fastest other method, divided by the time of our exact checker on one "
             "core. Below 1,\nthe other method is faster. Most models have several sizes. Left out: distances at which "
             "other programs interrupted the\nfirst query of ours, so that only this query was measured.", "",
             "| poses | distance / size | models and sizes | others faster | median ratio | smallest | by | with |",
             "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for (protocol, distance), ratios in sorted(distances.items()):
        least, method, model, triangles = min(ratios)
        lines.append(f"| {protocol} | {distance:g} | {len(ratios)} | {sum(ratio[0] < 1 for ratio in ratios)} | "
                     f"{statistics.median(ratio[0] for ratio in ratios):.2g} | {least:.2g} | "
                     f"{results.methods[method]['title']} | {model}, {triangles:,} triangles |")
    return lines


def wrong_outside(results, method):
    """(missed, false) in the cases outside the method's domain, by the truth of the solids."""
    rows = [row for row in results.families if row["method"] == method and row["in_domain"] == "no"]
    return (sum(int(row["missed_solids"]) for row in rows),
            sum(int(row["false_solids"]) - int(row["within_contract"]) for row in rows))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tables", type=pathlib.Path, help="folder that `literature --out` wrote")
    parser.add_argument("--out", type=pathlib.Path, help="folder for the pictures (default: that of the tables)")
    arguments = parser.parse_args()
    if not (arguments.tables / "methods.csv").exists():
        sys.exit(f"{arguments.tables}: there is no methods.csv; write the tables with literature --out "
                 f"{arguments.tables}")
    out = arguments.out or arguments.tables
    out.mkdir(parents=True, exist_ok=True)
    results = Results(arguments.tables)
    for draw in (overview, distance_chart, triangles_chart, states_chart, write_table):
        draw(results, out)


if __name__ == "__main__":
    main()
