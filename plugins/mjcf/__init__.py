"""MJCF (.xml), the models of MuJoCo -> one robot with all bodies of the file.

The format: https://mujoco.readthedocs.io/en/stable/XMLreference.html. MuJoCo itself reads the file,
in a child process: `compiling` and `reading` run there, and `child` asks it. `files`
reads the files that MuJoCo may open before it does. `reading` makes the robot of an answer,
`joints` its joints, and `exemptions` says which pairs MuJoCo does not check. README.md says what is
read.
"""
