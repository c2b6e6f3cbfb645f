"""The table of a study's file as Parquet, block by block."""
from __future__ import annotations

import contextlib
import os

from . import described

try:
    import h5py
    import pyarrow as pa
    import pyarrow.parquet as pq
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(f"{error.name}: asdic.to_parquet needs it (h5py: Debian's python3-h5py; "
                              "pyarrow: pip install pyarrow, Debian has none). The file itself "
                              "is HDF5: asdic.read_study reads it without", name=error.name) from None


def _text(value) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


def _columns(file) -> list[tuple[str, object, list[str]]]:
    """→ [(name, dataset, labels)] in the order of the manifest"""
    import json

    manifest = json.loads(_text(file["manifest"][()]))
    found = []
    for column in manifest["columns"]:
        path = "table/" + column["name"]
        if path in file:  # columns that tell how a row was made are not of the table
            found.append((column["name"], file[path],
                          [_text(label) for label in file[path].attrs.get("labels", [])]))
    return found


def _field(name, dataset, labels):
    about = {key: _text(dataset.attrs[of]) for key, of in
             (("unit", "units"), ("meaning", "long_name"), ("role", "role"), ("reference", "reference"))
             if of in dataset.attrs}
    kind = pa.dictionary(pa.int32(), pa.string()) if labels else pa.float64()
    return pa.field(name, kind, metadata=about)


def _values(dataset, labels, part):
    values = dataset[part]
    if not labels:
        return pa.array(values)
    known = [None if value != value else int(value) for value in values.tolist()]
    return pa.DictionaryArray.from_arrays(pa.array(known, pa.int32()), pa.array(labels))


def write(path: str, output: str, rows: int) -> int:
    if rows < 1:
        raise described.made("rows", str(rows), "at least 1 row a group")
    if os.path.exists(output):
        raise described.made("output", f"{output}, which is there", "the name of a new file")
    with h5py.File(path, "r") as file:
        if _text(file.attrs.get("filetype", "")) != "asdic study":
            raise described.made("file", f"{path}, which is no study's file",
                                 "the result of asdic study or asdic merge")
        columns = _columns(file)
        table = {key: _text(file.attrs[key]) for key in ("title", "identity", "seed", "design",
                                                         "program_version") if key in file.attrs}
        table["complete"] = str(bool(file.attrs["complete"])).lower()
        schema = pa.schema([pa.field("index", pa.int64()), pa.field("valid", pa.bool_()),
                            *(_field(*column) for column in columns)], metadata=table)
        count = file["index"].shape[0]
        part = output + ".part"
        try:
            with pq.ParquetWriter(part, schema) as to:
                for first in range(0, count, rows):
                    block = slice(first, min(first + rows, count))
                    arrays = [pa.array(file["index"][block]), pa.array(file["valid"][block] != 0),
                              *(_values(dataset, labels, block) for _, dataset, labels in columns)]
                    to.write_table(pa.Table.from_arrays(arrays, schema=schema), row_group_size=rows)
            os.rename(part, output)
        except BaseException:
            with contextlib.suppress(OSError):
                os.remove(part)
            raise
    return count
