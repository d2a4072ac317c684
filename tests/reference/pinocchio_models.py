"""Models of Pinocchio that a URDF and its file of loops say together."""


def with_balls(pinocchio, model, balls):
    """The model with joints that turn as balls, as those who wrote the format make it."""
    made = pinocchio.Model()
    for name, joint, parent, place in zip(
        model.names[1:], model.joints[1:], model.parents[1:], model.jointPlacements[1:], strict=True
    ):
        kind = pinocchio.JointModelSpherical() if name in balls else joint
        made.addJoint(parent, kind, place, name)
    for frame in model.frames[1:]:
        made.addFrame(frame)
    return made
