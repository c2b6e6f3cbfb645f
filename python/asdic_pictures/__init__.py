"""Pictures of asdic's ping files (docs/formats/ping.md): one module a picture, each with
`draw(data, ping)`.

data.py reads the file, signal.py holds what is computed from it, style.py the common look; the
pictures know nothing of HDF5.
"""
import os as _os

# matplotlib obeys a matplotlibrc of the folder in which it is imported: one that happens to lie
# beside the data, or came with them, is nobody's wish. That of the user's own folder is obeyed.
_here = _os.open(".", _os.O_PATH)
try:
    _os.chdir("/")
    import matplotlib as _matplotlib  # noqa: E402,F401
finally:
    _os.fchdir(_here)
    _os.close(_here)
