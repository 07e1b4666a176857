"""Scene files: the forms satcheck.scene/1 (TOML or JSON) and satcheck-scene-1 (JSON).

`text` parses. `table` and `values` read a document key by key. `problems` collects its errors with
their places. `scene_1` and `simple` read the two forms. `writing` writes new placements.
"""
