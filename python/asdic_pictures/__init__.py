"""Pictures of asdic's ping files (docs/formats/ping.md): one module a picture, each with
`draw(data, ping)`.

data.py reads the file, signal.py holds what is computed from it, style.py the common look; the
pictures know nothing of HDF5.
"""
