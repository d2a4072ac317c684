"""Poses, the paper's movements, surfaces, faces and parts."""
