"""Common code for loads and laws written in Python."""

from __future__ import annotations

import inspect
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Set, Tuple

from . import _butee


#: Names of the laws and loads in Python that have been registered.
written: Set[str] = set()


def names_in(value: Any) -> Set[str]:
    """The registered names that the tables of a scene use."""
    if isinstance(value, dict):
        here = {value.get(key) for key in ("law", "type") if isinstance(value.get(key), str)} & written
        return here.union(*map(names_in, value.values()))
    return set().union(*map(names_in, value)) if isinstance(value, list) else set()


def declared(name: str, function: Callable[..., float], first: str) -> List[Tuple[str, Optional[float]]]:
    """The parameters after the first one, with their defaults; raises TypeError if a scene cannot set them."""
    parameters = list(inspect.signature(function).parameters.values())
    if not parameters:
        raise TypeError(f"{name}: the function must take {first}, followed by its parameters")
    found = []
    for parameter in parameters[1:]:
        if parameter.kind not in (parameter.POSITIONAL_ONLY, parameter.POSITIONAL_OR_KEYWORD):
            raise TypeError(f"{name}: {parameter} is not a plain argument")
        default: Optional[float] = None if parameter.default is parameter.empty else float(parameter.default)
        found.append((parameter.name, default))
    return found


class Finding(NamedTuple):
    """The result of one check of ``conformance``."""

    name: str
    """``derivatives``"""
    demand: str
    """The requirement on every law or load."""
    passed: bool
    details: str
    """Figures, or the reason of the failure."""


def conformance(name: str, **keys: Any) -> List[Finding]:
    """Runs the suite of ``butee test-plugin`` on a law or load, which may be written in Python; ``keys`` are its keys in a scene.

    >>> @butee.law("cubic")
    ... def cubic(g, stiffness):
    ...     return stiffness * g**3 if g > 0 else 0.0
    >>> findings = butee.conformance("cubic", stiffness=1e12)
    >>> [finding.name for finding in findings if not finding.passed]
    []
    """
    return [Finding(*parts) for parts in _butee.conformance(name, dict(keys))]


__all__ = ["Finding", "conformance"]
