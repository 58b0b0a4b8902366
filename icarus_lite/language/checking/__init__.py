"""Checking: everything that can be wrong with a domain before it runs."""
