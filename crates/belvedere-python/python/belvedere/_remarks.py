"""What a user must know beside an answer."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterable
from typing import Any, NamedTuple

from ._errors import BelvedereWarning


class Remark(NamedTuple):
    """A warning or note on an answer, the same in Python, on the command line and on the page.

    Attributes
    ----------
    key : str
        Its name, which stays the same from version to version.
    severity : {'warning', 'note'}
        Whether results mislead a user who does not know it.
    text : str
        A sentence.
    numbers : dict
        Its numbers by name.

    Examples
    --------
    >>> [remark.key for remark in scene.shadow(sun=(180, 30)).remarks]
    [...]
    """

    key: str
    severity: str
    text: str
    numbers: dict[str, float]


#: The folder of this package.
_HERE = os.path.dirname(__file__)


def warned(given: Iterable[dict[str, Any]]) -> tuple[Remark, ...]:
    """The remarks of an answer; raises a `BelvedereWarning` for each that is a warning, at the line of the user."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == _HERE:
        level, frame = level + 1, frame.f_back
    remarks = tuple(Remark(one["key"], one["severity"], one["text"], one["numbers"]) for one in given)
    for remark in remarks:
        if remark.severity == "warning":
            warning = BelvedereWarning(remark.text, key=remark.key, numbers=remark.numbers)
            warnings.warn(warning, stacklevel=level)
    return remarks
