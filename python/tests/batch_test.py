"""Batch: the bits of each simulation alone, whatever the number of threads."""

import numpy
import pytest
import weft


def scenes_of(scene, count):
    return [{**scene, "gravity": [0.1 * k, -9.81, 0]} for k in range(count)]


@pytest.mark.parametrize("count", [1, 3, 7])
def test_the_bits_of_each_alone(scene, count):
    scenes = scenes_of(scene, count)
    alone = [weft.Simulation(s, threads=1) for s in scenes]
    for sim in alone:
        sim.advance(24)
    for threads in (1, 2, 3, 8):
        batch = weft.Batch(scenes, threads=threads)
        batch.advance(24)
        assert batch.positions.shape == (count, 108, 3)
        assert numpy.array_equal(batch.positions, numpy.stack([s.positions for s in alone]))
        assert numpy.array_equal(batch.velocities, numpy.stack([s.velocities for s in alone]))
        assert batch.hashes == [s.hash for s in alone]
        assert [r["energy"] for r in batch.reports()] == [s.energies for s in alone]


def test_record_keeps_every_nth_frame(scene):
    scenes = scenes_of(scene, 4)
    x = weft.Batch(scenes).record(20, every=6)
    assert x.shape == (4, 3, 108, 3) and x.dtype == numpy.float32
    for k, s in enumerate(scenes):
        sim = weft.Simulation(s)
        for sample in range(3):
            sim.advance(6)
            assert numpy.array_equal(x[k, sample], sim.positions.astype("f4"))


def test_each_is_a_simulation(scene):
    scene["cloths"][0]["grid"]["jitter"] = 0.001
    batch = weft.Batch([scene] * 3, seeds=[1, 2, 1])
    assert len(batch) == 3 and batch[0].hash == batch[-1].hash != batch[1].hash
    batch[1].pin(0, 3)
    assert batch[1].cloths[0].inverse_mass[0, 3] == 0 < batch[0].cloths[0].inverse_mass[0, 3]
    kept = batch[2].cloths[0].positions
    expected = kept.copy()
    del batch
    assert numpy.array_equal(kept, expected)


@pytest.mark.parametrize("one", [{"weft": 1}, "hello"])
def test_one_scene_is_no_list(one):
    with pytest.raises(TypeError, match="list of scenes"):
        weft.Batch(one)


@pytest.mark.parametrize("make", [
    lambda s: weft.Batch([]), lambda s: weft.Batch([s], seeds=[1, 2]),
    lambda s: weft.Batch([s, "hello"]), lambda s: weft.Batch([s], threads=-1),
    lambda s: weft.Batch([s]).record(5, every=0), lambda s: weft.Batch([s]).advance(-1),
    lambda s: weft.Batch([s, {"weft": 1}])])
def test_what_does_not_fit_is_a_value_error(scene, make):
    with pytest.raises(ValueError):
        make(scene)
