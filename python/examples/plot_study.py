"""Plots what a study with positions found, over its first parameter: sag, folds, settling time, frames a
second, greatest strain.
usage: python3 plot_study.py STUDY.h5 PICTURE.png
"""

import json
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import weft


def normals(x, triangles):
    """Unit normals of the triangles, (triangles, 3)."""
    a, b, c = (x[triangles[:, k]] for k in range(3))
    n = np.cross(b - a, c - a)
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def folds(x, triangles):
    """Mean angle between the two triangles of a square [degrees]."""
    n = normals(x, triangles)
    return np.degrees(np.arccos(np.clip((n[0::2] * n[1::2]).sum(axis=1), -1, 1))).mean()


def settling(positions, seconds):
    """When no particle is farther than 1 cm from where it ends, for good [s]."""
    away = np.linalg.norm(positions - positions[-1], axis=2).max(axis=1) > 0.01
    return seconds[np.flatnonzero(away)[-1] + 1] if away.any() else seconds[0]


file = h5py.File(sys.argv[1])
table = weft.study.table(sys.argv[1])
spec = json.loads(file["study"][()])
frame = weft.Simulation(spec["scene"]).scene.get("time", {}).get("frame", 1 / 60)
names = [name for name in table.dtype.names[2:] if name not in ("seconds", "outcome")]
parameter, rest = names[0], names[1 : len(spec["parameters"])]
figures = {
    "lowest point [m]": [x[-1, :, 1].min() for x in file["positions"]],
    "folds [degrees]": [folds(x[-1], file["triangles"][:]) for x in file["positions"]],
    "settled after [s]": [settling(x, file["frames"][:] * frame) for x in file["positions"]],
    "frames a second": 1000 / table["wall_ms.frame_median"],
    "greatest strain [%]": 100 * table["strain.max"],
}
picture, axes = plt.subplots(1, len(figures), figsize=(4 * len(figures), 3.5))
groups = sorted({tuple(row[name] for name in rest) for row in table})
for axis, (title, values) in zip(axes, figures.items()):
    for group in groups:
        mine = [tuple(row[name] for name in rest) == group for row in table]
        label = ", ".join(f"{name} {value}" for name, value in zip(rest, group))
        axis.plot(table[parameter][mine].astype(str), np.asarray(values)[mine], "o-", label=label)
    axis.set_title(title)
    axis.set_xlabel(parameter)
if rest:
    axes[0].legend(fontsize=6)
picture.tight_layout()
picture.savefig(sys.argv[2], dpi=80)
