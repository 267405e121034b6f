"""The graphics processors of this computer."""

from typing import NamedTuple

from . import _core


class Device(NamedTuple):
    """A graphics processor of this computer.

    Examples
    --------
    >>> names = [device.name for device in belvedere.devices()]
    """

    number: int
    """The number to give to :meth:`belvedere.Scene.with_device`."""
    name: str
    """Its name."""
    kind: str
    """``graphics card``, ``integrated graphics`` or ``software``, which is never chosen by itself."""
    driver: str
    """Its driver, with the version."""
    interface: str
    """The interface that it is reached by: Vulkan, Metal or DirectX 12."""


def devices() -> list[Device]:
    """The graphics processors of this computer; none where the package was built without them.

    Examples
    --------
    >>> for device in belvedere.devices():
    ...     print(device.number, device.name)  # doctest: +SKIP
    """
    return [Device(number, *texts) for number, texts in enumerate(_core.devices())]
