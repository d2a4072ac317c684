"""Two grippers as models of MuJoCo, with the places of joints and anchors that MuJoCo Menagerie publishes.

Metres and radians; github.com/google-deepmind/mujoco_menagerie, models robotiq_2f85 (its release of 2022) and
ufactory_xarm7/hand. Both have two fingers, each on a four-bar linkage closed by <connect>, and drivers that <equality>
and a tendon couple. The arms of the Robotiq are turned about the middle, those of the xArm mirrored: their axes differ.
"""

_HEAD = '<mujoco><compiler angle="radian" autolimits="true" boundmass="0.01" boundinertia="1e-6"/>'

_TAIL = """<tendon><fixed name="split"><joint joint="right_driver" coef="0.5"/><joint joint="left_driver" coef="0.5"/>
</fixed></tendon><actuator><general name="fingers" tendon="split"/></actuator></mujoco>"""


def _robotiq_finger(side: str, y: int, turned: str) -> str:
    return f"""
<body name="{side}_driver" pos="0 {y * 0.0306011} 0.054904" {turned}><joint name="{side}_driver" range="0 0.8"/>
  <body name="{side}_coupler" pos="0 0.0315 -0.0041"><joint name="{side}_coupler" range="-1.57 0"/></body></body>
<body name="{side}_spring_link" pos="0 {y * 0.0132} 0.0609" {turned}>
  <joint name="{side}_spring_link" range="-0.29670597283 0.8" stiffness="0.05" springref="2.62"/>
  <body name="{side}_follower" pos="0 0.055 0.0375">
    <joint name="{side}_follower" range="-0.872664 0.872664" pos="0 -0.018 0.0065"/>
    <body name="{side}_pad" pos="0 -0.0189 0.01352"/></body></body>"""


ROBOTIQ_2F85 = f"""{_HEAD}<default><joint axis="1 0 0"/></default><worldbody><body name="base" pos="0 0 0.0108"
quat="1 0 0 -1">{_robotiq_finger("right", 1, "")}{_robotiq_finger("left", -1, 'quat="0 0 0 1"')}</body></worldbody>
<equality><connect anchor="0 0 0" body1="right_follower" body2="right_coupler"/>
<connect anchor="0 0 0" body1="left_follower" body2="left_coupler"/>
<joint joint1="right_driver" joint2="left_driver" polycoef="0 1 0 0 0"/></equality>{_TAIL}"""


def _xarm_finger(side: str, y: int) -> str:
    return f"""
<body name="{side}_outer_knuckle" pos="0 {y * 0.035} 0.059098"><joint name="{side}_driver" axis="{y} 0 0"/>
  <body name="{side}_finger" pos="0 {y * 0.035465} 0.042039"><joint name="{side}_finger" axis="{-y} 0 0"/></body></body>
<body name="{side}_inner_knuckle" pos="0 {y * 0.02} 0.074098">
  <joint name="{side}_inner_knuckle" axis="{y} 0 0" stiffness="0.05" springref="2.62"/></body>"""


XARM_HAND = f"""{_HEAD}<default><joint range="0 0.85"/></default><worldbody><body name="base">
{_xarm_finger("left", 1)}{_xarm_finger("right", -1)}</body></worldbody>
<equality><connect anchor="0 0.015 0.015" body1="right_finger" body2="right_inner_knuckle"/>
<connect anchor="0 -0.015 0.015" body1="left_finger" body2="left_inner_knuckle"/>
<joint joint1="left_driver" joint2="right_driver" polycoef="0 1 0 0 0"/></equality>{_TAIL}"""
