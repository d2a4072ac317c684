"""A STEP file with a pair of solids in every state and variant, drawn by `benchmarks/examples/make_states.py`."""

from pathlib import Path

import numpy as np
import pytest

from jaxkin.contacts.detect import find_contacts
from jaxkin.geometry.part import size
from jaxkin.io.step import read_step


@pytest.fixture(scope="module")
def parts():
    return read_step(Path(__file__).parent / "data" / "states.step")[0]


def check(contacts, parts):
    """Each pair, and no other, is in contact as its name says: "h line pin in cone 1"."""
    wanted = {part.name[:-2]: tuple(part.name.split()[:2]) for part in parts}
    found = {}
    for contact in contacts:
        assert [name[-2:] for name in contact.parts] == [" 1", " 2"] and contact.parts[0][:-2] == contact.parts[1][:-2]
        assert contact.parts[0] not in found
        found[contact.parts[0][:-2]] = (contact.state, contact.region)
    assert found == wanted
    assert not contacts.near_misses and not contacts.notes


@pytest.mark.long
def test_every_state_is_found_between_solids(parts):
    contacts = find_contacts(parts)
    check(contacts, parts)
    assert len(contacts) == 25 and {contact.state for contact in contacts} == set("abcdefghijklmnop")
    assert max(contact.misfit for contact in contacts) < 1e-11 * size(parts)  # the file has twelve decimals


@pytest.mark.long
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_in_other_placements_and_units(parts, solids, scale):
    """Each pair placed anew, the parts of a pair apart by the noise of single precision."""
    rng = np.random.default_rng(round(1e3 * scale))
    placed = []
    for number in range(0, len(parts), 2):
        pose = solids.random_displacement(rng)
        pose[:3, 3] = [150 * (number % 10) / 2, 150 * (number // 10), 0]
        pose[:3, 3] -= pose[:3, :3] @ parts[number].box.mean(axis=0)
        for part in parts[number : number + 2]:
            noisy = pose.copy()
            noisy[:3, 3] += rng.uniform(-1e-5, 1e-5, 3)
            placed.append(solids.part(part.name, *(solids.moved(face, noisy, scale) for face in part.faces)))
    check(find_contacts(tuple(placed)), parts)
