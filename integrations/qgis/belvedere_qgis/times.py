"""Results of several times, as layers that the temporal controller plays."""

import os
from datetime import datetime, timedelta

from osgeo import gdal
from qgis.core import Qgis, QgsLayerDefinition, QgsLayerTreeGroup, QgsLayerTreeLayer, QgsRasterBandStats, QgsRasterLayer, QgsVectorLayer
from qgis.PyQt.QtXml import QDomDocument

from . import style

# How long the last of the times lasts if there is no step before it.
LAST = timedelta(hours=1)


def bands(path):
    """The bands of one measure that have a time, with the clock time from which and up to which each holds; none for fewer than two."""
    raster = gdal.Open(path)
    numbered = [(number, raster.GetRasterBand(number)) for number in range(1, raster.RasterCount + 1)]
    timed = [(band.GetDescription().split("_")[0], number, band.GetMetadataItem("TIME")) for number, band in numbered if band.GetMetadataItem("TIME")]
    # clock times: so QGIS reads the times of vector layers, too
    ones = [(number, datetime.fromisoformat(time[:19])) for measure, number, time in timed if measure == timed[0][0]]
    ends = [time for _, time in ones[1:]]
    if not ends:
        return []
    ends.append(ones[-1][1] + (ones[-1][1] - ones[-2][1] if ones[-1][1] > ones[-2][1] else LAST))
    return [(number, start, end) for (number, start), end in zip(ones, ends)]


def write_definition(command, output, path, title):
    """Writes a layer definition beside a result of several times, and returns its path; None where there are none.

    QGIS 3.22 keeps no times in the style of a layer that it opens, so that a file .qml is not enough.
    """
    stem = os.path.splitext(path)[0]
    if output.kind == "raster":
        layers = list(_layers_of_bands(command, output.key, path))
        node = QgsLayerTreeGroup(title)
        for layer in layers:
            node.addLayer(layer)
    else:
        layers = [QgsVectorLayer(path, output.label, "ogr")]
        layers[0].loadNamedStyle(stem + ".qml")
        layers = [layer for layer in layers if layer.temporalProperties().isActive()]
        node = QgsLayerTreeLayer(layers[0]) if layers else None
    if not layers:
        return None
    QgsLayerDefinition.exportLayerDefinition(stem + ".qlr", [node])
    return stem + ".qlr"


def _layers_of_bands(command, key, path):
    """A layer for each band of a raster that has a time."""
    found = bands(path)
    whole = QgsRasterLayer(path, "result")
    provider = whole.dataProvider()
    statistics = [provider.bandStatistics(number, QgsRasterBandStats.Min | QgsRasterBandStats.Max) for number, _, _ in found]
    for number, start, end in found:
        low, high = min(one.minimumValue for one in statistics), max(one.maximumValue for one in statistics)
        made = style.raster(command, key, low, high, provider.dataType(number) == Qgis.Byte, band=number, span=(start, end))
        if made is None:
            return
        layer = QgsRasterLayer(path, start.isoformat(" ", "minutes"))
        document = QDomDocument()
        document.setContent(made)
        layer.importNamedStyle(document)
        yield layer


def load(definition, result, context):
    """Loads the layers of a definition into the project instead of the result, if the user wants to see it."""
    if context.project() is None or not context.willLoadLayerOnCompletion(result):
        return
    wanted = context.layersToLoadOnCompletion()
    wanted.pop(result)
    context.setLayersToLoadOnCompletion(wanted)
    QgsLayerDefinition.loadLayerDefinition(definition, context.project(), context.project().layerTreeRoot())
