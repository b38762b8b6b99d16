"""Threads, Ctrl-C, progress, memory."""

import gc
import os
import resource
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import exactff
from support import CORNELL, POINT, UP, lamp_above, same_bits

ROOM = exactff.Scene.read(CORNELL)
FORM_FACTOR = ("form-factor", (0.0, 0.0, 1.0), False)
GRID = ROOM.receivers("floor", grid=(60, 60))


def work(**more):
    return ROOM.form_factors(GRID.points, GRID.normals, "all", GRID.on, **more)


def test_two_threads_at_once():
    expected, found = work(), {}
    threads = [threading.Thread(target=lambda k=k: found.update({k: work(threads=k)})) for k in (1, 2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert same_bits(found[1], expected) and same_bits(found[2], expected)


def test_the_gil_is_released():
    ticks, stop = [], threading.Event()

    def tick():
        while not stop.wait(0.001):
            ticks.append(1)

    ticker = threading.Thread(target=tick)
    ticker.start()
    work(threads=1)
    stop.set()
    ticker.join()
    assert len(ticks) > 3


LONG = """
import sys, time, exactff
scene = exactff.Scene.from_model("teapot:segments=12")
floor = scene.receivers("floor", grid=(400, 400))
def tell(done, total):
    if done: print("at work", flush=True)
start = time.monotonic()
try:
    WORK
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
FORM_FACTORS = "scene.form_factors(floor.points, floor.normals, on=floor.on, threads={}, progress=tell)"
METHOD = "exactff.methods.evaluate('wallace:splits=16', scene, floor.points, floor.normals, on=floor.on, progress=tell)"
TRUTH = "exactff.truth(scene, floor, sys.argv[1], existing='replace', progress=tell)"


@pytest.mark.parametrize("call", [FORM_FACTORS.format(0), FORM_FACTORS.format(1), METHOD, TRUTH],
                         ids=["threads", "one thread", "method", "truth"])
def test_ctrl_c_within_half_a_second(call, tmp_path):
    command = [sys.executable, "-c", LONG.replace("WORK", call), str(tmp_path / "t.csv")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "at work\n"
        sent = time.monotonic()
        child.send_signal(signal.SIGINT)
        rest = child.stdout.read()
        waited = time.monotonic() - sent
    assert child.returncode == 0 and rest.endswith("interrupted\n"), rest  # perhaps in the middle of "at work"
    # Twice the promise, because the tests share the machine; the end of the interpreter is included.
    assert waited < 1.0


def test_a_handler_of_the_user_may_go_on():
    seen = []
    before = signal.signal(signal.SIGALRM, lambda *_: seen.append(1))
    signal.setitimer(signal.ITIMER_REAL, 0.01)
    try:
        expected = work(threads=1)
    finally:
        signal.signal(signal.SIGALRM, before)
    assert seen and same_bits(expected, work())


def test_what_a_progress_function_raises_ends_the_work():
    def refuse(done, total):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        work(progress=refuse)
    assert work().shape == (3600, 8)


def test_progress_is_told_from_the_calling_thread(capsys, monkeypatch):
    pytest.importorskip("tqdm")
    monkeypatch.setattr("exactff._arguments._PATIENCE", 0.0)
    told = []
    work(progress=lambda done, total: told.append((done, total, threading.get_ident())))
    assert told[-1] == (3600, 3600, threading.get_ident())
    assert [done for done, _, _ in told] == sorted(done for done, _, _ in told)
    work(progress=True)
    assert "3600" in capsys.readouterr().err
    work()
    work(progress=False)
    assert capsys.readouterr().err == ""


def resident_bytes():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


def test_no_leak_in_100000_calls():
    """Calls of every kind, with results, errors, and scenes that come and go."""
    point, up = np.array([POINT]), np.array([UP])
    floor = ROOM.faces_of("floor")[:1]
    compiled = sys.modules["exactff._exactff"]

    def some(calls):
        for _ in range(calls):
            compiled.form_factor(ROOM._scene, POINT, UP, floor, "light", False, False, False, False, 0, 65536, None, FORM_FACTOR).facts()
        for _ in range(calls // 20):
            ROOM.form_factors(point, up, "light", 0, full=True)
            ROOM.form_factor(POINT, UP, "light", 0, gradient=True)
        for _ in range(calls // 200):
            with pytest.raises(exactff.InputError):
                compiled.form_factor(ROOM._scene, POINT, UP, floor, "lamp", False, False, False, False, 0, 65536, None, FORM_FACTOR)
            lamp_above((0.5, 0.2)).form_factors(np.zeros((40, 3)), [0, 0, 1], threads=2)
        gc.collect()

    some(10_000)
    before = resident_bytes()
    some(91_000)
    assert resident_bytes() - before < 2_000_000


def test_jemalloc_is_not_loaded():
    with open(f"/proc/{os.getpid()}/maps") as file:
        maps = file.read()
    assert "_exactff" in maps and "jemalloc" not in maps
