"""The provider: an algorithm for each command that the program describes."""

import json

from processing.core.ProcessingConfig import ProcessingConfig, Setting
from qgis.core import Qgis, QgsMessageLog, QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from . import program
from .algorithm import SETTING, BelvedereAlgorithm, path_setting
from .description import commands

# What the program described when the plugin was packed: shows the algorithms, and how to get the program, where there
# is none.
PACKED = program.PLUGIN / "describe.json"


class BelvedereProvider(QgsProcessingProvider):
    def id(self):
        return "belvedere"

    def name(self):
        return "Belvedere"

    def longName(self):
        return "Belvedere: visibility on point clouds"

    def icon(self):
        return QIcon(str(program.PLUGIN / "icon.svg"))

    def supportedOutputRasterLayerExtensions(self):
        return ["tif"]

    def load(self):
        ProcessingConfig.settingIcons[self.name()] = self.icon()
        ProcessingConfig.addSetting(Setting(self.name(), SETTING, "Path of the program belvedere", "", valuetype=Setting.FILE))
        ProcessingConfig.readSettings()
        self.refreshAlgorithms()
        return True

    def unload(self):
        ProcessingConfig.removeSetting(SETTING)

    def loadAlgorithms(self):
        try:
            described = program.describe(program.find(path_setting()))
        except (program.ProgramError, OSError) as error:
            QgsMessageLog.logMessage(str(error), self.name(), Qgis.Warning)
            if not PACKED.is_file():
                return
            described = json.loads(PACKED.read_text(encoding="utf-8"))
        for command in commands(described):
            self.addAlgorithm(BelvedereAlgorithm(command))
