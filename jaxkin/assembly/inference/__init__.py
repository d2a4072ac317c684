"""What solids imply beside the contacts that fit exactly: pins with clearance, bores without pins, bolts, what is held.

Each inference is a sentence that a user could have written, `rigid` or a joint by hand, with its evidence and sizes.
Reading begins in `infer`, which calls the rules, the surest first. What the modules beside it hold:

| what | modules |
|---|---|
| measured once | `measured`; `bores`, `axes`, `bearings`, `closed_bearings`, `slotted_pins`, `stop_faces`, `embedded` |
| what is known so far, and what a rule finds | `known`, `inference` |
| asked by several rules | `contact_faces`, `walls`, `slots`, `sockets`, `heads`, `coaxial_features`, `moves`, |
| | `slide_stops`, `part_names` |
| tubes that may be springs, found before all rules | `springs` |
| rules, one kind of evidence each, and parts of them | all others: functions of a `Known` that list `Inference`s |
"""
