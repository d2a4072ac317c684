"""Mates of CAD systems as equations in numpy, independent of jaxkin: residuals of two features, one of them moved."""

import numpy as np

AXES = np.eye(3)


def turned(vector):
    """The rotation matrix of a rotation vector, by the exponential series (Rodrigues)."""
    angle = np.linalg.norm(vector)
    if angle == 0.0:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def residual(mate, rotation, shift):
    """What is zero where a mate (kind, (feature, point, axis) at rest, the same moved) is kept: by x -> R x + t."""
    kind, (still, p, a), (moving, q, b) = mate
    now, along = rotation @ q + shift, rotation @ b
    if kind == "Angle":
        return np.array([a @ along - a @ b])
    if kind in ("Parallel", "Perpendicular"):
        aligned = (kind == "Parallel") == (still == moving)  # a line that is parallel to a plane is across its normal
        return np.cross(a, along) if aligned else np.array([a @ along])
    pair = {still, moving}
    if pair == {"point"}:
        return now - p
    if kind == "Concentric":
        return np.concatenate([np.cross(a, along), np.cross(a, now - p)])
    first = still == "plane" or (still == "line" and moving == "point")  # whether the larger feature rests
    at, normal, other = (p, a, now) if first else (now, along, p)
    at0, normal0, other0 = (p, a, q) if first else (q, b, p)
    if "line" in pair and "point" in pair:
        return np.cross(normal, other - at)
    away = np.array([normal @ (other - at) - normal0 @ (other0 - at0)])
    if pair == {"plane"}:
        return np.concatenate([np.cross(a, along), away])
    if pair == {"plane", "line"}:
        return np.concatenate([away, [a @ along]])
    return away


def freedoms(mates):
    """Six less the rank of the mates, differentiated by central differences; errors of these are 1e-10."""

    def residuals(twist):
        return np.concatenate([residual(each, turned(twist[:3]), twist[3:]) for each in mates])

    step = 1e-5
    slopes = [(residuals(step * unit) - residuals(-step * unit)) / (2 * step) for unit in np.eye(6)]
    return 6 - np.linalg.matrix_rank(np.array(slopes), tol=1e-7)


def draw(random):
    """A random mate, as (kind, feature at rest, feature that moves), which holds where nothing has moved.

    Half of the directions are axes of the world, so that mates repeat each other and are parallel by chance.
    """

    def direction():
        vector = random.normal(size=3)
        return AXES[random.integers(3)] if random.random() < 0.6 else vector / np.linalg.norm(vector)

    def across(axis):
        vector = np.cross(axis, direction())
        while np.linalg.norm(vector) < 0.1:
            vector = np.cross(axis, direction())
        return vector / np.linalg.norm(vector)

    def point():
        return random.integers(-2, 3, 3) * 0.1 if random.random() < 0.5 else random.uniform(-0.2, 0.2, 3)

    angles, others = ("Parallel", "Perpendicular", "Angle"), ("plane", "line", "point")
    kind = random.choice([*angles * 3, "Concentric", "Ball", "Pin", *others])
    a, p = direction(), point()
    one, other = ("plane", p, a), ("plane", point(), a)
    if kind in angles:
        features = [str(random.choice(["plane", "line"])) for _ in range(2)]
        b = direction()
        while abs(a @ b) > 0.95:
            b = direction()
        if kind != "Angle":
            b = a if (kind == "Parallel") == (features[0] == features[1]) else across(a)
        one, other = (features[0], p, a), (features[1], point(), b)
    elif kind == "Concentric":
        one, other = ("line", p, a), ("line", p + 0.05 * a, a)
    elif kind == "Ball":
        kind, one, other = "Coincident", ("point", p, AXES[2]), ("point", p, AXES[2])
    elif kind == "Pin":
        kind, one, other = "Coincident", ("line", p, a), ("point", p + 0.05 * a, AXES[2])
    else:
        other = (str(kind), point(), {"plane": a, "line": across(a), "point": AXES[2]}[str(kind)])
        kind = "Distance"
    return (str(kind), other, one) if random.random() < 0.5 else (str(kind), one, other)
