"""All poses of a range: interpolated between those of the branch, corrected; and their derivatives."""
