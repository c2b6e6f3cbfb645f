"""Summer profile, reverberation: asdic against energy of a ray fan."""
from pathlib import Path

import suite

NAME = "Summer profile, reverberation"
TRUTH = "energy of a ray fan"
QUICK = False


def compare(asdic, truth):
    return suite.compare_reverberation(asdic, Path(__file__).with_name("scenario.toml"),
                                       truth.levels, [suite.DEFAULT_BOUNCES, suite.TWENTY_BOUNCES],
                                       truth.PULSE, truth_name=TRUTH)
