"""Finding objects: oriented boxes from posed RGB-D pictures, Algorithm 1, exploration. Knows rendering and occupancy."""
