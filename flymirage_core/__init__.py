"""FlyMirage's plain library: numpy in, numpy out. It knows nothing of Dagster, services or where files are kept."""
