"""Writes GeoTIFFs and grids of ESRI's by their published layouts, without GDAL.

TIFF 6.0 (Aldus, 1992); OGC 19-008, GeoTIFF 1.1; ESRI's .flt with .hdr; Arc/Info's binary grid as
F. Warmerdam describes it (avce00.maptools.org)."""
import struct

import numpy as np

FORMATS = {"u": 1, "i": 2, "f": 3}  # SampleFormat
CODES = {"B": 1, "s": 2, "H": 3, "I": 4, "d": 12}


def entries_of(tags, start):
    """The directory of a little-endian TIFF at a byte, with what is too long for it behind."""
    body, extra = b"", b""
    behind = start + 2 + 12 * len(tags) + 4
    for tag, (code, values) in sorted(tags.items()):
        if code == "s":
            data = values.encode() + b"\0"
            count = len(data)
        else:
            values = list(np.ravel(values))
            data = struct.pack(f"<{len(values)}{code}", *values)
            count = len(values)
        if len(data) > 4:
            extra += b"\0" * (len(extra) % 2)
            where = struct.pack("<I", behind + len(extra))
            extra += data
        else:
            where = data.ljust(4, b"\0")
        body += struct.pack("<HHI", tag, CODES[code], count) + where
    return struct.pack("<H", len(tags)) + body + struct.pack("<I", 0) + extra


def geotiff(path, bands, west=0.0, north=0.0, dx=1.0, dy=1.0, epsg=4326, projected=False, point=False, nodata=None,
            described=(), units=(), scale=None, offset=None, turned_deg=0.0, placed=True, referenced=True,
            colours=None, alpha=None):
    """`bands`: arrays [rows, columns] of one type, from north to south; `west` and `north` are the outer corner of the
    first pixel, or, of `point`, its middle. `colours`: "palette" or "rgb". `alpha`: the last band, 0 hides a pixel."""
    bands = [np.ascontiguousarray(b) for b in bands] + ([] if alpha is None else [np.ascontiguousarray(alpha)])
    rows, columns = bands[0].shape
    kind = bands[0].dtype
    data = b"".join(b.astype(kind.newbyteorder("<")).tobytes() for b in bands)
    n = len(bands)
    tags = {256: ("I", [columns]), 257: ("I", [rows]), 258: ("H", [8 * kind.itemsize] * n), 259: ("H", [1]),
            262: ("H", [{"palette": 3, "rgb": 2}.get(colours, 1)]),
            273: ("I", 8 + rows * columns * kind.itemsize * np.arange(n)), 277: ("H", [n]), 278: ("I", [rows]),
            279: ("I", [rows * columns * kind.itemsize] * n), 284: ("H", [2]), 339: ("H", [FORMATS[kind.kind]] * n)}
    extra = n - (3 if colours == "rgb" else 1)
    if extra > 0:
        tags[338] = ("H", [0] * (extra - 1) + [2 if alpha is not None else 0])
    if colours == "palette":
        tags[320] = ("H", np.arange(3 * 256) % 256 * 257)
    if placed and turned_deg:
        c, s = np.cos(np.radians(turned_deg)), np.sin(np.radians(turned_deg))
        tags[34264] = ("d", [dx * c, dy * s, 0, west, dx * s, -dy * c, 0, north, 0, 0, 0, 0, 0, 0, 0, 1])
    elif placed:
        tags[33550] = ("d", [dx, dy, 0.0])
        tags[33922] = ("d", [0, 0, 0, west, north, 0])
    keys = [(1024, 1 if projected else 2)] if referenced else []
    keys.append((1025, 2 if point else 1))
    if referenced:
        keys.append((3072 if projected else 2048, epsg))
    tags[34735] = ("H", [1, 1, 1, len(keys)] + [x for key, value in keys for x in (key, 0, 1, value)])
    items = [f'<Item name="DESCRIPTION" sample="{k}" role="description">{t}</Item>' for k, t in enumerate(described)]
    items += [f'<Item name="UNITTYPE" sample="{k}" role="unittype">{t}</Item>' for k, t in enumerate(units)]
    for name, value in (("scale", scale), ("offset", offset)):
        if value is not None:
            items.append(f'<Item name="{name.upper()}" sample="0" role="{name}">{value!r}</Item>')
    if items:
        tags[42112] = ("s", "<GDALMetadata>" + "".join(items) + "</GDALMetadata>")
    if nodata is not None:
        tags[42113] = ("s", repr(nodata))
    start = 8 + len(data) + len(data) % 2
    path.write_bytes(struct.pack("<2sHI", b"II", 42, start) + data.ljust(start - 8, b"\0") + entries_of(tags, start))


def sparse_geotiff(path, side, west, north, step, at, values, tile=512, epsg=4326):
    """A square raster of float32 tiles, of which one, that holds the pixel `at` (row, column), is in the file."""
    across = -(-side // tile)
    number = at[0] // tile * across + at[1] // tile
    offsets, counts = np.zeros(across * across, int), np.zeros(across * across, int)
    data = np.asarray(values, "<f4").tobytes()
    offsets[number], counts[number] = 8, len(data)
    tags = {256: ("I", [side]), 257: ("I", [side]), 258: ("H", [32]), 259: ("H", [1]), 262: ("H", [1]), 277: ("H", [1]),
            322: ("H", [tile]), 323: ("H", [tile]), 324: ("I", offsets), 325: ("I", counts), 339: ("H", [3]),
            33550: ("d", [step, step, 0.0]), 33922: ("d", [0, 0, 0, west, north, 0]),
            34735: ("H", [1, 1, 1, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, epsg]), 42113: ("s", "-9999")}
    start = 8 + len(data)
    path.write_bytes(struct.pack("<2sHI", b"II", 42, start) + data + entries_of(tags, start))


WGS84 = ('GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],'
         'PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]]')


def float_grid(path, values, west, south, step, nodata=-9999):
    """ESRI's .flt: float32, with the .hdr and the .prj beside it. \\param west, south  of the outer corner"""
    path.write_bytes(np.asarray(values, "<f4").tobytes())
    rows, columns = np.shape(values)
    path.with_suffix(".hdr").write_text(
        f"ncols {columns}\nnrows {rows}\nxllcorner {west!r}\nyllcorner {south!r}\ncellsize {step!r}\n"
        f"NODATA_value {nodata}\nbyteorder LSBFIRST\n")
    path.with_suffix(".prj").write_text(WGS84)


def binary_grid(folder, values, west, south, step):
    """Arc/Info's binary grid: a folder of .adf, of float32 in one tile."""
    folder.mkdir()
    rows, columns = np.shape(values)
    head = bytearray(308)
    head[:8] = b"GRID1.2\0"
    struct.pack_into(">ii", head, 16, 2, 1)                   # floating point, not compressed
    struct.pack_into(">dddd", head, 256, step, step, 0.0, 0.0)
    struct.pack_into(">iiiii", head, 288, 1, 1, columns, 1, rows)  # tiles across and down; a tile's size
    (folder / "hdr.adf").write_bytes(bytes(head))
    (folder / "dblbnd.adf").write_bytes(struct.pack(">dddd", west, south, west + step * columns, south + step * rows))
    (folder / "sta.adf").write_bytes(struct.pack(">dddd", np.min(values), np.max(values), np.mean(values), np.std(values)))
    tile = np.asarray(values, ">f4").tobytes()
    start = bytearray(100)
    start[:8] = b"\x00\x00\x27\x0a\xff\xff\xfc\x14"
    body = bytearray(start)
    struct.pack_into(">i", body, 24, (100 + 2 + len(tile)) // 2)  # of the file, in words of 2 bytes
    (folder / "w001001.adf").write_bytes(bytes(body) + struct.pack(">H", len(tile) // 2) + tile)
    struct.pack_into(">i", start, 24, (100 + 8) // 2)
    (folder / "w001001x.adf").write_bytes(bytes(start) + struct.pack(">ii", 50, len(tile) // 2))
    (folder / "prj.adf").write_text("Projection    GEOGRAPHIC\nDatum         WGS84\nSpheroid      WGS84\nUnits         DD\n"
                                    "Zunits        NO\nParameters\n")
