"""What works with nothing but the wheel and numpy: the README's lines, and the program."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from pathlib import Path


def main() -> None:
    import belvedere
    import numpy as np

    # processor time, and the least of several: other programs may run
    timed = "import numpy, time; t = time.process_time(); import belvedere; print(time.process_time() - t)"
    runs = [subprocess.run([sys.executable, "-c", timed], capture_output=True, check=True) for _ in range(5)]
    seconds = min(float(run.stdout) for run in runs)
    assert seconds < 0.1, f"importing took {seconds:.3f} s beyond numpy"

    package = Path(__file__).parents[1]
    blocks = [
        re.findall(r"```python\n(.*?)```", readme.read_text(encoding="utf-8"), re.DOTALL)
        for readme in (package / "README.md", package.parents[1] / "README.md")
    ]
    assert blocks[0] == blocks[1] and len(blocks[0]) == 1, "both READMEs have the same lines"
    (lines,) = blocks[0]
    program = Path(sys.executable).parent / "belvedere"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        belvedere.simulate(extent=60, density=2).save(folder / "tile.laz")
        subprocess.run([sys.executable, "-c", lines], cwd=folder, check=True)
        assert (folder / "shadow.tif").stat().st_size > 1000
        result = subprocess.run([program, "info", "tile.laz"], cwd=folder, check=True, capture_output=True, text=True)
        assert re.search(r"\d points", result.stdout), result.stdout
    for package in ("pandas", "xarray", "geopandas", "tqdm", "laspy"):
        assert package not in sys.modules
    # an optional package that is missing is named
    lit = belvedere.Raster(np.zeros((2, 2), np.float32), (1, 0, 0, 0, -1, 0), belvedere._core.Crs("EPSG:28992"))
    try:
        lit.to_xarray()
    except belvedere.BelvedereError as error:
        assert error.advice == "install it: pip install xarray", error.advice
    else:
        raise AssertionError("xarray is not installed here")
    print(f"imported in {1000 * seconds:.0f} ms beyond numpy; the README's lines and the program run")


if __name__ == "__main__":
    main()
