"""The polynomial strain energy W = Σ C_ij (I1 − 3)^i (I2 − 3)^j of an incompressible rubber-like solid."""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.simulation.laws.law import Energy, FloatArray


@dataclass(frozen=True)
class Polynomial:
    """Coefficients in MPa, initial shear modulus 2·(C10 + C01).

    With C10 alone it is Neo-Hooke's law, with C10, C20 and C30 Yeoh's (1993), with C10 and C01 Mooney's and Rivlin's;
    all terms of second order are the law that the paper fitted to its film (Rivlin and Saunders 1951, as N = 2 in
    Abaqus and CalculiX).
    """

    C10: float
    C01: float = 0.0
    C20: float = 0.0
    C11: float = 0.0
    C02: float = 0.0
    C30: float = 0.0

    @property
    def incompressible(self) -> bool:
        return True

    @property
    def shear_modulus_MPa(self) -> float:
        return 2 * (self.C10 + self.C01)

    def energy(self, a: FloatArray, b: FloatArray) -> Energy:
        i, j = a + 1 / b - 3, a / b + b - 3
        # Derivatives in I1 and I2 ...
        W = i * (self.C10 + i * (self.C20 + i * self.C30) + j * self.C11) + j * (self.C01 + j * self.C02)
        W1 = self.C10 + i * (2 * self.C20 + 3 * self.C30 * i) + self.C11 * j
        W2 = self.C01 + self.C11 * i + 2 * self.C02 * j
        W11, W12, W22 = 2 * self.C20 + 6 * self.C30 * i, self.C11, 2 * self.C02
        # ... and of these in a and b: I1_a = 1, I2_a = 1/b, I1_b = −1/b², I2_b = 1 − a/b².
        r = 1 / b
        I1_b, I2_a, I2_b = -r * r, r, 1 - a * r * r
        return Energy(
            W=W,
            W_a=W1 + W2 * I2_a,
            W_b=W1 * I1_b + W2 * I2_b,
            W_aa=W11 + 2 * W12 * I2_a + W22 * I2_a**2,
            W_ab=W11 * I1_b + W12 * (I2_b + I1_b * I2_a) + W22 * I2_a * I2_b - W2 * r**2,
            W_bb=W11 * I1_b**2 + 2 * W12 * I1_b * I2_b + W22 * I2_b**2 + 2 * r**3 * (W1 + W2 * a),
        )
