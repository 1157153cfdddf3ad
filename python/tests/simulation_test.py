"""Simulation: the same bits as the program, arrays that live as long as somebody looks at them."""

import gc
import json
import os
import pathlib
import subprocess
import threading
import time

import numpy
import pytest
import weft

PROGRAM = os.environ["WEFT_PROGRAM"]


def run_program(tmp_path, *words):
    """`weft run` of a scene: its positions and its report."""
    dump, report = tmp_path / "dump.f64", tmp_path / "report.json"
    subprocess.run([PROGRAM, "run", *words, "--dump", dump, "--report", report], check=True,
                   capture_output=True)
    return numpy.fromfile(dump, "<f8").reshape(-1, 3), json.loads(report.read_text())


def test_the_same_bits_as_the_program(scene, tmp_path):
    file = tmp_path / "scene.json"
    file.write_text(json.dumps(scene))
    positions, report = run_program(tmp_path, file, "--frames", "40", "--threads", "1")
    for given, threads in [(scene, 1), (str(file), 2), (file, 3)]:
        sim = weft.Simulation(given, threads=threads, follow_strain=True)
        sim.advance(40)
        assert numpy.array_equal(sim.positions, positions)
        ours = sim.report()
        assert f"{sim.hash:016x}" == report["hash"] == ours["hash"]
        for key in ("energy", "strain", "momentum", "penetration", "frames", "substeps", "status"):
            assert ours[key] == report[key], key
        assert ours.keys() == report.keys()
        assert sim.energies == report["energy"]


def test_values_replace_those_of_the_scene(tmp_path):
    positions, _ = run_program(tmp_path, "pinned2", "--frames", "5", "--set", "/cloth/ks=700")
    sim = weft.Simulation("pinned2", {"/cloth/ks": 700})
    sim.advance(5)
    assert numpy.array_equal(sim.positions, positions)


def test_windows_are_the_simulations_own_memory(scene):
    sim = weft.Simulation(scene)
    window = sim.cloths[0]
    assert window.positions.shape == window.velocities.shape == (9, 12, 3)
    assert window.inverse_mass.shape == (9, 12)
    before = window.positions.copy()
    address = window.positions.__array_interface__["data"][0]
    sim.advance(7)
    assert sim.cloths[0].positions.__array_interface__["data"][0] == address
    assert not numpy.array_equal(window.positions, before)
    assert numpy.array_equal(window.positions.reshape(-1, 3), sim.positions)
    assert not window.positions.flags.writeable and not window.positions.flags.owndata
    with pytest.raises(ValueError):
        window.positions[0, 0, 0] = 1


def test_windows_of_cloth_far_away_count_from_their_origin(scene):
    scene["cloths"][0]["grid"]["origin"] = [1000, 50, -0.5]
    sim = weft.Simulation(scene)
    sim.advance()
    window = sim.cloths[0]
    assert window.origin != [0, 0, 0]
    assert numpy.array_equal(window.positions.reshape(-1, 3) + window.origin, sim.positions)


def test_arrays_outlive_their_simulation(scene):
    sims = [weft.Simulation(scene) for _ in range(8)]
    for sim in sims:
        sim.advance(3)
    expected = sims[0].positions
    windows = [sim.cloths[0].positions for sim in sims]
    del sim, sims
    gc.collect()
    filler = [weft.Simulation(scene) for _ in range(8)]  # takes memory that was let go
    for window in windows:
        assert numpy.array_equal(window.reshape(-1, 3), expected)
    del filler


def test_arrays_outlive_a_scene_that_starts_anew(scene):
    sim = weft.Simulation(scene)
    sim.advance(3)
    window, expected = sim.cloths[0].positions, sim.positions
    sim.set("/cloths/0/grid/points", [20, 20])
    sim.advance(3)
    assert numpy.array_equal(window.reshape(-1, 3), expected)
    assert sim.positions.shape == (400, 3) and sim.frame == 3
    far = sim.snapshot()
    window, expected = sim.cloths[0].positions, sim.positions
    sim.restore(far)
    assert numpy.array_equal(window.reshape(-1, 3), expected)


def test_velocities_are_the_slope_of_positions():
    sim = weft.Simulation({"weft": 1, "cloths": [{"grid": {"points": [3, 3]}}]})
    sim.advance(10)  # free fall
    assert numpy.allclose(sim.velocities, [0, -9.81 * sim.time, 0], atol=1e-4)


def test_strain_of_edges_is_that_of_the_report(scene):
    scene["cloths"][0]["pins"] = [[0, 0], [11, 0]]
    scene["cloths"].append({"grid": {"points": [5, 4], "origin": [2, 1, 0]}, "pins": [[0, 0]]})
    sim = weft.Simulation(scene)
    sim.advance(30)
    strain, edges = sim.strain, sim.edges
    assert strain.shape == (len(edges),) and edges.shape[1] == 2
    assert len(edges) == sim.report()["constraints"]["structural"]
    assert strain.max() == pytest.approx(sim.report()["strain"]["max"], abs=1e-6)
    assert strain.mean() == pytest.approx(sim.report()["strain"]["mean"], abs=1e-6)


def test_torn_cloth_has_fewer_triangles_and_edges_without_strain(scene):
    sim = weft.Simulation(scene)
    whole = sim.triangles
    assert whole.shape == (2 * 11 * 8, 3) and whole.dtype == numpy.uint32
    x = sim.positions
    a, b, c = (x[whole[:, k]] for k in range(3))
    area = numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1).sum() / 2
    assert area == pytest.approx(1)
    sim.advance()
    y = sim.positions[:, 1].mean()
    assert sim.cut([0.02, y, -1], [0.02, y, 1], 0.02) > 0
    sim.advance()
    assert 0 < len(sim.triangles) < len(whole)
    assert numpy.isnan(sim.strain).any()
    assert set(sim.triangles.ravel()) <= set(range(108))


def test_a_hand_pins_grabs_carries_and_moves_bodies(scene):
    sim = weft.Simulation(scene)
    sim.pin(0, 0)
    assert sim.cloths[0].inverse_mass[0, 0] == 0
    held = sim.positions[0]
    sim.grab(0, 107, [0.5, 1.0, 0.5])
    sim.advance(20)
    assert numpy.array_equal(sim.positions[0], held)
    assert numpy.linalg.norm(sim.positions[107] - [0.5, 1.0, 0.5]) < 0.1
    sim.release()
    sim.carry(0, numpy.array([0, 0.5, 0]))
    sim.advance(20)
    assert sim.positions[0, 1] > held[1] + 0.1
    sim.unpin(0, 0)
    sim.move_collider(0, (0, -5, 0))
    sim.advance(60)
    assert sim.positions[:, 1].min() < -1


def test_scene_values_change_while_it_runs(scene):
    sim = weft.Simulation(scene)
    sim.advance(5)
    before = sim.positions
    sim.set("/gravity", numpy.array([0.0, 9.81, 0.0]))
    assert numpy.array_equal(sim.positions, before) and sim.frame == 5
    assert sim.scene["gravity"] == [0, 9.81, 0]
    sim.advance(60)
    assert sim.positions[:, 1].mean() > before[:, 1].mean()
    with pytest.raises(weft.SceneError, match="/gravitty"):
        sim.set("/gravitty", 1)
    with pytest.raises(weft.SceneError, match="stiffness"):
        sim.set("/cloths/0/stiffness/shear", -1)


def test_a_snapshot_goes_back_to_the_same_bits(scene):
    sim = weft.Simulation(scene)
    sim.advance(20)
    snapshot = sim.snapshot()
    assert snapshot.time == pytest.approx(20 / 60) and snapshot.nbytes > 108 * 24
    x = sim.positions
    sim.advance(10)
    sim.restore(snapshot)
    assert numpy.array_equal(sim.positions, x) and sim.frame == 20
    other = weft.Simulation("hello").snapshot()
    with pytest.raises(ValueError, match="another scene"):
        sim.restore(other)


def test_set_state_takes_real_numbers_of_the_right_shape_only(scene):
    sim = weft.Simulation(scene)
    x, v = sim.positions, sim.velocities
    sim.set_state(x.astype("f4") + 1, numpy.zeros((108, 3), int))
    assert numpy.allclose(sim.positions, x + 1, atol=1e-6)
    for bad in (x[:-1], x.ravel(), x[:, :2], x[None]):
        with pytest.raises(ValueError, match=r"shape is .* \(allowed: \(108, 3\)\)"):
            sim.set_state(bad, v)
    for dtype in ("c16", "S4", "O", "?"):
        with pytest.raises(TypeError, match="dtype"):
            sim.set_state(x.astype(dtype), v)
    with pytest.raises(ValueError, match="finite"):
        sim.set_state(x * numpy.nan, v)


@pytest.mark.parametrize("call", [
    lambda s: s.pin(0, 108), lambda s: s.pin(1, 0), lambda s: s.unpin(0, -1),
    lambda s: s.grab(0, 1 << 30, [0, 0, 0]), lambda s: s.move_collider(7, [0, 0, 0]),
    lambda s: s.carry(-1, [0, 0, 0])])
def test_what_is_not_there_is_an_index_error(scene, call):
    with pytest.raises(IndexError):
        call(weft.Simulation(scene))


@pytest.mark.parametrize("call", [
    lambda s: s.grab(0, 0, [0, 0]), lambda s: s.grab(0, 0, "abc"), lambda s: s.pin(0, 1 << 40),
    lambda s: s.pin(0, 0.5), lambda s: s.set_state("x", "v"), lambda s: s.restore(None),
    lambda s: weft.Simulation(7), lambda s: weft.Simulation({"weft": 1, "cloths": {1, 2}})])
def test_what_is_of_the_wrong_kind_is_a_type_error(scene, call):
    with pytest.raises(TypeError):
        call(weft.Simulation(scene))


@pytest.mark.parametrize("call", [
    lambda s: s.advance(-1), lambda s: s.grab(0, 0, [float("nan"), 0, 0]),
    lambda s: weft.Simulation("hello", threads=257), lambda s: weft.Simulation("hello", threads=-1),
    lambda s: weft.Simulation("hello", simd="mmx"),
    lambda s: weft.Simulation({"weft": 1, "gravity": [0, float("nan"), 0]})])
def test_what_is_out_of_range_is_a_value_error(scene, call):
    with pytest.raises(ValueError):
        call(weft.Simulation(scene))


def test_faults_are_those_of_weft_check(scene, tmp_path):
    scene["cloths"][0]["densty"] = 1
    scene["solver"] = {"iterations": -3}
    file = tmp_path / "wrong.json"
    file.write_text(json.dumps(scene))
    said = subprocess.run([PROGRAM, "check", file], capture_output=True, text=True).stderr
    expected = [line.removeprefix("weft: error: ") for line in said.splitlines()]
    with pytest.raises(weft.SceneError) as error:
        weft.Simulation(file)
    assert str(error.value).splitlines() == expected and len(expected) == 2
    with pytest.raises(weft.SceneError) as error:
        weft.Simulation(scene)
    assert [place for place, _, _ in error.value.faults] == ["/cloths/0/densty", "/solver/iterations"]
    assert weft.check_scene(scene) == error.value.faults
    assert weft.check_scene("hello") == []
    with pytest.raises(weft.SceneError, match="there is no such scene"):
        weft.Simulation("helo")


def test_a_simulation_that_stops_itself_says_so(scene):
    sim = weft.Simulation(scene)
    v = sim.velocities
    v[5] = [0, 1e30, 0]
    sim.set_state(sim.positions, v)
    for _ in range(2):
        with pytest.raises(weft.SimulationError, match="frame 1, .* particle"):
            sim.advance(5)
    assert sim.report()["status"] != "ok"
    with pytest.raises(weft.SimulationError, match="^1: .*frame 1"):
        batch = weft.Batch([scene, scene])
        batch[1].set_state(sim.positions * 0 + [[k, 1, 0] for k in range(108)], v)
        batch.advance(5)


def test_stepping_lets_other_threads_run(scene):
    scene["cloths"][0]["grid"]["points"] = [150, 150]
    scene["time"]["substeps"] = 200
    sim = weft.Simulation(scene, threads=1)
    stepping = threading.Thread(target=sim.advance, args=(4,))
    stepping.start()
    turns = 0
    while stepping.is_alive():
        turns += 1
        time.sleep(0.001)
    assert turns > 5


def test_threads_may_share_a_simulation(scene):
    sim = weft.Simulation(scene)
    def work():
        for _ in range(20):
            sim.advance()
            assert sim.positions.shape == (108, 3)
            sim.cloths[0].positions.sum()
    threads = [threading.Thread(target=work) for _ in range(4)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    alone = weft.Simulation(scene)
    alone.advance(80)
    assert sim.frame == 80 and sim.hash == alone.hash


def test_scenes_as_dicts():
    assert "hello" in weft.shipped_scenes()
    hello = weft.read_scene("hello")
    assert weft.read_scene(hello) == hello and hello["weft"] == 1
    assert weft.read_scene("hello", {"/gravity/1": -1})["gravity"] == [0, -1, 0]
    assert "cloths" in weft.scene_schema()["properties"]
    assert weft.estimate("hello")["particles"] == 4096
    course = weft.read_scene("pinned2")
    a, b = weft.Simulation("pinned2"), weft.Simulation(course)
    a.advance(5), b.advance(5)
    assert a.hash == b.hash


def test_meshes(tmp_path):
    xs = [(x, z) for z in range(3) for x in range(3)]
    mesh = "".join(f"v {x} 0 {z}\n" for x, z in xs)
    mesh += "".join(f"f {a} {a + 3} {a + 4} {a + 1}\n" for a in (1, 2, 4, 5))
    (tmp_path / "square.obj").write_text(mesh)
    scene = {"weft": 1, "cloths": [{"mesh": {"file": str(tmp_path / "square.obj"), "scale": 0.5},
                                    "pins": [0, 8]}]}
    sim = weft.Simulation(scene)
    sim.advance(10)
    assert sim.positions.shape == (9, 3) and sim.triangles.shape == (8, 3)
    assert sim.triangles.max() == 8 and sim.edges.shape == (16, 2) and len(sim.strain) == 16
    assert sim.positions[8].tolist() == [1, 0, 1] and sim.positions[1, 1] < 0
    cloth = sim.cloths[0]
    assert (cloth.positions.reshape(-1, 3)[cloth.lanes] == sim.positions).all()
    assert cloth.inverse_mass.ravel()[cloth.lanes][[0, 8]].tolist() == [0, 0]
    sim.set("/gravity", [0, 0, 0])  # the mesh stays as it was read
    sim.advance(1)
    scene["cloths"][0]["mesh"]["file"] = "none.obj"
    with pytest.raises(weft.SceneError, match="none.obj"):
        weft.Simulation(scene)
    flags = [weft.Simulation(s) for s in ("flag_round", weft.read_scene("flag_round"))]
    for flag in flags:
        flag.advance(2)
    assert flags[0].hash == flags[1].hash and flags[0].cloths[0].lanes.shape == (817,)


def test_help_has_every_public_name_and_the_stubs_agree():
    stubs = (pathlib.Path(weft.__file__).parent / "__init__.pyi").read_text()
    for name in weft.__all__:
        thing = getattr(weft, name)
        assert thing.__doc__, name
        assert f"class {name}" in stubs or f"def {name}(" in stubs, name
        for member in vars(thing) if isinstance(thing, type) else ():
            if not member.startswith("_"):
                assert f"{member}(" in stubs or f"{member}:" in stubs, f"{name}.{member}"
