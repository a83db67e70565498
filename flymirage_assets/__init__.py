"""The Dagster room: partitions, thin assets, jobs, and the command line. All computation is in `flymirage_core`."""
