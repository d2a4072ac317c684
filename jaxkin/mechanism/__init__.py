"""The mechanism that a user holds, its motion over a range, and the plan of a drive."""
