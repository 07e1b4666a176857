"""Scene files: the forms satcheck.scene/1 (TOML or JSON) and satcheck-scene-1 (JSON).

`text` parses, `table` and `values` read a document key by key, `problems` collects what is wrong
with it and says where, `scene_1` and `simple` are the two forms, `writing` puts bodies elsewhere.
"""
