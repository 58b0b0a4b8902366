"""Formatting: the canonical layout, comments kept where they were."""
