"""19 m of water at 3.4 kHz: asdic against the energy of all images."""
from pathlib import Path

import numpy as np
import suite

NAME = "19 m of water, 3.4 kHz"
TRUTH = "energy of all images"
QUICK = False
TIMES = np.array([0.5, 0.75, 1.0, 1.25, 1.5])
MANY = {"propagation__max_bottom_bounces": 24, "propagation__max_surface_bounces": 24}


def compare(asdic, truth):
    runs = [suite.Reverberation("24 bounces", MANY, TIMES, 16),
            suite.Reverberation("default bounces", {}, TIMES, 24)]
    return suite.compare_reverberation(asdic, Path(__file__).with_name("scenario.toml"),
                                       lambda t: truth.levels(t, 0.25), runs, truth.PULSE, 0.25,
                                       truth_name="all images")
