#!/usr/bin/env python3
"""Times over an area as docs/performance.md has them: a region of 220 × 220 km at 15″, water at 1/12°.

    ASDIC=build/ci/bin/asdic /usr/bin/python3 scripts/area_times.py
"""
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

ASDIC = os.path.abspath(os.environ["ASDIC"])
LATITUDE, LONGITUDE, DEGREE = 31.5, -65.5, 111.2e3
LEVELS = [0, 2, 4, 6, 8, 10, 12, 15, 20, 25, 30, 35, 40, 45, 50, 60, 70, 80, 90, 100, 125, 150, 200, 250, 300, 350,
          400, 500, 600, 700, 800, 900, 1000, 1250, 1500, 2000, 2500, 3000, 4000, 5000]

SCENARIO = """title = "ship sonar over a seamount"
[environment]
wind_speed = 7.0
[environment.origin]
latitude_deg = 31.5
longitude_deg = -65.5
[environment.area.bathymetry]
file = "region.nc"
[environment.area.sound_speed]
file = "region.nc"
[environment.bottom]
kind = "fluid"
speed = 1550.0
density = 1500.0
attenuation_db_per_wavelength = 0.1
[platform]
position = [0.0, 0.0, 8.0]
velocity = [3.0, 4.0, 0.0]
[transmitter]
source_level_db = 220.0
elevation_deg = -5.0
beamwidth_deg = 20.0
[pulse]
kind = "lfm"
start_frequency = 3900.0
end_frequency = 4100.0
duration = 0.5
window = "tukey"
tukey_fraction = 0.2
[array]
kind = "horizontal"
phones = 16
spacing = 0.1875
[[target]]
range = 15000.0
bearing_deg = 60.0
depth = 150.0
velocity = [-3.0, 2.0, 0.0]
strength_db = 10.0
[noise]
spectral_level_db = 50.0
[reverberation.surface]
kind = "nrl"
[reverberation.bottom]
kind = "lambert"
mu_db = -27.0
[pings]
count = 2
interval = 200.0
recording_duration = 53.0
samples = "baseband"
"""


def axes(step, reach):
    count = int(reach / DEGREE / step)
    return LATITUDE + step * np.arange(-count, count), LONGITUDE + step * 1.2 * np.arange(-count, count)


def east_north(lat, lon):
    return np.meshgrid((lon - LONGITUDE) * DEGREE * np.cos(np.radians(LATITUDE)), (lat - LATITUDE) * DEGREE)


def region(path):
    """A seamount on hills of 3 to 40 km, and a front with an eddy in a Munk profile."""
    random = np.random.default_rng(1)
    lat, lon = axes(15 / 3600, 110e3)
    x, y = east_north(lat, lon)
    depth = 4000 - np.maximum(0, 3200 * (1 - np.hypot(x - 20e3, y - 5e3) / 18e3))
    for _ in range(60):
        length, towards, phase = random.uniform([3e3, 0, 0], [40e3, 2 * np.pi, 2 * np.pi])
        depth += length / 1e3 * np.sin(2 * np.pi * (x * np.cos(towards) + y * np.sin(towards)) / length + phase)
    with h5py.File(path, "w") as f:
        def put(name, values, scales, **attributes):
            made = f.create_dataset(name, data=values)
            made.attrs.update(attributes)
            if not scales:
                made.make_scale(name)
            for i, scale in enumerate(scales):
                made.dims[i].attach_scale(f[scale])

        put("lat", lat, [], units="degrees_north")
        put("lon", lon, [], units="degrees_east")
        put("elevation", -depth.astype("f"), ["lat", "lon"], units="m")
        lat, lon = axes(1 / 12, 130e3)
        x, y = east_north(lat, lon)
        z = np.array(LEVELS, float)[:, None, None]
        eta = 2 * (z - 1000) / 1000
        warm = 10 * np.exp(-z / 150) * (1 + 0.5 * np.tanh((x + 0.5 * y) / 20e3)) + \
            3 * np.exp(-((x - 30e3) ** 2 + (y + 20e3) ** 2) / 25e3 ** 2) * np.exp(-z / 300)
        put("level", np.array(LEVELS, float), [], units="m", positive="down")
        put("lat_water", lat, [], units="degrees_north")
        put("lon_water", lon, [], units="degrees_east")
        put("sound_speed", (1500 * (1 + 0.0057 * (eta - 1 + np.exp(-eta))) + warm).astype("f"),
            ["level", "lat_water", "lon_water"], units="m/s")


def run(title, folder, *words):
    begin, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    result = subprocess.run([ASDIC, *words, "--force"], cwd=folder, capture_output=True, text=True)
    wall, after = time.monotonic() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    if result.returncode != 0:
        sys.exit(result.stderr)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"{title}: {wall:.1f} s, {cpu:.1f} s of processor time, at most {after.ru_maxrss / 1024:.0f} MiB so far")
    return result.stdout


def main():
    with tempfile.TemporaryDirectory() as folder:
        region(Path(folder) / "region.nc")
        (Path(folder) / "ship.toml").write_text(SCENARIO)
        run("asdic area, 360 bearings, 500 ranges to 40 km", folder, "area", "ship.toml", "--depth", "150",
            "--reach", "40km", "--ranges", "500", "--bearings", "360", "-o", "area.h5", "-q")
        for count in (1, 2):
            for way in ("automatic", "scatterers"):
                said = run(f"asdic ping, pings: {count}, synthesis: {way}", folder, "ping", "ship.toml", "--set",
                           f"pings.count={count}", "--set", f"reverberation.synthesis={way}", "-o", "ping.h5")
                print("   ", next(line for line in said.splitlines() if line.startswith("after preparing:")))


if __name__ == "__main__":
    main()
