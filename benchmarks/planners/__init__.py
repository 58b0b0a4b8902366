"""Planning problems of the competitions: where they come from, who solves them, who judges."""
