#!/usr/bin/env python3
"""Reading a scenario over a ridged ice cover does not search the paths of a ping to their end, and says so.

    ASDIC=path/to/asdic tests/app/validation/validate_in_time.py
"""
import os
import subprocess
import tempfile

ASDIC = os.environ["ASDIC"]

# Four ice keels, each a smooth curve, over 20 s of reverberation: minutes of processor time.
RIDGES = """
[environment]
wind_speed = 0.0
[environment.sound_speed]
kind = "table"
depth = [0, 50, 150, 300, 600, 1200, 2500]
speed = [1436, 1438, 1445, 1455, 1460, 1466, 1487]
[environment.surface]
kind = "table"
grazing_deg = [0, 5, 10, 20, 40, 90]
loss_db = [0.2, 0.8, 1.5, 3.0, 6.0, 8.0]
[environment.surface.shape]
interpolation = "smooth"
range = [-12000, 0, 380, 420, 450, 480, 520, 1150, 1200, 1260, 1320, 1370, 2560, 2600, 2640, 2690, 2730, 6000, 6040,
         6100, 6160, 6200, 12000]
depth = [2, 2, 2, 3, 9, 3, 2, 2, 3, 14, 3, 2, 2, 3, 7, 3, 2, 2, 3, 12, 3, 2, 2]
[environment.bottom]
depth = 2500.0
kind = "fluid"
[platform]
position = [0.0, 0.0, 60.0]
[transmitter]
source_level_db = 215.0
taper = "omnidirectional"
[pulse]
kind = "lfm"
start_frequency = 850.0
end_frequency = 950.0
duration = 0.5
[array]
kind = "vertical"
phones = 8
spacing = 0.8
[[target]]
range = 8000.0
depth = 120.0
strength_db = 15.0
[reverberation]
[reverberation.bottom]
kind = "lambert"
[pings]
recording_duration = 20.0
samples = "baseband"
"""

with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "ridges.toml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(RIDGES)
    run = subprocess.run([ASDIC, "validate", path], capture_output=True, text=True, check=True)
assert "were not looked at to the end" in run.stdout, run.stdout
assert run.stdout.rstrip().endswith(": good"), run.stdout
print("validate ends and says what it did not look at")
