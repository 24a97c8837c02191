"""Run-up of a shaft with a disc through its critical speed: the scene is a dict, without a file."""

import matplotlib.pyplot as plt
import numpy as np

import butee

scene = butee.Scene({
    "schema": 1,
    "title": "A shaft with a disc through its critical speed",
    "material": {"steel": {"young_modulus": 2.1e11, "density": 7850.0, "poisson_ratio": 0.3}},
    "section": {"shaft": {"shape": "circle", "radius": 0.015}},
    "element": [
        {"type": "beam", "motion": "lateral", "name": "shaft", "material": "steel", "section": "shaft", "length": 1.0, "elements": 8},
        {"type": "disc", "node": "shaft:middle", "mass": 12.0, "diametral_inertia": 0.03, "polar_inertia": 0.06},
    ],
    "support": [{"nodes": ["shaft:first", "shaft:last"], "fix": ["uy", "uz"]}],
    "rotation": {"speed": {"type": "ramp", "from": 0.0, "to": 400.0, "start": 0.0, "end": 8.0}},
    "load": [{"type": "unbalance", "node": "shaft:middle", "moment": 1.0e-3}],
    "damping": {"stiffness_proportional": 2.0e-4},
    "integrator": {"type": "rodas4", "tolerance": 1.0e-5, "end_time": 8.0},
    "output": {"interval": 1.0e-3, "probe": [{"label": "disc", "node": "shaft:middle", "quantities": ["uy", "uz"]}]},
})

critical = scene.modes(1).angular_frequencies[0]  # no gyroscopic moments: the disc in the middle does not tilt
result = scene.run()
speed = 400.0 / 8.0 * result.t
radius = np.hypot(result["disc.uy"], result["disc.uz"])
peak = speed[radius.argmax()]
print(f"critical speed {critical:.1f} rad/s; largest orbit of {1e3 * radius.max():.2f} mm at {peak:.1f} rad/s")

plt.plot(speed, radius * 1e3)
plt.xlabel("speed / (rad/s)")
plt.ylabel("radius of the orbit / mm")
plt.savefig("run_up.png", dpi=150)
