"""Lossless guide, reverberation: asdic against closed form."""
from pathlib import Path

import suite

NAME = "Lossless guide, reverberation"
TRUTH = "closed form"
QUICK = True


def compare(asdic, truth):
    return suite.compare_reverberation(asdic, Path(__file__).with_name("scenario.toml"),
                                       truth.levels, [suite.DEFAULT_BOUNCES],
                                       truth.PULSE, truth_name=TRUTH)
