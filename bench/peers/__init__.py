"""Other collision libraries, each in a child process: they abort, and they hang.

A pair goes in as one line of numbers, an answer comes out as one line; `protocol` says which.
"""
