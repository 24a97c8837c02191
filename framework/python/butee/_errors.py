"""Errors and warnings."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple, Optional, Sequence, Tuple

if TYPE_CHECKING:
    from ._result import Result

_PLACE = re.compile(r"(?P<file>.+?):(?P<line>\d+): (?P<message>.*)", re.DOTALL)


class Error(Exception):
    """Base class of the errors of butee."""


class Mistake(NamedTuple):
    """One mistake of a scene."""

    file: str
    """The file, or ``--set KEY=VALUE`` for a value set by its key."""
    line: int
    """Line number from 1; 0 for the whole ``file``."""
    key: str
    """``contact[0].gap``; "" if the text could not be parsed up to a key."""
    message: str
    """The value, the reason why it is wrong, and the allowed values."""


class InputError(Error, ValueError):
    """Bad input. ``mistakes`` lists all mistakes of a scene, not only the first.

    >>> try:
    ...     butee.Scene({"schema": 1, "title": 5})
    ... except butee.InputError as error:
    ...     [mistake.key for mistake in error.mistakes]
    ['title', 'element', 'integrator']
    """

    mistakes: Tuple[Mistake, ...]

    def __init__(self, text: str, mistakes: Sequence[Tuple[str, int, str, str]] = ()):
        super().__init__(text)
        self.mistakes = tuple(Mistake(*parts) for parts in mistakes) or (_mistake_of(text),)

    def __reduce__(self):
        return type(self), (str(self), self.mistakes)


def _mistake_of(text: str) -> Mistake:
    place = _PLACE.match(text)
    if place:
        return Mistake(place["file"], int(place["line"]), "", place["message"])
    return Mistake("", 0, "", text)


class RunError(Error, RuntimeError):
    """A run that failed: a step that did not converge, a file that could not be written.

    ``result`` contains the results up to the failure, or is None.
    """

    def __init__(self, text: str, result: Optional["Result"] = None):
        super().__init__(text)
        self.result = result

    def __reduce__(self):
        return type(self), (str(self), self.result)


class SceneWarning(UserWarning):
    """A warning as given by the program: a likely mistake in a scene, or a limitation of a result."""
