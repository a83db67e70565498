"""One module for each outside thing - the store, the services - each with its offline twin. Knows the core only."""
