"""Between layers of QGIS and the files of the program."""

import csv
import json
import os

import numpy as np
from osgeo import gdal
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsFeature,
    QgsGeometry,
    QgsPoint,
    QgsProcessingException,
    QgsRasterBandStats,
    QgsRasterLayer,
    QgsVectorFileWriter,
    QgsVectorLayer,
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import QVariant
from qgis.PyQt.QtXml import QDomDocument

from . import style

# What the columns of a table are, by the columns that say where a row is.
LINE = ("ax", "ay", "az", "bx", "by", "bz")
POINT = ("x", "y", "z")
# Opacities of cells that are proven and unproven. 255 is nodata in some rasters.
OPAQUE, FAINT = 254, 80


def system(text):
    """The system that the program names, invalid for none."""
    return QgsCoordinateReferenceSystem.fromUserInput(text) if text and text.startswith("EPSG:") else _from_wkt(text)


def _from_wkt(text):
    made = QgsCoordinateReferenceSystem()
    if text:
        made.createFromWkt(text)
    return made


def definition(crs):
    """What names a system for the program."""
    if not crs.isValid():
        return None
    return crs.authid() if crs.authid().startswith("EPSG:") else crs.toWkt(QgsCoordinateReferenceSystem.WKT_PREFERRED_GDAL)


def write_geojson(source, scene, path, context):
    """Writes the features in the coordinates of the scene, with their attributes, and returns the path."""
    transform = QgsCoordinateTransform(source.sourceCrs(), scene, context.transformContext()) if scene.isValid() else None
    names = [field.name() for field in source.fields()]
    features = []
    for feature in source.getFeatures():
        geometry = QgsGeometry(feature.geometry())
        if geometry.isNull():
            continue
        if transform is not None:
            geometry.transform(transform)
        # 17 digits: coordinates of maps are large numbers
        shape = json.loads(geometry.asJson(9))
        properties = {name: _plain(value) for name, value in zip(names, feature.attributes())}
        features.append({"type": "Feature", "geometry": shape, "properties": properties})
    if not features:
        raise QgsProcessingException(f"{source.sourceName()}: the layer has no features to use")
    collection = {"type": "FeatureCollection", "features": features}
    if scene.isValid() and scene.authid().startswith("EPSG:"):
        # small coordinates would else be taken as longitude and latitude
        collection["crs"] = {
            "type": "name",
            "properties": {"name": "urn:ogc:def:crs:" + scene.authid().replace(":", "::")},
        }
    with open(path, "w", encoding="utf-8") as file:
        json.dump(collection, file)
    return path


def _plain(value):
    return value if isinstance(value, (int, float, str)) else None


def convert(written, destination, scene, context):
    """Makes a vector layer at `destination` of a table or GeoJSON of the program."""
    layer = _of_table(written, scene) if written.endswith(".csv") else QgsVectorLayer(written, "result", "ogr")
    options = QgsVectorFileWriter.SaveVectorOptions()
    extension = os.path.splitext(destination)[1].lstrip(".")
    options.driverName = QgsVectorFileWriter.driverForExtension(extension) or "GPKG"
    options.layerName = "result"
    if scene.isValid() and layer.crs().isValid():
        options.ct = QgsCoordinateTransform(layer.crs(), scene, context.transformContext())
    done = QgsVectorFileWriter.writeAsVectorFormatV3(layer, destination, context.transformContext(), options)
    if done[0] != QgsVectorFileWriter.NoError:
        raise QgsProcessingException(f"{destination}: {done[1]}")


def _of_table(path, scene):
    """A layer in memory of the rows of a table: lines, points, or rows without geometry."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    names = list(rows[0]) if rows else []
    ends = next((columns for columns in (LINE, POINT) if columns[0] in names and columns[1] in names), ())
    fields = [name for name in names if name not in ends]
    kind = "NoGeometry" if not ends else "LineStringZ" if ends == LINE else "PointZ"
    texts = {name for name in fields if not all(_is_number(row[name]) for row in rows)}
    whole = {name for name in fields if name not in texts and all(row[name].lstrip("-").isdigit() for row in rows if row[name])}
    listed = "".join(f"&field={name}:{'string' if name in texts else 'integer' if name in whole else 'double'}" for name in fields)
    layer = QgsVectorLayer(f"{kind}?{listed.lstrip('&')}", "result", "memory")
    layer.setCrs(scene)
    made = []
    for row in rows:
        feature = QgsFeature(layer.fields())
        feature.setAttributes([_value(row[name], name in texts, name in whole) for name in fields])
        if ends:
            places = [row.get(name) or "nan" for name in ends]
            corners = [QgsPoint(*map(float, places[at : at + 3])) for at in range(0, len(places), 3)]
            feature.setGeometry(QgsGeometry.fromPolyline(corners) if len(corners) == 2 else QgsGeometry(corners[0]))
        made.append(feature)
    layer.dataProvider().addFeatures(made)
    return layer


def _is_number(text):
    try:
        return not text or float(text) is not None
    except ValueError:
        return False


def _value(text, is_text, is_whole):
    if not text:
        return None
    return text if is_text else int(text) if is_whole else float(text)


def write_style(command, output, path):
    """Writes the style of a result, and returns it: into a package, else beside the file, where QGIS finds it whenever the result is loaded."""
    made = _raster_style(command, output.key, path) if output.kind == "raster" else _vector_style(command, output.key, path)
    if made is None:
        return None
    if path.endswith(".gpkg"):
        # a raster with the same name needs the file beside it
        layer = QgsVectorLayer(path, "result", "ogr")
        give_style(layer, made)
        layer.saveStyleToDatabase("result", "", True, "")
    else:
        with open(os.path.splitext(path)[0] + ".qml", "w", encoding="utf-8") as file:
            file.write(made)
    return made


def give_style(layer, made):
    """Gives a layer a style."""
    document = QDomDocument()
    document.setContent(made)
    layer.importNamedStyle(document)


def add_shown_band(path):
    """Adds to a raster what a map shows of its first band and the band "unproven", and returns the number of the band; None without such a band.

    Of answers the band is 2 where they are unproven, as codes of answers are elsewhere. Of numbers it is the opacity of the cell, 0 to 254: the more of the
    number is unproven, the lower. A style has no other way to show two bands.
    """
    source = gdal.Open(path)
    names = [source.GetRasterBand(number).GetDescription() for number in range(1, source.RasterCount + 1)]
    if "unproven" not in names:
        return None
    first, unproven = source.GetRasterBand(1).ReadAsArray(), source.GetRasterBand(names.index("unproven") + 1).ReadAsArray()
    nodata, kind = source.GetRasterBand(1).GetNoDataValue(), source.GetRasterBand(1).DataType
    is_answer = kind == gdal.GDT_Byte
    known = first != nodata
    share = np.divide(unproven, first, out=np.zeros(first.shape), where=known & (first > 0)).clip(0, 1)
    shown = np.where(known & (share > 0), 2, first) if is_answer else OPAQUE - (OPAQUE - FAINT) * share
    copy = gdal.GetDriverByName("MEM").CreateCopy("", source)
    source = None
    copy.AddBand(kind)
    band = copy.GetRasterBand(copy.RasterCount)
    band.WriteArray(shown)
    band.SetDescription("answer" if is_answer else "opacity")
    band.SetNoDataValue(nodata)
    gdal.GetDriverByName("GTiff").CreateCopy(path, copy, options=["COMPRESS=DEFLATE", "BIGTIFF=IF_SAFER"])
    return copy.RasterCount


def _raster_style(command, key, path):
    shown = add_shown_band(path)
    layer = QgsRasterLayer(path, "result")
    provider = layer.dataProvider()
    is_bytes = provider.dataType(1) == Qgis.Byte
    is_answer = shown is not None and is_bytes
    band = shown if is_answer else 1
    found = provider.bandStatistics(band, QgsRasterBandStats.Min | QgsRasterBandStats.Max)
    return style.raster(command, key, found.minimumValue, found.maximumValue, is_bytes, band, None if is_answer else shown)


def _vector_style(command, key, path):
    layer = QgsVectorLayer(path, "result", "ogr")
    kinds = {
        QgsWkbTypes.PointGeometry: "point",
        QgsWkbTypes.LineGeometry: "line",
        QgsWkbTypes.PolygonGeometry: "polygon",
    }
    geometry = kinds.get(layer.geometryType())
    if geometry is None:
        return None
    fields = layer.fields().names()
    low, high, field = 0.0, 1.0, style.field_of(command, key)
    if field is not None:
        values = [feature[field] for feature in layer.getFeatures() if isinstance(feature[field], (int, float))] if field in fields else []
        low, high = (min(values), max(values)) if values else (low, high)
    return style.vector(command, key, geometry, low, high, fields, _step_min(layer))


def _step_min(layer):
    """Minutes between the times of the features of a layer, or None where it has no two times."""
    at = layer.fields().indexFromName("time")
    if at < 0 or layer.fields()[at].type() != QVariant.DateTime:
        return None
    times = sorted(time for time in layer.uniqueValues(at) if time)
    return min(one.secsTo(other) for one, other in zip(times, times[1:])) / 60 if len(times) > 1 else None
