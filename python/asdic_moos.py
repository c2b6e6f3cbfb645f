#!/usr/bin/env python3
"""An active sonar in a MOOS community: asdic_moos.py MISSION.moos [NAME]. The command
asdic-moos.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from asdic_middleware.moos_app import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main())
