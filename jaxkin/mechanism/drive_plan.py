"""Plan a drive: find what of a sweep depends on which coordinates are driven, and not on how far.

The plan is found once for a linkage and a drive. A sweep of some hundred poses takes a few milliseconds: to plan anew
each time would be a large part of them.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any, NamedTuple

import jax
import numpy as np
from jax import dtypes, lax

from jaxkin._memory import once_for_each
from jaxkin._traced import traced
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.coordinates import coordinates
from jaxkin.linkage.coupled_order import OrderOfLoops, order_with_couplings
from jaxkin.linkage.first_order import IN_SUBGROUP, Columns
from jaxkin.linkage.linkage import Linkage
from jaxkin.linkage.loop_class import LoopClass
from jaxkin.linkage.solve_order import Group, keep_freedoms_together, order_by_counting, solve_order
from jaxkin.mechanism.collect import DisplacementSources
from jaxkin.mechanism.formula_sweep import FormulaSweep
from jaxkin.mobility.infeasible_drive import InfeasibleDrive, dead_point, infeasible_drive
from jaxkin.mobility.loop_freedoms import LoopFreedoms, loop_freedoms
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes, assembled_axes
from jaxkin.solve.closed_form.group_formulas import why_not_all
from jaxkin.solve.closed_form.input_line import InputLine, full_turn
from jaxkin.solve.closed_form.planar_derivative import has_planar_slopes
from jaxkin.solve.system.from_linkage import coupled_places, group_joints, group_system, solved_coordinates
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.topology.structure import LoopGroup


class GivenLoops(NamedTuple):
    """The loops of the joints that were given, which close at the assembled pose only."""

    system: LoopSystem
    columns: Columns
    joints: Joints


class DrivenLoopGroup(NamedTuple):
    """A loop group that is to be solved."""

    members: LoopGroup
    """Its loops, couplings and joints in the structure."""
    system: LoopSystem
    """What is solved; the groups of its `order` are the steps of the plan."""
    columns: Columns
    groups: tuple[Group, ...]
    """The groups of loops of `system.order`; their joints are those of the linkage, their columns those of the
    system."""
    by_counting: bool
    """Whether the groups were found by counting and not by the ranks of the closure Jacobian: for a single loop, or
    where the joint frames are traced or do not close."""
    inputs: tuple[int, ...]
    """Numbers of its inputs among those of the drive, in the order of `system.driven`; none where its loops are only to
    be closed."""
    joints: Joints
    axes: AssembledAxes | None
    """The axes of the assembled pose, from which formulas compute the poses; None where they are traced, or where a
    group has no formula: see `jaxkin.solve.closed_form`."""
    planar_axes: AssembledAxes | None
    """The same of planar loops, from which their rates follow in poses that are known, with or without formulas; None
    where they are traced, or where `jaxkin.solve.closed_form.planar_derivative` does not serve."""
    line: InputLine | None
    """What the formulas say of a full turn of the input; None where that is no angle, or where there are no `axes`."""
    given: GivenLoops | None
    """The loops of the joints as they were given, whose residual poses are brought to the least of; None where these
    joints are the ones solved, and not `linkage.ideal`."""


class DrivePlan(NamedTuple):
    """A drive of a linkage, as yet without displacements: what is solved for it, and in which order."""

    driven: dict[str, JointCoordinate]
    """The driven coordinates by full names, in the order given."""
    freedoms: tuple[int, ...]
    """Number of freedoms of every joint."""
    loop_groups: tuple[DrivenLoopGroup, ...]
    """Loop groups that are solved; they do not depend on each other."""
    infeasible: InfeasibleDrive | None
    """Why the loops cannot follow the drive; None where they can, or where that is not sure."""
    at_dead_point: bool = False
    """Whether the assembled pose is a dead point of the drive; False where numbers are traced."""
    formula_sweep: FormulaSweep | None = None
    """The sweep of all loop groups by one program; None where one of them has no formula, or numbers are traced."""


def plan_drive(linkage: Linkage, keys: tuple[str, ...]) -> DrivePlan:
    """Plan the drive of the coordinates named `keys`; ValueError as in `coordinates.resolve`.

    The plan is kept as long as the linkage lives, unless its numbers, or what JAX makes of them here, are traced.
    """
    key = keys, dtypes.canonicalize_dtype(float), getattr(jax.config, "jax_default_device", None)
    if key in (kept := _kept(linkage)):
        return kept[key]
    if traced(linkage):  # changes of the numbers may leave a plane
        return _plan_drive(linkage.in_space, keys)
    plan = _plan_drive(linkage, keys)
    on_device = jax.device_put([(loop_group.joints, loop_group.planar_axes) for loop_group in plan.loop_groups])
    if traced(on_device):
        return plan
    loop_groups = tuple(
        loop_group._replace(joints=joints, planar_axes=axes)
        for loop_group, (joints, axes) in zip(plan.loop_groups, on_device, strict=True)
    )
    kept[key] = plan._replace(loop_groups=loop_groups, formula_sweep=_formula_sweep(plan))
    return kept[key]


@once_for_each
def _kept(linkage: Linkage) -> dict[Any, DrivePlan]:
    """Keep the plans of drives of a linkage, by the names that the drives give."""
    del linkage
    return {}


def _plan_drive(linkage: Linkage, keys: Sequence[str]) -> DrivePlan:
    """Make the plan of a drive, without `formula_sweep`; whether it is feasible is judged where numbers are known."""
    driven = coordinates(linkage, keys)
    places = list(driven.values())
    on_host = linkage if not traced(linkage) else lax.stop_gradient(linkage)  # by `grad` alone they are there
    judged = not traced(on_host) and all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(on_host))
    loop_groups = []
    for number, loop_group in enumerate(linkage.structure.loop_groups):
        inside = sorted(
            (loop_group.joints.index(joint), k, i) for i, (joint, k) in enumerate(places) if joint in loop_group.joints
        )
        if not inside and not _edited(linkage, loop_group):
            continue
        inputs = tuple(i for _, _, i in inside)
        loop_groups.append(
            _driven_loop_group(linkage, on_host if judged else None, number, tuple(places[i] for i in inputs), inputs)
        )
    freedoms = tuple(joint.freedoms for joint in linkage.joints)
    if not judged or traced(linkage):
        return DrivePlan(driven, freedoms, tuple(loop_groups), None)
    infeasible, dead = infeasible_drive(linkage, places), dead_point(linkage, places) is not None
    return DrivePlan(driven, freedoms, tuple(loop_groups), infeasible, dead)


def _driven_loop_group(
    linkage: Linkage, on_host: Linkage | None, number: int, driven: Columns, inputs: tuple[int, ...]
) -> DrivenLoopGroup:
    """Plan a loop group, its loops in the order in which they are solved; `on_host` where numbers are known."""
    loop_group, loop_class = linkage.structure.loop_groups[number], linkage.classes[number]
    # of a single loop there is one order only, and the freedoms take a millisecond to find
    several = len(loop_group.loops) + len(loop_group.couplings) > 1
    freedoms = loop_freedoms(on_host)[number] if on_host is not None and several else None
    by_counting = freedoms is None or not freedoms.closes
    if freedoms is None or by_counting:
        groups = _counted_groups(linkage, loop_group, driven, loop_class)
    else:
        groups = ranked_groups(linkage, loop_group, driven, loop_class, freedoms)
    together = [(group.loops, group.couplings) for group in groups]
    system, columns = group_system(on_host or linkage, loop_group, driven, loop_class, together)
    given = None
    if linkage.ideal:
        every = group_system(linkage, loop_group, driven, LoopClass())
        given = GivenLoops(*every, group_joints(linkage, linkage.joints, loop_group))
    joints = group_joints(linkage, linkage.solved_joints, loop_group)
    axes, line, by_formulas = None, None, why_not_all(system) is None
    planar = has_planar_slopes(system) and not traced(joints)  # under `grad` alone they are known, and have derivatives
    if on_host is not None and (by_formulas or planar):
        axes = assembled_axes(system, group_joints(on_host, on_host.solved_joints, loop_group))
        line = full_turn(system, axes) if by_formulas and system.periodic else None
    return DrivenLoopGroup(
        members=loop_group,
        system=system,
        columns=columns,
        groups=groups,
        by_counting=by_counting,
        inputs=inputs,
        joints=joints,
        axes=axes if by_formulas else None,
        planar_axes=axes if planar else None,
        line=line,
        given=given,
    )


def _formula_sweep(plan: DrivePlan) -> FormulaSweep | None:
    """Make the sweep of all loop groups by formulas; None where one has no formula, or joints that disagree."""
    loop_groups = [
        (each.columns, each.system, each.inputs[0], each.axes, each.line, each.joints)
        for each in plan.loop_groups
        if each.axes is not None and each.given is None
    ]
    if not loop_groups or len(loop_groups) < len(plan.loop_groups):
        return None
    columns, *rest = map(tuple, zip(*loop_groups, strict=True))
    return FormulaSweep(DisplacementSources(plan.freedoms, tuple(plan.driven.values()), columns), *rest)


def ranked_groups(
    linkage: Linkage, loop_group: LoopGroup, driven: Columns, loop_class: LoopClass, freedoms: LoopFreedoms
) -> tuple[Group, ...]:
    """Find the groups of loops of a loop group by ranks of the closure Jacobian beside the assembled pose."""
    columns = solved_coordinates(linkage, loop_group, driven, loop_class).columns
    screws = freedoms.screws[:, [freedoms.columns.index(place) for place in columns]]
    looped = {joint for loop in loop_group.loops for joint, _ in loop}
    ends = {joint: pair for joint, pair in freedoms.ends.items() if joint in looped}

    def order(known: Collection[int]) -> tuple[Group, ...]:
        given = [column for column in known if columns[column][0] in looped]
        groups = solve_order(ends, loop_group.loops, columns, screws, given, freedoms.thresholds)
        return keep_freedoms_together(groups, columns, screws, freedoms.thresholds)

    return _with_couplings(linkage, loop_group, driven, columns, order)


def _counted_groups(
    linkage: Linkage, loop_group: LoopGroup, driven: Columns, loop_class: LoopClass
) -> tuple[Group, ...]:
    """Find the groups of loops of a loop group by counting, from the class of the loops alone."""
    solved = solved_coordinates(linkage, loop_group, driven, loop_class)
    about_point = loop_class.spherical
    equations = [IN_SUBGROUP if solved.planar or k in about_point else None for k in range(len(loop_group.loops))]

    def order(known: Collection[int]) -> tuple[Group, ...]:
        unknown = {joint: list[int]() for joint in loop_group.joints}
        for column, (joint, _) in enumerate(solved.columns):
            if column not in known:
                unknown[joint].append(column)
        return order_by_counting(loop_group.loops, unknown, equations)

    return _with_couplings(linkage, loop_group, driven, solved.columns, order)


def _with_couplings(
    linkage: Linkage, loop_group: LoopGroup, driven: Columns, columns: Columns, order: OrderOfLoops
) -> tuple[Group, ...]:
    """Find the groups of loops in the order that `order` finds, with the couplings before, among and after them."""
    given = [columns.index(place) for place in driven]
    if not loop_group.couplings:
        return order(given)
    tied = {
        number: tuple(columns.index(place) for place in coupled_places(linkage, number))
        for number in loop_group.couplings
    }
    return order_with_couplings(loop_group.loops, tied, columns, given, order)


def _edited(linkage: Linkage, loop_group: LoopGroup) -> bool:
    """Tell whether loops may be open at the assembled pose: after a change of lengths, or where numbers are traced."""
    joints = [linkage.solved_joints[joint] for joint in loop_group.joints]
    couplings = [linkage.couplings[number] for number in loop_group.couplings]
    return (
        traced((joints, couplings))
        or any(not joint.coincides for joint in joints)
        or any(float(coupling.offset) for coupling in couplings)
    )
