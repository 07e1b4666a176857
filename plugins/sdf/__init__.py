"""SDFormat (.sdf, .world): worlds and models -> one robot with all links.

The format: http://sdformat.org/spec. `reading` collects models, links and joints, `frames` places
them, and `trees` of robots orders the joints.
README.md says what is read.
"""
