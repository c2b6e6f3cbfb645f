#!/usr/bin/env python3
"""`asdic export --mat` and `--wav` hold what the ping file holds: real and complex, one phone and
several, with targets and without; nothing of another ping. SciPy reads the MAT-files, and Octave
where it is installed and ASDIC_DEEP is set.

    ASDIC=build/release/bin/asdic mat_files.py
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import h5py
import numpy as np
import scipy.io

ASDIC = os.environ["ASDIC"]
ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/support"))
from deep import DEEP  # noqa: E402

SMALL = ["--set", "pings.recording_duration=2", "--set", "reverberation.enabled=false", "--quiet"]
RUNS = {  # name: (scenario, options)
    "real": ("deep_ocean.toml", ["--set", "array.phones=3", "--set", "pings.count=2",
                                 "--set", "target.0.range=700.0", "--set", "target.0.depth=4300.0"]),
    "complex": ("bistatic.toml", ["--set", "pings.recording_duration=9"]),
    "stereo": ("bistatic.toml", ["--set", "array.phones=1"]),
}


def asdic(*words, status=0):
    done = subprocess.run([ASDIC, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == status, f"asdic {words}: {done.returncode}\n{done.stderr}"
    return done.stdout + done.stderr


def column(values):
    return np.asarray(values, float).reshape(-1)


def same(name, found, expected):
    assert np.array_equal(np.asarray(found), np.asarray(expected), equal_nan=True), name


def check_mat(mat, file, ping):
    """Everything in a MAT-file is what the ping file says, bit by bit."""
    valid = file["valid_samples"][ping]
    pressure = file["pressure"][ping][:, :valid]
    told = file["pressure"].attrs
    if "iq" in file:
        pressure = pressure[..., 0] + 1j * pressure[..., 1]
        assert np.iscomplexobj(mat["pressure"]) and np.iscomplexobj(mat["replica"])
        assert mat["carrier"].item() == told["carrier_hz"]
        replica = file["replica"][:, 0] + 1j * file["replica"][:, 1]
    else:
        assert not np.iscomplexobj(mat["pressure"]) and mat["carrier"].item() == 0
        replica = file["replica"][:]
    assert mat["pressure"].real.dtype == np.float32
    same("pressure", mat["pressure"], pressure.T)
    same("replica", mat["replica"][:, 0], replica)
    same("time", mat["time"][:, 0], told["time_start"] + np.arange(valid) * told["time_step"])
    assert mat["sample_rate"].item() == told["sample_rate_hz"]
    number = file["ping"][ping]
    assert mat["ping"].item() == number
    for name in ("ping_time", "elevation_deg", "transmitter"):
        assert mat[name].item() == file[name][ping], name
    same("phone_position", mat["phone_position"], file["phone_position"][ping])
    same("platform_position", mat["platform_position"].ravel(), file["platform_position"][ping])
    same("channel_array", mat["channel_array"].ravel(), file["channel_array"][:])
    if "target_position" in file:
        same("target_position", mat["target_position"], file["target_position"][ping])
    assert mat["scenario"].item() == file["scenario"][()].decode()
    for group in ("echoes", "arrivals"):
        if group not in file:
            continue
        table = mat[group][0, 0]
        of_ping = file[f"{group}/ping"][:] == number
        assert len(table.dtype.names) >= 10
        for name in table.dtype.names:
            same(f"{group}.{name}", column(table[name]), file[f"{group}/{name}"][of_ping])
    units = mat["units"][0, 0]
    assert units["pressure"].item() == "Pa" and units["time"].item() == "s"
    assert units["echoes"][0, 0]["delay"].item() == "s"
    assert units["echoes"][0, 0]["level_db"].item() == "dB"


def check_wav(path, file, ping):
    """Channels are phones, of baseband I and Q of each; scale and carrier stand beside them."""
    beside = json.loads(Path(f"{path}.json").read_text())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", scipy.io.wavfile.WavFileWarning)  # of who wrote it
        _, sound = scipy.io.wavfile.read(path)
    sound = sound.reshape(len(sound), -1) * beside["pascal_per_unit"]
    pressure = file["pressure"][ping][:, :file["valid_samples"][ping]]
    if "iq" in file:
        assert beside["carrier_hz"] == file["pressure"].attrs["carrier_hz"]
        expected = np.moveaxis(pressure, 2, 1).reshape(-1, pressure.shape[1]).T
    else:
        assert "carrier_hz" not in beside
        expected = pressure.T
    assert sound.shape == expected.shape == (beside["samples"], beside["channels"])
    # Two roundings to float, 2⁻²⁴ each, of full scale.
    assert np.max(np.abs(sound - expected)) <= 1.2e-7 * beside["pascal_per_unit"]


def check_octave(path, file, ping):
    """Octave sees the same numbers, names and texts."""
    told = subprocess.run(
        ["octave-cli", "--no-init-file", "--eval",
         f"s = load('{path}'); p = double(s.pressure); "
         "printf('%d %d %d\\n', size(p), iscomplex(p)); "
         "printf('%.17g\\n', sum(abs(p(:)).^2), s.time(end), s.phone_position(end, 3), "
         "sum(s.echoes.delay), real(s.replica(10))); "
         "printf('%s\\n', s.units.pressure, s.units.echoes.arrival_bearing_deg, s.array_names{1})"],
        capture_output=True, text=True, check=True)
    said = [line for line in told.stderr.splitlines() if "preparing to exit" not in line]
    assert not said, said  # (Octave 7.3 on its way out without a display)
    lines = told.stdout.splitlines()
    valid = file["valid_samples"][ping]
    pressure = file["pressure"][ping][:, :valid].astype(float)
    rows, columns, is_complex = map(int, lines[0].split())
    assert (rows, columns, bool(is_complex)) == (valid, len(pressure), "iq" in file)
    of_ping = file["echoes/ping"][:] == file["ping"][ping]
    attrs = file["pressure"].attrs
    expected = [np.sum(pressure ** 2), attrs["time_start"] + (valid - 1) * attrs["time_step"],
                file["phone_position"][ping][-1, 2], np.sum(file["echoes/delay"][of_ping]),
                np.ravel(file["replica"][9])[0]]
    # Sums in another order: 10⁵ terms of rounding 10⁻¹⁶ each.
    np.testing.assert_allclose([float(x) for x in lines[1:6]], expected, rtol=1e-11)
    names = file["channel_array"].attrs["names"]
    assert lines[6:] == ["Pa", "degree", np.ravel(names)[0].decode().split(",")[0]], lines


def main():
    octave = shutil.which("octave-cli") if DEEP else None
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for name, (scenario, options) in RUNS.items():
            ping = folder / f"{name}.h5"
            asdic("ping", ROOT / "scenarios" / scenario, "-o", ping, *SMALL, *options)
            asdic("export", ping, "--mat", "--wav", "-o", folder)
            with h5py.File(ping) as file:
                count = len(file["ping"])
                for k in range(count):
                    path = folder / f"{name}_ping{k + 1:03}.mat"
                    check_mat(scipy.io.loadmat(path), file, k)
                    check_wav(path.with_suffix(".wav"), file, k)
                    if octave:
                        check_octave(path, file, k)
                print(f"{name}: {count} pings, {file['pressure'].shape}, "
                      f"{len(file['echoes/delay'])} echoes")
        said = asdic("info", folder / "stereo_ping001.wav")
        assert "1 phone as I and Q about" in said, said
        # Somebody's file is not written over, ours is.
        asdic("export", folder / "real.h5", "--mat", "-o", folder, "--ping", "2")
        (folder / "real_ping002.mat").write_text("mine")
        said = asdic("export", folder / "real.h5", "--mat", "-o", folder, status=2)
        assert "real_ping002.mat" in said, said
        check_limits(folder)
    print("Octave reads the same" if octave else "Octave is asked where ASDIC_DEEP is set")


def check_limits(folder):
    """More channels than a WAV file holds are refused, and the message says what takes them."""
    wide = folder / "wide.h5"
    shutil.copyfile(folder / "stereo.h5", wide)
    with h5py.File(wide, "r+") as file:
        told = dict(file["pressure"].attrs)
        samples = int(file["valid_samples"][0])
        del file["pressure"]
        pressure = file.create_dataset("pressure", data=np.zeros((1, 600, samples, 2), np.float32),
                                       maxshape=(None, 600, samples, 2))
        for key in ("sample_rate_hz", "time_start", "time_step", "carrier_hz", "units"):
            pressure.attrs[key] = told[key]
    said = asdic("export", wide, "--wav", "-o", folder / "none", status=2)
    assert "600 phones, 1200 channels, expected at most 1024 channels" in said, said
    assert not (folder / "none").exists()
    asdic("export", wide, "--mat", "-o", folder / "wide")


if __name__ == "__main__":
    sys.exit(main())
