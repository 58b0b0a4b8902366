"""The experiment on the gearbox: the paper's six tasks, through every fault a cell can have.

| module | its one question |
|---|---|
| `trials.py` | which runs are there: task, seed, with or without attachments, fault, clock? |
| `faults.py` | what can go wrong, and which reasons of a failed run are then the true ones? |
| `plans.py` | when does it go wrong in this run, and with whom? |
| `running.py` | one run, from an empty table to a row of figures |
| `killing.py` | the same when the program itself is killed at some cycle and resumed |
| `operating.py` | who minds the arm, and gives the word to go on? |
| `judging.py` | what of the beliefs was true? The only place that looks at the ground truth |
| `safety.py` | did the arm ever do what it must not? As the controller saw it, not the driver |
| `endings.py` | how did a run end, and is its reason the true one? |
| `rows.py` | what is kept of a run, as a line of JSON |
| `command.py` | which runs are wanted, and which of them are there already? |
| `pool.py` | many runs over several processes, one loopback address each |
| `statistics.py` | rates with their intervals |
| `page.py`, `tables.py`, `figures.py` | the page that is made of the rows |
"""
