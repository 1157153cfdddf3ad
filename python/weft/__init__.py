"""Weft: fast and accurate cloth simulation on the CPU.

A scene is a dict (or a JSON file), a Simulation moves it, arrays of NumPy show it:

    import weft

    scene = {
        "weft": 1,
        "cloths": [{"grid": {"points": [50, 50], "origin": [-0.5, 1, -0.5],
                             "u": [1, 0, 0], "v": [0, 0, 1]}}],
        "colliders": [{"sphere": {"center": [0, 0.5, 0], "radius": 0.3}}],
    }
    sim = weft.Simulation(scene)
    sim.advance(60)              # frames; one second
    x = sim.positions            # (2500, 3) float64 [m], a copy
    v = sim.cloths[0].positions  # (50, 50, 3) float32 [m], no copy: shows every later frame, too
    print(sim.report()["strain"])

While it runs:

    sim.set("/gravity", [0, -1.6, 0])          # any value of the scene
    sim.pin(0, 0); sim.grab(0, 2499, [1, 1, 1]); sim.move_collider(0, [0, 0.7, 0])
    before = sim.snapshot(); sim.advance(30); sim.restore(before)

Many at once: Batch. Studies over parameters, on all cores or on a Dask cluster: weft.study.

Everything is SI (m, kg, s, N), y is up. The same scene gives the same bits for any number of threads,
on every instruction set. What is wrong with a scene is told as `weft check` tells it: SceneError.
shipped_scenes() lists scenes to begin with, scene_schema() has every value with its range, default
and unit.
"""

import os as _os
import pathlib as _pathlib

from ._weft import (
    Batch,
    ClothArrays,
    SceneError,
    Simulation,
    SimulationError,
    Snapshot,
    __version__,
    check_scene,
    estimate,
    read_scene,
    scene_schema,
    shipped_scenes,
)

try:
    from . import study
except AttributeError:  # built without HDF5
    pass

# An installed package brings the shipped scenes.
_scenes = _pathlib.Path(__file__).parent / "scenes"
if _scenes.is_dir():
    _os.environ.setdefault("WEFT_SCENES", str(_scenes))

__all__ = [
    "Batch",
    "ClothArrays",
    "SceneError",
    "Simulation",
    "SimulationError",
    "Snapshot",
    "check_scene",
    "estimate",
    "read_scene",
    "scene_schema",
    "shipped_scenes",
]
