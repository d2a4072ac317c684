"""Where a drive locks: against triangles of stretched and folded links, extremes of closed forms, and sweeps."""

import re

import jax
import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import jaxkin as jk
from jaxkin import LimitKind
from jaxkin.geometry.pose import rotation
from reference import planar, spatial
from reference.catalogue import hexapod, parallelogram, stephenson, watt
from reference.mechanisms import planar_fourbar, rssr_linkage, slider_crank

Z = (0.0, 0.0, 1.0)


def corner(one: float, other: float, opposite: float) -> float:
    """The angle between two sides of a triangle; nan where there is none."""
    return float(np.arccos((one**2 + other**2 - opposite**2) / (2 * one * other)))


def crank_range(theta: float, ground: float, crank: float, coupler: float, rocker: float):
    """The range of the crank of a four-bar about theta, between 0 and pi; None for a full turn."""
    with np.errstate(invalid="ignore"):
        most, least = corner(ground, crank, coupler + rocker), corner(ground, crank, abs(coupler - rocker))
    if np.isnan(most) and np.isnan(least):
        return None
    if np.isnan(least):
        return -most - theta, most - theta
    return least - theta, (2 * np.pi - least if np.isnan(most) else most) - theta


@pytest.mark.parametrize("beyond", [1e-8, 1e-4, 0.01, 0.3, 3.0])
def test_a_range_that_is_left_within_a_step_ends_the_drive(beyond):
    """A slide is beyond its end beside the dead point only, however short the arc: by the law of cosines."""
    crank, rod = 30.0, 120.0
    mechanism = slider_crank(theta=0.0, crank=crank, rod=rod, offset=0.0)
    found = jk.limits(mechanism, "A", ranges={"S": (-2 * crank + beyond, np.inf)})
    # the angle is that of a cosine near -1: an error of the slide counts by its root
    expected = corner(crank, rod - crank + beyond, rod)
    np.testing.assert_allclose(found.range, (-expected, expected), rtol=0, atol=1e-9 / np.sqrt(beyond))
    assert found.upper.kind is LimitKind.RANGE and found.upper.joints == ("S",) and not found.full_turn
    assert jk.limits(mechanism, "A", ranges={"S": (-2 * crank - beyond, np.inf)}).full_turn


@pytest.mark.long
def test_a_fourbar_locks_where_coupler_and_rocker_are_aligned(tmp_path):
    """By the law of cosines, to 1e-12: far below the 1e-9 that is promised."""
    lengths = {"ground": 100.0, "crank": 90.0, "coupler": 60.0, "rocker": 60.0}
    mechanism = planar_fourbar(1.0, **lengths)
    found = jk.limits(mechanism, "A")
    np.testing.assert_allclose(found.range, crank_range(1.0, **lengths), rtol=0, atol=1e-12)
    assert found.upper.kind is LimitKind.LOCKS and found.upper.joints == ("B", "C", "D") and not found.full_turn
    assert found.upper.reason == "A.phi locks: the axes of B, C and D lie in one plane"
    assert found.drive == "A.phi" and "A.phi from -2.36376498 rad to 0.363764975 rad" in str(found)
    # in the pose of the limit the three pins are on one line
    pin = np.asarray(mechanism.joints["C"].frames_1)[0, :3, 3]
    b, c = (
        np.asarray(found.motion.points("coupler", at))[-1, :2]
        for at in (np.asarray(mechanism.joints["B"].frames_1)[0, :3, 3], pin)
    )
    across = np.cross(np.append(c - b, 0.0), np.append(c - [100.0, 0.0], 0.0))[2]
    assert abs(across) < 1e-8 * 60 * 60  # the pose itself is right to the root of rounding
    assert np.asarray(found.motion.residual).max() < 1e-13 and np.all(found.motion.closed) and len(found.motion) == 3
    assert found.plot(tmp_path / "limits.png").read_bytes().startswith(b"\x89PNG")
    assert len(found.save(tmp_path / "limits.csv").read_text().splitlines()) == 4


@pytest.mark.long
def test_grashof_linkages_turn_fully():
    """The crank; the rocker swings between the poses in which crank and coupler are aligned."""
    assert jk.limits(planar_fourbar(), "A").full_turn and "no limit" in str(jk.limits(planar_fourbar(), "A"))
    found = jk.limits(planar_fourbar(1.0), "D")
    home = planar.fourbar(np.array([1.0])).rocker[0]
    wanted = [np.pi - corner(100.0, 80.0, 120.0 + side * 40.0) - home for side in (-1, 1)]
    np.testing.assert_allclose(found.range, sorted(wanted), rtol=0, atol=1e-12)
    assert jk.limits(slider_crank(), "A").full_turn and jk.limits(watt(), "A").range == (-np.inf, np.inf)
    assert jk.limits(parallelogram(), "A").full_turn  # straight on where it lies flat


@pytest.mark.long
def test_a_slider_crank_locks_where_crank_and_rod_are_aligned():
    home = 40 * np.cos(1.0) + np.sqrt(120.0**2 - (40 * np.sin(1.0) + 20) ** 2)
    found = jk.limits(slider_crank(1.0), "S")
    wanted = [np.sqrt(length**2 - 20.0**2) - home for length in (80.0, 160.0)]
    np.testing.assert_allclose(found.range, wanted, rtol=0, atol=1e-11)  # mm, of 100
    # a rod shorter than the crank: it locks where the rod is square to the slide
    found = jk.limits(slider_crank(1.0, crank=60.0, rod=50.0, offset=20.0), "A")
    wanted = [np.arcsin((20.0 - 50.0) / 60.0), np.pi - np.arcsin((20.0 - 50.0) / 60.0)]
    np.testing.assert_allclose(found.range, np.array(wanted) - 1.0, rtol=0, atol=1e-12)
    assert found.lower.reason == "A.phi locks: the plane of the axes of B and C is square to the slide S"


@pytest.mark.long
@pytest.mark.parametrize("number", range(4))
def test_random_fourbars(number):
    """Also beside change points, where a range ends in a pose that is nearly passed: 1e-4 and 1e-2 of 100 mm."""
    rng = np.random.default_rng(number)
    count = 0
    while count < 3:
        ground, crank, coupler, rocker = rng.uniform(20, 150, 4)
        if number % 2:
            rocker = ground + crank - coupler + rng.choice([-1e-2, 1e-2, 1e-1])
        theta = rng.uniform(0.2, np.pi - 0.2)
        with np.errstate(invalid="ignore"):
            if rocker < 5 or np.isnan(planar.fourbar(np.array([theta]), ground, crank, coupler, rocker).rocker[0]):
                continue
        count += 1
        lengths = {"ground": ground, "crank": crank, "coupler": coupler, "rocker": rocker}
        found, wanted = jk.limits(planar_fourbar(theta, **lengths), "A"), crank_range(theta, **lengths)
        assert found.full_turn == (wanted is None), lengths
        if wanted is not None:
            # worst of 100: 3e-11, where branches nearly cross
            np.testing.assert_allclose(found.range, wanted, rtol=0, atol=1e-9)


@pytest.mark.long
def test_ranges_of_joints():
    """Given, or of the joints themselves; the nearest limit counts."""
    theta = np.array([1.0])
    home = planar.fourbar(theta).rocker[0]
    found = jk.limits(planar_fourbar(1.0), "A", ranges={"D": (-0.1, np.inf)})
    assert found.lower.kind is LimitKind.RANGE and found.lower.joints == ("D",) and not found.full_turn
    assert found.lower.reason == "the range of D.phi ends, at -0.1"
    for end in found.range:  # the rocker comes to the same end from either side
        at = planar.fourbar(theta + end).rocker[0]
        assert np.angle(np.exp(1j * (at - home))) == pytest.approx(-0.1, abs=1e-12)
    own = jk.limits(planar_fourbar(1.0), "A", ranges={"A": (0.0, 0.25)})
    assert own.range == (0.0, pytest.approx(0.25, abs=1e-12))

    joints = [
        jk.Joint(j.name, j.parts, j.kind, j.movements, j.frames_1, j.frames_2, j.pitch, limits=((-0.1, 5.0),))
        if j.name == "D"
        else j
        for j in planar_fourbar(1.0).all_joints
    ]
    limited = jk.Mechanism.build(fixed=["ground"], joints=joints)
    np.testing.assert_allclose(jk.limits(limited, "A").range, found.range, rtol=0, atol=1e-12)
    assert jk.limits(limited, "A", ranges={"D": (-np.inf, np.inf)}).full_turn


@pytest.mark.parametrize("own", [(-1.0, 20.0), (-20.0, 1.0), (-1.0, 7.0), (-7.0, 7.0), (-2 * np.pi, 2 * np.pi)])
def test_a_range_of_several_turns_ends_a_drive_that_turns_fully(own):
    found = jk.limits(planar_fourbar(1.0), "A", ranges={"A": own})
    np.testing.assert_allclose(found.range, own, rtol=0, atol=1e-12)
    assert not found.full_turn
    assert {found.lower.kind, found.upper.kind} == {LimitKind.RANGE}


@pytest.mark.parametrize("ends", [(-100.0, 1.0), (-9.0, 100.0), (-3.0, np.inf), (-1e4, 1e4)])
def test_the_range_of_a_joint_that_turns_on_with_the_drive_ends_it(ends):
    """The coupler turns against the crank by a full turn each turn, the other way round."""
    mechanism = planar_fourbar(1.0)
    found = jk.limits(mechanism, "A", ranges={"B": ends})
    assert not found.full_turn
    for limit, end in ((found.lower, ends[1]), (found.upper, ends[0])):
        if np.isinf(end):
            assert limit.value == -np.inf
            continue
        assert limit.joints == ("B",)
        assert limit.coordinates["B"] == pytest.approx(end, abs=1e-9)
        before = np.linspace(0.0, limit.value, 200)[1:-1]
        within = np.asarray(mechanism.sweep({"A": before}).coordinates["B"])[:, 0]
        assert within.min() > ends[0] and within.max() < ends[1]


@pytest.mark.parametrize(("ends", "expected"), [((-9.0, 50.0), (-100.0, 18.0)), ((-9.0, 1.0), (-2.0, 18.0))])
def test_the_range_of_a_gear_ends_its_drive_after_some_turns(ends, expected):
    joints = [jk.revolute(name, "ground", name, point=(at, 0, 0), axis=Z) for name, at in (("A", 0), ("B", 2))]
    pair = jk.Mechanism.build(fixed=["ground"], joints=joints, couplings=[jk.gear("A", "B", -0.5)])
    np.testing.assert_allclose(jk.limits(pair, "A", ranges={"B": ends}).range, expected, rtol=0, atol=1e-11)


@pytest.mark.long
def test_slides_that_grow_without_end_end_the_drive():
    """The rotations of an RCCC loop are those of a spherical four-bar; where the cosine of its angle between the axes
    before and after the middle one is that of a folded triangle, the translations are infinite."""
    random = np.random.default_rng(3)
    axes = [each / np.linalg.norm(each) for each in (random.normal(size=3) for _ in range(4))]
    points = [random.normal(size=3) for _ in range(4)]
    parts = ("ground", "one", "two", "three", "ground")
    joints = [jk.revolute("A", *parts[:2], point=points[0], axis=axes[0])]
    joints += [
        jk.cylindrical(name, *parts[k : k + 2], point=points[k], axis=axes[k]) for k, name in enumerate("BCD", start=1)
    ]
    found = jk.limits(jk.Mechanism.build(fixed=["ground"], joints=joints), "A")
    assert {found.lower.kind, found.upper.kind} == {LimitKind.FAR}

    def fold(angle):
        along = rotation(axes[0], angle) @ axes[1]
        cosines = np.array([axes[1] @ axes[2], axes[2] @ axes[3]])
        gram = np.array([[1.0, along @ axes[3]], [along @ axes[3], 1.0]])
        return 1.0 - cosines @ np.linalg.solve(gram, cosines)

    for limit in (found.lower, found.upper):
        assert fold(limit.value) * fold(limit.value * (1 + 1e-3)) < 0  # the slides are a hundred sizes there
        assert np.abs(limit.coordinates["C"]).max() > 100


@pytest.mark.long
def test_drives_outside_of_loops_and_over_many_turns():
    """A knob that is geared to the slider of a slider-crank, a millimetre a radian."""
    joints = [*slider_crank(1.0).all_joints, jk.revolute("knob", "ground", "knob", point=(0, 0, 50), axis=Z)]
    free = jk.Mechanism.build(fixed=["ground"], joints=joints)
    assert jk.limits(free, "knob").full_turn
    assert jk.limits(free, "knob", ranges={"knob": (-1.0, 2.0)}).range == (-1.0, 2.0)
    tied = free.with_couplings([jk.rack("knob", "S", 1.0)])
    slide, knob = jk.limits(free, "S").range, jk.limits(tied, "knob").range
    np.testing.assert_allclose(knob, slide, rtol=0, atol=1e-10)
    assert max(np.abs(knob)) > 8 * np.pi  # radians


def test_a_screw_is_followed_over_many_turns_of_its_nut():
    """Slides that are long for the mechanism have longer steps, which must not pass over turns of its hinges."""
    joints = [jk.revolute("A", "ground", "screw", point=(0, 0, 0), axis=Z), jk.prismatic("S", "ground", "nut", axis=Z)]
    joints.append(jk.screw("N", "screw", "nut", point=(0, 0, 0), axis=Z, pitch=1.5))
    found = jk.limits(jk.Mechanism.build(fixed=["ground"], joints=joints), "A", ranges={"S": (-20.0, 45.0)})
    # the nut advances by its pitch in a turn of the screw, against the screw that it holds
    np.testing.assert_allclose(found.range, [-2 * np.pi * 30.0, 2 * np.pi * 40.0 / 3.0], rtol=0, atol=1e-9)


@pytest.mark.long
def test_the_rocker_of_an_rssr_linkage():
    """Extremes of its closed form over the crank; the rod may spin."""
    home = spatial.rssr(np.array([0.3])).output[0]
    found = jk.limits(rssr_linkage(0.3), "D")

    def angle(theta: float) -> float:
        return float(np.angle(np.exp(1j * (spatial.rssr(np.array([theta])).output[0] - home))))

    grid = np.linspace(0, 2 * np.pi, 721)
    values = np.array([angle(theta) for theta in grid])
    wanted = []
    for sign, start in ((1, grid[values.argmin()]), (-1, grid[values.argmax()])):
        best = minimize_scalar(lambda t, s=sign: s * angle(t), bracket=(start - 0.01, start, start + 0.01), tol=1e-12)
        wanted.append(sign * best.fun)
    np.testing.assert_allclose(found.range, wanted, rtol=0, atol=1e-12)
    assert found.lower.joints == ("A", "B", "C")


def test_what_has_no_limits_is_refused():
    mechanism = planar_fourbar(1.0)
    with pytest.raises(ValueError, match=r"the assembled pose, 0, is not in the range 1 to 2 of D.phi"):
        jk.limits(mechanism, "A", ranges={"D": (1.0, 2.0)})
    with pytest.raises(ValueError, match=r"the range of 'D' must rise, as in \(-1.0, 1.0\), got \(0.5, -0.5\)"):
        jk.limits(mechanism, "A", ranges={"D": (0.5, -0.5)})
    with pytest.raises(ValueError, match=r"must be two numbers, as in \(-1.0, 1.0\)"):
        jk.limits(mechanism, "A", ranges={"D": (1.0,)})
    with pytest.raises(ValueError, match="there is no joint 'AA'"):
        jk.limits(mechanism, "AA")
    with pytest.raises(ValueError, match="hold must be a list"):
        jk.limits(mechanism, "A", hold="B")
    with pytest.raises(ValueError, match="limits are those of one coordinate, such as 'A'"):
        jk.limits(mechanism, ["A"])  # pyright: ignore[reportArgumentType]
    with pytest.raises(ValueError, match=r"leg 0.z leaves freedoms.*: hold .* as in hold=\['leg 1.z'\]"):
        jk.limits(hexapod(), "leg 0")
    with pytest.raises(ValueError, match="outside of jit"):
        jax.jit(lambda m: jk.limits(m, "A").upper.value)(mechanism)


@pytest.mark.long
@pytest.mark.parametrize(
    ("mechanism", "drive", "why", "ends"),
    [
        (slider_crank(theta=0.0, crank=30.0, rod=120.0, offset=0.0), "S", "S.z is at a limit there, and B.phi", 60.0),
        (parallelogram(angle=0.0), "A", "branches cross there", np.inf),
    ],
    ids=["slider-crank at its dead point", "flat parallelogram"],
)
def test_a_singular_pose_is_left_by_what_the_error_says(mechanism, drive, why, ends):
    """Beside it the range is found: the slide has twice the crank, the parallelogram makes full turns."""
    with pytest.raises(ValueError, match=f"^the assembled pose is singular: {why}") as error:
        jk.limits(mechanism, drive)
    (call,) = re.findall(r"mechanism\.at\(.*\)$", str(error.value))
    found = jk.limits(eval(call, {"mechanism": mechanism}), drive)
    assert found.upper.value - found.lower.value == pytest.approx(ends, abs=1e-9)


@pytest.mark.long
@pytest.mark.parametrize(
    ("mechanism", "drive", "hold"),
    [
        (stephenson(), "G", []),
        pytest.param(hexapod(), "leg 0", [f"leg {i}" for i in range(1, 6)], marks=pytest.mark.study),
    ],
    ids=["Stephenson", "hexapod"],
)
def test_a_sweep_ends_there(mechanism, drive, hold):
    """It is closed up to 1e-6 before the limit, and cannot be reached 1e-6 behind it."""
    found = jk.limits(mechanism, drive, hold=hold)
    for end, sign in ((found.lower, -1), (found.upper, 1)):
        scale = max(1.0, abs(end.value))
        values = np.append(np.linspace(0.0, end.value - sign * 1e-6 * scale, 100), end.value + sign * 1e-6 * scale)
        motion = mechanism.sweep({drive: values, **{name: 0.0 * values for name in hold}})
        assert np.all(motion.closed[:-1]) and int(motion.status[-1]) == jk.Status.UNREACHABLE.value
        assert float(motion.sigma_min[-2]) < 0.05 * float(motion.sigma_min[0])
