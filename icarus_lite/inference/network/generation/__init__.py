"""From a design to Python source: what is generated for a domain, and how it is written."""
