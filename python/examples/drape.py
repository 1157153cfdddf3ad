"""A sheet falls on a ball: its energies over time, and its shape at the end.
usage: python3 drape.py [PICTURE.png]
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import weft

sim = weft.Simulation("hello")
kinetic, height = [], []
for _ in range(120):
    sim.advance()
    kinetic.append(sim.energies["kinetic"])
    height.append(sim.positions[:, 1].mean())

figure = plt.figure(figsize=(9, 4))
left = figure.add_subplot(1, 2, 1)
left.plot(np.arange(1, 121) / 60, kinetic, label="kinetic energy [J]")
left.plot(np.arange(1, 121) / 60, height, label="mean height [m]")
left.set_xlabel("time [s]")
left.legend()
right = figure.add_subplot(1, 2, 2, projection="3d")
x, y, z = sim.positions.T
right.plot_trisurf(x, z, y, triangles=sim.triangles, shade=True)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "drape.png", dpi=100)
