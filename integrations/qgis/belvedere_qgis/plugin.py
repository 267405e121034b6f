"""What QGIS loads: a provider of Processing algorithms."""

from qgis.core import QgsApplication

from .provider import BelvedereProvider


class BelvederePlugin:
    """Adds the provider while the plugin is enabled, in the desktop and in `qgis_process`."""

    def __init__(self):
        self.provider = None

    def initProcessing(self):
        self.provider = BelvedereProvider()
        QgsApplication.processingRegistry().addProvider(self.provider)

    def initGui(self):
        self.initProcessing()

    def unload(self):
        if self.provider is not None:
            QgsApplication.processingRegistry().removeProvider(self.provider)
            self.provider = None
