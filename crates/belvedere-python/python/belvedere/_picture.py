"""Small pictures for notebooks, without other packages."""

from __future__ import annotations

import base64
import struct
import zlib
from typing import Any

import numpy as np
import numpy.typing as npt

#: Most pixels along a side.
_MOST = 240


def png_tag(values: npt.NDArray[Any], nodata: float | None = None) -> str:
    """An HTML image of a grid in grey, from its smallest value to its greatest; transparent where there is none."""
    step = max(1, -(-max(values.shape) // _MOST))
    small = values[::step, ::step].astype(np.float64)
    known = np.isfinite(small)
    if nodata is not None:
        known &= small != nodata
    low, high = (small[known].min(), small[known].max()) if known.any() else (0.0, 1.0)
    scaled = np.where(known, (small - low) / (high - low or 1.0), 0.0)
    grey = (30 + 210 * scaled).astype(np.uint8)
    pixels = np.stack([grey, np.where(known, 255, 0).astype(np.uint8)], axis=-1)
    text = base64.b64encode(_png(pixels)).decode("ascii")
    return f'<img src="data:image/png;base64,{text}" style="image-rendering: pixelated; max-width: 480px">'


def _png(pixels: npt.NDArray[np.uint8]) -> bytes:
    rows, columns, _ = pixels.shape

    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    header = struct.pack(">IIBBBBB", columns, rows, 8, 4, 0, 0, 0)
    lines = b"".join(b"\0" + row.tobytes() for row in pixels)
    parts = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + parts
