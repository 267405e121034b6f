"""Styles of results as QML, in colours that the colour-blind can separate. Imports nothing of QGIS."""

from __future__ import annotations

from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

# Van der Walt & Smith 2015 (matplotlib): even in lightness
VIRIDIS = ("#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725")
INFERNO = ("#000004", "#210c4a", "#57106e", "#8a226a", "#bc3754", "#e45a31", "#f98e09", "#f9cb35", "#fcffa4")
# from shadow to sun
DAY = ("#23325a", "#6f7f9c", "#b9b7a0", "#fde796")
# ColorBrewer PuOr: losses against gains
CHANGE = ("#542788", "#998ec3", "#d8daeb", "#f7f7f7", "#fee0b6", "#f1a340", "#b35806")
# as the maps of the program
VISIBLE, UNPROVEN, BLOCKED, OUTSIDE = "#ffb000", "#5a96f0", "#b0b0b4", "#e4e4e6"
EDGE = "#d55e00"


@dataclass(frozen=True)
class Ramp:
    """Colours between two values; None is the least or the greatest of the raster."""

    colors: tuple[str, ...]
    low: float | None = 0.0
    high: float | None = None
    is_even: bool = False
    """reaches as far below zero as above it"""


# codes of answers, in the words of the program
SIGHTS = (
    (0, "#6e6e73", "blocked"),
    (1, VISIBLE, "visible"),
    (2, UNPROVEN, "unproven"),
    (3, OUTSIDE, "no line"),
    (4, OUTSIDE, "outside the cloud"),
    (5, "#8c5a3c", "inside an obstacle"),
)
# results of answers: bytes
SEEN = (("viewshed", "OUTPUT"), ("viewshed", "FAR_OUTPUT"))
ANSWERS = ((0, BLOCKED, "blocked"), *SIGHTS[1:])
# of a raster that does not say what is unproven
UNBLOCKED = (ANSWERS[0], (1, VISIBLE, "nothing blocks it"))
AREAS = (("visible", VISIBLE, "visible"), ("unproven", UNPROVEN, "unproven"))
EDGES = ((0, "#ffffff00", "reliable"), (1, EDGE, "near the edge of the cloud"))
# Shadows by what casts them; without casters all are "else".
CASTERS = (
    ("building", "#23325ab4", "of buildings"),
    ("trees", "#3c7850b4", "of trees"),
    ("plan", "#d55e00b4", "of the plan"),
    ("ground", "#8c5a3cb4", "of the ground"),
    ("", "#46465ab4", "shadow"),
)
# Ramps of rasters by command and output.
RAMPS = {
    ("viewshed", "OUTPUT"): Ramp(VIRIDIS),
    ("viewshed", "FAR_OUTPUT"): Ramp(VIRIDIS),
    ("viewshed", "HEIGHTS"): Ramp(VIRIDIS),
    ("towers", "OUTPUT"): Ramp(VIRIDIS),
    ("towers", "FAR_OUTPUT"): Ramp(VIRIDIS),
    ("landmark", "OUTPUT"): Ramp(VIRIDIS),
    ("cameras", "OUTPUT"): Ramp(VIRIDIS),
    ("shadow", "OUTPUT"): Ramp(DAY, 0.0, 1.0),
    ("sun-hours", "OUTPUT"): Ramp(INFERNO),
    ("sky-view", "OUTPUT"): Ramp(VIRIDIS, 0.0, 1.0),
    ("irradiance", "OUTPUT"): Ramp(INFERNO),
    ("heat", "OUTPUT"): Ramp(INFERNO, None),
    ("protected-view", "OUTPUT"): Ramp(VIRIDIS),
    ("protected-view", "TOPS"): Ramp(VIRIDIS, None),
    ("envelope", "OUTPUT"): Ramp(VIRIDIS),
    ("envelope", "TOPS"): Ramp(VIRIDIS, None),
    ("difference", "OUTPUT"): Ramp(CHANGE, None, is_even=True),
}
# Fields that vector layers are coloured by: with classes, or between the least and the greatest value.
FIELDS = {
    ("line-of-sight", "OUTPUT"): ("answer", SIGHTS),
    ("viewshed", "OUTPUT_AREAS"): ("answer", AREAS),
    ("landmark", "OUTPUT_LAYER"): ("visible_share", VIRIDIS),
    ("cameras", "OUTPUT_AREAS"): ("covered_targets", VIRIDIS),
    ("cameras", "OUTPUT_LAYER"): ("cameras", VIRIDIS),
    ("shadow", "OUTPUT_LAYER"): ("lit", DAY),
    ("sun-hours", "OUTPUT_LAYER"): ("sun_hours", INFERNO),
    ("sky-view", "OUTPUT_LAYER"): ("sky_view_factor", VIRIDIS),
    ("irradiance", "OUTPUT_LAYER"): ("kwh_m2", INFERNO),
    ("heat", "OUTPUT_LAYER"): ("utci_max", INFERNO),
    ("comfort", "OUTPUT"): ("sun_hours", INFERNO),
    ("isovist", "OUTPUT"): ("openness", VIRIDIS),
    ("window-views", "OUTPUT"): ("sky", VIRIDIS),
    ("window-views", "OUTPUT_LAYER"): ("sky", VIRIDIS),
    ("irradiance", "PLANES"): ("kwh_m2", INFERNO),
    ("shadow", "OUTLINES"): ("caster", CASTERS),
}
# Views of points: the field of their direction, and the angle in degrees. Cameras that turn have no heading.
SECTORS = {"heading": ("heading", 'if("heading" is null, 360, "fov")'), "azimuth": ("azimuth", "90")}
HEAD = "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"


def raster(command, key, low, high, is_bytes, band=1, opacity=None, span=None):
    """The style of a band of a raster with values from `low` to `high`; None where it has no style of its own.

    `is_bytes` tells answers from numbers. `opacity` is the band with the opacity of each cell, 0 to 255. `span` has the times from which and up to which the
    band holds.
    """
    if key == "EDGE_MASK":
        return _raster(_paletted(EDGES, band), span)
    if (command, key) in SEEN and is_bytes:
        return _raster(_paletted([one for one in ANSWERS if one[0] <= high] if high > 1 else UNBLOCKED, band), span)
    ramp = RAMPS.get((command, key))
    if ramp is None:
        return None
    low = low if ramp.low is None else ramp.low
    high = high if ramp.high is None else ramp.high
    if ramp.is_even:
        high = max(abs(low), abs(high))
        low = -high
    return _raster(_ramped(ramp.colors, low, high if high > low else low + 1.0, band, opacity or -1), span)


def vector(command, key, geometry, low=0.0, high=1.0, fields=(), step_min=None):
    """The style of a vector layer of "point", "line" or "polygon"; None where it has none. Ramps go from `low` to `high`.

    `fields` are those of the layer: points with a direction get a sector of view. `step_min` are the minutes for which each feature holds from its time on.
    """
    field, colors = FIELDS.get((command, key), (None, None))
    if field is None:
        return None
    sector = next((found for name, found in SECTORS.items() if name in fields), None) if geometry == "point" else None
    if isinstance(colors[0], tuple):
        renderer = _categories(field, colors, geometry, sector)
    else:
        renderer = _graduated(field, colors, geometry, low, high if high > low else low + 1.0, sector)
    times = "" if step_min is None else f'<temporal enabled="1" mode="1" startField="time" durationUnit="min" fixedDuration="{step_min!r}"/>'
    return f'{HEAD}<qgis styleCategories="Symbology|Temporal" version="3.22.0">{times}{renderer}</qgis>\n'


def field_of(command, key):
    """The field that a ramp of a vector layer shows, or None."""
    field, colors = FIELDS.get((command, key), (None, None))
    return None if field is None or isinstance(colors[0], tuple) else field


def _paletted(classes, band):
    entries = "".join(
        f'<paletteEntry value="{value}" color="{color[:7]}" alpha="{_alpha(color)}" label={quoteattr(label)}/>' for value, color, label in classes
    )
    return f'<rasterrenderer type="paletted" band="{band}" opacity="1" alphaBand="-1" nodataColor=""><colorPalette>{entries}</colorPalette></rasterrenderer>'


def _ramped(colors, low, high, band, opacity):
    steps = [low + (high - low) * number / (len(colors) - 1) for number in range(len(colors))]
    items = "".join(f'<item value="{value!r}" color="{color}" alpha="255" label="{value:.4g}"/>' for value, color in zip(steps, colors))
    stops = ":".join(f"{number / (len(colors) - 1):.4f};{_rgba(color)}" for number, color in enumerate(colors[1:-1], 1))
    properties = {
        "color1": _rgba(colors[0]),
        "color2": _rgba(colors[-1]),
        "discrete": "0",
        "rampType": "gradient",
        "stops": stops,
    }
    ramp = "".join(f'<prop k="{name}" v="{value}"/>' for name, value in properties.items())
    return (
        f'<rasterrenderer type="singlebandpseudocolor" band="{band}" opacity="1" alphaBand="{opacity}" '
        f'classificationMin="{low!r}" classificationMax="{high!r}">'
        f'<rastershader><colorrampshader colorRampType="INTERPOLATED" classificationMode="1" clip="0" minimumValue="{low!r}" maximumValue="{high!r}">'
        f'<colorramp type="gradient" name="[source]">{ramp}</colorramp>{items}</colorrampshader></rastershader></rasterrenderer>'
    )


def _raster(renderer, span):
    times = ""
    if span is not None:
        start, end = (time.isoformat() for time in span)
        times = f'<temporal enabled="1" mode="0" fetchMode="0"><fixedRange><start>{start}</start><end>{end}</end></fixedRange></temporal>'
    return f'{HEAD}<qgis styleCategories="AllStyleCategories" version="3.22.0">{times}<pipe>{renderer}</pipe></qgis>\n'


def _categories(field, classes, geometry, sector):
    categories = "".join(
        f'<category value={quoteattr(str(value))} symbol="{number}" label={quoteattr(label)} render="true"/>'
        for number, (value, _, label) in enumerate(classes)
    )
    symbols = "".join(_symbol(number, color, geometry, sector) for number, (_, color, _) in enumerate(classes))
    return f'<renderer-v2 type="categorizedSymbol" attr="{field}"><categories>{categories}</categories><symbols>{symbols}</symbols></renderer-v2>'


def _graduated(field, colors, geometry, low, high, sector):
    width = (high - low) / len(colors)
    ranges, symbols = [], []
    for number, color in enumerate(colors):
        lower, upper = low + number * width, low + (number + 1) * width
        ranges.append(f'<range lower="{lower!r}" upper="{upper!r}" symbol="{number}" label="{lower:.4g} to {upper:.4g}" render="true"/>')
        symbols.append(_symbol(number, color, geometry, sector))
    return (
        f'<renderer-v2 type="graduatedSymbol" attr="{field}" graduatedMethod="GraduatedColor"><ranges>{"".join(ranges)}</ranges>'
        f"<symbols>{''.join(symbols)}</symbols></renderer-v2>"
    )


def _symbol(name, color, geometry, sector):
    layers = {
        "point": (
            "marker",
            "SimpleMarker",
            {"color": _rgba(color), "outline_color": "60,60,60,255", "outline_width": "0.1", "size": "2"},
        ),
        "line": ("line", "SimpleLine", {"line_color": _rgba(color), "line_width": "0.8"}),
        "polygon": (
            "fill",
            "SimpleFill",
            {"color": _rgba(color), "outline_color": "60,60,60,160", "outline_width": "0.1"},
        ),
    }
    kind, layer, properties = layers[geometry]
    # lines lie on rasters of the same colours: an edge sets them off
    edges = [{"line_color": "30,30,30,255", "line_width": "1.3"}] if geometry == "line" else []
    drawn = "".join(_symbol_layer(layer, one) for one in [*edges, properties])
    if sector is not None:
        drawn = _sector(name, color, *sector) + drawn
    return f'<symbol type="{kind}" name="{name}" alpha="1" clip_to_extent="1">{drawn}</symbol>'


def _sector(name, color, direction, angle):
    """What a point sees, 8 mm wide on the map at any scale; with a white edge, as rasters have the same colours."""
    wedge = f'wedge_buffer($geometry, coalesce("{direction}", 0), {angle}, 0.008 * coalesce(@map_scale, 2000))'
    fill = _symbol_layer("SimpleFill", {"color": _rgba(color[:7] + "b4"), "outline_color": "255,255,255,255", "outline_width": "0.4"})
    listed = f'<prop k="SymbolType" v="Fill"/><prop k="geometryModifier" v={quoteattr(wedge)}/>'
    symbol = f'<symbol type="fill" name="@{name}@0" alpha="1" clip_to_extent="1">{fill}</symbol>'
    return f'<layer class="GeometryGenerator" enabled="1" pass="0" locked="0">{listed}{symbol}</layer>'


def _symbol_layer(name, properties):
    listed = "".join(f'<prop k="{key}" v="{value}"/>' for key, value in properties.items())
    return f'<layer class="{name}" enabled="1" pass="0" locked="0">{listed}</layer>'


def _alpha(color):
    return int(color[7:9], 16) if len(color) == 9 else 255


def _rgba(color):
    return ",".join(str(int(color[at : at + 2], 16)) for at in (1, 3, 5)) + f",{_alpha(color)}"
