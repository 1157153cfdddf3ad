"""Studies: what HDF5 readers find in the file, equal files however it was made, and bad input."""

import ast
import copy
import fcntl
import inspect
import itertools
import json
import os
import pathlib
import random
import resource
import signal
import subprocess
import time

import h5py
import numpy
import pytest
import weft
from conftest import contents

study = pytest.importorskip("weft.study")
PROGRAM = os.environ["WEFT_PROGRAM"]
KILLS = int(os.environ.get("WEFT_STUDY_KILLS", "2"))


def cli(*words, **more):
    return subprocess.run([PROGRAM, "study", *map(str, words)], capture_output=True, text=True, **more)


def test_the_file_holds_what_each_simulation_alone_does(spec, tmp_path):
    path = tmp_path / "a.h5"
    told = []
    study.run(spec, path=path, progress=lambda done, all: told.append((done, all)))
    assert told == [(k, 24) for k in range(1, 25)]
    assert os.listdir(tmp_path) == ["a.h5"]
    table = study.table(path)
    densities = [0.1, 0.2, 0.4]
    with h5py.File(path) as file:
        assert list(file["frames"]) == [4, 8, 12]
        assert file["positions"].shape == (24, 3, 108, 3) and file["positions"].compression == "gzip"
        for row in table:
            k = int(row["run"])
            assert row["g"] == [-9.81, -2][k // 12]
            assert row["cloths.0.density"] == pytest.approx(densities[k // 4 % 3])
            assert 0.1 <= row["colliders.0.sphere.radius"] < 0.28
            sim = weft.Simulation(spec["scene"], {
                "/gravity/1": row["g"], "/cloths/0/density": row["cloths.0.density"],
                "/colliders/0/sphere/radius": row["colliders.0.sphere.radius"]}, seed=5)
            for sample in range(3):
                sim.advance(4)
                assert numpy.array_equal(file["positions"][k, sample], sim.positions.astype("f4"))
            report = sim.report()
            assert row["hash"] == report["hash"] and row["outcome"] == "ok" and row["finite"] == 1
            assert row["strain.max"] == report["strain"]["max"]
            assert row["energy.total"] == report["energy"]["total"]
            assert row["particles"] == 108
        assert numpy.array_equal(file["triangles"], weft.Simulation(spec["scene"]).triangles)
    # A Latin hypercube: each quarter of the range once.
    layers = numpy.floor((table["colliders.0.sphere.radius"][:4] - 0.1) / 0.18 * 4)
    assert sorted(layers) == [0, 1, 2, 3]


def test_one_content_for_any_jobs_shards_and_programs(spec, tmp_path):
    file = tmp_path / "spec.json"
    file.write_text(json.dumps(spec))
    paths = [tmp_path / f"{k}.h5" for k in range(4)]
    study.run(spec, path=paths[0], jobs=1)
    study.run(str(file), path=paths[1], jobs=5)
    assert cli(file, "--out", paths[2], "--jobs", 3).returncode == 0
    shards = [tmp_path / f"shard{k}.h5" for k in (1, 2, 3)]
    for k, shard in enumerate(shards, 1):
        assert cli(file, "--out", shard, "--shard", f"{k}/3").returncode == 0
    assert cli("--merge", *reversed(shards), "--out", paths[3]).returncode == 0
    sizes = {path.stat().st_size for path in paths}
    assert len(sizes) == 1
    for path in paths[1:]:
        assert contents(path) == contents(paths[0])
    # Byte for byte: only the 8 bytes of `seconds` of each row may differ.
    a, b = (numpy.frombuffer(p.read_bytes(), "u1") for p in (paths[0], paths[3]))
    assert (a != b).sum() <= 24 * 8
    merged = tmp_path / "again.h5"
    study.merge(shards, merged)
    assert contents(merged) == contents(paths[0])


def test_kill_9_loses_at_most_the_runs_in_flight(spec, tmp_path):
    spec["draws"]["count"], spec["frames"] = 40, 40
    file, path, whole = tmp_path / "spec.json", tmp_path / "a.h5", tmp_path / "whole.h5"
    file.write_text(json.dumps(spec))
    start = time.monotonic()
    assert cli(file, "--out", whole).returncode == 0
    duration = time.monotonic() - start
    dice = random.Random(7)
    kills = 0
    for _ in range(KILLS):
        for name in ("a.h5", "a.h5.runs"):
            (tmp_path / name).unlink(missing_ok=True)
        words = [PROGRAM, "study", file, "--out", path, "--resume"]
        while True:
            child = subprocess.Popen(words, stdout=subprocess.DEVNULL)
            time.sleep(dice.uniform(0.2, 0.6) * duration)
            done_before = path.with_suffix(".h5.runs").stat().st_size if path.with_suffix(".h5.runs").exists() else 0
            child.kill()
            kills += child.wait() == -9
            journal = path.with_suffix(".h5.runs")
            if path.exists():
                break
            assert journal.stat().st_size >= done_before
        assert cli(file, "--out", path, "--resume").returncode == 0
        assert contents(path) == contents(whole)
        assert not [n for n in os.listdir(tmp_path) if n.startswith(".weft") or n.endswith(".runs")]
    assert kills >= 1
    print(f"{kills} kills in {KILLS} studies")


def test_a_journal_cut_anywhere_keeps_its_whole_records(spec, tmp_path):
    spec["frames"], spec["positions"] = 2, {"every": 2}
    file, path, journal = tmp_path / "s.json", tmp_path / "a.h5", tmp_path / "a.h5.runs"
    file.write_text(json.dumps(spec))
    seen = []
    def stop(done, all):
        seen.append(journal.read_bytes())
        if done == 5:
            raise KeyboardInterrupt
    with pytest.raises(KeyboardInterrupt):
        study.run(spec, path=path, jobs=1, progress=stop)
    assert not path.exists() and len(seen) == 5
    whole = seen[-1]
    reference = tmp_path / "ref.h5"
    study.run(spec, path=reference)
    for cut in (len(seen[1]) + 1, len(seen[2]) - 1, len(seen[3]) + 40, len(whole)):
        journal.write_bytes(whole[:cut])
        told = []
        study.run(spec, path=path, resume=True, progress=lambda done, all: told.append(done))
        kept = sum(len(s) <= cut for s in seen)
        assert told == list(range(kept + 1, 25))
        assert contents(path) == contents(reference)
        path.unlink()
    broken = bytearray(whole)
    broken[len(seen[2]) - 9] ^= 1  # a bit of the third record: it and what follows is run again
    journal.write_bytes(broken)
    study.run(spec, path=path, resume=True)
    assert contents(path) == contents(reference)


def test_a_run_that_fails_is_a_row_with_its_reason(spec, tmp_path):
    spec["parameters"] = [
        {"pointer": "/cloths/0/density", "values": [0.2, -1]},
        {"pointer": "/cloths/0/velocity", "values": [[0, 0, 0], [0, 1e30, 0]]}]
    del spec["draws"]
    path = tmp_path / "a.h5"
    study.run(spec, path=path)
    table = study.table(path)
    outcome = list(table["outcome"])
    assert outcome[0] == "ok"
    assert outcome[2].startswith("/cloths/0/density: ") and outcome[2] == outcome[3][:len(outcome[2])]
    assert numpy.isnan(table["strain.max"][2]) and table["particles"][2] == 0
    assert outcome[1] != "ok"
    with h5py.File(path) as file:
        assert numpy.isfinite(file["positions"][0]).all()
        assert numpy.isnan(file["positions"][1:]).all()


def test_runs_with_other_grids_fill_up_with_nan(spec, tmp_path):
    spec["parameters"] = [{"pointer": "/cloths/0/grid/points", "values": [[12, 9], [5, 4], [20, 11]]}]
    del spec["draws"]
    path = tmp_path / "a.h5"
    study.run(spec, path=path)
    with h5py.File(path) as file:
        x = file["positions"][:]
    assert x.shape == (3, 3, 220, 3)
    for k, points in enumerate([[12, 9], [5, 4], [20, 11]]):
        sim = weft.Simulation(spec["scene"], {"/cloths/0/grid/points": points})
        sim.advance(12)
        n = points[0] * points[1]
        assert numpy.array_equal(x[k, 2, :n], sim.positions.astype("f4"))
        assert numpy.isnan(x[k, :, n:]).all()
    assert list(study.table(path)["cloths.0.grid.points"]) == ["[12,9]", "[5,4]", "[20,11]"]


def test_sobol_points_fill_every_layer_of_every_dimension(scene, tmp_path):
    names = ["/cloths/0/density", "/cloths/0/drag", "/gravity/0", "/gravity/1", "/gravity/2",
             "/wind/velocity/0", "/wind/velocity/1", "/wind/velocity/2", "/wind/drag",
             "/cloths/0/stiffness/structural", "/cloths/0/stiffness/shear", "/cloths/0/stiffness/bend",
             "/colliders/0/sphere/radius", "/colliders/0/sphere/center/0",
             "/colliders/0/sphere/center/1", "/colliders/0/sphere/center/2"]
    def points(method):
        spec = {"weft_study": 1, "scene": scene, "frames": 0, "seed": 9, "measures": [],
                "draws": {"method": method, "count": 64},
                "parameters": [{"pointer": n, "draw": {"from": 0.1, "to": 1.1}} for n in names]}
        path = tmp_path / (method + ".h5")
        study.run(spec, path=path)
        table = study.table(path)
        return numpy.stack([table[n[1:].replace("/", ".")] for n in names], axis=1) - 0.1
    for method in ("sobol", "latin_hypercube"):
        x = points(method)
        for d in range(16):
            assert sorted(numpy.floor(x[:, d] * 64 + 1e-6)) == list(range(64)), (method, d)
    x = points("sobol")
    for a, b in itertools.combinations(range(3), 2):  # squares of 8 x 8 hold one each, or pairs of them
        squares = numpy.floor(x[:, a] * 8 + 1e-9) * 8 + numpy.floor(x[:, b] * 8 + 1e-9)
        assert len(set(squares)) >= 32
    uniform = points("random")
    assert abs(uniform.mean() - 0.5) < 0.05 and len(set(uniform.ravel())) == 64 * 16


def changed(spec, pointer, value):
    spec = copy.deepcopy(spec)
    *way, last = pointer
    here = spec
    for key in way:
        here = here[key]
    if value is None:
        del here[last]
    else:
        here[last] = value
    return spec


@pytest.mark.parametrize("pointer, value, message", [
    (("weft_study",), 2, "this is no study"),
    (("scene",), None, "/scene: it is missing"),
    (("scene",), "helo", 'nearest is "hello"'),
    (("scene", "cloths"), [], "/scene/cloths"),
    (("parametres",), [], 'the nearest is "parameters"'),
    (("parameters", 0, "pointer"), "/gravitty/1", '/parameters/0/pointer: there is no "gravitty"'),
    (("parameters", 0, "pointer"), "/cloths/7/density", "the list has no element"),
    (("parameters", 0, "pointer"), "gravity", "no JSON pointer"),
    (("parameters", 0, "values"), [], "at least one value"),
    (("parameters", 0, "values"), None, "exactly one of them"),
    (("parameters", 1, "range", "count"), 1, "/parameters/1/range/count"),
    (("parameters", 1, "range", "count"), 10**9, "/parameters/1/range/count"),
    (("parameters", 1, "range", "from"), -1, "/parameters/1/range/from"),
    (("draws", "count"), 10**7, "the study has 60000000 runs .at most 10000000"),
    (("draws", "method"), "halton", "latin_hypercube, sobol, random"),
    (("draws",), None, "/draws: it is missing"),
    (("measures", 0), "/strain", "no single value"),
    (("measures", 0), "/nothing", "no single value"),
    (("measures", 1), "/strain/max", "two columns"),
    (("positions", "every"), 0, "/positions/every"),
    (("positions", "every"), 13, "no frame is kept"),
    (("positions",), {"frames": [3, 2]}, "/positions/frames/1"),
    (("positions",), {"frames": [13]}, "0 to 12"),
    (("frames",), -1, "/frames"),
    (("scene",), "flag_round", "/scene/cloths/0/mesh: a study has a mesh"),
])
def test_what_is_wrong_is_told_with_its_place_and_nothing_is_written(spec, tmp_path, pointer, value, message):
    wrong = changed(spec, pointer, value)
    with pytest.raises(study.StudyError, match=message):
        study.run(wrong, path=tmp_path / "a.h5")
    assert os.listdir(tmp_path) == []


def test_a_billion_combinations(spec, tmp_path):
    spec["parameters"] = [{"pointer": p, "range": {"from": 0.1, "to": 1, "count": 1000}}
                          for p in ("/gravity/0", "/gravity/1", "/gravity/2")]
    del spec["draws"]
    with pytest.raises(study.StudyError, match="1000000000 runs .at most 10000000"):
        study.run(spec, path=tmp_path / "a.h5")


def test_values_may_be_arrays_and_what_is_no_json_is_told(spec, tmp_path):
    path = tmp_path / "a.h5"
    spec["parameters"][0]["values"] = numpy.array([-9.81, -2])
    study.run(spec, path=path)
    assert set(study.table(path)["g"]) == {-9.81, -2}
    path.unlink()
    for value, error, message in (({1, 2}, TypeError, "study holds no set"),
                                  ([float("nan")], ValueError, "not finite")):
        with pytest.raises(error, match=message):
            study.run(changed(spec, ("parameters", 0, "values"), value), path=path)
    with pytest.raises(TypeError, match="Client is needed, not str"):
        study.run(spec, "tcp://somewhere", path=path)
    with pytest.raises(ValueError, match="jobs is -1"):
        study.run(spec, path=path, jobs=-1)
    with pytest.raises(study.StudyError, match="no shards"):
        study.merge([], path)
    assert os.listdir(tmp_path) == []


def test_more_shards_than_files_that_a_process_begins_with(spec, tmp_path):
    shards = [tmp_path / f"{k}.h5" for k in range(1, 25)]
    for k, shard in enumerate(shards, 1):
        study.run(spec, path=shard, shard=(k, 24))
    merge = lambda most: cli("--merge", *shards, "--out", tmp_path / "all.h5", preexec_fn=lambda:
                             resource.setrlimit(resource.RLIMIT_NOFILE, (40, most)))
    told = merge(80)  # the system's own limit, which no process may lift
    assert told.returncode == 2 and "24 shards are too many files to open" in told.stderr
    assert not (tmp_path / "all.h5").exists()
    assert merge(1000).returncode == 0
    study.run(spec, path=tmp_path / "whole.h5")
    assert contents(tmp_path / "all.h5") == contents(tmp_path / "whole.h5")


def test_a_study_that_another_process_is_at_is_refused(spec, tmp_path):
    journal = tmp_path / "a.h5.runs"
    with open(journal, "w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        with pytest.raises(study.StudyError, match="another process"):
            study.run(spec, path=tmp_path / "a.h5", resume=True)


def test_finished_runs_are_not_lost_by_mistake(spec, tmp_path):
    path = tmp_path / "a.h5"
    def stop(done, all):
        raise KeyboardInterrupt
    with pytest.raises(KeyboardInterrupt):
        study.run(spec, path=path, progress=stop)
    with pytest.raises(study.StudyError, match="resume"):
        study.run(spec, path=path)
    other = changed(spec, ("seed",), 6)
    with pytest.raises(study.StudyError, match="another study"):
        study.run(other, path=path, resume=True)
    study.run(spec, path=path, resume=True)
    study.run(spec, path=path, resume=True)  # nothing left to do
    with pytest.raises(study.StudyError, match="another study"):
        study.run(other, path=path, resume=True)
    with pytest.raises(study.StudyError, match="missing"):
        shard = tmp_path / "shard.h5"
        study.run(spec, path=shard, shard=(1, 2))
        study.merge([shard], tmp_path / "b.h5")
    with pytest.raises(study.StudyError, match="there twice"):
        study.merge([shard, shard], tmp_path / "b.h5")
    with pytest.raises(study.StudyError, match="cannot be read"):
        (tmp_path / "no.h5").write_text("no")
        study.merge([tmp_path / "no.h5"], tmp_path / "b.h5")
    assert not (tmp_path / "b.h5").exists()


@pytest.mark.parametrize("bytes", [40_000, 150_000, 280_000])
def test_a_full_disk_leaves_nothing_half_written(spec, tmp_path, bytes):
    file, path = tmp_path / "spec.json", tmp_path / "a.h5"
    file.write_text(json.dumps(spec))
    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (bytes, bytes))
    told = cli(file, "--out", path, preexec_fn=limit)
    names = [n for n in os.listdir(tmp_path) if n != "spec.json"]
    if told.returncode != 0:
        assert told.returncode == 5 and "a.h5" in told.stderr, told
        assert names == ["a.h5.runs"]
    assert cli(file, "--out", path, "--resume").returncode == 0
    study.run(spec, path=tmp_path / "b.h5")
    assert contents(path) == contents(tmp_path / "b.h5")


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_keeps_what_is_finished(spec, tmp_path, sent):
    spec["draws"]["count"], spec["frames"] = 2000, 60
    file = tmp_path / "spec.json"
    file.write_text(json.dumps(spec))
    child = subprocess.Popen([PROGRAM, "study", file, "--out", tmp_path / "a.h5"],
                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    time.sleep(0.5)
    child.send_signal(sent)
    assert child.wait(20) == 128 + sent and "--resume" in child.stderr.read()
    assert sorted(os.listdir(tmp_path)) == ["a.h5.runs", "spec.json"]


def test_stubs_have_every_function_with_its_arguments():
    stubs = ast.parse((pathlib.Path(study.__file__).with_suffix(".pyi")).read_text()).body
    stubs = {f.name: [a.arg for a in f.args.args + f.args.kwonlyargs]
             for f in stubs if isinstance(f, ast.FunctionDef)}
    functions = {name: list(inspect.signature(f).parameters) for name, f in vars(study).items()
                 if inspect.isfunction(f) and not name.startswith("_")}
    assert stubs == functions


def test_the_command_line(spec, tmp_path):
    assert cli().returncode == 2
    told = cli(tmp_path / "none.json", "--out", tmp_path / "a.h5")
    assert told.returncode == 3 and "cannot be read" in told.stderr
    file = tmp_path / "spec.json"
    file.write_text(json.dumps(spec))
    told = cli(file, "--out", tmp_path / "no" / "a.h5")
    assert told.returncode == 5 and told.stderr.startswith("weft: error: ")
    for shard in ("0/2", "3/2", "1", "a/b", "1/2x", "-1/2"):
        told = cli(file, "--out", tmp_path / "a.h5", "--shard", shard)
        assert told.returncode == 2 and "--shard" in told.stderr, shard
    assert sorted(os.listdir(tmp_path)) == ["spec.json"]
