"""Lossless guide, reverberation: asdic against closed form."""
from pathlib import Path

import numpy as np
import suite

NAME = "Lossless guide, reverberation"
TRUTH = "closed form"
QUICK = True
EARLY, LATE = np.array([3.0, 4.0, 5.0, 6.0]), np.array([3.0, 4.0, 6.0, 8.0, 10.0, 14.0, 18.0])


def compare(asdic, truth):
    runs = [suite.Reverberation("default bounces", {}, LATE, 24,
                                "three bounces by default, and nothing says what is left out")]
    return suite.compare_reverberation(asdic, Path(__file__).with_name("scenario.toml"),
                                       truth.levels, runs, truth.PULSE,
                                       truth_name="closed form")
