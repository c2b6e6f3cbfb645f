#!/usr/bin/env python3
"""`asdic.to_parquet`: what is written, in which blocks, and what is said without pyarrow.

Debian has no pyarrow. Where there is one, the file is read back by it; else a stand-in of the few names that are used
takes down what it is given. Truth: the study's own file, read by h5py.
"""
import importlib.util
import os
import subprocess
import sys
import tempfile
import types
import unittest
from pathlib import Path

import h5py
import numpy as np

BUILD, PROGRAM = Path(os.environ["ASDIC_BUILD"]), os.environ["ASDIC"]
ROOT = Path(__file__).resolve().parents[3]
if not list((BUILD / "python/asdic").glob("_core*.so")):
    print("the Python package was not built here")
    sys.exit(77)
sys.path.insert(0, str(BUILD / "python"))
REAL = importlib.util.find_spec("pyarrow") is not None

import asdic  # noqa: E402

def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


WITHOUT = """
import sys
sys.path.insert(0, {path!r})
sys.modules["pyarrow"] = None
import asdic
try:
    asdic.to_parquet("a.h5", "a.parquet")
except ModuleNotFoundError as error:
    print(error)
"""


class Written:
    """What the stand-in was given"""
    def __init__(self):
        self.schema, self.tables, self.groups, self.fails = None, [], [], None


def stand_in():
    """→ (modules by name, Written): the names of pyarrow that are used, with its signatures"""
    taken = Written()
    arrow, parquet = types.ModuleType("pyarrow"), types.ModuleType("pyarrow.parquet")
    for kind in ("int32", "int64", "float64", "bool_", "string"):
        setattr(arrow, kind, lambda kind=kind: kind)
    arrow.dictionary = lambda index_type, value_type: ("dictionary", index_type, value_type)
    arrow.field = lambda name, type, nullable=True, metadata=None: types.SimpleNamespace(
        name=name, type=type, metadata=dict(metadata or {}))
    arrow.schema = lambda fields, metadata=None: types.SimpleNamespace(fields=list(fields), metadata=metadata)
    arrow.array = lambda values, type=None: np.array(values, object) if type else np.asarray(values)

    class DictionaryArray:
        @staticmethod
        def from_arrays(indices, dictionary):
            return np.array([None if k is None else dictionary[k] for k in indices], object)

    class Table:
        @staticmethod
        def from_arrays(arrays, schema=None):
            assert len(arrays) == len(schema.fields)
            assert len({len(one) for one in arrays}) == 1
            return arrays

    class ParquetWriter:
        def __init__(self, where, schema):
            taken.schema, self.file = schema, open(where, "wb")

        def __enter__(self):
            return self

        def __exit__(self, *_):
            self.file.close()

        def write_table(self, table, row_group_size=None):
            if taken.fails and len(taken.tables) == taken.fails:
                raise OSError("no space left on device")
            assert len(table[0]) <= row_group_size
            taken.tables.append(table)

    arrow.DictionaryArray, arrow.Table, parquet.ParquetWriter = DictionaryArray, Table, ParquetWriter
    arrow.parquet = parquet
    return {"pyarrow": arrow, "pyarrow.parquet": parquet}, taken


class Parquet(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = Path(cls.folder.name)
        cls.file = cls.path / "study.h5"
        plan = cls.path / "study.toml"
        text = (ROOT / "scenarios/studies/known_answer.toml").read_text()
        plan.write_text(text.replace("[measure]", 'season = { law = "categorical", '
                                     'values = ["winter", "summer"], keys = [] }\n\n[measure]', 1))
        subprocess.run([PROGRAM, "study", plan, "-o", cls.file, "--quiet", "--set", "study.realisations=250"],
                       check=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        if not REAL:
            modules, self.taken = stand_in()
            sys.modules.update(modules)
        sys.modules.pop("asdic.parquet", None)

    def tearDown(self):
        sys.modules.pop("asdic.parquet", None)
        if not REAL:
            for name in ("pyarrow", "pyarrow.parquet"):
                sys.modules.pop(name, None)

    def columns(self, output):
        """→ {name: values} as written, and {name: metadata}"""
        if REAL:
            import pyarrow.parquet as pq
            table = pq.read_table(output)
            return ({name: np.array(table[name].to_pylist(), object) for name in table.column_names},
                    {field.name: {k.decode(): v.decode() for k, v in (field.metadata or {}).items()}
                     for field in table.schema})
        names = [field.name for field in self.taken.schema.fields]
        return ({name: np.concatenate([np.asarray(table[k], object) for table in self.taken.tables])
                 for k, name in enumerate(names)},
                {field.name: field.metadata for field in self.taken.schema.fields})

    def test_every_value_unit_and_label_is_there(self):
        output = self.path / "a.parquet"
        self.assertEqual(asdic.to_parquet(self.file, output, rows=100), 250)
        found, told = self.columns(output)
        with h5py.File(self.file) as file:
            self.assertEqual(set(found), {"index", "valid", *file["table"]})
            self.assertEqual(found["index"].tolist(), file["index"][()].tolist())
            for name, dataset in file["table"].items():
                truth = dataset[()]
                if name == "season":
                    labels = [text(one) for one in dataset.attrs["labels"]]
                    self.assertEqual(found[name].tolist(), [labels[int(k)] for k in truth])
                    continue
                np.testing.assert_array_equal(found[name].astype(float), truth)
                self.assertEqual(told[name].get("unit"), text(dataset.attrs["units"]))
                self.assertEqual(told[name]["role"], text(dataset.attrs["role"]))
        self.assertEqual(told["range"]["unit"], "m")
        self.assertFalse((self.path / "a.parquet.part").exists())
        if not REAL:
            self.assertEqual([len(table[0]) for table in self.taken.tables], [100, 100, 50])
            self.assertEqual(self.taken.schema.metadata["complete"], "true")
            self.assertEqual(len(self.taken.schema.metadata["identity"]), 64)

    def test_what_is_there_is_not_written_over(self):
        output = self.path / "mine.parquet"
        output.write_text("mine")
        with self.assertRaisesRegex(asdic.InputError, "mine.parquet, which is there"):
            asdic.to_parquet(self.file, output)
        self.assertEqual(output.read_text(), "mine")

    def test_another_file_is_refused(self):
        other = self.path / "other.h5"
        with h5py.File(other, "w") as file:
            file["x"] = 1
        with self.assertRaisesRegex(asdic.InputError, "no study's file"):
            asdic.to_parquet(other, self.path / "b.parquet")

    def test_a_full_disk_leaves_nothing(self):
        if REAL:
            self.skipTest("of the stand-in")
        self.taken.fails = 1
        with self.assertRaises(OSError):
            asdic.to_parquet(self.file, self.path / "c.parquet", rows=100)
        self.assertEqual(list(self.path.glob("c.parquet*")), [])

    def test_without_pyarrow_it_says_what_to_do(self):
        said = subprocess.run([sys.executable, "-c", WITHOUT.format(path=str(BUILD / "python"))], check=True,
                              capture_output=True, text=True).stdout
        self.assertIn("pip install pyarrow", said)
        self.assertIn("asdic.read_study", said)


if __name__ == "__main__":
    unittest.main()
