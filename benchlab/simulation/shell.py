"""The director shell at a point: strain energy and enclosed volume, with exact first and second derivatives.

Fields over the flat sheet (s, Z): x, y (mm) and t, the coordinate along the bent axis in unstretched length; and the
director d = (d_x, d_y, d_z). Components are those of the frame (e_x, e_y, e_ψ) that turns with the angle ψ = k·t. Two
numbers are common to all points: k, the bending angle per unstretched length, and λ, the axial stretch at x = 0:

    r_a = (x_a, y_a, (λ + k x) t_a),   d_a = (d_x,a − k t_a d_z,  d_y,a,  d_z,a + k t_a d_x),   a = s, Z.

At height z above the reference surface the in-plane metric is r_a·r_b + 2 z sym(r_a·d_b) + z² d_a·d_b (a geometrically
exact shell, Simo and Fox 1989); transverse shear is r_a·d. A stiff term gives d the length that the thickness has: 1 in
fabric, and in film, which keeps its volume, det(r_a·r_b)^(-1/2): a stretched film is thinner and bends more easily.
Everything is taken through the 16 components of `v` = (r_s, r_Z, d, d_s, d_Z, y): the energy is a function of v, and v of
the fields, k and λ.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchlab.simulation.laws.law import FloatArray
from benchlab.simulation.layup import Layer

SHEAR_FACTOR = 5 / 6
X, Y, T, DX, DY, DZ = range(6)
K, LAMBDA = 18, 19
"""Places of the fields among six; of k and λ after the 3·6 values and derivatives of the fields."""


@dataclass(frozen=True)
class Laminate:
    """The layers at a point, inner first; stiffnesses are per length (N/mm).

    curvature_per_mm: of the circumference where the laminate is free of stress; 0 is a flat sheet.
    """

    layers: tuple[Layer, ...]
    curvature_per_mm: float = 0.0

    def shear_stiffness(self) -> float:
        return SHEAR_FACTOR * sum(layer.law.shear_modulus_MPa * layer.thickness_mm for layer in self.layers)

    def length_stiffness(self, incompressible: bool) -> float:
        """Young's modulus times thickness, of the layers that keep their volume or of those that keep their thickness."""
        kept = [layer for layer in self.layers if layer.law.incompressible == incompressible]
        return 3 * sum(layer.law.shear_modulus_MPa * layer.thickness_mm for layer in kept)


@dataclass(frozen=True)
class Density:
    """A function of (fields, k, λ) at n points: value (n,), gradient (n, 20), Hessian (n, 20, 20)."""

    value: FloatArray
    gradient: FloatArray
    hessian: FloatArray


def kinematics(q: FloatArray, k: float, lam: float) -> tuple[FloatArray, FloatArray]:
    """v (n, 16) and its Jacobian (n, 16, 20) from the fields with their derivatives, q (n, 3, 6)."""
    n = len(q)
    value = q[:, 0]
    rho = lam + k * value[:, X]
    v = np.empty((n, 16))
    J = np.zeros((n, 16, 20))
    for a, r, d in ((1, 0, 9), (2, 3, 12)):
        slope, at = q[:, a], 6 * a
        t = slope[:, T]
        v[:, r], v[:, r + 1], v[:, r + 2] = slope[:, X], slope[:, Y], rho * t
        v[:, d] = slope[:, DX] - k * t * value[:, DZ]
        v[:, d + 1] = slope[:, DY]
        v[:, d + 2] = slope[:, DZ] + k * t * value[:, DX]
        J[:, r, at + X] = J[:, r + 1, at + Y] = J[:, d, at + DX] = J[:, d + 1, at + DY] = J[:, d + 2, at + DZ] = 1
        J[:, r + 2, at + T], J[:, r + 2, X], J[:, r + 2, K], J[:, r + 2, LAMBDA] = rho, k * t, value[:, X] * t, t
        J[:, d, at + T], J[:, d, DZ], J[:, d, K] = -k * value[:, DZ], -k * t, -t * value[:, DZ]
        J[:, d + 2, at + T], J[:, d + 2, DX], J[:, d + 2, K] = k * value[:, DX], k * t, t * value[:, DX]
    v[:, 6:9], v[:, 15] = value[:, DX:], value[:, Y]
    J[:, 6, DX] = J[:, 7, DY] = J[:, 8, DZ] = J[:, 15, Y] = 1
    return v, J


def _through_fields(value: FloatArray, g: FloatArray, H: FloatArray, q: FloatArray, k: float, J: FloatArray) -> Density:
    """Chain rule from v to the fields: gradient g (n, 16) and Hessian H (n, 16, 16) in v are given."""
    gradient = (g[:, None, :] @ J)[:, 0]
    hessian = J.transpose(0, 2, 1) @ (H @ J)
    x, dx, dz = q[:, 0, X], q[:, 0, DX], q[:, 0, DZ]
    for a, r, d in ((1, 0, 9), (2, 3, 12)):
        t, at = q[:, a, T], 6 * a + T
        g_r, g_x, g_z = g[:, r + 2], g[:, d], g[:, d + 2]
        for i, j, term in (
            (X, at, k * g_r),
            (K, X, t * g_r),
            (K, at, x * g_r - dz * g_x + dx * g_z),
            (LAMBDA, at, g_r),
            (at, DZ, -k * g_x),
            (K, DZ, -t * g_x),
            (at, DX, k * g_z),
            (K, DX, t * g_z),
        ):
            hessian[:, i, j] += term
            hessian[:, j, i] += term
    return Density(value, gradient, hessian)


# The strains e are half quadratic forms of the five vectors in v: e = (r_a·r_b, sym r_a·d_b, d_a·d_b for ss, ZZ, sZ;
# r_s·d, r_Z·d; d·d). FORMS[e] holds the 5 x 5 coefficients of its second derivative, each times the 3 x 3 identity.
FORMS = np.zeros((12, 5, 5))
for _form, _entries in enumerate(
    (
        [(0, 0, 2.0)], [(1, 1, 2.0)], [(0, 1, 1.0)],
        [(0, 3, 1.0)], [(1, 4, 1.0)], [(0, 4, 0.5), (1, 3, 0.5)],
        [(3, 3, 2.0)], [(4, 4, 2.0)], [(3, 4, 1.0)],
        [(0, 2, 1.0)], [(1, 2, 1.0)], [(2, 2, 2.0)],
    )
):  # fmt: skip
    for _i, _j, _coefficient in _entries:
        FORMS[_form, _i, _j] = FORMS[_form, _j, _i] = _coefficient


def potential_density(
    q: FloatArray, k: float, lam: float, laminate: Laminate, pressure_MPa: float, inner_mm: float
) -> Density:
    """Strain energy − pressure · enclosed volume per reference area (N/mm) at n points of one laminate.

    q (n, 3, 6): value, d/ds, d/dZ of the fields. inner_mm: z of the face on which the pressure acts.
    """
    v, J = kinematics(q, k, lam)
    W, g, H = _strain_energy(v, laminate)
    if pressure_MPa:
        volume, slope, curvature = _enclosed_volume(v, inner_mm)
        W -= pressure_MPa * volume
        g -= pressure_MPa * slope
        H -= pressure_MPa * curvature
    return _through_fields(W, g, H, q, k, J)


def volume_density(q: FloatArray, k: float, lam: float, inner_mm: float) -> FloatArray:
    """Volume enclosed by the face at z = `inner_mm`, per reference area (mm) at n points."""
    return _enclosed_volume(kinematics(q, k, lam)[0], inner_mm)[0]


def strains(q: FloatArray, k: float, lam: float) -> FloatArray:
    """The twelve strains (n, 12) that FORMS defines."""
    v = kinematics(q, k, lam)[0][:, :15]
    return 0.5 * (_strain_slopes(v) * v[:, None, :]).sum(axis=2)


def _strain_slopes(v: FloatArray) -> FloatArray:
    """Derivatives (n, 12, 15) of the strains in v."""
    return (FORMS.reshape(60, 5) @ v[:, :15].reshape(-1, 5, 3)).reshape(-1, 12, 15)


def _strain_energy(v: FloatArray, laminate: Laminate) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Energy (n,), gradient (n, 16) and Hessian (n, 16, 16) in v."""
    n = len(v)
    slopes = _strain_slopes(v)
    e = 0.5 * (slopes @ v[:, :15, None])[:, :, 0]
    W, W_e, W_ee = _energy_of_strains(e, laminate)
    g, H = np.zeros((n, 16)), np.zeros((n, 16, 16))
    g[:, :15] = (W_e[:, None, :] @ slopes)[:, 0]
    inner = slopes.transpose(0, 2, 1) @ (W_ee @ slopes)
    blocks, geometric = inner.reshape(n, 5, 3, 5, 3), (W_e @ FORMS.reshape(12, 25)).reshape(n, 5, 5)
    for c in range(3):
        blocks[:, :, c, :, c] += geometric
    H[:, :15, :15] = inner
    return W, g, H


def _enclosed_volume(v: FloatArray, z: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Volume between the face X = r + z d and the plane of symmetry y = 0, per reference area: Y·(X_Z × X_s)_y.

    Over a cell this is exact: the end planes and the plane of symmetry add nothing to ∮ y n_y dA.
    """
    P = np.zeros((5, 16))  # to X_s and X_Z along x and ψ, and Y
    for row, (middle, director) in enumerate(((0, 9), (2, 11), (3, 12), (5, 14), (15, 7))):
        P[row, middle], P[row, director] = 1, z
    a, c, b, d, y = P @ v.T
    area = a * d - c * b
    slope = np.stack([y * d, -y * b, -y * c, y * a, area], axis=1)
    curvature = np.zeros((len(v), 5, 5))
    for i, j, value in ((0, 3, y), (1, 2, -y), (0, 4, d), (3, 4, a), (1, 4, -b), (2, 4, -c)):
        curvature[:, i, j] = curvature[:, j, i] = value
    return y * area, slope @ P, P.T @ (curvature @ P)


def thickness_points(laminate: Laminate, per_layer: int = 2) -> Sequence[tuple[Layer, float, float]]:
    """(layer, z, weight) of Gauss points through the thickness, in mm."""
    places, weights = np.polynomial.legendre.leggauss(per_layer)
    return [
        (layer, layer.bottom_mm + (1 + place) / 2 * layer.thickness_mm, weight / 2 * layer.thickness_mm)
        for layer in laminate.layers
        for place, weight in zip(places, weights)
    ]


def metric_at(e: FloatArray, z: float, curvature_per_mm: float) -> FloatArray:
    """C (n, 3) as C_ss, C_ZZ, C_sZ at height z from the strains e (n, 12), against the stress-free shape."""
    grown = 1 + z * curvature_per_mm
    return (e[:, 0:3] + 2 * z * e[:, 3:6] + z * z * e[:, 6:9]) / np.array([grown**2, 1.0, grown])


def _energy_of_strains(e: FloatArray, laminate: Laminate) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Energy per area (n,), its gradient (n, 12) and Hessian (n, 12, 12) in the strains."""
    n = len(e)
    W, W_e, W_ee = np.zeros(n), np.zeros((n, 12)), np.zeros((n, 12, 12))
    moments = np.zeros((5, n, 3, 3))
    for layer, z, thick in thickness_points(laminate):
        grown = 1 + z * laminate.curvature_per_mm
        scale = 1 / np.array([grown**2, 1.0, grown])
        C11, C22, C12 = metric_at(e, z, laminate.curvature_per_mm).T
        area = C11 * C22 - C12 * C12
        at = layer.law.energy(C11 + C22, np.where(area > 0, area, np.nan))  # turned inside out: no energy, no way there
        weight = thick * grown
        W += weight * at.W
        b_C = np.stack([C22, C11, -2 * C12], axis=1)
        stress = weight * (at.W_a[:, None] * np.array([1.0, 1.0, 0.0]) + at.W_b[:, None] * b_C) * scale
        tangent = at.W_bb[:, None, None] * b_C[:, :, None] * b_C[:, None, :]
        mixed = at.W_ab[:, None] * b_C
        tangent[:, :2] += mixed[:, None, :]
        tangent[:, :, :2] += mixed[:, :, None]
        tangent[:, :2, :2] += at.W_aa[:, None, None]
        tangent[:, 0, 1] += at.W_b
        tangent[:, 1, 0] += at.W_b
        tangent[:, 2, 2] -= 2 * at.W_b
        tangent *= weight * scale[:, None] * scale
        for order, factor in enumerate((1.0, 2 * z, z * z)):
            W_e[:, 3 * order : 3 * order + 3] += factor * stress
        for power in range(5):
            moments[power] += z**power * tangent
    for i, a in enumerate((1.0, 2.0, 1.0)):
        for j, b in enumerate((1.0, 2.0, 1.0)):
            W_ee[:, 3 * i : 3 * i + 3, 3 * j : 3 * j + 3] = a * b * moments[i + j]
    shear = laminate.shear_stiffness()
    W += shear / 2 * (e[:, 9] ** 2 + e[:, 10] ** 2)
    W_e[:, 9:11] = shear * e[:, 9:11]
    W_ee[:, 9, 9] = W_ee[:, 10, 10] = shear
    _add_length_energy(e, laminate, W, W_e, W_ee)
    return W, W_e, W_ee


def _add_length_energy(e: FloatArray, laminate: Laminate, W: FloatArray, W_e: FloatArray, W_ee: FloatArray) -> None:
    """Energy E h/8·(d·d·J² − 1)² that holds the director's length; J² = det(r_a·r_b) where volume is kept, 1 otherwise."""
    length = e[:, 11]
    if fabric := laminate.length_stiffness(incompressible=False):
        W += fabric / 8 * (length - 1) ** 2
        W_e[:, 11] += fabric / 4 * (length - 1)
        W_ee[:, 11, 11] += fabric / 4
    if film := laminate.length_stiffness(incompressible=True):
        A_ss, A_ZZ, A_sZ = e[:, :3].T
        area = A_ss * A_ZZ - A_sZ**2
        off = length * area - 1
        places = np.array([0, 1, 2, 11])
        slope = np.stack([length * A_ZZ, length * A_ss, -2 * length * A_sZ, area], axis=1)
        W += film / 8 * off**2
        W_e[:, places] += film / 4 * off[:, None] * slope
        W_ee[:, places[:, None], places] += film / 4 * slope[:, :, None] * slope[:, None, :]
        for i, j, second in ((0, 1, length), (0, 11, A_ZZ), (1, 11, A_ss), (2, 11, -2 * A_sZ)):
            W_ee[:, i, j] += film / 4 * off * second
            W_ee[:, j, i] += film / 4 * off * second
        W_ee[:, 2, 2] -= film / 2 * off * length
