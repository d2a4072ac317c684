"""What near misses advise beside a mechanism: nothing that would lock what a joint lets move, without saying so."""

import pytest

from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, part, pin, ring


def seal(thicker, apart):
    """A piston on its rod with a seal that is thicker than the cylinder: in a groove, with play, or a part of it."""
    barrel = part("barrel", ring(45.0, 50.0, 0, 200), ring(16.0, 45.0, 200, 220), block((-50, -80, 0), (50, -49, 20)))
    groove = [ring(16.0, 45.0, 80, 90), ring(16.0, 45.0, 94, 104), ring(16.0, 40.0, 90, 94)]
    rod = part("rod", pin(16.0, 60, 280), *groove, *([] if apart else [ring(40.0, 45.0 + thicker, 90, 94)]))
    return assembly(barrel, rod, *([part("seal", ring(40.0, 45.0 + thicker, 90, 94))] if apart else []))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("apart", [True, False])
@pytest.mark.parametrize("thicker", [0.1, 0.5])
def test_the_seal_of_a_piston_is_not_advised_to_be_joined_with_its_cylinder(thicker, apart, seed):
    mechanism = anywhere(seal(thicker, apart), seed).mechanism(fixed=["barrel"])
    assert kind_of(mechanism, "barrel", "rod") == "cylindrical"
    advised = [note for note in mechanism.notes if "thicker than its hole" in note]
    assert advised and all("lock that joint: rigid=[[" in note for note in advised)
    assert all("lets the parts move on each other" in note for note in advised)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_valve_is_not_advised_to_be_joined_with_its_seat(seed):
    head = part("head", ring(3.0, 30.0, 0, 40), ring(13.0, 30.0, -20, 0))
    valve = part("valve", pin(3.0, -20, 80), pin(14.5, -20, -16))
    mechanism = anywhere(assembly(head, valve), seed).mechanism(fixed=["head"])
    advised = [note for note in mechanism.notes if "thicker than its hole" in note]
    assert advised and all("lock that joint: rigid=[[" in note for note in advised)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_press_fit_of_parts_that_no_joint_lets_move_is_advised_to_be_joined(seed):
    """A bush on a plate, and a pin that is thicker than the hole of the bush, with inference turned off."""
    plate, bush = part("plate", block((-30, -30, -10), (30, 30, 0))), part("bush", ring(5.0, 9.0, 0, 20))
    mechanism = anywhere(assembly(plate, bush, part("pin", pin(5.1, 0, 40))), seed).mechanism(
        fixed=["plate"], infer=False
    )
    (advised,) = (note for note in mechanism.notes if "thicker than its hole" in note)
    assert "a press fit holds the parts together, join them with rigid=[[" in advised
