"""The mathematics of the catalogue: one compiled kernel a task.

A kernel reads its task's parameters, a frame, and the state; it writes error, J and
drift of its rows, and to `rate` what changes by time alone (0 on entry).
"""
