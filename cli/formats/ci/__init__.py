"""Reports in the formats of CI systems and of spreadsheets, a module each (`../registry.py`)."""
