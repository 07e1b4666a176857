"""The report: plain data, and its way into JSON values."""
