"""FlyMirage's plain library: numpy in, numpy out. It knows nothing of Dagster, of services or of where files are kept."""
