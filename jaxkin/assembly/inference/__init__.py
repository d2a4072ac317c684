"""What solids imply beside the contacts that fit exactly: pins with clearance, bores without pins, bolts, what is held.

Each inference is a sentence that a user could have written, `rigid` or a joint by hand, with its evidence and sizes.
"""
