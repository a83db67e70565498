"""All scenes together: episodes, splits, statistics, exports and their reader. Knows products, not algorithms."""
