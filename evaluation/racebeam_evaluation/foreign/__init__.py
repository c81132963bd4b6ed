"""Readers of the files in which other programs leave results."""
