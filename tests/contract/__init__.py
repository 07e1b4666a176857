"""The contract of answers: what satcheck answered, pinned, so that no change alters it unnoticed.

`cases` lists the calls, `adapter` turns a report into the facts that count, `compare` says which
changes of a fact break the contract. The facts are in `pinned/`, a file for each group of calls.

`python -m tests.contract SATCHECK` makes them anew with a satcheck command. A fact that is meant to
change is changed there in a commit of its own that says why.
"""
