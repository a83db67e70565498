"""The embedded world model: description -> layout -> surfaces -> lit Gaussians. Knows scene, splats, rendering."""
