"""What a report holds: frozen structs, of which each is an object of the JSON document."""
