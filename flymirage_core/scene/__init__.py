"""Scene keys and seeds, the taxonomy, and what a scene is to look like. Knows no other room."""
