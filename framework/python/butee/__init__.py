"""Transient dynamics of beams and oscillators that strike stops.

    import butee

    scene = butee.Scene.load("beam1.toml")
    scene["contact[0].gap"] = 0.008            # any key that --set takes
    result = scene.run(end_time=1.0)
    result.t, result["mid.u"], result.summary["peak"], result.impacts

Names, defaults and units are those of the program: ``butee help`` explains scenes, methods and results.
"""

from ._butee import version as __version__
from ._errors import Error, InputError, Mistake, RunError, SceneWarning
from ._result import Result
from ._scene import Scene

__all__ = ["Error", "InputError", "Mistake", "Result", "RunError", "Scene", "SceneWarning", "__version__"]
