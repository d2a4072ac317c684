"""Check that a drive determines the poses of a mechanism, before they are searched for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from jaxkin._names import listed
from jaxkin.joints.joint import JointCoordinate
from jaxkin.mechanism.describe import why_infeasible
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mobility.infeasible_drive import infeasible_drive, undriven_freedoms
from jaxkin.mobility.open_loops import check_closed


def check_determined(
    mechanism: Mechanism,
    driven: Mapping[str, JointCoordinate],
    what: str,
    call: str,
    remedy: Literal["hold", "give"],
) -> None:
    """Raise ValueError unless the loops close in the assembled pose and have no freedoms beside a drive but idle ones.

    Refused are, in this order: loops that are open; joints that disagree, of which no motion is exact
    (`Linkage.ideal`); coordinates that the loops cannot follow; and coordinates that leave others free. `driven` are
    the driven and the held coordinates by full names. `what` and `call` are those of `check_closed`, and `remedy` says
    how the caller takes further coordinates: by its argument `hold`, or given with the drive.
    """
    linkage, places = mechanism.linkage, list(driven.values())
    check_closed(linkage, mechanism.unit, what, call)
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
