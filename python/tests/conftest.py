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
