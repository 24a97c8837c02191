"""The same M, C, K and stops by butee and by scipy.integrate.solve_ivp: results and run times."""

import pathlib
import time

import numpy as np
import scipy.integrate
import scipy.sparse.linalg

import butee

MODELS = pathlib.Path(__file__).parents[1] / "models"
END = 0.02  # s
scene = butee.Scene.load(MODELS / "beam1.toml", {
    "integrator.type": "exact", "contact[0].law": "linear", "contact[0].regularization": None,
    "load[0].amplitude": 3.0e5, "output.interval": 1.0e-3, "integrator.end_time": END})

begin = time.perf_counter()
result = scene.run()
ours = time.perf_counter() - begin

equations = scene.equations()
n = len(equations.dofs)
C, K = equations.C, equations.K
solve = scipy.sparse.linalg.factorized(equations.M)


def rate(t, y):
    x, v = y[:n], y[n:]
    return np.concatenate([v, solve(equations.external_force(t) + equations.contact_force(x, v, t) - C @ v - K @ x)])


begin = time.perf_counter()
theirs = scipy.integrate.solve_ivp(rate, (0.0, END), np.concatenate([equations.x0, equations.v0]), method="DOP853",
                                   rtol=1e-9, atol=1e-12, t_eval=result.t)
scipys = time.perf_counter() - begin

middle = equations.dofs.index("u of string:17")
difference = np.abs(theirs.y[middle] - result["mid.u"]).max() / np.abs(result["mid.u"]).max()
struck = (np.abs(theirs.y[: n]).max() > scene["contact[0].gap"])
print(f"largest difference {difference:.1e} of the peak, stops {'closed' if struck else 'open'}; "
      f"butee {ours:.3f} s, solve_ivp {scipys:.1f} s with {theirs.nfev} evaluations")
