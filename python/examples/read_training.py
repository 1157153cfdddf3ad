"""Reads training data that `weft study studies/training.json` made: batches of (before, after) pairs.
usage: python3 read_training.py TRAINING.h5
"""

import sys

import h5py
import numpy as np


def pairs(path, batch=32, seed=0):
    """Endless batches: parameters (batch, p), positions of one sample and of the next (batch, n, 3)."""
    random = np.random.default_rng(seed)
    with h5py.File(path) as file:
        rows, positions = file["runs"][:], file["positions"]
        good = np.flatnonzero(rows["outcome"] == b"ok")
        names = ("radius", "x", "z", "friction", "density", "bend")
        parameters = np.stack([rows[name] for name in names], axis=1).astype("f4")
        while True:
            runs = random.choice(good, batch)
            samples = random.integers(0, positions.shape[1] - 1, batch)
            both = np.stack([positions[r, s : s + 2] for r, s in zip(runs, samples)])
            yield parameters[runs], both[:, 0], both[:, 1]


parameters, before, after = next(pairs(sys.argv[1]))
print(f"a batch: {parameters.shape}, {before.shape}; a sample moves cloth by "
      f"{np.linalg.norm(after - before, axis=2).mean() * 1000:.1f} mm on average")
