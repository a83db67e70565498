"""Finding objects: oriented boxes from posed RGB-D, Algorithm 1, exploration. Knows rendering and occupancy."""
