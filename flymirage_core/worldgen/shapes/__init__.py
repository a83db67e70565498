"""Builders of the catalogue's kinds, a module a subject: (size, finish) -> parts."""
