#!/usr/bin/env python3
"""Datasets of asdic's can be kept and sent: netCDF by both engines, copies, pickles, other processes."""
import concurrent.futures
import copy
import importlib.util
import multiprocessing
import os
import pickle
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

BUILD, PROGRAM = Path(os.environ["ASDIC_BUILD"]), os.environ["ASDIC"]
SCENARIOS = Path(__file__).resolve().parents[3] / "scenarios"
if not list((BUILD / "python/asdic").glob("_core*.so")):
    print("the Python package was not built here")
    sys.exit(77)
sys.path.insert(0, str(BUILD / "python"))

import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
import xarray as xr  # noqa: E402

import asdic  # noqa: E402
from asdic import pictures  # noqa: E402

warnings.simplefilter("ignore", asdic.AsdicWarning)
ENGINES = [name for name, module in (("netcdf4", "netCDF4"), ("h5netcdf", "h5netcdf"))
           if importlib.util.find_spec(module)]


def modem(**changes):
    s = asdic.Scenario(SCENARIOS / "modem.toml")
    for path, value in changes.items():
        s.set(path.replace("__", "."), value)
    return s


def baseband():
    return modem(pings__samples="baseband", pings__sample_rate=None)


def loudest(ping):
    return float(abs(ping.pressure).max())


def detections(ping):
    return asdic.process(ping).detections


class Kept(unittest.TestCase):
    """What comes back is what was sent, bit by bit."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def made(self):
        """Datasets and arrays of every kind."""
        yield "ping", modem().ping()
        yield "complex baseband", baseband().ping()
        warned = asdic.Scenario(SCENARIOS / "isovelocity.toml")
        ping = warned.ping()
        self.assertTrue(ping.attrs["warnings"])
        yield "a ping with warnings", ping
        modem().write(self.folder / "i.h5")
        subprocess.run([PROGRAM, "process", self.folder / "i.h5", "-q"], check=True)
        yield "a processed file", asdic.open(self.folder / "i.h5", load=False)
        yield "paths of a channel", modem().channel().paths
        yield "a waveform", modem().waveform()
        deep = asdic.Scenario(SCENARIOS / "deep_ocean.toml")
        yield "sound speed", deep.sound_speed([0.0, 10.0])
        yield "a field", deep.field(frequency=50.0, source_depth=1000.0, depths=[500.0], ranges=[1e3, 2e3])
        yield "an area", asdic.area(warned, [40.0], reach=3e3, bearings=8, ranges=8)
        yield "a run", asdic.Scenario(sound_speed=1500.0, bathymetry=200.0, bottom={"kind": "rigid"}, run={
            "task": "arrivals", "frequency": 1000.0, "source": {"depth": 30.0},
            "receivers": {"depth": [60.0], "range": [2000.0]}}).run()
        asdic.study(SCENARIOS / "studies/known_answer.toml", self.folder / "st.h5", set={"study.realisations": 20})
        yield "a study", asdic.open(self.folder / "st.h5")

    def test_every_dataset(self):
        for number, (what, data) in enumerate(self.made()):
            for way, back in (("pickle", pickle.loads(pickle.dumps(data))), ("deepcopy", copy.deepcopy(data)),
                              ("copy", data.copy(deep=True))):
                with self.subTest(what, way=way):
                    xr.testing.assert_identical(back, data)
            for engine in ENGINES:
                with self.subTest(what, engine=engine):
                    file = self.folder / f"{number}{engine}.nc"
                    asdic.as_pairs(data).to_netcdf(file, engine=engine)
                    read = xr.load_dataarray if isinstance(data, xr.DataArray) else xr.load_dataset
                    xr.testing.assert_equal(asdic.as_complex(read(file, engine=engine, decode_times=False)),
                                            asdic.as_complex(data))

    def test_names_have_no_slash(self):
        ping = modem().ping()
        self.assertFalse([name for name in (*ping.variables, *ping.dims, *ping.attrs) if "/" in name])
        np.testing.assert_array_equal(ping["echoes.delay"], ping.asdic.group("echoes").delay)
        modem().write(self.folder / "i.h5")
        file = asdic.open(self.folder / "i.h5")
        self.assertFalse([name for name in (*file.variables, *file.dims, *file.attrs) if "/" in name])

    def test_a_ping_of_a_file_or_a_pickle_is_a_ping(self):
        """It is simulated again, which gives the same bits, so whatever takes a ping takes it."""
        for ping in (modem().ping(), baseband().ping()):
            wanted = asdic.process(ping).detections
            asdic.as_pairs(ping).to_netcdf(self.folder / "p.nc")
            for back in (pickle.loads(pickle.dumps(ping)), copy.deepcopy(ping), asdic.open(self.folder / "p.nc"),
                         xr.load_dataset(self.folder / "p.nc")):
                pd.testing.assert_frame_equal(asdic.process(back).detections, wanted)
            (self.folder / "p.nc").unlink()
        with self.assertRaisesRegex(asdic.InputError, "changed"):
            asdic.process(pickle.loads(pickle.dumps(ping.assign(pressure=0.0 * ping.pressure))))
        pictures.levels(back)

    def test_a_lazy_file_is_opened_again_where_it_is(self):
        """By its path, in a process with another working directory."""
        modem().write(self.folder / "m.h5")
        before = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)
        (self.folder / "sent").write_bytes(pickle.dumps(asdic.open("m.h5", load=False)))
        done = subprocess.run([sys.executable, "-c", "import pickle, sys; p = pickle.load(open(sys.argv[1], 'rb')); "
                               "print(float(abs(p.pressure).max()), p['echoes.delay'].size)", self.folder / "sent"],
                              cwd="/", check=True, capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": str((before / BUILD).resolve() / "python")})
        whole = asdic.open("m.h5", load=True)
        self.assertEqual(done.stdout.split(), [str(loudest(whole)), str(whole["echoes.delay"].size)])

    def test_other_processes(self):
        pings = list(modem(pings__count=2, pings__interval=2.0).pings())
        channel, sent = modem().channel(duration=0.1), np.random.default_rng(1).standard_normal(960)
        with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as pool:
            back = list(pool.map(asdic.Scenario.ping, [modem(), baseband()]))
            found = list(pool.map(detections, pings))
            heard = pool.submit(channel, sent, 48e3).result()
        for mine, theirs in zip((modem().ping(), baseband().ping()), back):
            xr.testing.assert_identical(theirs, mine)
        xr.testing.assert_identical(heard, channel(sent, 48e3))
        for ping, theirs in zip(pings, found):
            pd.testing.assert_frame_equal(theirs, detections(ping))

    @unittest.skipUnless(importlib.util.find_spec("dask"), "no dask here")
    def test_dask(self):
        import dask

        pings = [dask.delayed(modem(seed=seed).ping)() for seed in (1, 2)]
        found = dask.compute(*map(dask.delayed(loudest), pings), scheduler="threads")
        self.assertEqual(list(found), [loudest(modem(seed=seed).ping()) for seed in (1, 2)])
        chunked = modem().ping().chunk(sample=1000)
        self.assertEqual(loudest(chunked.compute()), loudest(modem().ping()))

    def test_a_scenario_knows_where_it_was_read(self):
        """Files that it names are found from another folder, and what kind of scenario it is is kept."""
        with open(SCENARIOS / "modem.toml", encoding="utf-8") as file:
            text = file.read()
        (self.folder / "ocean.toml").write_text("[environment]\nwind_speed = 7.5\n", encoding="utf-8")
        (self.folder / "s.toml").write_text('include = "ocean.toml"\n'
                                            + text.replace("wind_speed", "# wind_speed"), encoding="utf-8")
        s = pickle.loads(pickle.dumps(asdic.Scenario(self.folder / "s.toml")))
        self.assertEqual(s.environment.wind_speed, 7.5)
        self.assertEqual(asdic.Scenario._of_core(s._core.copy())._core.path(), str(self.folder / "s.toml"))
        case = asdic.bellhop.read(SCENARIOS / "bellhop/munk.env")
        self.assertEqual(pickle.loads(pickle.dumps(case)).notes, case.notes)
        self.assertEqual(type(pickle.loads(pickle.dumps(case))), asdic.bellhop.Case)


if __name__ == "__main__":
    unittest.main(verbosity=1)
