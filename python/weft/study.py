"""Studies: one scene, run with many values, here or on a cluster, into one HDF5 file.

    spec = {
        "weft_study": 1,
        "scene": "pinned4",
        "seconds": 3,
        "parameters": [{"pointer": "/cloth/ks", "values": [500, 5000, 50000]}],
        "measures": ["/strain/max", "/energy/total"],
        "positions": {"every": 30},
    }
    weft.study.run(spec, path="ks.h5")                  # all cores of this machine
    weft.study.run(spec, client, path="ks.h5")          # a dask.distributed.Client
    table = weft.study.table("ks.h5")                   # a NumPy array with a row for each run

The file is the same for both, and for `weft study STUDY.json --out ks.h5`, but for the column `seconds`.
docs/studies.md has every key.
"""

import contextlib
import functools
import itertools
import math
import os
import queue
import time

from . import _weft

StudyError = _weft.StudyError


def read(spec):
    """The study of a dict or of a STUDY file. Raises StudyError with every fault."""
    if isinstance(spec, dict):
        return _weft.Study(spec)
    path = os.fspath(spec)
    with open(path, encoding="utf-8") as file:
        return _weft.Study(file.read(), os.path.dirname(path))


def run(spec, client=None, *, path, resume=False, shard=(1, 1), jobs=0, retries=10, progress=None):
    """Runs a study into an HDF5 file.

    spec:     a dict or a STUDY file
    client:   a dask.distributed.Client, or None: this machine
    path:     the file; it appears when all runs are there. Until then finished runs are in path.runs
    resume:   goes on with those; else there must be none
    shard:    (K, N): only every Nth run, from the Kth on
    jobs:     runs at a time on this machine, 0 = all cores; never changes the result
    retries:  how often a run is given to another worker when its own is lost
    progress: called as progress(done, all) after every run

    A run that fails is a row with its reason in the column `outcome`. Raises StudyError for what is wrong
    with the study, OSError where a file cannot be written, ConnectionError where the scheduler of Dask is
    gone; finished runs are kept then.
    """
    if client is not None and not hasattr(client, "submit"):
        raise TypeError(f"client: a dask.distributed.Client is needed, not {type(client).__name__}")
    study = read(spec)
    path = os.fspath(path)
    if client is None:
        study.run_all(path, jobs, resume, shard, progress)
        return
    results = _weft.Results(study, path, shard, resume)
    _gather(results, study, client, retries, progress or (lambda done, all: None))
    results.finish()


def _gather(results, study, client, retries, progress):
    """Sends out what is missing, as much as the cluster has room for, and keeps what comes back."""
    from distributed import CancelledError, KilledWorker

    missing = results.missing
    runs = iter(missing)
    room = _Room(client)
    back = queue.SimpleQueue()  # (future, run, how often the run was lost)
    flying = done = 0

    def send(run, lost=0):
        # The text goes with every run: data scattered to workers is gone when they are.
        future = client.submit(_work, study.text, run, pure=False, retries=retries)
        future.add_done_callback(lambda future: back.put((future, run, lost)))

    while done < len(missing):
        room.require_scheduler()
        for run in itertools.islice(runs, max(0, room.runs() - flying)):
            send(run)
            flying += 1
        kept = 0
        batch = _batch(back)
        for (_, run, lost), record in zip(batch, _fetch(client, [future for future, *_ in batch])):
            if isinstance(record, bytes):
                results.append(record)
                kept += 1
            elif isinstance(record, (CancelledError, KilledWorker, OSError)) and lost < retries:
                room.require_scheduler()  # an OSError: it ended while it was asked
                send(run, lost + 1)
            else:
                raise record
        results.store()  # runs that are told of are safe
        flying -= kept
        for _ in range(kept):
            done += 1
            progress(done, len(missing))


def _batch(back):
    """What has come back by now, at most as much as one message carries; waits a second for the first."""
    batch = []
    try:
        batch.append(back.get(timeout=1))
        while len(batch) < 64:
            batch.append(back.get_nowait())
    except queue.Empty:
        pass
    return batch


def _fetch(client, futures):
    """The record of each, or the error that it ended with; in one message where all went well."""
    try:
        return client.gather(futures)
    except Exception as error:
        if len(futures) == 1:
            return [error]
        return [_fetch(client, [future])[0] for future in futures]


class _Room:
    """How many runs may be on their way: four for every thread of the cluster, which grows and shrinks."""

    def __init__(self, client):
        self._client, self._runs, self._asked = client, 4, -math.inf

    def runs(self):
        now = time.monotonic()
        if now > self._asked + 1 and self._client.status == "running":
            self._asked = now
            with contextlib.suppress(OSError):  # the scheduler is being lost
                self._runs = 4 * max(1, sum(self._client.nthreads().values()))
        return self._runs

    def require_scheduler(self):
        # A client looks for a lost scheduler for a while (distributed.comm.timeouts.connect), then closes.
        if self._client.status in ("closing", "closed"):
            raise ConnectionError(
                "the scheduler is gone; finished runs are kept, and resume=True goes on with them")


@functools.lru_cache(maxsize=4)
def _study(text):
    return _weft.Study(text)


def _work(text, run):
    """One run on a worker: its record as bytes."""
    return _study(text).run(run)


def merge(shards, path):
    """Makes one file of those of all shards: that of one run, but for the column `seconds`."""
    _weft.merge([os.fspath(shard) for shard in shards], os.fspath(path))


def table(path):
    """The table of a study, (runs,) with a field for each column; pandas.DataFrame takes it."""
    import h5py
    import numpy

    with h5py.File(path, "r") as file:
        rows = file["runs"][:]
    names = {k: "U%d" % t.itemsize if t.kind == "S" else t for k, (t, *_) in rows.dtype.fields.items()}
    words = numpy.empty(len(rows), list(names.items()))
    for name in names:
        column = rows[name]
        words[name] = numpy.char.decode(column, "utf-8") if column.dtype.kind == "S" else column
    return words
