"""Makes places.csv and ../../src/crs/areas.txt from the database of PROJ (pip install pyproj).

places.csv has one place for each reference system: its longitude and latitude (WGS 84, degrees), what PROJ makes of
them (x and y, in the unit of the system), and whether PROJ knows the step between the datums. The place is the middle
of the area of use, or near it. areas.txt has the areas of use: west, south, east, north in degrees, then the codes.
"""

import math
import warnings
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from pyproj import CRS
from pyproj.aoi import AreaOfInterest
from pyproj.database import query_crs_info
from pyproj.enums import PJType
from pyproj.exceptions import ProjError
from pyproj.transformer import TransformerGroup

FOLDER = Path(__file__).parent
KINDS = [PJType.PROJECTED_CRS, PJType.GEOGRAPHIC_2D_CRS]
# shares of the width and the height of an area, in the order in which they are tried
PLACES = [(0.5, 0.5), (0.4, 0.6), (0.6, 0.4), (0.3, 0.3), (0.7, 0.7)]


def codes() -> list[int]:
    known = query_crs_info(auth_name="EPSG", pj_types=KINDS, allow_deprecated=True)
    return sorted(int(info.code) for info in known if info.code.isdigit())


def projected(system: CRS, place: tuple[float, float], area: AreaOfInterest) -> tuple[float, float, bool]:
    """What the best operation that needs no grid makes of a place, and whether it is more than a guess."""
    group = TransformerGroup("EPSG:4326", system, always_xy=True, area_of_interest=area)
    best = group.transformers[0]
    x, y = best.transform(*place)
    return x, y, "ballpark" not in best.description.lower()


def row(code: int) -> tuple[int, tuple[float, ...], str] | None:
    warnings.filterwarnings("ignore")
    try:
        system = CRS.from_epsg(code)
    except ProjError:
        return None
    bounds = system.area_of_use.bounds
    west, south, east, north = bounds
    width = east - west if east > west else east - west + 360
    for across, up in PLACES:
        longitude = (west + width * across + 180) % 360 - 180
        place = round(longitude, 3), round(south + (north - south) * up, 3)
        try:
            x, y, is_known = projected(system, place, AreaOfInterest(*place, *place))
            if not is_known:
                # areas of operations have gaps, where one of the whole area may still hold
                wide = projected(system, place, AreaOfInterest(*bounds))
                x, y, is_known = wide if wide[2] else (x, y, is_known)
        except (ProjError, IndexError):
            continue  # the place has no coordinates, or there is no operation at all
        if math.isfinite(x) and math.isfinite(y):
            digits = 6 if system.is_geographic else 1
            line = f"{code},{place[0]},{place[1]},{x:.{digits}f},{y:.{digits}f},{'known' if is_known else 'guess'}"
            return code, bounds if system.is_projected else (), line
    return None


def main() -> None:
    with ProcessPoolExecutor() as pool:
        rows = [found for found in pool.map(row, codes(), chunksize=50) if found]
    lines = ["code,longitude,latitude,x,y,step"] + [line for _, _, line in rows]
    (FOLDER / "places.csv").write_text("\n".join(lines) + "\n")
    areas = defaultdict(list)
    for code, bounds, _ in rows:
        if bounds:
            areas[bounds].append(code)
    text = [" ".join(map(str, [*bounds, *members])) for bounds, members in sorted(areas.items())]
    (FOLDER.parent.parent / "src/crs/areas.txt").write_text("\n".join(text) + "\n")


if __name__ == "__main__":
    main()
