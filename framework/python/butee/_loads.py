"""Loads written in Python."""

from __future__ import annotations

import inspect
from typing import Callable

from . import _butee
from ._functions import declared, written


def load(name: str) -> Callable[[Callable[..., float]], Callable[..., float]]:
    """Registers a function of time as a type of load. Scenes created later can use its name in ``load`` and ``in_time``.

    The function receives the time in s and its parameters, and returns N (N m on rotations). Its other arguments are keys of the
    load and must be numbers; those without a default are required. Intended for experiments: every value takes about a microsecond
    and the interpreter's lock, some ten times the cost of a step of a small scene, and threads of a batch wait for each other. Methods
    that need a Taylor series or a piecewise parabolic load (``exact``, ``exponential``) refuse it, and ``auto`` chooses another method.

    >>> @butee.load("half_sine")
    ... def half_sine(t, amplitude, width=0.01):
    ...     return amplitude * math.sin(math.pi * t / width) if t < width else 0.0
    >>> struck = scene.with_values({"load[0]": {"type": "half_sine", "node": "rotor", "amplitude": 1e5}})
    Traceback (most recent call last):
    ...
    butee.InputError: ...
    >>> scene = butee.Scene({**scene.to_dict(), "load": [{"type": "half_sine", "node": "rotor", "amplitude": 1e5}]})
    >>> scene.run(end_time=0.001).completed
    True

    Registering a name again replaces the load in scenes created later. To unpickle a scene, the same load must be registered in
    that process.
    """

    if not isinstance(name, str):
        raise TypeError("the decorator needs the name of the load: @butee.load(\"NAME\")")

    def register(function: Callable[..., float]) -> Callable[..., float]:
        parameters = declared(name, function, "the time")
        _butee.register_load(name, function, parameters, inspect.getdoc(function) or "a function in Python")
        written.add(name)
        return function

    return register
