"""Transient dynamics of beams and oscillators that strike stops.

    import butee

    scene = butee.Scene.load("beam1.toml")
    scene["contact[0].gap"] = 0.008            # any key that --set takes
    result = scene.run(end_time=1.0)
    result.t, result["mid.u"], result.summary["peak"], result.impacts

Names, defaults and units are the same as in the program; ``butee help`` explains scenes, methods and results.
"""

from ._analyses import plugins, stability
from ._batch import Batch
from ._butee import version as __version__
from ._equations import Equations, Modes
from ._errors import Error, InputError, Mistake, RunError, SceneWarning
from ._functions import Finding, conformance
from ._laws import law
from ._loads import load
from ._result import Result
from ._scene import Scene
from ._structure import Snapshot, Structure
from ._study import Study

__all__ = ["Batch", "Equations", "Error", "Finding", "InputError", "Mistake", "Modes", "Result", "RunError", "Scene", "SceneWarning",
           "Snapshot", "Structure", "Study", "conformance", "law", "load", "plugins", "stability", "__version__"]

for _name in __all__:
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = __name__
