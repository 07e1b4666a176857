"""Options from a config file: `satcheck.toml`, or `[tool.satcheck]` of `pyproject.toml`.

`search` finds the file, `file` reads it, `values` turns its values into those of options, and
`source` gives them to a command and says where each value comes from. The options themselves are
those of the commands: click converts and checks their values.
"""
