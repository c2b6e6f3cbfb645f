#!/usr/bin/env python3
"""Whether two files of a study are the same, to the last bit, in every dataset and attribute outside
of /run.

    same_study.py A.h5 B.h5         exit code 1 and a line for each difference
"""
import sys

import h5py
import numpy as np

REFERENCES = {"REFERENCE_LIST", "DIMENSION_LIST", "_Netcdf4Dimid"}   # places in the file


def value(item):
    """Something that is equal if and only if the bits are."""
    array = np.asarray(item)
    return (str(array.dtype), array.shape, array.tobytes() if array.dtype != object
            else [v.encode() if isinstance(v, str) else bytes(v) for v in np.ravel(array)])


def content(path):
    """→ {name: value} of all datasets and attributes"""
    found = {}
    with h5py.File(path, "r") as f:
        def add(name, item):
            if name == "run" or name.startswith("run/"):
                return
            if isinstance(item, h5py.Dataset):
                found[name] = value(item[()])
            for key, attribute in item.attrs.items():
                if key not in REFERENCES:
                    found[f"{name}@{key}"] = value(attribute)
        add("", f)
        f.visititems(add)
    return found


def differences(a, b):
    """→ names of what is in one only, or differs"""
    first, second = content(a), content(b)
    assert len(first) > 20, f"{a}: only {len(first)} things to compare"
    return sorted(k for k in first.keys() | second.keys() if first.get(k) != second.get(k))


if __name__ == "__main__":
    different = differences(*sys.argv[1:3])
    print("\n".join(different))
    sys.exit(bool(different))
