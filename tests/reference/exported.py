"""Exports for Simscape Multibody, written by hand and without solids: all parts are boxes."""

import warnings

import jaxkin as jk

FRAME = "<Transform><Rotation>1 0 0 0 1 0 0 0 1</Rotation><Translation>{} {} {}</Translation></Transform>"


def instance(uid, point=(0, 0, 0), inside="", of="P", **more):
    said = "".join(f' {name}="{value}"' for name, value in more.items())
    return f'<Instance entityUid="{of}" name="{uid}" uid="{uid}"{said}>{FRAME.format(*point)}{inside}</Instance>'


def joint(kind, name, one, other, point, second=None):
    """A joint at a point of the world between parts whose frames are that of the world."""
    sides = [("BaseFrame", one, point), ("FollowerFrame", other, second or point)]
    frames = "".join(
        f"<{tag}><InstancePath>{''.join(f'<Uid>{uid}</Uid>' for uid in path.split('/') if uid)}</InstancePath>"
        f"{FRAME.format(*place)}</{tag}>"
        for tag, path, place in sides
    )
    return f'<{kind} name="{name}">{frames}</{kind}>'


def mate(kind, name, *sides):
    """A mate between (part, geometry, point, axis) twice."""
    text = "".join(
        f'<ConstraintGeometry geomType="{geometry}"><InstancePath><Uid>{uid}</Uid></InstancePath>'
        f"<Position>{' '.join(map(str, point))}</Position><Axis>{' '.join(map(str, axis))}</Axis></ConstraintGeometry>"
        for uid, geometry, point, axis in sides
    )
    return f'<{kind} name="{name}">{text}</{kind}>'


def load(folder, tree, joints="", mates="", assemblies="", file=""):
    path = folder / "machine.xml"
    solid = f'<GeometryFile name="{file}"/>' if file else ""
    parts = f'<Parts><Part uid="P" name="p">{solid}</Part></Parts>'
    path.write_text(
        '<SimscapeMultibodyImportXML xmlns="urn:x"><RootAssembly name="machine" uid="machine">'
        f"<InstanceTree>{tree}</InstanceTree><Constraints>{mates}</Constraints><Joints>{joints}</Joints></RootAssembly>"
        f"<Assemblies>{assemblies}</Assemblies>{parts}</SimscapeMultibodyImportXML>"
    )
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*no solids for .*drawn as small boxes")
        return jk.load(path)


X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
