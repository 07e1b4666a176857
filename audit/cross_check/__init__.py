"""`--cross-check`: what other libraries say about a pair that was decided here."""
