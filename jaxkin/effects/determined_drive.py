"""Check that a drive determines the poses of a mechanism, before they are searched for, and find where it begins."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from jaxkin._names import listed
from jaxkin.joints.joint import JointCoordinate
from jaxkin.mechanism.describe import why_infeasible
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mobility.home_pose import HomeRows, home_of_mechanism
from jaxkin.mobility.infeasible_drive import infeasible_drive, undriven_freedoms
from jaxkin.mobility.open_loops import check_assembles, tell_opening


def check_determined(
    mechanism: Mechanism,
    driven: Mapping[str, JointCoordinate],
    what: str,
    call: str,
    remedy: Literal["hold", "give"],
) -> None:
    """Raise ValueError unless the loops can be closed and have no freedoms beside a drive but idle ones.

    Refused are, in this order: loops that cannot be closed; joints that disagree, of which no motion is exact
    (`Linkage.ideal`); coordinates that the loops cannot follow; and coordinates that leave others free. `driven` are
    the driven and the held coordinates by full names. `what` and `call` are those of `check_assembles`, and `remedy`
    says how the caller takes further coordinates: by its argument `hold`, or given with the drive.
    """
    linkage, places = mechanism.linkage, list(driven.values())
    check_assembles(linkage, mechanism.unit, what, call)
    if linkage.ideal:
        raise ValueError(f"{what} cannot be told of joints that disagree: {'; '.join(mechanism.alignment)}")
    if (infeasible := infeasible_drive(linkage, places)) is not None:
        raise ValueError(why_infeasible(mechanism, infeasible))
    if free := undriven_freedoms(linkage, places):
        leaves = "leaves" if len(driven) == 1 else "leave"
        example = f", as in hold=[{free[0]!r}]" if remedy == "hold" else ""
        raise ValueError(
            f"{listed(list(driven))} {leaves} freedoms, so that there are infinitely many closed poses: {remedy} "
            f"{listed(free)} too{example}"
        )


def home_of_drive(
    mechanism: Mechanism, driven: Mapping[str, JointCoordinate], nearest: JointCoordinate | None = None
) -> HomeRows:
    """Find the pose from which a drive that `check_determined` has passed is followed, with its coordinates at 0.

    That is the assembled pose; with new lengths, or where that pose is open for another reason, the one in which the
    loops close from there. The coordinate `nearest` of the drive is as near to 0 as they close where they do not at 0.
    Raises ValueError where they do not for the others.
    """
    found = home_of_mechanism(mechanism.linkage, [*driven.values()])
    if found.loops is not None and nearest is not None:
        driven = {name: place for name, place in driven.items() if place != nearest}
        found = home_of_mechanism(mechanism.linkage, [*driven.values()])
    if found.loops is not None:
        left = tell_opening(mechanism.linkage, mechanism.unit, found.loops, found.q)
        raise ValueError(
            f"with {listed(list(driven))} at 0 the loops cannot be closed: where they are the least open, {left}; "
            "assemble the mechanism in a closed pose, as mechanism.close().mechanism, or give it other lengths"
        )
    return found.rows
