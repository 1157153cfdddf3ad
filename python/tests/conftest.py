import numpy
import pytest


@pytest.fixture
def scene():
    """A small sheet that falls on a ball."""
    return {
        "weft": 1,
        "name": "small",
        "time": {"frame": 1 / 60, "substeps": 8},
        "cloths": [{"grid": {"points": [12, 9], "origin": [-0.5, 0.6, -0.5],
                             "u": [1, 0, 0], "v": [0, 0, 1]}}],
        "colliders": [{"sphere": {"center": [0, 0.3, 0], "radius": 0.25}, "friction": 0.2}],
    }


@pytest.fixture
def spec(scene):
    return {
        "weft_study": 1,
        "scene": scene,
        "frames": 12,
        "seed": 5,
        "parameters": [
            {"pointer": "/gravity/1", "name": "g", "values": [-9.81, -2]},
            {"pointer": "/cloths/0/density", "range": {"from": 0.1, "to": 0.4, "count": 3, "scale": "log"}},
            {"pointer": "/colliders/0/sphere/radius", "draw": {"from": 0.1, "to": 0.28}},
        ],
        "draws": {"method": "latin_hypercube", "count": 4},
        "measures": ["/strain/max", "/energy/total", "/hash", "/finite"],
        "positions": {"every": 4},
    }


def contents(path):
    """All that is in a file, but for times."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(path) as file:
        found = {name: file[name][()] for name in file}
    found["runs"]["seconds"] = 0
    return {name: numpy.asarray(value).tobytes() for name, value in found.items()}
