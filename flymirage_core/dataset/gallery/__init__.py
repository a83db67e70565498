"""A gallery of the data set as HTML files that need no server and no network: plots, 3D scenes, flights, prompts."""
