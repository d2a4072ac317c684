"""A rod between two balls: of the loop without the rod one coordinate is unknown, and the rod keeps its length.

The first ball is at `near`, as seen from before the unknown motion U; the second at U `far`. |U far - near| = length is
A cos x + B sin x = C for a turn, and a quadratic for a slide. The turns of the balls follow from the rest of the loop.
"""

from __future__ import annotations

from jaxkin.solve.closed_form.arithmetic import Number, ratio, root
from jaxkin.solve.closed_form.equations import SlideRoot, TurnRoot, solve_slide, solve_turn
from jaxkin.solve.closed_form.vectors import Vector, cross, dot, subtract


def rod_turn(axis: Vector, centre: Vector, near: Vector, far: Vector, length: Number, sign: Number) -> TurnRoot:
    """Solve |U far - near| = length for the angle of U about a unit axis through `centre`, radians in (-pi, pi].

    `sign` is that of `signed_root_of_turn` in the assembled pose.
    """
    one, other = subtract(near, centre), subtract(far, centre)
    along = dot(axis, one) * dot(axis, other)
    c = 0.5 * (dot(one, one) + dot(other, other) - length * length) - along
    return solve_turn(dot(one, other) - along, dot(one, cross(axis, other)), c, sign)


def rod_slide(axis: Vector, near: Vector, far: Vector, length: Number, sign: Number) -> SlideRoot:
    """Solve |far + s axis - near| = length for the displacement s along a unit axis.

    The discriminant is the squared cosine of the angle between rod and slide. `sign` is that of `signed_root_of_slide`
    in the assembled pose.
    """
    apart = subtract(far, near)
    along = dot(axis, apart)
    across = root(dot(cross(axis, apart), cross(axis, apart)))
    return solve_slide(along, (length - across) * (length + across), length * length, sign)


def signed_root_of_turn(axis: Vector, centre: Vector, near: Vector, far: Vector) -> Number:
    """Compute the root of the discriminant of `rod_turn`, with its sign, in a pose in which the unknown is 0."""
    one, other = cross(axis, subtract(near, centre)), cross(axis, subtract(far, centre))
    return ratio(dot(axis, cross(other, one)), root(dot(one, one) * dot(other, other)))


def signed_root_of_slide(axis: Vector, near: Vector, far: Vector) -> Number:
    """Compute the root of the discriminant of `rod_slide`, with its sign, in a pose in which the unknown is 0."""
    apart = subtract(far, near)
    return ratio(dot(axis, apart), root(dot(apart, apart)))
