#include "bulk/j2_plasticity.h"

#include <algorithm>
#include <cmath>

namespace Nodus
{
  J2Plasticity::J2Plasticity(const MaterialParameters &parameters)
      : E_(parameters.youngs_modulus)
      , kappa_(E_ / (3. * (1. - 2. * parameters.poissons_ratio)))
      , mu_(E_ / (2. * (1. + parameters.poissons_ratio)))
      , hardening_(parameters)
  {
  }

  void J2Plasticity::set_initial(double *const state) const
  {
    std::fill_n(state, dim, 1.);
    std::fill(state + dim, state + history_size, 0.);
  }

  void J2Plasticity::respond(Principal &principal) const
  {
    const double log_J = principal.strain[0] + principal.strain[1] + principal.strain[2];
    double       deviator[dim], norm = 0.;
    for (unsigned int a = 0; a < dim; ++a)
    {
      deviator[a] = principal.strain[a] - log_J / 3.;
      norm += deviator[a] * deviator[a];
    }
    norm = std::sqrt(norm);

    // von Mises stress of the trial; what is left of the deviator, and its derivative along itself (eq. B9), see Simo &
    // Hughes, box 3.2
    const double trial = std::sqrt(6.) * mu_ * norm;
    double       left = 1., along = 1.;
    if (trial > hardening_.yield_stress(principal.plastic_strain) * (1. + 1e-12))
    {
      const double increment = hardening_.increment(principal.plastic_strain, trial, 3. * mu_);
      principal.plastic_strain += increment;
      const double slope = hardening_.slope(principal.plastic_strain);
      left               = 1. - 3. * mu_ * increment / trial;
      along              = slope / (3. * mu_ + slope);
    }
    const double across = left == 1. ? 0. : 2. * mu_ * (along - left) / (norm * norm);
    for (unsigned int a = 0; a < dim; ++a)
    {
      principal.elastic_strain[a] = log_J / 3. + left * deviator[a];
      principal.stress[a]         = kappa_ * log_J + 2. * mu_ * left * deviator[a];
      principal.secant[a]         = 2. * mu_ * left;
      for (unsigned int b = 0; b < dim; ++b)
        principal.modulus[a][b] =
            kappa_ + 2. * mu_ * left * ((a == b ? 1. : 0.) - 1. / 3.) + across * deviator[a] * deviator[b];
    }
  }

  double J2Plasticity::energy_of(const double (&elastic_strain)[dim]) const
  {
    const double log_J  = elastic_strain[0] + elastic_strain[1] + elastic_strain[2];
    double       energy = kappa_ / 2. * log_J * log_J;
    for (const double strain : elastic_strain)
      energy += mu_ * std::pow(strain - log_J / 3., 2);
    return energy;
  }
} // namespace Nodus
