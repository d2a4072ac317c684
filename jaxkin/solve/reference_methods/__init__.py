"""Other ways to find poses, among them the paper's own: for comparison."""
