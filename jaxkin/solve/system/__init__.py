"""What the solver sees of a linkage: static loop systems, their state, and tables of their chains."""
