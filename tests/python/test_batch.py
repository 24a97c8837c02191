"""Batches of runs on threads."""

import numpy as np
import pytest

import butee

AMPLITUDES = np.linspace(1.0e5, 3.0e5, 7)


def test_runs_are_those_of_run(rotor):
    many = rotor.batch({"load[0].amplitude": AMPLITUDES}, threads=2)
    assert len(many) == 7 and not many.failed
    runs = [rotor.run({"load[0].amplitude": amplitude}) for amplitude in AMPLITUDES]
    assert all(np.array_equal(one["rotor.u"], other["rotor.u"]) for one, other in zip(many, runs))
    assert np.array_equal(many.peaks("rotor.u"), [run.peaks["rotor.u"] for run in runs])
    assert np.array_equal(many.values("load[0].amplitude"), AMPLITUDES)


@pytest.mark.parametrize("threads", [1, 3, None])
def test_the_number_of_threads_changes_nothing(rotor, threads):
    expected = [result["rotor.v"] for result in rotor.batch({"load[0].amplitude": AMPLITUDES}, threads=2)]
    many = rotor.batch({"load[0].amplitude": AMPLITUDES}, threads=threads)
    assert all(np.array_equal(result["rotor.v"], column) for result, column in zip(many, expected))


def test_plans(rotor):
    values = {"load[0].amplitude": [1e5, 2e5], "contact[0].gap": [1e-4, 2e-4]}
    grid = rotor.batch(values, end_time=0.002, collect=lambda result: result.t[-1])
    assert list(grid) == [0.002] * 4
    assert [tuple(point.values()) for point in grid.points] == [(1e5, 1e-4), (1e5, 2e-4), (2e5, 1e-4), (2e5, 2e-4)]
    listed = rotor.batch(values, plan="list", end_time=0.002)
    assert [tuple(point.values()) for point in listed.points] == [(1e5, 1e-4), (2e5, 2e-4)]
    rotor.update({"contact[0].law": "arctan", "contact[0].regularization": 1e6})
    laws = rotor.batch({"contact[0].law": ["linear", "arctan"], "contact[0].regularization": [None, 1e7]}, plan="list",
                       end_time=0.002)
    assert len(laws) == 2 and not laws.failed


def test_bad_plans(rotor):
    gaps = [1e-4, 2e-4, 3e-4]
    for values, options, error in [
        ({"contact[0].gap": gaps, "load[0].amplitude": [1e5]}, {"plan": "list"}, ValueError),
        ({"contact[0].gap": gaps}, {"plan": "sobol"}, ValueError),
        ({"contact[0].gap": gaps}, {"threads": 0}, ValueError),
        ({"contact[0].gap": 1e-4}, {}, TypeError),
        ({"contact[0].gap": range(10000), "load[0].amplitude": range(10000)}, {}, ValueError),
        ({"contact[0].law": "linear"}, {}, TypeError),
        ({"contact[0].gap": [1e-4, -1.0, 2e-4]}, {"threads": 2}, butee.InputError),
        ({"contact[0].gpa": gaps}, {}, butee.InputError),
        ({"contact[0].gap": [object()]}, {}, TypeError),
    ]:
        with pytest.raises(error):
            rotor.batch(values, **options)


def test_no_points(rotor):
    assert len(rotor.batch({"contact[0].gap": []})) == 0


def test_a_failed_run_is_one_of_them(rotor):
    rotor.update({"integrator.tolerance": None, "integrator.type": "rk4", "integrator.time_step": 1.0e-6})
    steps = [2.0e-3, 1.0e-6]
    many = rotor.batch({"integrator.time_step": steps}, threads=2)
    assert list(many.failed) == [0] and many.failed[0] == many[0].message
    assert many[1].completed and not many[0].completed


def test_collect_and_progress_raise(rotor):
    def refuse(*_):
        raise ZeroDivisionError

    for options in ({"collect": refuse}, {"progress": refuse}):
        with pytest.raises(ZeroDivisionError):
            rotor.batch({"load[0].amplitude": AMPLITUDES}, threads=2, **options)
    seen = []
    rotor.batch({"load[0].amplitude": AMPLITUDES}, progress=lambda *of: seen.append(of), end_time=0.001)
    assert seen == [(i + 1, 7) for i in range(7)]


def test_memory_does_not_grow():
    from conftest import ROTOR

    scene = butee.Scene({**ROTOR, "output": {}}).with_values(end_time=1e-4)

    def kilobytes():
        with open("/proc/self/status") as file:
            return int(next(line for line in file if line.startswith("VmRSS")).split()[1])

    def run(n):
        return scene.batch({"load[0].amplitude": np.linspace(1.0, 2.0, n)}, threads=2, collect=lambda result: result.t[-1])

    # A leak of one result of 1000 rows in each run would be 24 MB for 1000 runs, each time. Memory also grows by malloc
    # arenas and, under the address sanitizer, until its list of 256 MB of freed memory is full.
    run(300)
    growth = []
    while not growth or (growth[-1] >= 8000 and len(growth) < 20):
        before = kilobytes()
        assert len(run(1000)) == 1000
        growth.append(kilobytes() - before)
    assert growth[-1] < 8000, growth
