"""What is at a path, for names that a user gives.

`Path.is_dir` and its siblings raise OSError for a name that is too long, and for one in a folder
that may not be searched. These say no, and whatever reads or writes the path says why.
"""

import os.path

is_folder = os.path.isdir
is_file = os.path.isfile
exists = os.path.exists
