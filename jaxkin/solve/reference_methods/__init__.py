"""Find poses by other methods, among them that of the paper, for comparison."""
