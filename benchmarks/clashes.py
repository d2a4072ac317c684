"""What clashes cost: 100 parts, about 400 contacts, 361 poses. `python benchmarks/clashes.py [poses]`.

`python benchmarks/clashes.py poses FILE` takes an assembly that others drew instead, as `benchmarks/cad.py` does, and
runs its first drive through 0.1 rad, or a fiftieth of its size.

The lattice of plates of `benchmarks/assembly.py`, hinged to their neighbours, closes and opens like rotating squares:
neighbours turn by opposite angles, and their centres come nearer by the cosine. All plates move in all poses, and each
stays in contact with up to four others and with the base. Times are of the processor and of the clock.
"""

from __future__ import annotations

import json
import sys
import time
from dataclasses import replace
from pathlib import Path
from resource import RUSAGE_SELF, getrusage
from tempfile import TemporaryDirectory

import jax
import jax.numpy as jnp
import numpy as np
from cad import grounded, read

import jaxkin as jk
from assembly import lattice
from jaxkin.geometry.part import size

jax.config.update("jax_enable_x64", True)
POSES = 361
ROWS, COLUMNS = 9, 11
MOST = 0.25
"""Largest angle of the plates, radians: beyond 0.3 plates of one layer meet at their corners."""


def folded(mechanism: jk.Mechanism, poses: int) -> jk.Motion:
    """The motion of rotating squares, from the displacements of all parts that it has."""
    angle = MOST * np.sin(np.linspace(0.0, 2 * np.pi, poses))
    centres = {part.name: _centre(part) for part in mechanism.solids}
    base = next(part for part in mechanism.solids if part.name == "base")
    normal = _normal(base)
    middle = np.mean([centre for name, centre in centres.items() if name != "base"], axis=0)
    places = {"base": np.broadcast_to(np.eye(4), (poses, 4, 4))}
    cross = np.cross(np.eye(3), normal)
    for name, centre in centres.items():
        if name == "base":
            continue
        row, column = map(int, name.removeprefix("plate ").split("."))
        turn = angle * (1 if (row + column) % 2 else -1)
        rotation = (
            np.eye(3) + np.sin(turn)[:, None, None] * -cross + (1 - np.cos(turn))[:, None, None] * (cross @ cross)
        )
        out = centre - middle
        out = out - (out @ normal) * normal
        moved = centre + (np.cos(angle) - 1)[:, None] * out
        found = np.tile(np.eye(4), (poses, 1, 1))
        found[:, :3, :3] = rotation
        found[:, :3, 3] = moved - rotation @ centre
        places[name] = found
    motion = mechanism.sweep({mechanism.all_joints[0].name + "." + mechanism.all_joints[0].coordinates[0]: np.zeros(1)})
    rows = tuple(jnp.zeros((poses, joint.freedoms)) for joint in mechanism.all_joints)
    status, zeros = jnp.zeros(poses, jnp.int32), jnp.zeros(poses)
    motion = replace(
        motion, inputs=dict.fromkeys(motion.inputs, zeros), displacements=rows, status=status, residual=zeros
    )
    motion.__dict__["transforms"] = {name: jnp.asarray(places[name]) for name in mechanism.parts}
    return motion


def _centre(part) -> np.ndarray:
    """The centre of the surface of a part, which is on the axis of a plate."""
    sides = np.diff(part.triangles, axis=1)
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    return np.average(part.triangles.mean(axis=1), axis=0, weights=areas)


def _normal(base) -> np.ndarray:
    """The direction across the base: the normal of its largest triangle."""
    sides = np.diff(base.triangles, axis=1)
    normals = np.cross(sides[:, 0], sides[:, 1])
    sizes = np.linalg.norm(normals, axis=1)
    return normals[np.argmax(sizes)] / sizes.max()


def real(path: Path, poses: int) -> jk.Motion:
    """The motion of a drawn assembly by the first of its drives, the others at rest."""
    labels = path.with_name(f"{path.name.split('.')[0]}.joints.json")
    assembly = read(path)
    fixed = grounded(json.loads(labels.read_text())) if labels.exists() else assembly.proposals()[0].fixed
    mechanism = assembly.mechanism(fixed=fixed)
    first, *others = mechanism.mobility().drivable
    reach = 0.1 if first.rsplit(".", 1)[1].startswith(("phi", "theta", "psi")) else size(mechanism.solids) / 50
    path_of_first = np.linspace(-reach / 2, reach / 2, poses)
    return mechanism.sweep(dict.fromkeys(others, np.zeros(poses)) | {first: path_of_first})


def main(poses: int = POSES, file: str | None = None) -> None:
    motion = drawn_lattice(poses) if file is None else real(Path(file), poses)
    solids = motion.mechanism.solids
    print(f"{len(solids)} parts, {sum(len(part.triangles) for part in solids)} triangles, {poses} poses")
    for within in (0.0, None):
        clock, processor = time.perf_counter(), time.process_time()
        found = jk.clashes(motion, within=within)
        processor, clock = time.process_time() - processor, time.perf_counter() - clock
        clash = int(found.clashing.any(axis=1).sum())
        megabytes = getrusage(RUSAGE_SELF).ru_maxrss / 1024
        print(
            f"clearances within {'the default' if within is None else within}: {processor:.1f} s of the processor, "
            f"{clock:.1f} s; {len(found.pairs)} pairs, {clash} clash; at most {megabytes:.0f} MB"
        )


def drawn_lattice(poses: int) -> jk.Motion:
    """The lattice of plates, and its motion."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "lattice.step"
        lattice(ROWS, COLUMNS, path)
        assembly = jk.load(path)
        contacts = assembly.contacts()
        mechanism = assembly.mechanism(fixed=["base"])
    print(f"{len(contacts)} contacts")
    return folded(mechanism, poses)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else POSES, *sys.argv[2:3])
