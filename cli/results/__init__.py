"""What `satcheck report` makes of the results of batches."""
