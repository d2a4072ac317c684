"""How the time for the structure of a mechanism grows with its parts: `python benchmarks/structure.py`.

Two kinds of graphs, with three joints for two parts as in a planar linkage: trusses, in which parts are joined to those
near them, and rings with chords between any parts, whose loops are long and share most of their joints. "analysed" is
everything up to the loop data: incidence, biconnected components, loops in one direction, the tree, the order of parts.
"""

from __future__ import annotations

import random
import time

from jaxkin.topology.structure import Structure, structure

PARTS = (10, 30, 100, 300, 1000, 3000)
NEAR = 30
"""Parts between two that a truss joins, at most."""

Description = tuple[list[str], list[tuple[str, str, str]]]


def truss(parts: int, seed: int = 0) -> Description:
    """Each part on one of those just before it, and half as many joints more."""
    rng = random.Random(seed)
    pairs = [(rng.randrange(max(0, part - NEAR), part), part) for part in range(1, parts)]
    while len(pairs) < 3 * parts // 2:
        first = rng.randrange(parts)
        second = min(parts - 1, max(0, first + rng.randint(-NEAR, NEAR)))
        pairs += [(first, second)] if first != second else []
    return named(parts, pairs)


def ring(parts: int, seed: int = 0) -> Description:
    """A ring with half as many chords, each between two parts at random."""
    rng = random.Random(seed)
    pairs = [(part, (part + 1) % parts) for part in range(parts)]
    for _ in range(parts // 2):
        first, second = rng.sample(range(parts), 2)
        pairs.append((first, second))
    return named(parts, pairs)


def named(parts: int, pairs: list[tuple[int, int]]) -> Description:
    return [f"p{part}" for part in range(parts)], [(f"j{k}", f"p{a}", f"p{b}") for k, (a, b) in enumerate(pairs)]


def analysed(description: Description) -> tuple[Structure, float]:
    """The structure, and the seconds of everything that follows from it."""
    start = time.perf_counter()
    found = structure(*description, fixed=["p0"])
    found.incidence  # noqa: B018
    found.cycles  # noqa: B018
    found.elements  # noqa: B018
    found.tree  # noqa: B018
    return found, time.perf_counter() - start


def main() -> None:
    analysed(ring(10))
    print("graph  parts  joints  loops  joints a loop  analysed [s]")
    for graph in (truss, ring):
        for parts in PARTS:
            runs = [analysed(graph(parts, seed)) for seed in range(3)]
            found, seconds = runs[0][0], min(seconds for _, seconds in runs)
            joints = sum(len(loop.joints) for loop in found.loops) / len(found.loops)
            numbers = f"{len(found.parts):6}{len(found.joints):8}{len(found.loops):7}{joints:15.1f}{seconds:14.3f}"
            print(f"{graph.__name__:5}{numbers}")


if __name__ == "__main__":
    main()
