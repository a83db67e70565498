"""Gaussian-splat worlds: the cloud itself, its files, its frame of reference, its cleaning. Knows no other room."""
