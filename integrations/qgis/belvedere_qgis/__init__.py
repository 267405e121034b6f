"""Belvedere for QGIS: what can be seen from where, and what lies in shadow, directly on a lidar point cloud."""


def classFactory(iface):
    from .plugin import BelvederePlugin

    return BelvederePlugin()
