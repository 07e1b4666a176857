"""MJCF (.xml), the models of MuJoCo -> one robot with all bodies of the file.

The format: https://mujoco.readthedocs.io/en/stable/XMLreference.html. MuJoCo itself reads the file,
in a child process. `files` reads the files that MuJoCo may open before it does. `compiling` asks
MuJoCo, `reading` makes the robot, `joints` its joints, and `exemptions` says which pairs MuJoCo
does not check. README.md says what is read.
"""
