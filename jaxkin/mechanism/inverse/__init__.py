"""The inverse problem: joints for targets that are more, or fewer, than the freedoms, within limits."""
