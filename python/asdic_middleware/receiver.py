"""The receiver: `asdic process` on the file of one ping."""
import csv
import subprocess
import tempfile
from pathlib import Path

TIME_LIMIT = 600  # of one ping [s]
PLACE = ("x", "y", "depth", "range", "bearing_deg", "range_rate")


class ReceiverError(Exception):
    """What `asdic process` said."""


def process(program, path, options=(), most=50):
    """Detections of a ping, the loudest first.

    most  of them that are told
    → list of dict: ping, array, time [s after the ping], doppler_factor, snr_db, excess_db,
    level_db,
      look_bearing_deg, look_elevation_deg (None: the array cannot tell), and `places`: where it may
      be, up to two (a line hears right and left alike): dicts of x, y, depth, range [m],
      bearing_deg, range_rate [m/s, opening]; how many there were. \\throws ReceiverError
    """
    with tempfile.TemporaryDirectory(prefix="asdic_receiver_") as folder:
        try:
            done = subprocess.run([program, "process", str(path), "--no-file", "--no-maps",
                                   "--quiet", "--csv", folder, *options], capture_output=True,
                                  text=True, timeout=TIME_LIMIT, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            raise ReceiverError(f"not done after {TIME_LIMIT} s") from None
        if done.returncode != 0:
            said = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
            raise ReceiverError(said[-1][:300])
        table = Path(folder) / (Path(path).stem + "_detections.csv")
        with open(table, newline="") as lines:
            rows = list(csv.DictReader(lines))
    found = [_detection(row) for row in rows]
    found.sort(key=lambda d: -d["snr_db"])
    return found[:most], len(found)


def _number(text):
    value = float(text) if text else None
    return None if value is None or value != value else value


def _detection(row):
    """Without `target`: a receiver does not know the truth."""
    one = {name: _number(row[name]) for name in
           ("time", "doppler_factor", "snr_db", "excess_db", "level_db", "look_bearing_deg",
            "look_elevation_deg")}
    one["array"] = int(row["array"])
    sides = ("", "mirror_")[:int(row["places"])]
    one["places"] = [{name: _number(row[side + name]) for name in PLACE} for side in sides]
    return one
