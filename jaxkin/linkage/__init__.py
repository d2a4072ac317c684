"""The linkage: joints, structure and loop classes, all that computing needs; its rates at first order."""
