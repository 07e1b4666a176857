"""What accuracy costs in time, over a corpus: pairs, measuring, statistics, figures, a page."""
