"""Reading: text into a syntax tree, with everything that keeps it from being one."""
