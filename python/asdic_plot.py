#!/usr/bin/env python3
"""Pictures of a file of asdic: asdic_plot.py FILE.h5 [-o DIR] [--ping N] [--against B.h5]

Writes PNGs and prints a line for each. Exit code: 0 all written, 1 they could not be written, 2 the
input is wrong.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

if __name__ == "__main__":
    from asdic_pictures.command import main

    sys.exit(main())
