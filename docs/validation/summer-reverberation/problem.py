"""Summer profile, reverberation: asdic against energy of a ray fan."""
from pathlib import Path

import numpy as np
import suite

NAME = "Summer profile, reverberation"
TRUTH = "energy of a ray fan"
QUICK = False
EARLY, LATE = np.array([3.0, 4.0, 5.0, 6.0]), np.array([3.0, 4.0, 6.0, 8.0, 10.0, 14.0, 18.0])


def compare(asdic, truth):
    runs = [suite.Reverberation("default bounces", {}, LATE, 24,
                                "three bounces by default, and nothing says what is left out"),
            suite.Reverberation("20 bounces", {"propagation__max_bottom_bounces": 20,
                                               "propagation__max_surface_bounces": 20,
                                               "pings__recording_duration": 6.6}, EARLY, 16)]
    return suite.compare_reverberation(asdic, Path(__file__).with_name("scenario.toml"),
                                       truth.levels, runs, truth.PULSE,
                                       truth_name="energy of a ray fan")
