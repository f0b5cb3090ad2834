"""Threads, forks, spawned processes, interrupts, progress."""

import concurrent.futures
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import spinneb as sn


def run_small(sites):
    system = sn.System(sn.chain(sites), [sn.exchange(J=["10 meV"]), sn.anisotropy(K="0.5 meV")])
    return sn.barrier(system, sn.uniform("z"), sn.uniform("-z"))


def height(sites):
    return run_small(sites).barrier_meV["forward"]


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_processes_run_after_a_run_here(method):
    if method not in multiprocessing.get_all_start_methods():
        pytest.skip(f"no {method} on this system")
    here = [height(sites) for sites in (12, 14)]
    run_small(12).html()
    context = multiprocessing.get_context(method)
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        assert list(pool.map(height, (12, 14), timeout=120)) == here
        # a result comes back whole
        result = pool.submit(run_small, 12).result(120)
    assert np.array_equal(result.spins, run_small(12).spins)


def test_several_threads_run_at_once():
    here = [height(sites) for sites in (10, 11, 12, 13)]
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        assert list(pool.map(height, (10, 11, 12, 13))) == here


def test_progress_is_told_of(capsys):
    told = []
    system = sn.System(sn.chain(60), [sn.exchange(J=["10 meV"]), sn.anisotropy(K="0.1 meV")])
    here = threading.get_ident()
    sn.barrier(system, sn.uniform("z"), sn.uniform("-z"), progress=lambda news: told.append((threading.get_ident(), news)))
    assert all(thread == here for thread, _ in told)
    assert any(news["stage"] == "relaxing the ends" for _, news in told)
    assert any(news.get("highest_image_meV", 0) > 0 for _, news in told)
    sn.barrier(system, sn.uniform("z"), sn.uniform("-z"), progress=True)
    assert "relaxing" in capsys.readouterr().err


def test_what_progress_raises_ends_the_run():
    def fail(news):
        raise KeyError("enough")

    system = sn.System(sn.chain(40), [sn.exchange(J=["10 meV"]), sn.anisotropy(K="0.1 meV")])
    with pytest.raises(KeyError, match="enough"):
        sn.barrier(system, sn.uniform("z"), sn.uniform("-z"), progress=fail)


LONG = """
import signal, sys, time
# where the tests run in the background the signal comes in as one that is ignored
signal.signal(signal.SIGINT, signal.default_int_handler)
import spinneb as sn
sites = int(sys.argv[1])
system = sn.System(sn.chain(sites), [sn.exchange(J=["10 meV"]), sn.anisotropy(K="0.5 meV")])
def tell(news):
    if not told:
        told.append(1)
        print("running", flush=True)
told = []
try:
    sn.barrier(system, sn.uniform("z"), sn.uniform("-z"), images=20, progress=tell, threads=2)
    print("finished")
except KeyboardInterrupt:
    print("interrupted")
"""


@pytest.mark.skipif(os.name == "nt", reason="signals of another kind")
@pytest.mark.parametrize("wait", [0.2, 2.0, 6.0])
def test_ctrl_c_ends_a_run_of_1e5_spins_soon(wait):
    process = subprocess.Popen([sys.executable, "-c", LONG, "100000"], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "running\n"
    time.sleep(wait)
    sent = time.monotonic()
    process.send_signal(signal.SIGINT)
    patience = threading.Timer(20.0, process.kill)
    patience.start()
    said = process.stdout.readline()
    patience.cancel()
    took = time.monotonic() - sent
    process.wait(30)
    assert said in ("interrupted\n", "finished\n")
    # a second as a rule, and some more on a busy machine
    assert took < 4.0, took


RECORDED = """
import signal, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)
import spinneb as sn
out, resume = sys.argv[1], sys.argv[2] == "resume"
system = sn.System(sn.chain(1000), [sn.exchange(J=["10 meV"]), sn.anisotropy(K="4e-4 meV")])
def tell(news):
    if news.get("iteration", 0) >= 1 and not told and not resume:
        told.append(1)
        print("running", flush=True)
        time.sleep(30)
told = []
try:
    found = sn.barrier(system, sn.uniform("z"), sn.uniform("-z"), images=20, progress=tell, out=out, resume=resume)
    print("finished", found.summary["work"]["force_evaluations"], repr(found.barrier_meV["forward"]))
except KeyboardInterrupt as stop:
    print("interrupted", getattr(stop, "__notes__", None))
"""


@pytest.mark.skipif(os.name == "nt", reason="signals of another kind")
def test_what_was_interrupted_goes_on_from_its_folder(tmp_path):
    anew = [sys.executable, "-W", "error", "-c", RECORDED, str(tmp_path / "x"), "anew"]
    process = subprocess.Popen(anew, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "running\n"
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[0]
    assert said.startswith("interrupted"), said
    assert sys.version_info < (3, 11) or "resume=True goes on from the checkpoint in" in said
    assert (tmp_path / "x" / "checkpoint" / "journal").is_file() and not (tmp_path / "x" / "summary.json").exists()
    # the one that goes on warns of that it does
    words = [sys.executable, "-c", RECORDED, str(tmp_path / "x"), "resume"]
    on = subprocess.run(words, capture_output=True, text=True, timeout=300)
    assert "going on from the checkpoint, with" in on.stderr, on.stderr
    assert not (tmp_path / "x" / "checkpoint").exists()
    assert sn.load(tmp_path / "x").certified
    # what is finished is read, and is the outcome of a run without interruption
    again = subprocess.run(words, capture_output=True, text=True, timeout=300)
    whole = subprocess.run([*words[:3], str(tmp_path / "y"), "resume"], capture_output=True, text=True, timeout=300)
    assert on.stdout == again.stdout == whole.stdout and on.stdout.startswith("finished"), (on, again, whole)


def test_a_landscape_is_written_and_read_where_it_is_finished(tmp_path):
    system = sn.System(sn.chain(6), [sn.exchange(J=["10 meV"]), sn.anisotropy(K="0.5 meV")])
    found = sn.landscape(system, effort="quick", out=tmp_path)
    assert not (tmp_path / "checkpoint").exists()
    again = sn.landscape(system, effort="quick", out=tmp_path, resume=True)
    assert {**again.summary, "manifest": None} == {**found.summary, "manifest": None}
    with pytest.raises(ValueError, match="give it as out"):
        sn.landscape(system, resume=True)


def test_import_is_quick():
    code = (
        "import time, numpy; start = time.process_time(); import spinneb; "
        "print(time.process_time() - start)"
    )
    times = [float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout) for _ in range(5)]
    assert min(times) < 0.05, times
