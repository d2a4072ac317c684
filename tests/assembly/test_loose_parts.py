"""Assemblies of parts that touch nothing: told on a screen, with advice that works."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin._grouped import SCREEN
from reference.round_parts import assembly, block, part, pin, ring


def scattered(count):
    """Plates far from each other, beside each other."""
    return assembly(*(part(f"plate {k}", block((40 * k, 0, 0), (40 * k + 10, 10, 2))) for k in range(count)))


def test_what_is_said_fits_on_a_screen_and_says_what_to_do():
    mechanism = scattered(60).mechanism(fixed=["plate 0"])
    assert len(mechanism.notes) > SCREEN
    said = str(mechanism)
    assert len(said.splitlines()) <= SCREEN and "Nothing ties them: none touches another" in said
    assert "ignore=" not in said and "infer=False" not in said  # neither of them helps here
    assert all(note in mechanism.describe(verbose=True) for note in mechanism.notes)


def test_joints_by_hand_move_them_as_the_report_says():
    assert "joints=[jk.revolute(...)]" in str(scattered(3).mechanism(fixed=["plate 0"]))
    hinge = jk.revolute("hinge", "plate 0", "plate 1", point=(20, 0, 0), axis=(0, 0, 1))
    mechanism = scattered(3).mechanism(fixed=["plate 0"], joints=[hinge])
    assert mechanism.mobility().freedoms == 1
    assert bool(np.all(mechanism.sweep({"hinge": np.linspace(0, 1, 3)}).closed))


def test_there_is_no_contact_to_ignore_and_none_at_all():
    with pytest.raises(ValueError, match="nothing is inferred there; no two parts touch each other"):
        scattered(3).mechanism(fixed=["plate 0"], ignore=[["plate 0", "plate 1"]])


def test_discs_on_a_shaft_are_not_said_to_spin_only():
    """They slide on it, too: two freedoms each."""
    rings = [part(f"disc {k}", ring(5, 20, 12 * k, 12 * k + 8)) for k in range(3)]
    mechanism = assembly(part("shaft", pin(5, 0, 60)), *rings).mechanism(fixed=["shaft"], infer=False)
    mobility = mechanism.mobility()
    assert (mobility.freedoms, mobility.spins) == (6, 6)
    assert "6 of them of parts that only turn or slide by themselves: disc 0, disc 1, disc 2" in str(mobility)
    assert "only spin" not in str(mechanism)
