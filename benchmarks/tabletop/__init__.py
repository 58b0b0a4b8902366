"""The workload "table-top beliefs", and the engines that are measured on it.

`scene` makes it, `oracle` says what is true in each frame, `engines` puts the engines behind one
interface, `measuring` takes times and memory. The rules are in `tabletop.icr`.
"""
