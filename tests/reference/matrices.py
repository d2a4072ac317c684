"""Random matrices of a given structure."""

import numpy as np

from jaxkin.solve.system.equation_blocks import EquationBlock


def block_triangular(rng, poses):
    """Blocks of three, four and two equations, the last in one unknown more, rows and columns in random order."""
    rows, columns = rng.permutation(9), rng.permutation(12)
    cut = [0, 3, 7, 9], [0, 3, 7, 10]
    found = tuple(
        EquationBlock(tuple(map(int, rows[a:b])), tuple(map(int, columns[c:d])))
        for a, b, c, d in zip(cut[0], cut[0][1:], cut[1], cut[1][1:], strict=False)
    )
    jacobian = np.zeros((9, 12, poses))
    for number, block in enumerate(found):
        for other in found[: number + 1]:
            shape = len(block.rows), len(other.columns), poses
            jacobian[np.ix_(block.rows, other.columns)] = rng.normal(size=shape)
    return jacobian, found
