"""What differs from movement to movement is said in the row of the movement, and nowhere else."""

import re
from dataclasses import replace
from inspect import signature
from pathlib import Path

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.contacts.states import CONTACT_STATES
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.io.study_file import JointTable
from jaxkin.io.study_writer import WRITTEN_ARGUMENTS
from jaxkin.joints.combine import SUBGROUP_JOINTS, subgroup_joints
from jaxkin.joints.joint import joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.pairs import JOINTS_BY_HAND
from jaxkin.view.sticks import stick_parts

PACKAGE = Path(jk.__file__).parent
NAMED_IN = {"geometry/movements.py", "contacts/states.py", "joints/pairs.py"}
NAMED_IN |= {"joints/curve_joints.py", "joints/sliding_joints.py", "joints/surface_joints.py"}
"""The rows themselves, and where joints and contact states are made of them."""


def test_no_other_file_names_a_movement():
    name = re.compile(r"""["'](T_[a-z_]+|I)["']""")
    found = {str(path.relative_to(PACKAGE)) for path in PACKAGE.rglob("*.py") if name.search(path.read_text("utf-8"))}
    assert found == NAMED_IN


def test_no_other_file_names_the_joint_of_a_contact_state():
    name = re.compile(r"""["']contact [a-p]["']""")
    text = {str(path.relative_to(PACKAGE)): path.read_text("utf-8") for path in PACKAGE.rglob("*.py")}
    assert {path for path, lines in text.items() if name.search(lines)} <= {"joints/kinds.py", "joints/joint.py"}


def test_every_contact_state_has_a_kind_and_every_subgroup_joint_a_movement():
    assert {JointKind.of_state(state.letter) for state in CONTACT_STATES} == {
        k for k in JointKind if k.name[:8] == "CONTACT_"
    }
    assert {movement.subgroup_joint for movement in MOVEMENTS.values() if movement.subgroup_joint} <= set(JointKind)
    assert str(JointKind.REVOLUTE) == "revolute" and f"{JointKind.CONTACT_B}" == "contact b"


def test_no_other_file_asks_for_a_contact_state_by_its_letter():
    """What a state is (flat, a fit, a pin) its row says."""
    name = re.compile(
        r"""(\bstates?|\.letter)\s*(==|!=|in|not in) [({[]?["'][a-p]+["']|["'][a-p]["'] (not )?in states"""
    )
    text = {str(path.relative_to(PACKAGE)): path.read_text("utf-8") for path in PACKAGE.rglob("*.py")}
    assert {path for path, lines in text.items() if name.search(lines)} == set()


def test_a_fit_is_where_one_surface_fills_the_other():
    of = {name: {s.letter for s in CONTACT_STATES if getattr(s, name)} for name in ("is_flat", "is_fit", "is_pin")}
    assert of == {"is_flat": {"a"}, "is_fit": {"e", "k", "o"}, "is_pin": {"e"}}


@pytest.mark.parametrize("kind", [kind for kind in JointKind if not kind.startswith("contact")])
def test_a_joint_by_hand_is_one_row_for_users_and_studies(kind):
    """What its function takes can be read from a study, and be written to one from a joint that it made."""
    function = JOINTS_BY_HAND[kind]
    takes = {
        name for name, argument in signature(function).parameters.items() if argument.kind is argument.KEYWORD_ONLY
    }
    assert takes <= set(JointTable.model_fields)
    assert takes - {"limits"} <= set(WRITTEN_ARGUMENTS)  # limits are written beside, in degrees
    assert getattr(jk, function.__name__) is function


def test_two_movements_are_not_the_same_subgroup_joint():
    other = replace(MOVEMENTS["T_phi"], subgroup_joint="screw")
    with pytest.raises(
        ValueError, match=r"'T_new'.*'screw', with 1 rotations and 0 translations, as 'T_phi'.*revolute"
    ):
        subgroup_joints(MOVEMENTS | {"T_new": other})
    assert subgroup_joints(MOVEMENTS) == SUBGROUP_JOINTS and len(SUBGROUP_JOINTS) == 9


@pytest.mark.parametrize("state", CONTACT_STATES, ids=lambda state: f"{state.letter}-{state.region}")
def test_a_contact_state_has_at_most_one_length_between_two_frames(state):
    assert len(state.lengths) <= len(state.movements) - 1


def test_a_movement_added_as_a_row_is_swept_measured_and_drawn(monkeypatch):
    # a slide along x instead of z: the same row but for the axis
    slide = MOVEMENTS["T_z"]
    across = replace(
        slide,
        coordinates=("x",),
        elements=(replace(slide.elements[0], axis=0),),
        feature=slide.feature._replace(axis=0) if slide.feature else None,
    )
    monkeypatch.setitem(MOVEMENTS, "T_slide", across)
    z = np.array([0.0, 0.0, 1.0])
    pins = [
        jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=z),
        jk.revolute("B", "crank", "rod", point=(1, 0, 0), axis=z),
        jk.revolute("C", "rod", "slider", point=(4, 0, 0), axis=z),
    ]
    rail = joint("D", ("ground", "slider"), JointKind.PRISMATIC, ("T_slide",), [np.eye(4)])
    mechanism = jk.Mechanism.build(joints=[*pins, rail], fixed=["ground"])
    angle = np.linspace(0.0, 2.0, 9)
    motion = mechanism.sweep({"A": angle})
    assert np.all(np.asarray(motion.closed))
    # crank 1, rod 3: x = cos a + sqrt(9 - sin^2 a), and x = 4 as assembled; rounding of double precision
    wanted = np.cos(angle) + np.sqrt(9.0 - np.sin(angle) ** 2) - 4.0
    np.testing.assert_allclose(np.asarray(motion.coordinates["D"])[:, 0], wanted, atol=1e-12)
    assert mechanism.lengths["crank", "A", "B"] == pytest.approx(1.0, rel=1e-14)
    assert mechanism.lengths["slider", "C", "D"] == pytest.approx(0.0, abs=1e-14)
    assert {part.name for part in stick_parts(mechanism)} == {"ground", "crank", "rod", "slider"}
