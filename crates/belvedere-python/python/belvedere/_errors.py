"""What goes wrong, and what is lost."""

from __future__ import annotations

from collections.abc import Iterable


class BelvedereError(ValueError):
    """An argument, a file or a cloud that Belvedere cannot use.

    Files that the operating system refuses raise `OSError`, one that is missing `FileNotFoundError`.

    Attributes
    ----------
    what : str
        What is wrong, such as the name of a parameter.
    value : str
        The value at fault.
    advice : str
        What to do about it.

    Examples
    --------
    >>> try:
    ...     scene.shadow(sun=(180, 95))
    ... except belvedere.BelvedereError as error:
    ...     print(error.what, error.value)
    sun 180,95
    """

    def __init__(self, message: str, what: str = "", value: str = "", advice: str = "") -> None:
        super().__init__(message)
        self.what = what
        self.value = value
        self.advice = advice

    def __reduce__(self) -> tuple[type[BelvedereError], tuple[str, str, str, str]]:
        return type(self), (str(self), self.what, self.value, self.advice)


class BelvedereWarning(UserWarning):
    """Something is lost or uncertain, such as points that were left out.

    Attributes
    ----------
    key : str
        The name of the remark, which stays the same from version to version; empty for what is no remark on an answer.
    numbers : dict
        Its numbers by name.

    Examples
    --------
    >>> import warnings
    >>> warnings.simplefilter("error", belvedere.BelvedereWarning)  # make them errors
    """

    def __init__(self, message: str, key: str = "", numbers: dict[str, float] | None = None) -> None:
        super().__init__(message)
        self.key = key
        self.numbers = {} if numbers is None else numbers


def wrong(what: str, value: object, advice: str) -> BelvedereError:
    """The error of an argument."""
    return BelvedereError(f"{what} is {value}: {advice}", what, str(value), advice)


def no_attribute(thing: object, name: str, names: Iterable[str]) -> AttributeError:
    """The error of an attribute that a collection of columns or rasters lacks."""
    known = list(names)
    advice = f"take one by name: [{name if name in known else next(iter(known), '')!r}]"
    return AttributeError(f"a {type(thing).__name__} has no attribute {name!r}; {advice}", name=name, obj=thing)


def missing(package: str, needed_for: str) -> BelvedereError:
    """The error of an optional package that is not installed."""
    advice = f"install it: pip install {package}"
    return BelvedereError(f"{needed_for} needs the package {package}; {advice}", package, "missing", advice)
