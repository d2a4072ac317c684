"""The matrices of Section 3 entry by entry, as the paper prints them (but for errata), and of movements of our own."""

import numpy as np


def matrix(movement, q, pitch=0.0):
    """The 4x4 matrices of a movement for coordinates (coordinates, poses), in their printed order; poses come first."""
    q = np.asarray(q)
    one, zero = np.ones(q.shape[1]), np.zeros(q.shape[1])
    c, s = np.cos(q), np.sin(q)
    match movement:
        case "I":
            rows = [[one, zero, zero, zero], [zero, one, zero, zero], [zero, zero, one, zero]]
        case "T_z":
            rows = [[one, zero, zero, zero], [zero, one, zero, zero], [zero, zero, one, q[0]]]
        case "T_x":
            rows = [[one, zero, zero, q[0]], [zero, one, zero, zero], [zero, zero, one, zero]]
        case "T_y":
            rows = [[one, zero, zero, zero], [zero, one, zero, q[0]], [zero, zero, one, zero]]
        case "T_xy":
            rows = [[one, zero, zero, q[0]], [zero, one, zero, q[1]], [zero, zero, one, zero]]
        case "T_xyz":
            rows = [[one, zero, zero, q[0]], [zero, one, zero, q[1]], [zero, zero, one, q[2]]]
        case "T_xyz_phi":
            rows = _about_z(c[3], s[3], *q[:3])
        case "T_phi":
            rows = _about_z(c[0], s[0], zero, zero, zero)
        case "T_theta":
            rows = [[one, zero, zero, zero], [zero, c[0], -s[0], zero], [zero, s[0], c[0], zero]]
        case "T_phi_y":
            rows = [[c[0], zero, s[0], zero], [zero, one, zero, zero], [-s[0], zero, c[0], zero]]
        case "T_screw":
            rows = _about_z(c[0], s[0], zero, zero, pitch * q[0] / (2 * np.pi))
        case "T_z_phi":
            rows = _about_z(c[1], s[1], zero, zero, q[0])
        case "T_xy_phi":
            rows = _about_z(c[2], s[2], q[0], q[1], zero)
        case "T_theta_phi":
            (ct, cf), (st, sf) = c, s
            rows = [[cf, sf * st, sf * ct, zero], [zero, ct, -st, zero], [-sf, cf * st, cf * ct, zero]]
        case "T_theta_phi_theta":  # Rx Ry Rx, multiplied out; its skew part has no z component
            (ct, cf), (st, sf) = c, s
            rows = [
                [cf, sf * st, sf * ct, zero],
                [sf * st, ct * ct - st * st * cf, -st * ct - st * ct * cf, zero],
                [-sf * ct, st * ct + st * ct * cf, ct * ct * cf - st * st, zero],
            ]
        case "T_theta_phi_psi":
            (ct, cf, cp), (st, sf, sp) = c, s
            rows = [
                [cp * cf, cp * sf * st - sp * ct, cp * sf * ct + sp * st, zero],
                [sp * cf, sp * sf * st + cp * ct, sp * sf * ct - cp * st, zero],
                [-sf, cf * st, cf * ct, zero],
            ]
        case _:
            raise ValueError(f"the paper has no movement {movement!r}")
    return np.moveaxis(np.array([*rows, [zero, zero, zero, one]]), -1, 0)


def _about_z(c, s, x, y, z):
    one, zero = np.ones_like(c), np.zeros_like(c)
    return [[c, -s, zero, x], [s, c, zero, y], [zero, zero, one, z]]
