"""Cameras, the paper's camera placements, and turning Gaussians into RGB, expected depth and alpha. Knows splats."""
