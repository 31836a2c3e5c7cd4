"""Names beside the points and lines of a chart."""
import math

import matplotlib.text
import matplotlib.transforms


def overlaps(box, others):
    return any(box.overlaps(other) for other in others)


def label_points(axes, points):
    """Writes texts next to points (x, y, text, colour). A text covers no point and no other text. If it is not close to
    its point, a line joins the two."""
    figure = axes.figure
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    taken = []
    for x, y, _, _ in points:
        px, py = axes.transData.transform((x, y))
        taken.append(matplotlib.transforms.Bbox.from_bounds(px - 4, py - 4, 8, 8))
    frame = axes.get_window_extent(renderer)
    for x, y, text, colour in sorted(points, key=lambda point: point[0]):
        best = None
        for distance in (5, 9, 14, 20, 27, 35, 44, 54, 65, 77, 90, 105, 120):
            for angle in (0, 180, 90, 270, 45, 135, 315, 225, 20, 160, 340, 200, 70, 110, 290, 250):
                dx, dy = distance * math.cos(math.radians(angle)), distance * math.sin(math.radians(angle))
                side = "left" if dx > 1 else "right" if dx < -1 else "center"
                height = "bottom" if dy > 3 else "top" if dy < -3 else "center"
                arrow = {"arrowstyle": "-", "color": colour, "lw": 0.4, "shrinkA": 0, "shrinkB": 2}
                note = axes.annotate(text, (x, y), (dx, dy), textcoords="offset points", fontsize=6.5, color=colour,
                                     ha=side, va=height, arrowprops=arrow if distance > 9 else None)
                note.update_positions(renderer)
                box = matplotlib.text.Text.get_window_extent(note, renderer).expanded(1.03, 1.1)
                inside = (box.x0 >= frame.x0 and box.x1 <= frame.x1 + 30 and box.y0 >= frame.y0 - 2 and
                          box.y1 <= frame.y1 + 4)
                if inside and not overlaps(box, taken):
                    best = box
                    break
                note.remove()
            if best is not None:
                taken.append(best)
                break
        else:
            axes.annotate(text, (x, y), (5, 0), textcoords="offset points", fontsize=6.5, color=colour, va="center")


def end_labels(axes, ends):
    """Writes names at the right ends of lines, without overlaps."""
    axes.figure.canvas.draw()
    line_height = 8 * axes.figure.dpi / 72
    placed = []
    for x, y, text, colour in sorted(ends, key=lambda end: end[1]):
        _, py = axes.transData.transform((x, y))
        py = max([py] + [other + line_height for other in placed[-1:]])
        placed.append(py)
        shift = (py - axes.transData.transform((x, y))[1]) * 72 / axes.figure.dpi
        axes.annotate(text, (x, y), (5, shift), textcoords="offset points", fontsize=6.5, color=colour, va="center",
                      annotation_clip=False)
