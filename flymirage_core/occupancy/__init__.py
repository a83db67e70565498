"""Where there is matter and where one can fly: voxels from splats, queries, search and smoothing. Knows splats."""
