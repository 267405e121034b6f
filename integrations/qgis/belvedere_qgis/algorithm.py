"""A command of the program as an algorithm of Processing."""

import html
import os
import tempfile

from processing.core.ProcessingConfig import ProcessingConfig
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterCrs,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterEnum,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFile,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterFolderDestination,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
    QgsProcessingParameterPoint,
    QgsProcessingParameterRasterDestination,
    QgsProcessingParameterRasterLayer,
    QgsProcessingParameterString,
    QgsProcessingParameterVectorDestination,
    QgsProcessingUtils,
)
from qgis.PyQt.QtGui import QIcon

from . import layers, page, program, times
from .command_line import arguments
from .description import as_html

SETTING = "BELVEDERE_PROGRAM"
GEOMETRIES = {
    "any": QgsProcessing.TypeVectorAnyGeometry,
    "point": QgsProcessing.TypeVectorPoint,
    "line": QgsProcessing.TypeVectorLine,
    "polygon": QgsProcessing.TypeVectorPolygon,
}


def path_setting():
    return ProcessingConfig.getSetting(SETTING) or ""


class BelvedereAlgorithm(QgsProcessingAlgorithm):
    def __init__(self, command):
        super().__init__()
        self.command = command
        self.layers = {}
        """style and, of several times, layer definition of the results that are layers, by their paths"""

    def createInstance(self):
        return BelvedereAlgorithm(self.command)

    def name(self):
        return self.command.name.replace("-", "_")

    def displayName(self):
        return self.command.title

    def group(self):
        return self.command.group

    def groupId(self):
        return self.command.group.lower().replace(" ", "_")

    def icon(self):
        return QIcon(str(program.PLUGIN / "icon.svg"))

    def shortDescription(self):
        return self.command.summary

    def shortHelpString(self):
        shown = [one for one in self.command.parameters if not one.is_advanced]
        return as_html(self.command.description) + "".join(f"<p><b>{html.escape(one.heading)}</b><br>{html.escape(one.help)}</p>" for one in shown)

    def canExecute(self):
        try:
            program.find(path_setting())
        except program.ProgramError as error:
            return False, str(error)
        return True, ""

    def initAlgorithm(self, configuration=None):
        for parameter in self.command.parameters:
            for made in _definitions(parameter):
                made.setHelp(parameter.help)
                if parameter.is_advanced:
                    made.setFlags(made.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
                self.addParameter(made)

    def processAlgorithm(self, parameters, context, feedback):
        try:
            return self._process(parameters, context, feedback)
        except program.ProgramError as error:
            raise QgsProcessingException(self.command.reworded(str(error))) from None
        except program.Cancelled:
            return {}

    def postProcessAlgorithm(self, context, feedback):
        # in the thread of the project, unlike the run
        for result, (made, definition) in self.layers.items():
            times.show(result, made, definition, context)
        return {}

    def _process(self, parameters, context, feedback):
        path = program.find(path_setting())
        folder = tempfile.mkdtemp(dir=QgsProcessingUtils.tempFolder())
        wanted = {output.key: self._destination(parameters, output, context) for output in self.command.outputs}
        wanted = {key: destination for key, destination in wanted.items() if destination}
        scene = self._scene(path, parameters, wanted, context, feedback)
        values = {one.key: self._value(parameters, one, scene, folder, context, feedback) for one in self.command.parameters if one.kind != "written"}
        # vector layers are made from what the program writes
        written = {
            output.key: os.path.join(folder, output.key.lower() + output.formats[0]) if output.kind in ("vector", "table") else wanted[output.key]
            for output in self.command.outputs
            if output.key in wanted
        }
        summary = self._run(path, arguments(self.command, values, written), feedback)
        for sentence in self.command.sentences(summary):
            feedback.pushInfo(sentence)
        for remark in summary.get("remarks", []):
            (feedback.pushWarning if remark["severity"] == "warning" else feedback.pushInfo)(self.command.reworded(remark["text"]))
        for name, value in summary.items():
            if isinstance(value, (int, float, str)):
                feedback.pushInfo(f"{name.replace('_', ' ')}: {value}")
        for output in self.command.outputs:
            if output.key not in wanted:
                continue
            if output.kind == "page":
                page.write(wanted[output.key], self.command, summary)
            if output.kind in ("vector", "table"):
                layers.convert(written[output.key], wanted[output.key], scene, context)
            if output.kind in ("raster", "vector", "table"):
                made = layers.write_style(self.command.name, output, wanted[output.key])
                if made is not None:
                    definition = times.write_definition(self.command.name, output, wanted[output.key], self.command.title, made)
                    self.layers[wanted[output.key]] = made, definition
        return wanted

    def _run(self, path, typed, feedback):
        feedback.pushCommandInfo(program.shown(typed))
        latest = []

        def show(stage, done, total):
            if latest != [stage]:
                latest[:] = [stage]
                feedback.setProgressText(stage[:1].upper() + stage[1:])
            if total:
                feedback.setProgress(100.0 * done / total)

        return program.run(path, typed, show, feedback.isCanceled)

    def _scene(self, path, parameters, wanted, context, feedback):
        """The system of the scene, for what goes between layers and the program; an invalid one where it is not known or not needed."""
        given = self.parameterAsCrs(parameters, "CRS", context) if self.parameterDefinition("CRS") else QgsCoordinateReferenceSystem()
        is_needed = any(output.kind in ("vector", "table") for output in self.command.outputs if output.key in wanted)
        is_needed |= any(one.kind in ("layer", "point") and parameters.get(one.key) for one in self.command.parameters)
        if given.isValid() or not is_needed:
            return given
        clouds = self.parameterAsFileList(parameters, "CLOUDS", context) if "CLOUDS" in parameters else []
        if not clouds:
            return given
        feedback.setProgressText("Reading the reference system")
        return layers.system(program.run(path, ["info", "--", *clouds], is_cancelled=feedback.isCanceled).get("crs"))

    def _destination(self, parameters, output, context):
        if output.kind in ("raster", "vector", "table"):
            return self.parameterAsOutputLayer(parameters, output.key, context)
        return self.parameterAsFileOutput(parameters, output.key, context)

    def _value(self, parameters, one, scene, folder, context, feedback):
        given = parameters.get(one.key, self.parameterDefinition(one.key).defaultValue())
        if given is None or given == "":
            return None
        if one.kind == "files":
            return self.parameterAsFileList(parameters, one.key, context) or None
        if one.kind == "flag":
            return self.parameterAsBool(parameters, one.key, context)
        if one.kind == "choice":
            return self.parameterAsEnum(parameters, one.key, context)
        if one.kind == "number":
            return self.parameterAsDouble(parameters, one.key, context)
        if one.kind == "integer":
            return self.parameterAsInt(parameters, one.key, context)
        if one.kind == "crs":
            return layers.definition(self.parameterAsCrs(parameters, one.key, context))
        if one.kind == "point":
            place = self.parameterAsPoint(parameters, one.key, context, scene)
            return f"{place.x()!r},{place.y()!r}"
        if one.kind == "place":
            place = self.parameterAsPoint(parameters, one.key, context, QgsCoordinateReferenceSystem("EPSG:4326"))
            return f"{place.y()!r},{place.x()!r}"
        if one.kind == "layer":
            source = self.parameterAsSource(parameters, one.key, context)
            if source is None:
                raise QgsProcessingException(self.invalidSourceError(parameters, one.key))
            return layers.write_geojson(source, scene, os.path.join(folder, one.key.lower() + ".geojson"), context)
        if one.kind == "raster":
            layer = self.parameterAsRasterLayer(parameters, one.key, context)
            if layer is None:
                raise QgsProcessingException(self.invalidRasterError(parameters, one.key))
            return layer.source()
        if one.kind == "file":
            return self.parameterAsFile(parameters, one.key, context)
        return self.parameterAsString(parameters, one.key, context)


def _definitions(one):
    optional = not one.is_required
    if one.kind == "written":
        return [_destination(output) for output in one.outputs]
    if one.kind == "files":
        return [QgsProcessingParameterMultipleLayers(one.key, one.label, QgsProcessing.TypeFile, optional=optional)]
    if one.kind == "flag":
        return [QgsProcessingParameterBoolean(one.key, one.label, defaultValue=False)]
    if one.kind == "choice":
        options = [f"{name}: {text}" if text else name for name, text in one.choices]
        return [QgsProcessingParameterEnum(one.key, one.label, options, defaultValue=one.default, optional=optional)]
    if one.kind in ("number", "integer"):
        kind = QgsProcessingParameterNumber.Double if one.kind == "number" else QgsProcessingParameterNumber.Integer
        return [QgsProcessingParameterNumber(one.key, one.label, kind, one.default, optional)]
    if one.kind == "crs":
        return [QgsProcessingParameterCrs(one.key, one.label, optional=optional)]
    if one.kind in ("point", "place"):
        return [QgsProcessingParameterPoint(one.key, one.label, optional=optional)]
    if one.kind == "layer":
        kinds = [GEOMETRIES[one.geometry]]
        return [QgsProcessingParameterFeatureSource(one.key, one.label, kinds, optional=optional)]
    if one.kind == "raster":
        return [QgsProcessingParameterRasterLayer(one.key, one.label, optional=optional)]
    if one.kind == "file":
        return [QgsProcessingParameterFile(one.key, one.label, optional=optional)]
    return [QgsProcessingParameterString(one.key, one.label, optional=optional)]


def _destination(output):
    if output.kind == "raster":
        made = QgsProcessingParameterRasterDestination(output.key, output.label, None, True, output.is_usual)
    elif output.kind in ("vector", "table"):
        kind = QgsProcessing.TypeVectorAnyGeometry
        made = QgsProcessingParameterVectorDestination(output.key, output.label, kind, None, True, output.is_usual)
    elif output.kind == "folder":
        made = QgsProcessingParameterFolderDestination(output.key, output.label, None, True, output.is_usual)
    else:
        known = ";;".join(f"{extension[1:].upper()} (*{extension})" for extension in output.formats)
        made = QgsProcessingParameterFileDestination(output.key, output.label, known, None, True, output.is_usual)
    return made
