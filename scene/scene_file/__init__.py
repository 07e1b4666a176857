"""Scene files: the forms satcheck.scene/1 (TOML or JSON) and satcheck-scene-1 (JSON).

`text` parses, and finds lines. `document` has the keys of satcheck.scene/1 as typed structs,
`simple` those of the other form. `form` converts to structs and says what is wrong. `reading` makes
a `SceneFile`, and `joined` the scene of several.
"""
