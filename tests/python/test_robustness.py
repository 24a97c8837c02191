"""No Python code crashes the interpreter, and Ctrl-C ends a running computation."""

import gc
import os
import pathlib
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import butee
from conftest import ROTOR

#: A run that takes longer than any test.
LONG = """
    import sys, time
    sys.path[:0] = {path!r}
    import butee
    from conftest import ROTOR
    scene = butee.Scene(ROTOR).with_values({{"output.interval": 1.0}}, type={method!r}, **{options!r})
"""


def interrupted(method, options, code, after=0.4):
    """Runs `code` in another interpreter, sends SIGINT and returns its output."""
    text = textwrap.dedent(LONG.format(path=[str(pathlib.Path(__file__).parent)], method=method, options={"end_time": 1.0e6, **options}))
    text += textwrap.dedent(code)
    process = subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert process.stdout.readline() == "ready\n"
    time.sleep(after)
    process.send_signal(signal.SIGINT)
    watchdog = threading.Timer(30.0, process.kill)
    watchdog.start()
    with process:
        out = process.stdout.read()
    watchdog.cancel()
    return process.returncode, out


def interrupted_twice(code):
    """interrupted() for each of the two `calls` that `code` defines."""
    loop = """
        import os, signal, threading
        for call in calls:
            try:
                print("ready", flush=True)
                call()
            except KeyboardInterrupt:
                print("interrupted")
                threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    """
    return interrupted("rk4", {"time_step": 1e-6, "tolerance": None}, textwrap.dedent(code) + textwrap.dedent(loop))


@pytest.mark.parametrize("method, options", [("rk4", {"time_step": 1e-6, "tolerance": None}), ("exponential", {}), ("rodas4", {"end_time": 1.0e4}),
                                             ("exact", {"tolerance": None})])
def test_ctrl_c_ends_a_run(method, options):
    code = """
        try:
            print("ready", flush=True)
            scene.run()
        except KeyboardInterrupt:
            print("interrupted", scene.run(end_time=1e-3, time_step=1e-6).completed)
    """
    assert interrupted(method, options, code) == (0, "interrupted True\n")


def test_ctrl_c_ends_a_batch_and_a_structure():
    code = """
        part = scene.structure()
        calls = (lambda: scene.batch({"load[0].amplitude": [1e5, 2e5, 3e5]}, threads=2), lambda: part.advance_to(1e6))
    """
    assert interrupted_twice(code) == (0, "interrupted\nready\ninterrupted\n")


def test_ctrl_c_within_a_load_ends_a_run_and_a_structure():
    code = """
        @butee.load("slow")
        def slow(t):
            until = time.monotonic() + 0.01
            while time.monotonic() < until:
                pass
            return 1.0

        import time
        scene = butee.Scene({**ROTOR, "load": [{"node": "rotor", "type": "slow"}], "output": {"interval": 1.0},
                             "integrator": {"type": "rk4", "time_step": 1e-6, "end_time": 1e4}})
        part = scene.structure()
        calls = (lambda: scene.run(), lambda: part.advance_to(1e4))
    """
    assert interrupted_twice(code) == (0, "interrupted\nready\ninterrupted\n")


def test_nan_from_a_law_names_the_function():
    @butee.law("lost")
    def lost(g, stiffness):
        return float("nan") if 2e-6 < g < 9e-6 else stiffness * max(g, 0.0)

    scene = butee.Scene({**ROTOR, "contact": [{"type": "stop", "nodes": "rotor", "gap": 1e-5, "law": "lost", "stiffness": 1e9}]})
    with pytest.raises(butee.RunError, match="the Python function lost returned nan at"):
        scene.run()


def test_progress_is_called_and_may_raise(rotor):
    slow = rotor.with_values({"integrator.tolerance": None, "output.interval": 0.01}, type="rk4", time_step=1e-7, end_time=0.3)
    seen = []
    slow.run(progress=lambda t, end: seen.append((t, end)))
    assert seen and all(0.0 < t < end == 0.3 for t, end in seen) and seen == sorted(seen)

    def refuse(t, end):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        slow.run(progress=refuse)
    assert slow.run(end_time=0.001).completed


def test_other_threads_go_on_meanwhile(rotor):
    slow = rotor.with_values({"integrator.tolerance": None, "output.interval": 0.01}, type="rk4", time_step=1e-7, end_time=0.2)
    running = threading.Thread(target=slow.run)
    running.start()
    count = 0
    while running.is_alive():
        count += 1
        time.sleep(0.001)
    # If a run kept the lock, this loop would execute only a few times, before and after the run.
    assert count > 20


def test_one_scene_on_many_threads(rotor):
    expected = rotor.run()["rotor.u"]
    same = []

    def work(i):
        for k in range(10):
            if i == 0:
                rotor["contact[0].gap"] = 4.0e-4  # the same value; running computations use their own scene
            same.append(np.array_equal(rotor.run()["rotor.u"], expected))

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert same == [True] * 40


def test_one_structure_on_two_threads_is_refused(rotor):
    part = rotor.with_values({"integrator.tolerance": None}, type="rk4", time_step=1e-7).structure()

    def work():
        while True:
            try:
                return part.advance_to(0.2)
            except butee.RunError:  # the other thread has the structure
                pass

    running = threading.Thread(target=work)
    running.start()
    refused = 0
    while running.is_alive():
        for call in (lambda: part.x, lambda: part.time, part.snapshot, lambda: part.forces):
            try:
                call()
            except butee.RunError:
                refused += 1
    running.join()
    assert refused > 0 and part.time == 0.2


def test_equations_on_many_threads(rotor):
    equations = rotor.equations()
    expected = equations.acceleration(0.1, [5e-4], [1.0])
    wrong = []

    def work():
        for _ in range(2000):
            if not np.array_equal(equations.acceleration(0.1, [5e-4], [1.0]), expected):
                wrong.append(1)

    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
def test_a_forked_process_goes_on_by_itself(rotor):
    """Uses objects created before the fork, while other threads compute.

    A child of a process with the address sanitizer of GCC 12 may wait forever for a lock of its allocator, which
    another thread had at the fork (the C library releases its own). There the other thread is left out.
    """
    sanitized = "libasan" in os.environ.get("LD_PRELOAD", "")
    expected, part = rotor.run()["rotor.u"], rotor.structure()
    slow = rotor.with_values({"integrator.tolerance": None, "output.interval": 0.01}, type="rk4", time_step=1e-7, end_time=0.3)
    running = threading.Thread(target=slow.run if not sanitized else int)
    running.start()
    statuses = []
    for _ in range(3):
        child = os.fork()
        if child == 0:
            try:
                amplitudes = {"load[0].amplitude": [1e5, 2e5]}
                many, rows = rotor.batch(amplitudes, threads=2), rotor.study(amplitudes, "peak rotor.u", periods=3, threads=2)
                part.advance_to(1e-3)
                good = np.array_equal(rotor.run()["rotor.u"], expected) and not many.failed and not rows.failed and part.time == 1e-3
                os._exit(0 if good else 3)
            finally:
                os._exit(4)
        watchdog = threading.Timer(30.0, os.kill, (child, signal.SIGKILL))
        watchdog.start()
        statuses.append(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
        watchdog.cancel()
    running.join()
    assert statuses == [0, 0, 0] and part.time == 0.0


def test_owners_may_go_first(rotor):
    part, equations, result = rotor.structure(forced=["rotor"]), rotor.equations(), rotor.run()
    snapshot, K, u = part.snapshot(), equations.K, result["rotor.u"]
    del rotor, result, equations
    gc.collect()
    part.advance_to(1e-3)
    part.restore(snapshot)
    del part
    gc.collect()
    assert snapshot.time == 0.0 and K[0, 0] == 1.0e9 and np.isfinite(u).all()


@pytest.mark.parametrize("name", ["Session", "Outcome", "Batch", "Equations", "Part", "Snapshot"])
def test_objects_without_content_are_not_made(name):
    """Objects cannot be created by __new__ alone, because they would be incomplete."""
    kind = getattr(butee._butee, name)
    for make in (kind, lambda: kind.__new__(kind), lambda: object.__new__(kind), lambda: super(kind, kind).__new__(kind)):
        with pytest.raises(TypeError):
            make()


def test_empty_python_objects_raise():
    for kind in (butee.Scene, butee.Result, butee.Structure, butee.Equations):
        empty = kind.__new__(kind)
        with pytest.raises(AttributeError):
            repr(empty)


PYTHON_LOAD = """
@butee.load("nothing")
def nothing(t):
    return 0.0
scene = butee.Scene({**scene.to_dict(), "load": [{"type": "nothing", "node": "rotor"}]})
"""


@pytest.mark.parametrize("setting", ["", PYTHON_LOAD], ids=["alone", "with_a_load_in_python"])
def test_an_interpreter_may_end_in_the_midst(tmp_path, setting):
    """Threads that compute then want its lock now and then, or nearly always."""
    code = textwrap.dedent(LONG.format(path=[str(pathlib.Path(__file__).parent)], method="rk4",
                                       options={"time_step": 1e-6, "tolerance": None, "end_time": 1.0e6}))
    code += setting + textwrap.dedent("""
        import threading
        for _ in range(6):
            threading.Thread(target=scene.run, daemon=True).start()
        time.sleep(0.2)
        print('bye')
        """)
    # More threads than cores: then threads want the lock while and after the interpreter ends.
    processes = [subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  text=True) for _ in range(4)]
    for process in processes:
        said = process.communicate(timeout=60)
        assert (process.returncode, *said) == (0, "bye\n", "")


@pytest.mark.parametrize("setting", [
    "runs = butee._butee.batch(scene._core, ['output.interval'], [(1.0,)] * 3, 2)",
    PYTHON_LOAD], ids=["a_batch", "a_load_in_python"])
def test_what_outlives_the_program_dies_with_the_interpreter(setting):
    """The thread that ends the interpreter drops the last references then, and must not wait for itself."""
    code = textwrap.dedent(LONG.format(path=[str(pathlib.Path(__file__).parent)], method="rk4",
                                       options={"time_step": 1e-4, "tolerance": None, "end_time": 1.0e6}))
    code += setting + "\nsys.kept = [scene, globals().get('runs')]\nprint('bye')\n"
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (process.returncode, process.stdout, process.stderr) == (0, "bye\n", "")
