"""Documents of FreeCAD, written as it writes them, and a crank-slider in one."""

import zipfile

import numpy as np
from scipy.spatial.transform import Rotation

from jaxkin.geometry.pose import rotation

SAME = np.eye(3)
X, Y, Z = SAME
TYPES = ("Fixed", "Revolute", "Cylindrical", "Slider", "Ball", "Distance", "Parallel", "Perpendicular", "Angle",
         "RackPinion", "Screw", "Gears", "Belt")  # fmt: skip
HALF = rotation(X, np.pi)


def pose(point=(0.0, 0.0, 0.0), turn=SAME):
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = turn, point
    return made


def placed(at):
    """Write a placement: Q3 is the real part of the quaternion."""
    numbers = dict(zip(("Px", "Py", "Pz"), at[:3, 3], strict=True)) | {
        f"Q{number}": value for number, value in enumerate(Rotation.from_matrix(at[:3, :3]).as_quat())
    }
    return "<PropertyPlacement " + " ".join(f'{key}="{float(value)!r}"' for key, value in numbers.items()) + "/>"


def xlink(name, *subs, file=""):
    inner = "".join(f'<Sub value="{sub}"/>' for sub in subs)
    return f'<XLink file="{file}" stamp="" name="{name}" count="{len(subs)}">{inner}</XLink>'


def group(*names):
    return f'<LinkList count="{len(names)}">' + "".join(f'<Link value="{name}"/>' for name in names) + "</LinkList>"


def number(value):
    return f'<Float value="{value!r}"/>'


def yes(value=True):
    return f'<Bool value="{str(value).lower()}"/>'


def joint(kind, one, other, place_1, place_2, **more):
    names = "".join(f'<Enum value="{each}"/>' for each in TYPES)
    listed = (
        f'<Integer value="{TYPES.index(kind)}" CustomEnum="true"/><CustomEnumList count="13">{names}</CustomEnumList>'
    )
    own = {"JointType": listed, "Reference1": xlink(*one), "Reference2": xlink(*other)}
    return "App::FeaturePython", own | {"Placement1": placed(place_1), "Placement2": placed(place_2), **more}


def document(path, objects, head=""):
    """Write a document of objects: {name: (type, {property: xml})}."""
    listed = "".join(f'<Object type="{kind}" name="{name}" id="1"/>' for name, (kind, _) in objects.items())
    data = ""
    for name, (_, own) in objects.items():
        said = "".join(f'<Property name="{key}" type="App::Property">{xml}</Property>' for key, xml in own.items())
        data += f'<Object name="{name}"><Properties Count="{len(own)}">{said}</Properties></Object>'
    text = f"<?xml version='1.0' encoding='utf-8'?>{head}<Document SchemaVersion=\"4\"><Objects>{listed}</Objects>"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("Document.xml", f"{text}<ObjectData>{data}</ObjectData></Document>")
    return path


def assembled(joints, parts, more=(), at=None):
    """List the objects of one assembly, parts by their placements."""
    own = {name: ("Part::Feature", {"Placement": placed(place)}) for name, place in parts.items()}
    ground = {"GroundedJoint": ("App::FeaturePython", {"ObjectToGround": '<Link value="base"/>'})}
    found = own | ground | dict(joints) | dict(more)
    place = {} if at is None else {"Placement": placed(at)}
    return found | {
        "Joints": ("Assembly::JointGroup", {"Group": group("GroundedJoint", *dict(joints))}),
        "Assembly": ("Assembly::AssemblyObject", {"Group": group("Joints", *parts, *dict(more)), **place}),
    }


CRANK, ROD = 30.0, 80.0
WHERE = pose((10.0, 20.0, 30.0), rotation(Z, 0.3) @ rotation(X, 0.7))
"""Of the assembly in the world."""


def slider_crank(folder):
    """Write a crank-slider of a part with a body, a body, a link, and a link to another document."""
    angle = 0.6
    reach = CRANK * np.cos(angle) + np.sqrt(ROD**2 - (CRANK * np.sin(angle)) ** 2)
    pin = np.array([CRANK * np.cos(angle), CRANK * np.sin(angle), 0.0])
    rod_angle = float(np.arctan2(-pin[1], reach - pin[0]))
    places = {
        "base": pose((1.0, 2.0, 3.0), rotation(Y, 0.4)),
        "crank": pose((5.0, -2.0, 1.0), rotation(Z, angle)),
        "rod": pose(pin, rotation(Z, rod_angle)),
        "slider": pose((reach, 0.0, 0.0)),
    }
    body = pose((0.0, 4.0, 0.0), rotation(X, 0.2))
    inverse = np.linalg.inv
    document(
        folder / "slider.FCStd",
        {
            "Block": ("App::Part", {"Group": group("Body"), "Placement": placed(pose((9.0, 9.0, 9.0)))}),
            "Body": ("PartDesign::Body", {"Placement": placed(body), "Group": group("Pad")}),
            "Pad": ("PartDesign::Pad", {"Placement": placed(pose((7.0, 7.0, 7.0)))}),
        },
    )
    forward = rotation(Y, np.pi / 2)
    joints = {
        "main": joint("Revolute", ("Assembly", "base.inner.Face1", "base.inner.Edge1"), ("Assembly", "crank.Edge3"),
                      inverse(places["base"] @ body), inverse(places["crank"]) @ pose((0.0, 0.0, 0.0), HALF),
                      EnableAngleMin=yes(), AngleMin=number(-90.0), EnableAngleMax=yes(False), AngleMax=number(5.0)),
        "crankpin": joint("Revolute", ("crank", "Edge1"), ("rod", "Pad.Edge2"),
                          inverse(places["crank"]) @ pose(pin), inverse(places["rod"]) @ pose(pin)),
        "wrist": joint("Revolute", ("Assembly", "rod.Pad.;g12.x;Face3"), ("Assembly", "slider.Body.Pad.Face2"),
                       inverse(places["rod"]) @ pose((reach, 0.0, 0.0)),
                       inverse(places["slider"] @ body) @ pose((reach, 0.0, 0.0))),
        "guide": joint("Slider", ("Assembly", "slider."), ("Assembly", "base."),
                       inverse(places["slider"]) @ pose((reach, 0.0, 0.0), forward),
                       inverse(places["base"]) @ pose((0.0, 0.0, 0.0), forward)),
        "off": joint("Fixed", ("Assembly", "rod.Face1"), ("Assembly", "base.Face1"), np.eye(4), np.eye(4),
                     Suppressed=yes()),
    }  # fmt: skip
    objects = {
        "base": ("App::Part", {"Group": group("inner"), "Placement": placed(places["base"])}),
        "inner": ("PartDesign::Body", {"Placement": placed(body)}),
        "source": ("Part::Feature", {"Placement": placed(pose((50.0, 0.0, 0.0), rotation(X, 1.0)))}),
        "crank": ("App::Link", {"LinkedObject": xlink("source"), "LinkPlacement": placed(places["crank"]),
                                "LinkTransform": yes(False), "Label": '<String value="the crank"/>'}),
        "rod": ("PartDesign::Body", {"Placement": placed(places["rod"]), "Group": group("Pad", "Sketch")}),
        "Pad": ("PartDesign::Pad", {"Placement": placed(pose((3.0, 3.0, 3.0)))}),
        "slider": ("App::Link", {"LinkedObject": xlink("Block", file="slider.FCStd"),
                                 "LinkPlacement": placed(places["slider"])}),
        "Grounded": ("App::FeaturePython", {"ObjectToGround": '<Link value="base"/>'}),
        **joints,
        "Joints": ("Assembly::JointGroup", {"Group": group("Grounded", *joints)}),
        "Folder": ("App::DocumentObjectGroup", {"Group": group("rod", "slider")}),
        "drive": ("App::FeaturePython", {"Joint": xlink("main"), "Formula": '<String value="time"/>',
                                         "MotionType": '<Integer value="0"/>'}),
        "Assembly": ("Assembly::AssemblyObject", {"Group": group("Joints", "base", "crank", "Folder"),
                                                  "Placement": placed(WHERE)}),
    }  # fmt: skip
    return document(folder / "machine.FCStd", objects), angle, reach
