"""The products, one asset each, in the paper's three stages, and the data set over all scenes."""
