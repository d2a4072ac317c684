"""Couplings against closed forms: gear trains before, behind and within linkages, Willis's equation, racks."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk

Z = (0.0, 0.0, 1.0)
TURNS = np.linspace(0.0, 4 * np.pi, 91)
"""Two turns: behind a gear a second turn of the input is not a repetition of the first one."""

FOUR_BAR = [
    jk.revolute("B", "ground", "crank", point=(0, 0, 0), axis=Z),
    jk.revolute("C", "crank", "coupler", point=(0, 1, 0), axis=Z),
    jk.revolute("D", "coupler", "rocker", point=(3, 3, 0), axis=Z),
    jk.revolute("E", "rocker", "ground", point=(3, 0, 0), axis=Z),
]
FIVE_BAR = [
    jk.revolute("A", "ground", "a", point=(0, 0, 0), axis=Z),
    jk.revolute("B", "a", "b", point=(0, 1, 0), axis=Z),
    jk.revolute("C", "b", "c", point=(1.5, 3, 0), axis=Z),
    jk.revolute("D", "c", "d", point=(4, 1, 0), axis=Z),
    jk.revolute("E", "ground", "d", point=(4, 0, 0), axis=Z),
]
WHEEL = jk.revolute("A", "ground", "wheel", point=(-3, 0, 0), axis=Z)


def build(joints, couplings=()):
    return jk.Mechanism.build(fixed=["ground"], joints=joints, couplings=couplings)


def same(one, other):
    """To rounding: positions of this size are sums of a few numbers of order ten."""
    np.testing.assert_allclose(one, other, rtol=0, atol=2e-13)


@pytest.mark.long
def test_a_gear_in_front_of_a_linkage_turns_its_crank():
    motion = build([WHEEL, *FOUR_BAR], [jk.gear("A", "B", -0.5)]).sweep({"A": TURNS}, throw=True)
    direct = build(FOUR_BAR).sweep({"B": -0.5 * TURNS}, throw=True)
    for joint in "BCDE":
        same(motion.coordinates[joint], direct.coordinates[joint])


@pytest.mark.long
def test_a_gear_behind_a_linkage_follows_it_and_may_be_driven_itself():
    mechanism = build([*FOUR_BAR, jk.revolute("F", "ground", "wheel", point=(5, 0, 0), axis=Z)], [jk.gear("E", "F", 3)])
    motion = mechanism.sweep({"B": TURNS}, throw=True)
    same(motion.coordinates["F"], 3 * motion.coordinates["E"])
    part = slice(0, 12)  # before the rocker turns back
    back = mechanism.sweep({"F": motion.coordinates["F"][part, 0]}, throw=True)
    same(back.coordinates["B"][:, 0], TURNS[part])


@pytest.mark.long
@pytest.mark.parametrize("ratio", [-1.0, 0.5])
def test_a_geared_five_bar_moves_as_one_that_two_motors_drive(ratio):
    geared, free = build(FIVE_BAR, [jk.gear("A", "E", ratio)]), build(FIVE_BAR)
    assert (geared.mobility().freedoms, free.mobility().freedoms) == (1, 2)
    angles = np.linspace(0.0, 0.8, 15)
    motion = geared.sweep({"A": angles}, throw=True)
    other = free.sweep({"A": angles, "E": ratio * angles}, throw=True)
    for joint in "BCD":
        same(motion.coordinates[joint], other.coordinates[joint])


@pytest.mark.long
def test_a_coupling_within_the_loops_is_solved_with_them():
    """Tied to a coordinate that only the loops know, the coupling is an equation among theirs."""
    mechanism = build(FIVE_BAR, [jk.relation({"B": 1.0, "D": 0.7})])
    motion = mechanism.sweep({"A": np.linspace(0, 0.4, 9)}, throw=True)
    same(motion.coordinates["B"], -0.7 * motion.coordinates["D"])
    assert float(jnp.abs(motion.coordinates["C"]).max()) > 0.05


@pytest.mark.long
def test_planetary_gears_obey_the_equation_of_willis():
    """(ring - carrier) / (sun - carrier) = - z_sun / z_ring; here with the ring at rest, and with the sun at rest."""
    sun, planet = 20, 15
    ring = sun + 2 * planet
    wheels = [
        jk.revolute("sun", "ground", "s", point=(0, 0, 0), axis=Z),
        jk.revolute("ring", "ground", "r", point=(0, 0, 0), axis=Z),
        jk.revolute("carrier", "ground", "c", point=(0, 0, 0), axis=Z),
        jk.revolute("planet", "c", "p", point=(1, 0, 0), axis=Z),
    ]
    mesh = [
        jk.relation({"planet": planet, "sun": sun, "carrier": -sun}, name="sun and planet"),
        jk.relation({"planet": planet, "ring": -ring, "carrier": ring}, name="ring and planet"),
    ]
    mechanism = build(wheels, mesh)
    assert mechanism.mobility().freedoms == 2
    motion = mechanism.sweep({"sun": TURNS, "ring": 0 * TURNS}, throw=True)
    same(motion.coordinates["carrier"][:, 0], TURNS * sun / (sun + ring))
    motion = mechanism.sweep({"ring": TURNS, "sun": 0 * TURNS}, throw=True)
    same(motion.coordinates["carrier"][:, 0], TURNS * ring / (sun + ring))


@pytest.mark.long
def test_a_differential_halves_the_sum_of_its_outputs():
    shafts = [
        jk.revolute(name, "ground", name.lower(), point=(k, 0, 0), axis=(1, 0, 0))
        for k, name in enumerate(("Left", "Right", "Case"))
    ]
    mechanism = build(shafts, [jk.differential("Left", "Right", "Case")])
    motion = mechanism.sweep({"Case": TURNS, "Left": 0.8 * TURNS}, throw=True)
    same(motion.coordinates["Right"][:, 0], 1.2 * TURNS)


@pytest.mark.long
def test_a_rack_steers_both_wheels_through_tie_rods():
    """The linkage is symmetric about x = 0: what one wheel does at s the other one does, mirrored, at -s."""
    joints = [jk.revolute("pinion", "ground", "shaft", point=(0, 0, 0), axis=(0, 1, 0))]
    joints += [jk.prismatic("rack", "ground", "bar", axis=(1, 0, 0))]
    for side, name in ((-1, "left"), (1, "right")):
        joints += [
            jk.revolute(f"{name} rod", "bar", f"{name} tie", point=(0.3 * side, 0, 0), axis=Z),
            jk.revolute(f"{name} arm", f"{name} tie", f"{name} wheel", point=(0.65 * side, 0.02, 0), axis=Z),
            jk.revolute(f"{name} pin", "ground", f"{name} wheel", point=(0.7 * side, 0.15, 0), axis=Z),
        ]
    mechanism = build(joints, [jk.rack("pinion", "rack", 0.008)])
    angles = np.linspace(-8.0, 8.0, 33)
    motion = mechanism.sweep({"pinion": angles}, throw=True)
    same(motion.coordinates["rack"][:, 0], 0.008 * angles)
    same(motion.coordinates["left pin"], -motion.coordinates["right pin"][::-1])
    assert float(jnp.abs(motion.coordinates["left pin"] - motion.coordinates["right pin"]).max()) > 0.02  # Ackermann


@pytest.mark.long
def test_a_polynomial_holds_both_ways():
    wheels = [jk.revolute(name, "ground", name.lower(), point=(k, 0, 0), axis=Z) for k, name in enumerate("AB")]
    mechanism = build(wheels, [jk.polynomial("B", "A", [0.0, 1.0, 0.3, -0.01])])
    angles = np.linspace(0.0, 2.0, 9)
    wanted = angles + 0.3 * angles**2 - 0.01 * angles**3
    same(mechanism.sweep({"A": angles}, throw=True).coordinates["B"][:, 0], wanted)
    same(mechanism.sweep({"B": wanted}, throw=True).coordinates["A"][:, 0], angles)


@pytest.mark.long
def test_beyond_the_largest_value_of_a_polynomial_nothing_is_reached():
    wheels = [jk.revolute(name, "ground", name.lower(), point=(k, 0, 0), axis=Z) for k, name in enumerate("AB")]
    mechanism = build(wheels, [jk.polynomial("B", "A", [0.0, 1.0, -0.5])])
    wanted = np.linspace(0.0, 0.7, 16)
    motion = mechanism.sweep({"B": wanted})
    # the wanted angle A - A^2 / 2 is 1 / 2 at most, at A = 1
    np.testing.assert_array_equal(motion.status, np.where(wanted < 0.5, jk.Status.CLOSED, jk.Status.UNREACHABLE))
    away = np.asarray(motion.coordinates["A"])[wanted > 0.5, 0]
    np.testing.assert_allclose(away, 1.0, atol=1e-3)  # the least residual is flat there


@pytest.mark.long
def test_derivatives_with_respect_to_a_ratio():
    """The crank angle is ratio times the input: d/d ratio of the rocker is its rate times the input."""

    def rocker(ratio):
        mechanism = build([WHEEL, *FOUR_BAR], [jk.gear("A", "B", ratio)])
        return mechanism.sweep({"A": jnp.array([0.5])}).coordinates["E"][0, 0]

    def of_crank(angle):
        return build(FOUR_BAR).sweep({"B": angle[None]}).coordinates["E"][0, 0]

    wanted = 0.5 * jax.grad(of_crank)(jnp.asarray(-0.6 * 0.5))
    for found in (
        jax.grad(rocker)(-0.6),
        jax.jit(jax.grad(rocker))(-0.6),
        jax.vmap(jax.grad(rocker))(jnp.array([-0.6]))[0],
    ):
        np.testing.assert_allclose(found, wanted, rtol=1e-12)


@pytest.mark.long
def test_neither_order_nor_unit_nor_names_matter():
    plain = build([WHEEL, *FOUR_BAR], [jk.gear("A", "B", -0.5)]).sweep({"A": TURNS})
    other = build([*FOUR_BAR[::-1], WHEEL], [jk.relation({"B": 2.0, "A": 1.0})]).sweep({"A": TURNS})
    same(plain.coordinates["E"], other.coordinates["E"])
    pinion = jk.revolute("pinion", "ground", "p", point=(0, 0, 0), axis=Z)
    slides = [[pinion, jk.prismatic("rack", "ground", "r", axis=(1, 0, 0), point=(s, 0, 0))] for s in (1.0, 1000.0)]
    one, thousand = (
        build(slide, [jk.rack("pinion", "rack", radius)]).sweep({"pinion": TURNS}).coordinates["rack"]
        for slide, radius in zip(slides, (0.3, 300.0), strict=True)
    )
    np.testing.assert_allclose(1000 * one, thousand, rtol=1e-13)


@pytest.mark.long
def test_changed_lengths_keep_couplings():
    mechanism = build(FIVE_BAR, [jk.gear("A", "E", -1.0)])
    name = next(iter(mechanism.lengths))
    longer = mechanism.with_lengths({name: 1.1 * mechanism.lengths[name]})
    motion = longer.sweep({"A": np.linspace(0, 0.3, 5)}, throw=True)
    same(motion.coordinates["E"], -motion.coordinates["A"])


@pytest.mark.long
def test_an_offset_opens_the_assembled_pose_and_close_brings_it_home():
    mechanism = build(FIVE_BAR, [jk.relation({"A": 1.0, "E": 1.0}, 0.1, name="phase")])
    assert "the coupling 'phase' of A, E is off by 0.1" in str(mechanism)
    found = mechanism.close()
    assert found.closed
    at_once = mechanism.sweep({"A": np.array([0.0, 0.2])}, throw=True)
    same(at_once.coordinates["A"] + at_once.coordinates["E"], 0.1)
    again = found.mechanism.sweep({"A": np.array([0.0, 0.2])}, throw=True)
    same(again.coordinates["A"], -again.coordinates["E"])


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: jk.gear("A", "A", 2.0), "at least two different coordinates, got 'A', 'A'"),
        (lambda: jk.gear("A", "B", 0.0), "the ratio of 'A' must not be zero"),
        (lambda: jk.gear("A", "B", np.nan), "the ratio of 'A' must be one finite number, got nan"),
        (lambda: jk.belt("A", "B", 1.0, 0.0), "radius_b must not be zero"),
        (lambda: jk.relation({"A": 1.0}), "at least two different coordinates"),
        (lambda: jk.relation({"A": 1.0, "B": 1.0}, np.inf), "the offset must be one finite number, got inf"),
        (lambda: jk.polynomial("A", "B", [1.0]), "needs the coefficients c_0, c_1"),
        (lambda: jk.polynomial("A", "B", [1.0, 0.0]), "not all of the powers zero"),
    ],
)
def test_couplings_that_make_no_sense(make, said):
    with pytest.raises(ValueError, match=said):
        make()


@pytest.mark.parametrize(
    ("coupling", "said"),
    [
        (jk.gear("A", "ball", 2.0), "joint 'ball' .spherical. has no coordinate to couple"),
        (jk.gear("A", "ball.phi", 2.0), "an angle of a ball, which has no axis of its own"),
        (jk.gear("A", "slide", 2.0), "couples turns, and 'slide.z' is a length; jk.rack couples a slide"),
        (
            jk.rack("A", "B", 2.0),
            "couples a turn with a slide, in this order; 'A.phi' is an angle and 'B.phi' an angle",
        ),
        (jk.gear("A", "b", 2.0), "there is no joint 'b'; did you mean 'B'?"),
        (jk.gear("A.z", "B", 2.0), "write one of 'A.phi', got 'A.z'"),
        (jk.relation({"A": 1.0, "A.phi": 2.0}), "names a coordinate twice"),
    ],
)
def test_couplings_of_what_is_not_there(coupling, said):
    joints = [jk.revolute(name, "ground", f"part {name}", point=(k, 0, 0), axis=Z) for k, name in enumerate("AB")]
    joints += [jk.prismatic("slide", "ground", "r", axis=Z), jk.spherical("ball", "ground", "q", point=(0, 0, 0))]
    with pytest.raises(ValueError, match=said):
        build(joints, [coupling])


def test_both_sides_of_a_gear_cannot_be_driven():
    with pytest.raises(ValueError, match=r"driven A.phi, B.phi, but .* has 1 freedom: drive only A.phi"):
        build([WHEEL, *FOUR_BAR], [jk.gear("A", "B", 2.0)]).sweep({"A": TURNS, "B": TURNS})


@pytest.mark.long
def test_the_plan_says_where_a_coupling_is_solved():
    mechanism = build([WHEEL, *FOUR_BAR], [jk.gear("A", "B", -0.5)])
    first, second = mechanism.plan(["A"]).steps
    assert (first.couplings, first.unknowns, first.equations) == (("gear A B",), ("B.phi",), 1)
    assert (second.loops, second.after) == (1, (0,))
    assert "gear A B: -0.5 A.phi - B.phi = 0" in str(mechanism)


def test_an_equation_ends_in_no_negative_zero():
    assert str(jk.relation({"A.phi": 1, "B.phi": -2}, -0.0, name="c")) == "A.phi - 2 B.phi = 0"
