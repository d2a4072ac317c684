"""Other methods that find poses, among them that of the paper: for comparison."""
