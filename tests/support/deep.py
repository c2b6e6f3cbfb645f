"""Whether a test is to run in its full form, as scripts/deep_check.sh asks for."""
import os
import unittest

DEEP = os.environ.get("ASDIC_DEEP") == "1"


def in_depth(why):
    """A case of the full form alone: `why` says what runs every day in its place."""
    return unittest.skipUnless(DEEP, f"ASDIC_DEEP=1 runs it; else {why}")
