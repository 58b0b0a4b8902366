"""Trials of the inference engine: random domains, random histories, and other accounts of both.

`programs` and `histories` draw them, `trial` runs one through the engine and through those that
must agree with it, `shrinking` looks for the smallest trial that still fails. One seed, one trial.
"""
