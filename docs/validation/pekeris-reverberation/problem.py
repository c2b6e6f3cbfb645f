"""Pekeris guide, reverberation: asdic against energy of all images."""
from pathlib import Path

import suite

NAME = "Pekeris guide, reverberation"
TRUTH = "energy of all images"
QUICK = False


def compare(asdic, truth):
    return suite.compare_reverberation(asdic, Path(__file__).with_name("scenario.toml"),
                                       truth.levels, [suite.DEFAULT_BOUNCES, suite.TWENTY_BOUNCES],
                                       truth.PULSE, truth_name=TRUTH)
