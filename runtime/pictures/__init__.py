"""A recorded run as pictures for the Rerun viewer.

It needs the extra `view`: `pip install 'icarus-lite[view]'`. `icarus report` does without.
"""
