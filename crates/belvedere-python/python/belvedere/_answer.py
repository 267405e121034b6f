"""What is known of a line of sight."""

from __future__ import annotations

from enum import IntEnum


class Answer(IntEnum):
    """Whether a target can be seen; arrays of answers hold these numbers as `uint8`.

    Attributes
    ----------
    BLOCKED
        0: something lies before the target.
    VISIBLE
        1: nothing lies before it.
    UNPROVEN
        2: nothing lies before it, but the line crosses space that no laser pulse came near.
    OUTSIDE_VIEW
        3: the target is the eye itself, or nobody looks at it.
    OUTSIDE_CLOUD
        4: the target or the eye lies beside or below the cloud, where nothing is known.
    INSIDE_OBSTACLE
        5: the target or the eye lies inside an obstacle: nothing is seen from there, and nothing there is seen.

    Examples
    --------
    >>> seen = scene.visible(eye, targets)
    >>> int((seen == belvedere.Answer.VISIBLE).sum()) <= len(targets)
    True
    """

    BLOCKED = 0
    VISIBLE = 1
    UNPROVEN = 2
    OUTSIDE_VIEW = 3
    OUTSIDE_CLOUD = 4
    INSIDE_OBSTACLE = 5
