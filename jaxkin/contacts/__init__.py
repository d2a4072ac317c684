"""The sixteen contact states of the paper as a table, and how they are found between solids."""
