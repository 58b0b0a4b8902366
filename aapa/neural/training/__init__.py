"""How the networks are trained; `trainer.py` is where to begin."""
