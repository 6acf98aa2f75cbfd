#ifndef nodus_bulk_dilatation_modes_h
#define nodus_bulk_dilatation_modes_h

#include "bulk/lanes.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>

namespace Nodus
{
  /// Modes of the pressure and of the dilatation in hexahedra, and the projection on them: sum the right-hand side with
  /// project(), then solve() with the mass of the cells at hand.
  template <unsigned int degree>
  class DilatationModes
  {
  public:
    static constexpr unsigned int n_q     = (degree + 1) * (degree + 1) * (degree + 1);
    static constexpr unsigned int n_modes = degree == 1 ? 1 : dim + 1;

    DilatationModes()
    {
      const dealii::QGauss<dim> quadrature(degree + 1);
      for (unsigned int q = 0; q < n_q; ++q)
        for (unsigned int k = 0; k < n_modes; ++k)
          mode_[q][k] = k == 0 ? 1. : 2. * quadrature.point(q)[k - 1] - 1.;
    }

    double value(const unsigned int q, const unsigned int k) const
    {
      return mode_[q][k];
    }

    /// Other cells come; their points follow with add_mass(), then factorise().
    void clear_mass()
    {
      for (unsigned int k = 0; k < n_modes; ++k)
        std::fill_n(mass_[k], n_modes, Lanes{});
    }

    void add_mass(const unsigned int q, const Lanes &JxW)
    {
      for (unsigned int k = 0; k < n_modes; ++k)
      {
        const Lanes weighted = mode_[q][k] * JxW;
        for (unsigned int l = 0; l <= k; ++l)
          mass_[k][l] += weighted * mode_[q][l];
      }
    }

    /// The mass becomes L D L^T, in place: L below the diagonal, 1/D on it.
    void factorise()
    {
      for (unsigned int j = 0; j < n_modes; ++j)
      {
        Lanes scaled[n_modes]; // row j of L D
        for (unsigned int l = 0; l < j; ++l)
        {
          scaled[l] = mass_[j][l];
          for (unsigned int m = 0; m < l; ++m)
            scaled[l] -= scaled[m] * mass_[l][m];
          mass_[j][l] = scaled[l] * mass_[l][l];
          mass_[j][j] -= mass_[j][l] * scaled[l];
        }
        mass_[j][j] = 1. / mass_[j][j];
      }
    }

    /// Adds the product of @p weight and @p value at a point to the right-hand side @p sum.
    void project(const unsigned int q, const Lanes &weight, const Lanes &value, Lanes (&sum)[n_modes]) const
    {
      for (unsigned int k = 0; k < n_modes; ++k)
        sum[k] += mode_[q][k] * weight * value;
    }

    /// @param x right-hand side, then the coefficients of the modes
    void solve(Lanes (&x)[n_modes]) const
    {
      for (unsigned int k = 0; k < n_modes; ++k)
        for (unsigned int l = 0; l < k; ++l)
          x[k] -= mass_[k][l] * x[l];
      for (unsigned int k = n_modes; k-- > 0;)
      {
        x[k] *= mass_[k][k];
        for (unsigned int l = k + 1; l < n_modes; ++l)
          x[k] -= mass_[l][k] * x[l];
      }
    }

    /// The field that has these coefficients, at a point.
    void at_point(const unsigned int q, const Lanes (&coefficient)[n_modes], Lanes &result) const
    {
      Lanes sum = coefficient[0];
      for (unsigned int k = 1; k < n_modes; ++k)
        sum += mode_[q][k] * coefficient[k];
      result = sum;
    }

  private:
    double mode_[n_q][n_modes];
    Lanes  mass_[n_modes][n_modes];
  };
} // namespace Nodus

#endif
