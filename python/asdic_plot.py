#!/usr/bin/env python3
"""Pictures of a file of asdic: asdic_plot.py FILE.h5 [-o DIR] [--ping N] [--against B.h5]

Writes PNGs and prints a line for each. Exit code: 0 all written, 1 they could not be written, 2 the
input is wrong.
"""
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

if __name__ == "__main__":
    os.environ["MPLBACKEND"] = "agg"  # draws files and opens no window, whatever the shell sets
    try:
        from asdic_pictures.command import main
    except (OSError, ValueError) as error:  # in matplotlib's own folders or settings
        told = " ".join(str(error).split())
        print(f"asdic plot: matplotlib does not start: {told}; set MPLCONFIGDIR to an empty folder that can be "
              "written to, and unset MATPLOTLIBRC", file=sys.stderr)
        sys.exit(1)

    sys.exit(main())
