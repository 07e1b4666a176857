"""MJCF (.xml), the models of MuJoCo, which reads them itself. README.md says what is read.

The format: https://mujoco.readthedocs.io/en/stable/XMLreference.html.
"""
