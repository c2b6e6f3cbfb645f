"""The Python package asdic for pip: CMake builds the library and the extension, and nothing else."""
import re
import sys
from pathlib import Path

from setuptools import find_packages
from skbuild import setup

text = (Path(__file__).parent / "CMakeLists.txt").read_text(encoding="utf-8")
version = re.search(r"project\(asdic VERSION (\S+)", text)[1]

setup(
    name="asdic",
    version=version,
    description="Active sonar in a real ocean",
    license="BSD-3-Clause",
    packages=find_packages("python"),
    py_modules=["asdic_client", "asdic_stream"],
    package_dir={"": "python"},
    entry_points={"console_scripts": ["asdic-moos=asdic_middleware.moos_app:main"]},
    package_data={"asdic": ["py.typed", "*.pyi"], "asdic_page": ["*.js", "*.css", "*/*.js", "*/*.css"]},
    python_requires=">=3.11",
    install_requires=["numpy", "pandas", "xarray"],  # files: h5py and h5netcdf, without metadata in Debian
    extras_require={"pictures": ["matplotlib"]},
    cmake_args=["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
                "-DASDIC_PRECOMPILED_HEADERS=ON", "-DASDIC_TESTS=OFF", "-DASDIC_MPI=OFF",
                "-DASDIC_PYTHON_PACKAGE=ON", f"-DASDIC_PACKAGE_PYTHON={sys.executable}"],
    cmake_install_target="install_wheel",
)
