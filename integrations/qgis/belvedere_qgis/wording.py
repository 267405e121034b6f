"""Texts of the program in the words of a dialog: labels instead of flags, titles instead of commands. Imports nothing of QGIS."""

from __future__ import annotations

import re

# A flag, with the placeholder of its value. Of short flags texts name two; others are minus signs, as in x, -z, y.
FLAG = re.compile(r"(?<![\w-])(--[a-z][a-z0-9-]*|-[ov]\b)(?:[ =](?:<[^<>]+>|[A-Z](?:[A-Z,]*[A-Z])?(?![\w:=])))?")
# `belvedere balls --help`, `balls`, belvedere sun-position: a command, with whatever stands behind it.
COMMAND = re.compile(r"`(belvedere )?([a-z-]+)[^`]*`|(belvedere) ([a-z]+-[a-z]+)\b")
# A remark in parentheses that speaks of what the dialog has not.
ASIDE = re.compile(r" \([^()]*\0[^()]*\)")
EXTENSIONS = re.compile(r" \((?:\.[\w.]+[ ,]*)+\)")
# What only a command line has.
PLACES = re.compile(
    r":? ?(?:X,Y\[,Z\])?,? in file coordinates(?:,? or (?:as )?(?:LAT,LON|LATITUDE,LONGITUDE in degrees))?"
    r"| as LATITUDE,LONGITUDE| in degrees, north and east positive|, as EPSG:CODE or WKT"
)
USAGE = re.compile(r"\n*(Usage: |For more information, try).*?(?=\n\n|\Z)", re.DOTALL)
MISSING = re.compile(r"the following required arguments were not provided:\n((?:  .+\n?)+)")
TYPED = re.compile(r""",? or (?:as )?"X,Y[^"]*\"""")
UNKNOWN = "\0"
RESULT = "the result"


def named(text, labels, titles):
    """A text with labels instead of flags, and titles instead of commands; what the dialog has not becomes UNKNOWN."""

    def flag(found):
        return RESULT if found[1] == "-o" else f'"{labels[found[1]]}"' if found[1] in labels else UNKNOWN

    return FLAG.sub(flag, titled(text, titles))


def titled(text, titles):
    """A text with titles instead of commands."""

    def title(found):
        name = found[2] or found[4]
        return f'"{titles[name]}"' if name in titles else UNKNOWN if found[1] or found[3] else found[0]

    return COMMAND.sub(title, text)


def help_text(text, labels, titles):
    """A text of help: without the sentences and asides that speak of what the dialog has not."""
    text = re.sub(r"\bflag(s?)\b", r"parameter\1", text).replace(" on the command line", " in the dialog")
    text = re.sub(r" ?\[default: [^]]*\]", "", re.sub(r"-o [A-Z]+(\.\w+)", rf"{RESULT} (\1)", text))
    text = PLACES.sub("", TYPED.sub("", text))
    text = ASIDE.sub("", named(text, labels, titles).replace("; repeatable", ""))
    text = "\n\n".join(part for part in map(_known_sentences, text.split("\n\n")) if part)
    return re.sub(r"(?:\A|(?<=\n)|(?<=[.!?] )|(?<=\n  ))" + RESULT, RESULT.capitalize(), text)


def error_text(text, labels, titles):
    """An error of the program: without its usage, and with the labels of what is missing or wrong."""
    text = MISSING.sub(_missing, USAGE.sub("", text)).strip()
    text = text.replace("the argument '", "'")
    # flags that the dialog has not stay as they are: they say what went wrong
    text = FLAG.sub(lambda found: named(found[0], labels, titles) if found[1] in labels or found[1] == "-o" else found[0], text)
    return re.sub(r"""'("[^"]*")'""", r"\1", titled(text, titles).replace(UNKNOWN, "the program"))


def label_text(text, limit, titles, is_typed):
    """The start of a text that fits a label: up to the last boundary before `limit` characters. What a user types keeps its example."""
    text = titled(re.sub(r" ?\[default:.*", "", text), titles)
    text = re.sub(r"^With [^:]*: ", "", PLACES.sub("", EXTENSIONS.sub("", text)).replace("Latitude and longitude", "Place"))
    text = text.split("; ")[0].split(" from a table")[0]
    if not is_typed:
        text = re.split(r": |, such as | such as | \(|, or table", text)[0]
    return _cut(text, limit) or _cut(without_flags(text), limit)


def short(label):
    """What a sentence calls the parameter of a label."""
    cut = re.sub(r"^Also (?:write|give|save|tell|say|report) (?:an? |the )?", "", re.split(r": |, | \(| in metres| in degrees| in seconds", label)[0])
    return cut[:1].upper() + cut[1:]


def lowered(phrase):
    """A phrase for the middle of a text, unless it begins with a name in capitals."""
    return phrase if phrase[1:2].isupper() else phrase[:1].lower() + phrase[1:]


def without_flags(text):
    """A text with the names of flags as plain words."""
    words = {"crs": "CRS", "at": "places"}
    return re.sub(r"--([a-z][a-z-]*)", lambda found: words.get(found[1], found[1].replace("-", " ")), text)


def _cut(text, limit):
    while len(text) > limit or "--" in text:
        shorter = re.match(r"(.*)(?:: |, | \()", text)
        if shorter is None:
            return None
        before, _, listed = shorter[1].partition(": ")
        # a list of words that lost its end would mislead; examples of numbers may be fewer
        text = shorter[1] if re.search(r"\d", listed) else before
    return text[:1].upper() + text[1:]


def result_texts(text):
    """What a text of a result says of each extension: "Raster (.tif) or areas (.geojson .gpkg)" has "Raster" and "Areas"."""
    said = {}
    for phrase, listed in re.findall(r"([^()]+?) \(((?:\.[\w.]+ ?)+)\)", text):
        parts = re.sub(r"^With [^:]*: ", "", phrase).split(": ")
        cut = re.sub(r"^[,;]? ?(?:or |and )?|^Also (?:write|save) ", "", parts[-1] if "--" in parts[0] else parts[0])
        cut = re.sub(r"^(?:an?|the) ", "", cut, flags=re.IGNORECASE)
        for extension in listed.split():
            said.setdefault(extension, cut[:1].upper() + cut[1:])
    return said


def folder_text(text):
    """The label of a folder of results."""
    return without_flags(re.sub(r"^Also write (.*) into this folder.*", r"Folder for \1", text).split(";")[0].split(" (")[0])


def _known_sentences(part):
    """A paragraph without its sentences, or the lines of its list, that have an UNKNOWN; its heading stays if anything does."""
    if UNKNOWN not in part:
        return part
    first, _, rest = part.partition("\n")
    head, body = (first + "\n  ", rest) if rest.startswith("  ") and not first.startswith(" ") else ("", part)
    is_list = any("  " in line.strip() for line in body.splitlines())
    ones = body.splitlines() if is_list else re.split(r"(?<=[.!?])\s+(?=[A-Z\"])", " ".join(body.split()))
    kept = [one.strip() for one in ones if UNKNOWN not in one]
    return head + ("\n  " if is_list else " ").join(kept) if kept else ""


def _missing(found):
    said = []
    for line in found[1].splitlines():
        either = re.findall(r"--[a-z0-9-]+", line) or [line.strip().strip("<>.").lower()]
        said.append(("one of " if len(either) > 1 else "") + ", ".join(either))
    return "Please give " + ", and ".join(said)
