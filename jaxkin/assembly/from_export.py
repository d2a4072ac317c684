"""The mechanism of the joints and mates that the export of a CAD system, or the file of a robot, says."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from jaxkin._names import free_name, listed
from jaxkin.assembly.exported import Constraint, Exported
from jaxkin.assembly.ignored_contacts import check_ignored
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.untied import tied_to_nothing
from jaxkin.assembly.joints_of_two import apart, joints_of_two, told
from jaxkin.assembly.subassemblies import rigid_subassemblies
from jaxkin.assembly.to_mechanism import MechanismOptions, check_options, make_mechanism
from jaxkin.contacts.contact import Contacts
from jaxkin.geometry.part import size
from jaxkin.joints.combine import subgroup_joint
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.regularise import Noise
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.coupled import counted_from, coupled
from jaxkin.linkage.linkage import Linkage

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly
    from jaxkin.mechanism.mechanism import Mechanism

DIGITS = 1e-6
"""Radians, or lengths over the size of the assembly, within which axes of an export are parallel or coincide: exporters
write nine decimals of a metre, which is 1e-7 of a part of ten millimetres, and directions that are rounded alike."""

PLACES = 4.0
"""Roundings that add up on the way to a direction: of two sub-assemblies, of a part in them, and of the direction."""


def from_export(assembly: Assembly, exported: Exported, options: MechanismOptions) -> Mechanism:
    """Make the mechanism that an export says, but where the user's `options` say else; contacts are not looked at.

    All joints and mates between two bodies become the one joint that they amount to together, or as few as keep them
    all. Parts that nothing of the export ties move with the sub-assembly that they are in,
    else with the part nearest to them. Parts are fixed by the user, or else by the export. Each step is told in the
    notes of the mechanism.

    Raises ValueError where neither fixes a part, for what is about contacts, and for names that do not exist.
    """
    for word, given in (("combine=False", not options.combine), ("clearance=", options.clearance is not None)):
        if given:
            raise ValueError(
                f"{assembly.source}: {word} is about contacts, and its {exported.system} says what the joints "
                "are: leave it out, or write infer=False for the joints that contacts make"
            )
    options = options._replace(fixed=options.fixed or exported.fixed)
    if not options.fixed:
        raise ValueError(
            f"{assembly.source}: its {exported.system} holds no part; say which parts are fixed, as in "
            f"fixed=[{assembly.names[0]!r}]"
        )
    check_options(assembly.names, options)
    check_ignored((), options.ignore, [frozenset(each.parts) for each in exported.constraints], "joint or mate")
    notes = [*exported.notes]
    digits = max(DIGITS, PLACES * exported.accuracy)
    noise = Noise(digits, digits * size(assembly.parts))
    known = Known(assembly._measured, Contacts(()), options.fixed, options.rigid, options.joints)
    constraints = _heeded(exported.constraints, options, notes)
    known.take(_groups(exported, constraints, options))
    _tell_apart(constraints, notes, noise)
    while known.take(_locked(known, constraints, noise, notes)):
        pass
    joints = _joints(known, constraints, noise, notes, exported.motors, {given.name for given in options.joints})
    if not exported.marks_rigid:
        joined = [each.parts for each in options.joints] + [each.joint.parts for each in joints if each.joint]
        known.take(rigid_subassemblies(known, joined))
    notes += _replaced_notes(known, constraints, options)
    known.take(joints)
    known.take(tied_to_nothing(known))
    mechanism = make_mechanism(assembly, Contacts(()), options, known.found, exported.system)
    owner = {name: name if name in mechanism.joints else name.rpartition(".")[0] for name in exported.motors}
    motors = tuple(name for name, joint in owner.items() if joint in mechanism.joints)
    notes += [f"the motor {name!r} is left out: it moves nothing here" for name in owner if name not in motors]
    driven = {part for name in motors for part in mechanism.joints[owner[name]].parts}
    spinning = tuple(each for each in mechanism.linkage.spinning if each.name not in driven)
    linkage = _coupled(replace(mechanism.linkage, spinning=spinning), exported, notes)
    motors = _independent(linkage, motors, notes)
    return replace(mechanism, linkage=linkage, history=(*notes, *mechanism.history), motors=motors)


def _coupled(linkage: Linkage, exported: Exported, notes: list[str]) -> Linkage:
    """Make the linkage with the couplings of the export, but for those of joints that are not there; notes name
    these."""
    names = {joint.name for joint in linkage.joints if joint.freedoms}
    kept = []
    for coupling in exported.couplings:
        still = [each for each in coupling.coordinates if not {each, each.rpartition(".")[0]} & names]
        if still:
            others = [each for each in coupling.coordinates if each not in still]
            held = f"; drive {listed(list(map(repr, others)))} with zeros to hold what it ties" if others else ""
            notes.append(f"{coupling.name!r} is left out: {listed(list(map(repr, still)))} moves nothing here{held}")
        else:
            kept.append(coupling)
    return coupled(linkage, counted_from(kept, linkage.joints, exported.joint_values))


def _independent(linkage: Linkage, motors: tuple[str, ...], notes: list[str]) -> tuple[str, ...]:
    """Select the motors without those that couplings let follow the others; a note names these."""
    names = list(dict.fromkeys(name for coupling in linkage.couplings for name in coupling.coordinates))
    if not names:
        return motors
    rows = np.zeros((len(linkage.couplings), len(names)))
    for row, coupling in zip(rows, linkage.couplings, strict=True):
        row[[names.index(name) for name in coupling.coordinates]] = np.asarray(coupling.coefficients)[:, 0]
    places = {name: coordinate(linkage, name) for name in (*motors, *names)}
    kept = []
    for motor in motors:
        column = [float(places[name] == places[motor]) for name in names]
        more = np.vstack([rows, column])
        if any(column) and np.linalg.matrix_rank(more) == np.linalg.matrix_rank(rows):
            notes.append(f"the motor {motor!r} follows the other motors by couplings: drive those alone")
            continue
        rows = more if any(column) else rows
        kept.append(motor)
    return tuple(kept)


def _heeded(constraints: Sequence[Constraint], options: MechanismOptions, notes: list[str]) -> list[Constraint]:
    """Leave out the constraints of parts between which the user ignores all; a note names them."""
    ignored = [each for each in constraints if any({*each.parts} == {*pair} for pair in options.ignored)]
    if ignored:
        notes.append(f"{listed([each.text for each in ignored])} ignored, as was asked for")
    return [each for each in constraints if each not in ignored]


def _groups(exported: Exported, constraints: Sequence[Constraint], options: MechanismOptions) -> list[Inference]:
    """List the rigid groups of the export, and its welds.

    Of a group that a joint by hand is inside of, each part is held to the first one by itself: then the joint takes one
    part out of the group, and all others stay.
    """
    told = Evidence(EvidenceKind.EXPORT, (), "a rigid group of the CAD system")
    groups = []
    for group in exported.rigid:
        apart = any({*group} >= {*given.parts} for given in options.joints)
        groups += [(group[0], part) for part in group[1:]] if apart else [group]
    welds = [each for each in constraints if each.kind is JointKind.FIXED]
    return [
        *(Inference(group, told) for group in groups),
        *(Inference(each.parts, Evidence(EvidenceKind.EXPORT, (), each.text)) for each in welds),
    ]


def _tell_apart(constraints: Sequence[Constraint], notes: list[str], noise: Noise) -> None:
    """Tell which welds are between frames that do not coincide."""
    for each in constraints:
        if each.kind is JointKind.FIXED:
            apart([each], notes, noise)


def _replaced_notes(known: Known, constraints: Sequence[Constraint], options: MechanismOptions) -> list[str]:
    """Tell which constraints of two bodies joints by hand replace."""
    body, notes = known.body, []
    for owners, given in {frozenset(body[part] for part in each.parts): each for each in options.joints}.items():
        if replaced := [each for each in constraints if {body[part] for part in each.parts} == owners]:
            notes.append(f"joint {given.name!r}, given by hand, replaces {told(replaced)} between its parts")
    return notes


def _between(known: Known, constraints: Sequence[Constraint]) -> list[list[Constraint]]:
    """Collect the constraints of each two bodies that no joint joins yet; those inside a body are left out."""
    found: dict[frozenset[str], list[Constraint]] = defaultdict(list)
    for each in constraints:
        owners = frozenset(known.body[part] for part in each.parts)
        if len(owners) == 2 and owners not in known.jointed:
            found[owners].append(each)
    return list(found.values())


def _locked(known: Known, constraints: Sequence[Constraint], noise: Noise, notes: list[str]) -> list[Inference]:
    """Find pairs of bodies that several constraints leave no freedom together; features that do not meet are noted."""
    result = []
    for several in _between(known, constraints):
        together = subgroup_joint([each.chain for each in several], noise) if len(several) > 1 else None
        if together is not None and together.kind is JointKind.FIXED:
            evidence = Evidence(EvidenceKind.EXPORT, apart(several, notes, noise), f"{told(several)} leave no freedom")
            result.append(Inference(several[0].parts, evidence))
    return result


def _joints(
    known: Known,
    constraints: Sequence[Constraint],
    noise: Noise,
    notes: list[str],
    motors: Sequence[str],
    taken: Collection[str],
) -> list[Inference]:
    """Make the joints between bodies, with names that are not `taken`; axes that do not meet are added to the notes."""
    driven, taken = {*motors, *(name.rpartition(".")[0] for name in motors)}, {*taken}
    result = []
    for several in _between(known, constraints):
        whole = len(several) > 1 and not any(each.limits or each.pitch or each.name in driven for each in several)
        for found in joints_of_two(several, known.body, noise, notes, whole):
            unique = free_name(found.name, taken)
            taken.add(unique)
            evidence = found.evidence or Evidence(EvidenceKind.EXPORT)
            result.append(Inference(found.parts, evidence, replace(found, name=unique)))
    return result
