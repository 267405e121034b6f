"""Parameters of Processing from what `belvedere describe --json` says of a command. Imports nothing of QGIS."""

from __future__ import annotations

import html
from dataclasses import dataclass, field, replace

from . import wording

# The commands that become algorithms: their group in the toolbox, and their title.
ALGORITHMS = {
    "viewshed": ("Visibility", "Viewshed"),
    "line-of-sight": ("Visibility", "Line of sight"),
    "isovist": ("Visibility", "Visible space"),
    "horizon": ("Visibility", "Horizon"),
    "towers": ("Visibility", "Visible metres of towers"),
    "landmark": ("Visibility", "Visibility of a landmark"),
    "protected-view": ("Visibility", "Protected view"),
    "window-views": ("Visibility", "Views from windows"),
    "cameras": ("Visibility", "Where to put cameras"),
    "survey-plan": ("Visibility", "Where to scan again"),
    "shadow": ("Sun and sky", "Shadow"),
    "sun-hours": ("Sun and sky", "Sun hours"),
    "sky-view": ("Sun and sky", "Sky view factor"),
    "irradiance": ("Sun and sky", "Solar irradiance"),
    "heat": ("Sun and sky", "Heat stress"),
    "glare": ("Sun and sky", "Glare of panels and glass"),
    "envelope": ("Sun and sky", "Solar envelope"),
    "comfort": ("Sun and sky", "Sun and sky along walks"),
    "sun-calendar": ("Sun and sky", "Sun calendar of windows and places"),
    "sun-position": ("Sun and sky", "Position of the sun"),
    "report": ("Sun and sky", "Sunlight report"),
    "difference": ("Before and after", "Difference of two results"),
    "fetch": ("Scene", "Points of an open survey"),
    "info": ("Scene", "What a point cloud contains"),
    "balls": ("Scene", "Ball file for many questions"),
    "calibrate": ("Scene", "How reliable answers are"),
    "surfaces": ("Scene", "Roofs and walls"),
    "normals": ("Scene", "Normals of points"),
    "trajectory": ("Scene", "Positions of the scanner"),
    "simulate": ("Scene", "Simulated town"),
    "cache": ("Scene", "Kept scenes"),
}
TITLES = {name: title for name, (_, title) in ALGORITHMS.items()}
# Headings of parameters that few people change.
RARE = ("Lines of sight", "Scene", "Balls", "Global options")
# Layers that must have a certain geometry; others take any.
GEOMETRIES = {
    ("line-of-sight", "--pairs"): "line",
    ("line-of-sight", "--among"): "point",
    ("towers", "--towers"): "point",
    ("landmark", "--observers"): "point",
    ("landmark", "--target-polygon"): "polygon",
    ("protected-view", "--observers"): "point",
    ("protected-view", "--target-polygon"): "polygon",
    ("comfort", "--route"): "line",
    ("envelope", "--parcel"): "polygon",
    ("report", "--area"): "polygon",
    # of all commands
    (None, "--areas"): "polygon",
}
# Commands whose tables become the same lines as their GeoJSON, which rounds degrees.
LINES_IN_TABLES = ("line-of-sight",)
# Commands that report more than they write.
REPORTED = ("fetch", "calibrate")
# Names of inputs whose texts begin with the kinds of files that they take.
NAMES = {
    "--pairs": "Lines from observers to targets",
    "--protect": "Lines, polygons or points to protect from shadow",
    "--targets": "Targets",
    "--candidates": "Candidates: places as points or lines",
}
UNITS = {"degree": "degrees", "minute": "minutes", "m2": "square metres"}
# A label longer than this makes the dialog too wide.
LONGEST_LABEL = 80
SEVERAL = " (separate several with ;)"


@dataclass(frozen=True)
class Output:
    """A result that the user can choose to keep: one destination of Processing."""

    key: str
    kind: str
    """raster, vector, table (a vector layer made from a table), file, folder or page (what the program reports)"""
    label: str
    formats: tuple[str, ...]
    is_usual: bool = False
    """written unless the user refuses it"""


@dataclass(frozen=True)
class Parameter:
    """A parameter of a command, as Processing shows it."""

    flag: str
    key: str
    kind: str
    """flag, choice, number, integer, text, crs, point, place (on earth), layer, raster, file, files or written"""
    label: str
    help: str
    default: object = None
    choices: tuple[tuple[str, str], ...] = ()
    geometry: str = "any"
    is_required: bool = False
    is_repeatable: bool = False
    is_advanced: bool = False
    outputs: tuple[Output, ...] = ()

    @property
    def heading(self):
        """What stands over its help."""
        return ", ".join(output.label for output in self.outputs) or self.label


@dataclass(frozen=True)
class Command:
    """A command of the program as an algorithm."""

    name: str
    title: str
    group: str
    summary: str
    description: str
    labels: dict[str, str] = field(default_factory=dict)
    """what parameters of this and other dialogs are called in sentences, by their flags"""
    parameters: tuple[Parameter, ...] = ()

    def reworded(self, text):
        """What the program says of a run, with the labels of the dialog."""
        return wording.error_text(text, self.labels, TITLES)

    def sentences(self, summary):
        """What a summary says in sentences, but for those on the command line."""
        said = (wording.help_text(one, self.labels, TITLES) for one in summary.get("headline", []))
        return [one for one in said if one]

    @property
    def outputs(self):
        return [output for parameter in self.parameters for output in parameter.outputs]


def commands(described):
    """The commands that become algorithms, in the order of the groups."""
    by_name = {command["name"]: command for command in described["commands"]}
    threads = [one for one in described["global_parameters"] if one["name"] == "--threads"]
    found = [by_name[name] for name in ALGORITHMS if name in by_name]
    # texts name fields of other dialogs, too
    shared = {}
    for command in found:
        shared = _labels(command["parameters"]) | shared
    return [_command(command, threads, shared) for command in found]


def as_html(description):
    """The description of a command as HTML: its indented parts with their headings, and lists line by line."""
    parts = []
    for part in description.split("\n\n"):
        lines = part.splitlines()
        has_heading = len(lines) > 1 and not lines[0].startswith(" ") and all(line.startswith("  ") for line in lines[1:])
        body = [html.escape(line.strip()) for line in (lines[1:] if has_heading else lines)]
        is_list = any("  " in line for line in body)
        text = ("<br>" if is_list else " ").join(body)
        parts.append(f"<p><b>{html.escape(lines[0])}</b><br>{text}</p>" if has_heading else f"<p>{text}</p>")
    return "".join(parts)


def _labels(described):
    """What parameters are called in sentences, by their flags."""
    return {one["name"]: wording.short(_label(one, _kind(one))) for one in described} | {"--output": "Result"}


def _command(described, further, shared):
    name = described["name"]
    all_described = described["parameters"] + further
    labels = shared | _labels(all_described)

    def plain(text):
        return wording.help_text(text, labels, TITLES)

    parameters = [made for one in all_described for made in _parameters(name, one, plain)]
    if name in REPORTED or not any(one.outputs for one in parameters):
        page = Output("PAGE", "page", f"{TITLES[name]}: page", (".html",), is_usual=True)
        parameters.append(Parameter("", "PAGE", "written", page.label, "What the program reports, as a page.", outputs=(page,)))
    parameters.sort(key=lambda one: 3 if one.kind == "written" else 1 if one.kind == "crs" else 2 if one.flag.startswith("-") else 0)
    group, title = ALGORITHMS[name]
    return Command(
        name=name,
        title=title,
        group=group,
        summary=plain(described["summary"]),
        description=plain(described["description"]),
        labels=labels,
        parameters=tuple(parameters),
    )


def _parameters(command, described, plain):
    """A parameter, or two where a flag takes a layer and what no layer holds."""
    made = _parameter(command, described, plain)
    if described["value_name"] != "AREA":
        return [made]
    layer = replace(made, kind="layer", geometry="polygon", label=wording.label_text(described["text"], LONGEST_LABEL, TITLES, is_typed=False))
    return [layer, replace(made, key=made.key + "_TEXT", label="Clear a class of points (class:N) or a box (X0,Y0,X1,Y1)" + SEVERAL, is_advanced=True)]


def _parameter(command, described, plain):
    flag = described["name"]
    kind = _kind(described)
    default, said = _default(described, kind), described["default"]
    without = f"\n\nIf empty: {plain(said)}." if said and default is None and kind != "written" else ""
    is_usual = flag in ("clouds", "--crs")
    return Parameter(
        flag=flag,
        key=flag.lstrip("-").replace("-", "_").upper(),
        kind=kind,
        label=_label(described, kind),
        help=plain(described["details"] or described["text"]) + without,
        default=default,
        choices=tuple((choice["name"], plain(choice["text"])) for choice in described["choices"]),
        geometry=GEOMETRIES.get((command, flag)) or GEOMETRIES.get((None, flag), "any"),
        is_required=described["required"] and kind != "written",
        is_repeatable=described["repeatable"],
        is_advanced=not is_usual and (described["builds_balls"] or described["heading"] in RARE),
        outputs=_outputs(command, described) if kind == "written" else (),
    )


def _kind(described):
    named = described["value_name"] or ""
    if described["written"]:
        return "written"
    if described["name"] == "clouds":
        return "files"
    if named in ("CRS", "LAT,LON"):
        return {"CRS": "crs", "LAT,LON": "place"}[named]
    if named.startswith("X,Y"):
        return "point"
    if ".geojson" in described["formats"]:
        return "layer"
    if ".tif" in described["formats"]:
        return "raster"
    if described["type"] == "path":
        return "files" if described["repeatable"] else "file"
    # several numbers are typed, as on the command line
    is_several = described["repeatable"] and described["type"] in ("number", "integer")
    return "text" if is_several or described["type"] == "numbers" else described["type"]


def _label(described, kind):
    flag, text = described["name"], described["text"]
    if flag == "clouds":
        return "Point clouds, or a ball file"
    label = NAMES.get(flag) if kind in ("layer", "file") else None
    is_typed = kind not in ("choice", "layer", "raster", "file", "files")
    label = label or wording.label_text(text, LONGEST_LABEL, TITLES, is_typed) or _name(flag)
    unit = UNITS.get(described["unit"], described["unit"])
    says_unit = any(word in label for word in ("metre", "degree", "minute", "second", "hPa", "GHz", "percent", " kW"))
    if kind in ("number", "integer") and unit and not says_unit:
        label += {"m": " in metres", "s": " in seconds"}.get(unit, f" in {unit}")
    return label + SEVERAL if described["repeatable"] and kind == "text" and "," not in described["value_name"] else label


def _name(flag):
    return flag.lstrip("-").replace("-", " ").capitalize()


def _default(described, kind):
    text = described["default"]
    if kind == "flag":
        return False
    if text is None or kind == "written":
        return None
    if kind in ("number", "integer"):
        try:
            return int(text) if kind == "integer" else float(text)
        except ValueError:
            # a sentence: what happens without a value
            return None
    if kind == "choice":
        names = [choice["name"] for choice in described["choices"]]
        return names.index(text) if text in names else None
    # texts say what happens without a value
    return None


def _outputs(command, described):
    key = described["name"].lstrip("-").replace("-", "_").upper()
    is_main = described["name"] == "--output"
    if described["type"] == "folder":
        return (Output(key, "folder", wording.folder_text(described["text"]), (), is_main),)
    said = wording.result_texts(described["text"])
    # QGIS writes packages itself
    left = [one for one in dict.fromkeys(described["formats"]) if one != ".gpkg"]
    if is_main and command in LINES_IN_TABLES:
        left.remove(".geojson")
    found = []

    def take(kind, suffix, *extensions):
        formats = tuple(one for one in extensions if one in left)
        if formats and (described["repeatable"] or not found):
            phrases = dict.fromkeys(said.get(one, _name(key.lower())) for one in formats)
            first, *others = phrases
            label = " or ".join([first, *map(wording.lowered, others)])
            label += f" ({' '.join(formats)})" if kind == "file" else " as a table" * any(one.label == label for one in found)
            found.append(Output(key + suffix * bool(found), kind, label, formats, is_main and not found))
            left[:] = [one for one in left if one not in formats]

    take("raster", "_RASTER", ".tif")
    take("vector", "_AREAS", ".geojson")
    # a cloud whose points get a column stays a cloud
    if is_main and (found or ".laz" not in left):
        take("table", "_LAYER", ".csv")
    take("file", "_FILE", *left)
    # "raster" alone says too little: a layer is named by its label
    before = TITLES[command] if is_main else _name(described["name"]) if len(found) > 1 else None
    return tuple(replace(one, label=f"{before}: {wording.lowered(one.label)}") if before else one for one in found)
