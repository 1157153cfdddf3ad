"""Plots what a study with positions found over one of its parameters: sag, folds, settling time, frames a
second, and how steady it was.
usage: python3 plot_study.py STUDY.h5 PICTURE.png [PARAMETER]

PARAMETER is the one along the axis (else the first that has numbers). Of the others, the first has a colour
for each value, the second a line style. Hollow dots: something is still faster than 10 mm/s at
the end, so that its figures are not those of rest. Runs that failed are left out.
"""

import json
import math
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import weft

COLOURS = ["#0b6e4f", "#d1495b", "#2f6fde", "#e08e00", "#7b4bb3"]
STYLES = ["-", "--", ":", "-."]
UNITS = {"ks": "N/m", "density": "kg/m²", "damping": "% a step"}
PLACE = 0.01  # [m] what is no farther from its last place has settled
REST = 10  # [mm/s] what has nothing faster is at rest
STEADY = "Steady: fastest particle at the end [mm/s]"


def angles(x, triangles):
    """Mean angle between the two triangles of a square [degrees]."""
    a, b, c = (x[triangles[:, k]] for k in range(3))
    n = np.cross(b - a, c - a)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    return np.degrees(np.arccos(np.clip((n[0::2] * n[1::2]).sum(axis=1), -1, 1))).mean()


def settling(x, seconds):
    """From when on no particle is farther than PLACE from where it ends [s]."""
    away = np.linalg.norm(x - x[-1], axis=2).max(axis=1) > PLACE
    return seconds[np.flatnonzero(away)[-1] + 1] if away.any() else seconds[0]


def fastest(x, seconds):
    """Of all particles between the last two samples [mm/s]; never shown below 0.01."""
    way = np.linalg.norm(x[-1] - x[-2], axis=1).max()
    return max(0.01, 1000 * way / (seconds[-1] - seconds[-2]))


def stretch(x, edges, rest):
    """Greatest strain of all samples [%]."""
    return 100 * max((np.linalg.norm(now[edges[:, 0]] - now[edges[:, 1]], axis=1) / rest).max() - 1 for now in x)


def read(path):
    """The table, its parameters that vary, and figures of every run by their titles."""
    table = weft.study.table(path)
    with h5py.File(path) as file:
        spec = json.loads(file["study"][()])
        sim = weft.Simulation(spec["scene"])
        edges, start = sim.edges, sim.positions
        rest = np.linalg.norm(start[edges[:, 0]] - start[edges[:, 1]], axis=1) / (1 + sim.strain)
        seconds = file["frames"][:] * sim.scene.get("time", {}).get("frame", 1 / 60)
        triangles, runs = file["triangles"][:], file["positions"]
        settled = np.array([settling(x, seconds) for x in runs])
        figures = {
            "Sag: lowest point at the end [m]": np.array([x[-1, :, 1].min() for x in runs]),
            "Folds: mean angle in a square [°]": np.array([angles(x[-1], triangles) for x in runs]),
            f"Settled to {100 * PLACE:.0f} cm after [s]": settled,
            "Stable: greatest strain on the way [%]": np.array([stretch(x, edges, rest) for x in runs]),
            STEADY: np.array([fastest(x, seconds) for x in runs]),
            "Speed: frames a second": 1000 / table["wall_ms.frame_median"],
        }
    names = table.dtype.names[2 : 2 + len(spec["parameters"])]
    return table, [n for n in names if len(set(table[n])) > 1], figures


def words(name, value):
    if isinstance(value, str):
        return value
    return f"{name} {value:g} {UNITS.get(name, '')}".strip()


def lines(table, over, others):
    """(rows, colour, line style, words) for every combination of the other parameters, at most two."""
    levels = [list(dict.fromkeys(table[name])) for name in others]
    for which in np.ndindex(*map(len, levels)):
        values = [level[k] for level, k in zip(levels, which)]
        rows = (table["outcome"] == "ok") & np.all([table[n] == v for n, v in zip(others, values)], axis=0)
        rows = np.flatnonzero(rows)
        colour, style = (*which, 0, 0)[:2]
        text = ", ".join(words(n, v) for n, v in zip(others, values))
        yield rows[np.argsort(table[over][rows])], COLOURS[colour], STYLES[style], text


def finish(axis, title, over, places, values):
    """Title, names and ranges, such that what hardly differs looks like it."""
    axis.set_title(title, fontsize=10)
    axis.set_xlabel(over + (f" [{UNITS[over]}]" if over in UNITS else ""))
    if 0 < 30 * places.min() < places.max():
        axis.set_xscale("log")
    least, most = values.min(), values.max()
    if title.startswith("Sag"):
        more = max(0.05 * (most - least), 0.05 - (most - least) / 2)
        axis.set_ylim(least - more, most + more)
    elif 0 < 30 * least < most:
        axis.set_yscale("log")
    else:
        axis.set_ylim(0, 1.08 * most)
    axis.grid(color="#e6e9ee")
    axis.set_axisbelow(True)
    axis.spines[["top", "right"]].set_visible(False)


def plot(path, picture, over=None):
    table, vary, figures = read(path)
    at_rest, ok = figures[STEADY] < REST, table["outcome"] == "ok"
    over = over or next(name for name in vary if table[name].dtype.kind == "f")
    others = [name for name in vary if name != over]
    page, axes = plt.subplots(2, 3, figsize=(9.6, 5.8))
    for axis, (title, values) in zip(axes.flat, figures.items()):
        for rows, colour, style, text in lines(table, over, others):
            axis.plot(table[over][rows], values[rows], style, color=colour, linewidth=1.5, label=text)
            for dots, face in ((rows[at_rest[rows]], colour), (rows[~at_rest[rows]], "white")):
                axis.plot(table[over][dots], values[dots], "o", color=colour, markerfacecolor=face, markersize=5)
        finish(axis, title, over, table[over][ok], values[ok])
    top = 1.0
    if others:
        handles, texts = axes[0, 0].get_legend_handles_labels()
        columns = min(3, len(texts))
        top -= 0.02 + 0.04 * math.ceil(len(texts) / columns)
        page.legend(handles, texts, loc="upper center", ncol=columns, frameon=False, handlelength=3)
    page.tight_layout(rect=(0, 0, 1, top), h_pad=2, w_pad=2)
    page.savefig(picture, dpi=100)


plot(*sys.argv[1:])
