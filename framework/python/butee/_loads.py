"""Loads written in Python."""

from __future__ import annotations

import inspect
from typing import Callable

from . import _butee
from ._functions import declared, written


def load(name: str) -> Callable[[Callable[..., float]], Callable[..., float]]:
    """Makes a function of the time a type of load that scenes made later may name, in ``load`` and ``in_time``.

    The function gets the time in s and its parameters, and returns N (N m on rotations). Its further arguments are the keys of the
    load, all of them numbers; those without a default have to be given. For trying out: every value takes about a microsecond
    and the interpreter's lock, some ten times the cost of a step of a small scene, and threads of a batch wait for each other. Methods
    that need a Taylor series or a load made of parabolas (``exact``, ``exponential``) refuse it, and ``auto`` takes another one.

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

    A name that is registered again is replaced, in scenes that are made later. A pickled scene needs the same registration where it is
    unpickled.
    """

    def register(function: Callable[..., float]) -> Callable[..., float]:
        parameters = declared(name, function, "the time")
        _butee.register_load(name, function, parameters, inspect.getdoc(function) or "a function in Python")
        written.add(name)
        return function

    return register
