"""Plates with many screws: what is measured grows with their number, and not with its square."""

import pytest

from jaxkin.assembly.inference import measured
from reference.round_parts import assembly, part, pin, ring


def measurements(count, monkeypatch):
    """How often stop faces are looked for on a plate of so many bored pieces with a screw in each."""
    places = [(15.0 * k, 0.0) for k in range(count)]
    plate = part("plate", *(ring(3, 6, 0, 10, at) for at in places))
    screws = [part(f"screw {k}", pin(3, -10, 10, at), pin(5, 10, 14, at)) for k, at in enumerate(places)]
    calls = []

    def stops(*given):
        calls.append(given)
        return original(*given)

    with monkeypatch.context() as patched:
        original = measured.stops
        patched.setattr(measured, "stops", stops)
        mechanism = assembly(plate, *screws).mechanism(fixed=["plate"])
    assert len(mechanism.bodies) == 1
    return len(calls)


@pytest.mark.long
def test_twice_as_many_screws_are_twice_as_much_work(monkeypatch):
    few, many = (measurements(count, monkeypatch) for count in (10, 20))
    assert many < 2.5 * few + 10  # four times as many with the square
