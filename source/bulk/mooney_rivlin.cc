#include "bulk/mooney_rivlin.h"

#include <cmath>

namespace Nodus
{
  using namespace dealii;

  MooneyRivlin::MooneyRivlin(const MaterialParameters &parameters)
      : E_(parameters.youngs_modulus)
      , c10_(E_ / (4. * (1. + parameters.poissons_ratio) * (1. + parameters.mooney_rivlin_ratio)))
      , c01_(parameters.mooney_rivlin_ratio * c10_)
      , kappa_(E_ / (3. * (1. - 2. * parameters.poissons_ratio)))
  {
  }

  void MooneyRivlin::evaluate(const Tensor<2, dim> &F, SymmetricTensor<2, dim> &S, SymmetricTensor<4, dim> *C) const
  {
    const auto   I         = unit_symmetric_tensor<dim>();
    const auto   strain    = symmetrize(transpose(F) * F); // right Cauchy-Green
    const auto   A         = invert(strain);
    const double J         = determinant(F);
    const double I1        = trace(strain);
    const double I2        = (I1 * I1 - strain * strain) / 2.;
    const auto   D         = I1 * I - strain; // dI2/d(strain)
    const double J_23      = std::pow(J, -2. / 3.);
    const double a         = 2. * c10_ * J_23;
    const double b         = 2. * c01_ * J_23 * J_23;
    const double on_A      = a * I1 / 3. + b * 2. / 3. * I2 - kappa_ * (J - 1.) * J; // minus the factor of A in S
    const double isochoric = a * I1 / 9. + b * 4. / 9. * I2;

    S = a * I + b * D - on_A * A;
    if (C)
    {
      const auto T = a / 3. * I + b * 2. / 3. * D;
      *C = 2. * (b * (outer_product(I, I) - identity_tensor<dim>()) - outer_product(T, A) - outer_product(A, T)) +
           (2. * isochoric + kappa_ * (2. * J - 1.) * J) * outer_product(A, A) + 2. * on_A * symmetric_square(A);
    }
  }

  void MooneyRivlin::evaluate_lanes(const Lanes (&F)[dim][dim], Lanes (&S)[n_pairs], Lanes (*C)[n_pairs][n_pairs]) const
  {
    Lanes strain[n_pairs], A[n_pairs], J, J_23;
    right_cauchy_green(F, strain);
    determinant(F, J);
    invert(strain, J * J, A);
    for (unsigned int v = 0; v < n_lanes; ++v)
      J_23[v] = 1. / std::cbrt(J[v] * J[v]);
    const Lanes I1 = strain[0] + strain[1] + strain[2];
    // second invariant: the sum of the principal minors
    const Lanes I2 = strain[0] * strain[1] + strain[1] * strain[2] + strain[2] * strain[0] - strain[3] * strain[3] -
                     strain[4] * strain[4] - strain[5] * strain[5];
    const Lanes a = 2. * c10_ * J_23, b = 2. * c01_ * J_23 * J_23;
    const Lanes on_A      = a * I1 / 3. + b * I2 * (2. / 3.) - kappa_ * (J - 1.) * J;
    const Lanes isochoric = a * I1 / 9. + b * I2 * (4. / 9.);
    const Lanes on_AA     = 2. * isochoric + kappa_ * (2. * J - 1.) * J;
    Lanes       T[n_pairs];
    for (unsigned int r = 0; r < n_pairs; ++r)
    {
      const Lanes D = r < dim ? I1 - strain[r] : -strain[r]; // dI2/d(strain)
      S[r]          = b * D - on_A * A[r];
      T[r]          = 2. * b * (2. / 3.) * D;
      if (r < dim)
      {
        S[r] += a;
        T[r] += 2. / 3. * a;
      }
    }
    for (unsigned int r = 0; C && r < n_pairs; ++r)
      for (unsigned int c = r; c < n_pairs; ++c)
      {
        Lanes AA;
        square(A, r, c, AA);
        Lanes sum = on_AA * A[r] * A[c] + on_A * AA - T[r] * A[c] - A[r] * T[c];
        if (r == c && r >= dim)
          sum -= b;
        if (r < dim && c < dim && r != c)
          sum += 2. * b;
        (*C)[r][c] = (*C)[c][r] = sum;
      }
  }

  double MooneyRivlin::energy(const Tensor<2, dim> &F) const
  {
    const auto   strain = symmetrize(transpose(F) * F);
    const double J      = determinant(F);
    const double I1     = trace(strain);
    const double I2     = (I1 * I1 - strain * strain) / 2.;
    const double J_23   = std::pow(J, -2. / 3.);
    return c10_ * (J_23 * I1 - 3.) + c01_ * (J_23 * J_23 * I2 - 3.) + kappa_ / 2. * (J - 1.) * (J - 1.);
  }
} // namespace Nodus
