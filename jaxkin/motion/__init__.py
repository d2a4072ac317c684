"""The mechanism, its motion over a range, its mobility, and the registry of the files that it is saved as."""
