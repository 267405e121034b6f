"""Results of several times, as layers that the temporal controller plays."""

from datetime import datetime

from osgeo import gdal
from qgis.core import (
    Qgis,
    QgsLayerDefinition,
    QgsLayerTreeGroup,
    QgsLayerTreeLayer,
    QgsProcessingLayerPostProcessorInterface,
    QgsRasterBandStats,
    QgsRasterLayer,
    QgsVectorLayer,
)

from . import style
from .layers import give_style


def bands(path):
    """The bands of one measure that have a time, with the clock time from which and up to which each holds: the shortest step; none for fewer than two."""
    raster = gdal.Open(path)
    numbered = [(number, raster.GetRasterBand(number)) for number in range(1, raster.RasterCount + 1)]
    timed = [(band.GetDescription().split("_")[0], number, band.GetMetadataItem("TIME")) for number, band in numbered if band.GetMetadataItem("TIME")]
    # clock times: so QGIS reads the times of vector layers, too
    ones = sorted((datetime.fromisoformat(time[:19]), number) for measure, number, time in timed if measure == timed[0][0])
    steps = [later[0] - earlier[0] for earlier, later in zip(ones, ones[1:]) if later[0] > earlier[0]]
    return [(number, start, start + min(steps)) for start, number in ones] if steps else []


def write_definition(command, output, path, title, made):
    """Writes a layer definition beside a result of several times with a style, and returns its path; None where there are none.

    QGIS 3.22 keeps no times in the style of a layer that it opens, so that a file .qml is not enough.
    """
    if output.kind == "raster":
        layers = list(_layers_of_bands(command, output.key, path))
        node = QgsLayerTreeGroup(title)
        for layer in layers:
            node.addLayer(layer).setExpanded(False)
    else:
        layer = QgsVectorLayer(path, output.label, "ogr")
        give_style(layer, made)
        layers = [layer] if layer.temporalProperties().isActive() else []
        node = QgsLayerTreeLayer(layer)
    if not layers:
        return None
    QgsLayerDefinition.exportLayerDefinition(path + ".qlr", [node])
    return path + ".qlr"


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
        give_style(layer, made)
        yield layer


# What styles layers: QGIS holds no reference to it, and does not say when it is done.
KEPT = []


class _Styler(QgsProcessingLayerPostProcessorInterface):
    """Gives the layer of a result its style, which Processing leaves out."""

    def __init__(self, made):
        super().__init__()
        self.made = made

    def postProcessLayer(self, layer, context, feedback):
        give_style(layer, self.made)
        layer.triggerRepaint()


def show(result, made, definition, context):
    """Has a result loaded with its style, or the layers of its definition instead, if the user wants to see it."""
    if context.project() is None or not context.willLoadLayerOnCompletion(result):
        return
    if definition is None:
        styler = _Styler(made)
        KEPT.append(styler)
        context.layerToLoadOnCompletionDetails(result).setPostProcessor(styler)
        return
    wanted = context.layersToLoadOnCompletion()
    wanted.pop(result)
    context.setLayersToLoadOnCompletion(wanted)
    QgsLayerDefinition.loadLayerDefinition(definition, context.project(), context.project().layerTreeRoot())
