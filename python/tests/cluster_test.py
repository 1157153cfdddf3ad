"""Studies on Dask: the file of one machine, whatever is killed in the middle."""

import copy
import os
import json
import math
import random
import signal
import socket
import subprocess
import sys
import time

import pytest
import weft
from conftest import contents

study = pytest.importorskip("weft.study")
distributed = pytest.importorskip("distributed")
KILLS = int(os.environ.get("WEFT_STUDY_KILLS", "4"))


def test_dask_gives_the_same_file_though_workers_are_killed(spec, tmp_path):
    distributed = pytest.importorskip("distributed")
    spec = copy.deepcopy(spec)
    spec["draws"]["count"], spec["frames"] = 12, 40
    here, there = tmp_path / "here.h5", tmp_path / "there.h5"
    study.run(spec, path=here)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, \
            distributed.Client(cluster) as client:
        killed = []

        def progress(done, all):
            if done in (10, 30):  # in the middle of whatever it is at
                pid = next(iter(client.run(os.getpid).values()))
                os.kill(pid, signal.SIGKILL)
                killed.append(pid)

        study.run(spec, client, path=there, progress=progress)
    assert len(killed) == 2
    assert contents(here) == contents(there)


# Tells of each run that is kept: how many by now, of how many that were missing.
CLIENT = """
import json, sys, distributed, weft
address, spec, path = sys.argv[1:]
client = distributed.Client(address)
progress = lambda done, all: print(done, all, flush=True)
weft.study.run(json.loads(spec), client, path=path, resume=True, progress=progress)
"""


class Cluster:
    """Scheduler, two workers and client as processes; those that end are started again until a client is done."""

    def __init__(self, folder):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{port}"
        dask = [sys.executable, "-m", "distributed.cli.dask_"]
        worker = dask[:2] + [dask[2] + "worker", self.address, "--no-nanny", "--no-dashboard",
                             "--nthreads", "1", "--local-directory", str(folder)]
        self.words = {"scheduler": dask[:2] + [dask[2] + "scheduler", "--host", "127.0.0.1", "--port",
                                               str(port), "--no-dashboard"],
                      "worker 1": worker, "worker 2": worker}
        self.running = {}
        self.folder = folder

    def begin(self, spec, path):
        self.running.pop("client", None)
        self.words["client"] = [sys.executable, "-c", CLIENT, self.address, json.dumps(spec), str(path)]
        self.outputs = []

    def keep_up(self):
        """Starts what does not run; whether the study goes on."""
        for name, words in self.words.items():
            process = self.running.get(name)
            if process is not None and process.poll() is None:
                continue
            out = errors = subprocess.DEVNULL
            if name == "client":
                if process is not None and process.returncode == 0:
                    return False
                errors = self.folder / "errors"
                assert process is None or process.returncode == -signal.SIGKILL, errors.read_text()
                self.outputs.append(self.folder / f"client{len(self.outputs)}")
                out, errors = open(self.outputs[-1], "wb"), open(errors, "wb")
            self.running[name] = subprocess.Popen(words, stdout=out, stderr=errors)
        return True

    def told(self):
        """(done, missing at its start) as the present client and those before it told, for each that did."""
        lines = [path.read_text().splitlines() for path in self.outputs]
        return [tuple(map(int, all[-1].split())) for all in lines if all]

    def kill(self, name):
        self.running[name].send_signal(signal.SIGKILL)
        self.running[name].wait()

    def end(self):
        for process in self.running.values():
            process.kill()
            process.wait()


def test_kill_9_of_scheduler_worker_and_client_loses_the_runs_in_flight_alone(spec, tmp_path):
    spec["draws"]["count"], spec["frames"] = 10, 1500
    spec["positions"] = {"every": 300}
    whole, path = tmp_path / "whole.h5", tmp_path / "a.h5"
    study.run(spec, path=whole)
    dice = random.Random(11)
    killed, again, rounds = [], [], 0
    cluster = Cluster(tmp_path)
    try:
        while len(killed) < KILLS:
            path.unlink(missing_ok=True)
            cluster.begin(spec, path)
            rounds += 1
            told, moment = None, math.inf
            while cluster.keep_up():
                time.sleep(0.02)
                if cluster.told() != told and moment == math.inf:  # runs come in again
                    moment = time.monotonic() + dice.uniform(0, 0.6)
                if time.monotonic() > moment and len(killed) < KILLS:
                    # Each in turn, in an order by chance.
                    if not again:
                        again = dice.sample(sorted(cluster.words), 4)
                    killed.append(again.pop())
                    cluster.kill(killed[-1])
                    told, moment = cluster.told(), math.inf
            clients = cluster.told()
            assert clients[0][1] == 60
            for (done, missing), (_, later) in zip(clients, clients[1:]):
                assert missing - done - 8 <= later <= missing - done  # eight runs are in flight at most
            assert contents(path) == contents(whole)
            assert not path.with_suffix(".h5.runs").exists()
    finally:
        cluster.end()
    print(f"{len(killed)} kills in {rounds} studies:", {name: killed.count(name) for name in cluster.words})
