"""Late decay, asdic and all images against Harrison's closed form."""
from pathlib import Path

import numpy as np
import suite

NAME = "Harrison's late decay"
TRUTH = "closed form, all images"
QUICK = False
TIMES = np.array([1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0])


def compare(asdic, truth):
    runs = [suite.Reverberation("12 bounces", {}, TIMES, 48)]
    result = suite.compare_reverberation(asdic, Path(__file__).with_name("scenario.toml"),
                                         truth.levels, runs, truth.PULSE, truth_name="all images")
    late = np.array([7.0, 10.0, 14.0, 20.0])
    off = truth.closed_form(late) - truth.levels(late)
    result.checks.append(suite.Check("closed form against all images, 7 to 20 s, worst",
                                     float(max(off, key=abs)), 0.05))
    return result
