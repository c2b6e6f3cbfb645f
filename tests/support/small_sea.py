"""A small sea as text, for tests of commands: one target by one path, one phone, white noise, no
reverberation."""

SEA = """[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 200.0
kind = "rigid"
[platform]
position = [0.0, 0.0, 50.0]
[transmitter]
source_level_db = 200.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 500.0
duration = 0.05
[array]
kind = "horizontal"
phones = 1
spacing = 1.0
[[target]]
position = [500.0, 0.0, 60.0]
strength_db = 10.0
[noise]
spectral_level_db = 40.0
[reverberation]
enabled = false
[propagation]
max_surface_bounces = 0
max_bottom_bounces = 0
[pings]
recording_duration = 1.0
sample_rate = 4000.0
"""
