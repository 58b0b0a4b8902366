"""LA-CATER, where eyes and mind meet: attachments from the engine, models run, tables made.

`attachments.py` asks the engine, `evaluation.py` runs and scores one video, `workers.py` spreads
the videos over processes, `report.py` makes the table.
"""
