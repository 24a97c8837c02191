"""A coupled controller and structure: a beam between stops is damped by a force proportional to its velocity.

The controller samples the middle of the beam every millisecond and holds its force until the next sample, as a computer does.
"""

import pathlib

import matplotlib.pyplot as plt
import numpy as np

import butee

MODELS = pathlib.Path(__file__).parents[1] / "models"
PERIOD, END = 1e-3, 2.0  # s
LIMIT = 20e3  # N, largest force of the actuator

scene = butee.Scene.load(MODELS / "beam3.toml", {"integrator.type": "auto"})


def course(gain):
    """Instants and displacements of the middle with a controller of `gain` N s/m."""
    beam = scene.structure(forced=["string:middle"])
    middle = beam.dof("string:middle")
    t = np.arange(0.0, END, PERIOD)
    u = np.empty_like(t)
    for i, now in enumerate(t):
        beam.advance_to(now)
        u[i] = beam.displacement(middle)
        beam.set_force(middle, float(np.clip(-gain * beam.velocity(middle), -LIMIT, LIMIT)))
    return t, u


for gain in (0.0, 20e3):
    t, u = course(gain)
    plt.plot(t, u * 1e3, linewidth=0.7, label=f"{gain:g} N s/m")
    print(f"gain {gain:g} N s/m: rms displacement {1e3 * np.sqrt(np.mean(u**2)):.2f} mm")
plt.xlabel("t / s")
plt.ylabel("middle of the beam / mm")
plt.legend()
plt.savefig("control_loop.png", dpi=150)
