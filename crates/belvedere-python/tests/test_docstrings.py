"""Every public name has a docstring with an example, and all examples run."""

from __future__ import annotations

import doctest
import importlib
import inspect
import pkgutil

import belvedere
import pytest

OPTIONS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
MODULES = [
    belvedere,
    *(
        importlib.import_module(f"belvedere.{module.name}")
        for module in pkgutil.iter_modules(belvedere.__path__)
        if module.name != "_core"
    ),
]
EXAMPLES = [test for module in MODULES for test in doctest.DocTestFinder().find(module) if test.examples]
#: Members whose one line says all.
PLAIN = {"crs", "dtype", "ndim", "shape", "size", "x", "y"}


# so small a tile is near its edge almost everywhere
@pytest.mark.filterwarnings("ignore::belvedere.BelvedereWarning")
@pytest.mark.parametrize("test", EXAMPLES, ids=lambda test: test.name)
def test_example_runs(test, cloud, scene, targets, eye, standing, tile, folder):
    test.globs |= {
        "belvedere": belvedere,
        "np": importlib.import_module("numpy"),
        "cloud": cloud,
        "scene": scene,
        "targets": targets,
        "eye": eye,
        "standing": standing,
        "tile": tile,
        "folder": folder,
    }
    said: list[str] = []
    failed = doctest.DocTestRunner(optionflags=OPTIONS).run(test, out=said.append).failed
    assert not failed, "".join(said)


def public_members():
    for name in belvedere.__all__:
        if name == "__version__":
            continue
        thing = getattr(belvedere, name)
        yield name, thing
        if inspect.isclass(thing):
            for member, value in inspect.getmembers(thing):
                is_ours = callable(value) or isinstance(value, property)
                module = getattr(getattr(value, "fget", value), "__module__", None) or ""
                if not member.startswith("_") and is_ours and module.startswith("belvedere"):
                    yield f"{name}.{member}", value


@pytest.mark.parametrize(
    ("name", "thing"), list(public_members()), ids=lambda value: value if isinstance(value, str) else ""
)
def test_public_name_is_documented_with_an_example(name, thing):
    text = inspect.getdoc(thing) or ""
    assert text, f"{name} has no docstring"
    assert ">>>" in text or name.split(".")[-1] in PLAIN, f"{name} has no example"
