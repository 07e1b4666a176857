"""The structs of reports. Each is frozen and is an object of the JSON document."""
