"""Bifurcation diagram of a rotor against a stop: displacement once per period of the load, over the load amplitude.

    python3 bifurcation.py [POINTS [TURNS]]     (291 points, 1500 turns: half a minute)
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import butee

points, turns = (int(word) for word in (sys.argv[1:] + ["291", "1500"][len(sys.argv) - 1 :]))

scene = butee.Scene.load(pathlib.Path(__file__).with_name("rattle.toml"))
turn = 2 * np.pi / scene["load[0].angular_frequency"]
scene.update({"output.interval": turn, "integrator.end_time": turns * turn, "output.probe[0].quantities": ["u"]})
many = scene.batch({"load[0].amplitude": np.linspace(1e3, 30e3, points)},
                   collect=lambda result: result["rotor.u"][-60:].copy())  # after the transient

for amplitude, u in zip(many.values("load[0].amplitude"), many):
    plt.plot(np.full(u.size, amplitude / 1e3), u * 1e3, ".", markersize=1, color="tab:blue")
plt.xlabel("load / kN")
plt.ylabel("displacement once per turn / mm")
plt.savefig("bifurcation.png", dpi=150)
kinds = [np.unique(np.round(u, 6)).size for u in many]
print(f"{points} loads, {sum(kind == 1 for kind in kinds)} of them with one turn of the load as the period")
