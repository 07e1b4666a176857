"""STEP files (ISO 10303-21): OpenCascade makes facets of their solids, through cascadio.

`exchange` looks at the text of the file: whether it is whole, and what OpenCascade would leave out
without a word. `assembly` makes bodies of the glTF document with the facets. README.md says what is
read.
"""
