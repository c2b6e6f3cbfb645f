#!/usr/bin/env python3
"""Writes a synthetic ping file, laid out as docs/formats/ping.md says.

    make_ping_file.py OUT.h5 [--array horizontal|vertical|volume] [--pings N] [--no-target] …
"""
from __future__ import annotations

import argparse

import h5py
import numpy as np
from plausible_ping import (Settings, add_echo, analytic_pulse, eigenrays, munk, simulate, trace,
                            travel_direction)

# What tests take from here besides `write`.
__all__ = ["Settings", "add_echo", "travel_direction", "write"]


# Each table with its dimension and its columns.
TABLES = {
    "arrivals": ("arrival",
        "ping leg target channel path bearing_deg range launch_elevation_deg "
        "arrival_elevation_deg launch_deflection_deg arrival_deflection_deg delay "
        "amplitude_real amplitude_imag spreading_db "
        "absorption_db scattered path_length surface_bounces bottom_bounces upper_turns "
        "lower_turns caustics first_bounce bounce_count"),
    "bounces": ("bounce",
        "boundary grazing_deg range"),
    "echoes": ("echo",
        "ping target channel highlight outgoing returning delay doppler_factor level_db "
        "arrival_elevation_deg arrival_bearing_deg"),
    "patches": ("patch",
        "ping boundary range area delay grazing_in_deg grazing_out_deg launch_elevation_deg "
        "arrival_elevation_deg scattering_strength_db level_db"),
}


def put(group, name, data, long_name, units=None, scales=(), dtype=None):
    d = group.create_dataset(name, data=np.asarray(data, dtype=dtype))
    d.attrs["long_name"] = long_name
    if units:
        d.attrs["units"] = units
    for axis, scale in enumerate(scales):
        if scale is not None:
            d.dims[axis].attach_scale(scale)
    return d


def scale(group, name, data, long_name, units=None, dtype=None):
    d = put(group, name, data, long_name, units, (), dtype)
    d.make_scale(name)
    return d


def time_axis(f, s, dimension, coordinate, times, long_name):
    """The axis of a dataset's samples, and the dataset's attributes that tell their times. Version 1
    has the times as the axis' scale, version 2 a dimension without values.
    """
    if s.version == 1:
        return scale(f, coordinate, times, long_name, "s"), {}
    axis = f.create_dataset(dimension, (len(times),), ">f4")
    axis.make_scale(f"This is a netCDF dimension but not a netCDF variable.{len(times):10d}")
    told = {"time_start": times[0] if len(times) else 0.0,
            "time_step": times[1] - times[0] if len(times) > 1 else 1.0}
    axis.attrs.update(long_name=f"no values: {long_name}", **told)
    return axis, told


def unit_of(name):
    if name.endswith("_deg"):
        return "degrees"
    if name.endswith("_db"):
        return "dB"
    return {"range": "m", "delay": "s", "path_length": "m", "area": "m2",
            "echo_time": "s"}.get(name)


def table(file, name, dimension, columns, rows):
    """A table is a group of 1-D columns over one dimension."""
    group = file.create_group(name)
    rows = np.array(rows, float).reshape(-1, len(columns))
    index = scale(group, dimension, np.arange(len(rows)), "row", dtype=np.int32)
    whole = {"ping", "leg", "target", "channel", "highlight", "path", "outgoing", "returning", "surface_bounces",
             "bottom_bounces", "upper_turns",
             "lower_turns", "caustics", "first_bounce", "bounce_count", "boundary"}
    for column, values in zip(columns, rows.T):
        put(group, column, values, column.replace("_", " "), unit_of(column), (index,),
            np.int32 if column in whole else np.float64)
    return group


def write(path, s: Settings):
    """Simulates and writes one file. → what simulate() made"""
    result = simulate(s)
    with h5py.File(path, "w") as f:
        write_root(f, s, result)
        environment = f.create_group("environment")
        depth = scale(environment, "depth", np.linspace(0, s.water, 500), "depth below the surface",
                      "m")
        put(environment, "sound_speed", munk(depth[()]), "speed of sound", "m/s", (depth,))
        environment.attrs.update(surface="vacuum", bottom="fluid, 1600 m/s", bottom_depth_m=s.water,
                                 wind_speed_mps=10.0,
                                 absorption="thorp", interpolation="spline", scattering_model="nrl",
                                 transmitter_line_length_m=5.0)
        for name, (dimension, columns) in TABLES.items():
            table(f, name, dimension, columns.split(), result.get(name, []))
        f["patches"].attrs["every"] = 1
        write_levels_and_rays(f, s, result)
    return result


def write_root(f, s, result):
    n = result["pressure"].shape[2]
    f.attrs.update(filetype="asdic ping", version="1.0" if s.version == 1 else "3.3",
                   title="Synthetic ping in deep water", program_version="0.1.0",
                   build="none", seed=s.seed, scenario_sha256="0" * 64,
                   complete=int((s.pings_requested or s.pings) == s.pings),
                   pings_requested=s.pings_requested or s.pings)
    ping = scale(f, "ping", np.arange(1, s.pings + 1), "number of the ping", dtype=np.int32)
    channel = scale(f, "channel", np.arange(len(result["offsets"])), "number of the phone",
                    dtype=np.int32)
    time, told = time_axis(f, s, "sample", "time", np.arange(n) / s.sample_rate,
                           "time after the start of the ping")
    xyz = scale(f, "xyz", np.arange(3), "0 east, 1 north, 2 depth", dtype=np.int32)
    p = f.create_dataset("pressure", data=result["pressure"], chunks=(1, 1, n) if n else None)
    for axis, axis_scale in enumerate((ping, channel, time)):
        p.dims[axis].attach_scale(axis_scale)
    p.attrs.update(long_name="acoustic pressure", units="Pa", sample_rate_hz=s.sample_rate, **told,
                   reference="p = Re{Σ A s₊(η(t − τ))}, time dependence exp(+iωt)")
    count = np.arange(s.pings)
    put(f, "valid_samples", np.full(s.pings, n), "samples that were simulated", None, (ping,),
        np.int64)
    put(f, "ping_time", s.interval * count, "start of the ping", "s", (ping,), float)
    put(f, "elevation_deg", [s.elevations[i % len(s.elevations)] for i in count],
        "elevation of the beam", "degrees", (ping,), float)
    platform = np.tile([0.0, 0.0, s.depth], (s.pings, 1))
    put(f, "platform_position", platform, "position of the platform", "m", (ping, xyz))
    put(f, "platform_velocity", 0 * platform, "velocity of the platform", "m/s", (ping, xyz))
    put(f, "phone_position", platform[:, None] + result["offsets"], "positions of the phones", "m",
        (ping, channel, xyz))
    if s.targets:
        index = scale(f, "target_index", np.arange(len(s.targets)), "number of the target",
                      dtype=np.int32)
        index.attrs["names"] = [f"target {i + 1}" for i in range(len(s.targets))]
        r, b, z = np.array(s.targets).T
        r = r - s.target_speed * s.interval * count[:, None]
        b = np.radians(b)
        position = np.stack([r * np.sin(b), r * np.cos(b), 0 * r + z], axis=2)
        velocity = np.broadcast_to(np.stack([-np.sin(b), -np.cos(b), 0 * b],
                                            axis=1) * s.target_speed, position.shape)
        put(f, "target_position", position, "positions of the targets", "m", (ping, index, xyz))
        put(f, "target_velocity", velocity, "velocities of the targets", "m/s", (ping, index, xyz))
        put(f, "target_strength_db", np.full(r.shape, s.strength), "target strength", "dB",
            (ping, index))
        put(f, "target_present", np.ones(r.shape), "1 where the target is there", None,
            (ping, index), np.int8)
    t = np.arange(int(np.ceil(s.pulse * s.sample_rate)) + 1) / s.sample_rate
    replica_time, told = time_axis(f, s, "replica_sample", "replica_time", t,
                                   "time after the leading edge")
    replica = put(f, "replica", analytic_pulse(t, s).real, "transmitted pulse", None,
                  (replica_time,), np.float32)
    replica.attrs.update(kind="lfm" if s.bandwidth else "cw", centre_frequency_hz=s.frequency,
                         bandwidth_hz=s.bandwidth + 6.0 / s.pulse, duration_s=s.pulse,
                         window="hann", source_level_db=s.source_level, **told)
    if s.version > 1:
        replica.attrs["sweep_hz"] = s.bandwidth
    text = f.create_dataset("scenario", data="title = \"synthetic\"\n")
    text.attrs["long_name"] = "the scenario file"


def write_levels_and_rays(f, s, result):
    levels = f.create_group("levels")
    count = result["levels"]["noise"].shape[1]
    time, told = time_axis(levels, s, "interval", "level_time", np.arange(count) * result["step"],
                           "time after the start of the ping")
    for key, values in result["levels"].items():
        put(levels, key, values, f"mean-square pressure of {key}", "Pa2", (f["ping"], time),
            np.float32).attrs.update(told)
    if s.targets:
        summary = f.create_group("summary")
        rows = np.array(result["summary"], float)
        for k, (name,
                kind) in enumerate([("present", np.int8), ("paths", np.int32), ("echo_time", float),
                                    ("echo_level_db", float)]):
            put(summary, name, rows[:, :, k], name.replace("_", " "), unit_of(name),
                (f["ping"], f["target_index"]), kind)
        put(summary, "array", np.zeros(rows.shape[:2]), "array that receives it best", None,
            (f["ping"], f["target_index"]), np.int32)
        for name, value in (("reverberation_db", 60.0), ("noise_db", 50.0),
                            ("echo_peak_db", 91.0), ("echo_to_background_db", 10.0), ("signal_excess_db", 10.0)):
            put(summary, name, np.full(rows.shape[:2], value), name.replace("_", " "), "dB",
                (f["ping"], f["target_index"]))
    axis = s.elevations[0]
    wanted = [(a, reach, 0) for a,
              reach in ((a, result["reach"]) for a in np.linspace(axis - 6, axis + 6, 41))]
    for distance, _, depth in s.targets:
        wanted += [(a, distance, 1)
                   for a in eigenrays(s, distance, depth)[0] if distance < result["reach"] * 1.2]
    r, z, _, _, bounces = trace([a for a, _, _ in wanted], s,
                                max([result["reach"]] + [t[0] for t in s.targets]))
    end = np.array([reach for _, reach, _ in wanted])[:, None]
    r, z = np.where(r <= end, r, np.nan)[:, ::4], np.where(r <= end, z, np.nan)[:, ::4]
    group = f.create_group("rays")
    ray = scale(group, "ray", np.arange(len(wanted)), "number of the ray", dtype=np.int32)
    point = scale(group, "point", np.arange(r.shape[1]), "point of the ray", dtype=np.int32)
    put(group, "launch_elevation_deg", [a for a, _, _ in wanted], "elevation at launch", "degrees",
        (ray,))
    put(group, "range", r, "horizontal range", "m", (ray, point))
    put(group, "depth", z, "depth", "m", (ray, point))
    put(group, "kind", [k for _, _, k in wanted], "0 fan, 1 eigenray", None, (ray,), np.int8)
    fan = np.array([k == 0 for _, _, k in wanted])
    hits = [row_r[i] for row_r,
            row_b in zip(r[fan], bounces[fan][:, ::4])
            for i in [int(np.argmax(row_b > 0))] if row_b.max() > 0]
    hit = scale(group, "hit", np.arange(len(hits)), "number of the hit", dtype=np.int32)
    put(group, "hit_range", hits, "where the fan meets the surface", "m", (hit,), float)
    run = f.create_group("run")
    run.attrs.update(host="test", started="2000-01-01T00:00:00Z", cpu="none", threads=1,
                     library_versions="none")
    for name in ("rays", "eigenrays", "patches", "synthesis", "noise", "write"):
        put(run, f"time_{name}", np.zeros(s.pings), f"wall time of {name}", "s", (f["ping"],))
    for name in ("reuse_ocean", "legs_searched", "legs_reused", "planes_searched",
                 "planes_reused", "reuse_reverberation", "reuse_expected_level", "band_points", "band_error",
                 "surface_bounces", "bottom_bounces"):
        put(run, name, np.zeros(s.pings), "what was known", None, (f["ping"],), np.int32)
    put(run, "ended_searches", np.zeros(s.pings, np.int32), "for paths in three dimensions", "", (f["ping"],))
    put(run, "sea_drawn_anew", np.zeros(s.pings, np.int8), "1 if weights that last are drawn anew", "", (f["ping"],))
    put(run, "left_out_db", np.zeros(s.pings), "of the level", "dB", (f["ping"],))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out")
    parser.add_argument("--array", default="horizontal",
                        choices=["horizontal", "vertical", "volume"])
    parser.add_argument("--pings", type=int, default=1)
    parser.add_argument("--phones", type=int, default=16)
    parser.add_argument("--elevations", type=float, nargs="+", default=[8.0])
    parser.add_argument("--duration", type=float, default=60.0)
    parser.add_argument("--no-target", action="store_true")
    parser.add_argument("--no-noise", action="store_true")
    parser.add_argument("--no-reverberation", action="store_true")
    a = parser.parse_args()
    s = Settings(array=a.array, pings=a.pings, phones=a.phones, elevations=a.elevations,
                 duration=a.duration,
                 reverberation=not a.no_reverberation)
    if a.no_target:
        s.targets = []
    if a.no_noise:
        s.noise_level = None
    write(a.out, s)


if __name__ == "__main__":
    main()
