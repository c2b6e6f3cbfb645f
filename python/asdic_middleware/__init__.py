"""`asdic serve` on the middleware that vehicles run: MOOS (asdic-moos) and ROS (ros/).

    quantities   what goes in and out, by one description each, whatever carries it
    sonar        what is known of the vehicle, the targets and the array, and the pings made of it
    receiver     `asdic process` on each ping's file; tracker: tracks of what it finds
    paths        sound paths on request
    mission      files of MOOS; packets, moosdb: its wire; moos_app: the app asdic-moos
    messages     ROS messages from and to the quantities

Standard library and numpy, and asdic_client.py. h5py where ping files are read.
docs/guide/moos.md, docs/guide/ros.md, docs/formats/middleware.md
"""
