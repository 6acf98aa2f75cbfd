#include "bulk/ogden.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Nodus
{
  Ogden::Ogden(const MaterialParameters &parameters)
      : modulus_(parameters.ogden_moduli)
      , exponent_(parameters.ogden_exponents)
  {
    if (modulus_.size() != exponent_.size() || std::count(exponent_.begin(), exponent_.end(), 0.) > 0)
      throw InputError("Material: Ogden's law needs as many exponents, not 0, as moduli");
    const double mu = std::inner_product(modulus_.begin(), modulus_.end(), exponent_.begin(), 0.) / 2.;
    if (!(mu > 0.))
      throw InputError("Material: the moduli and exponents of Ogden's law give the shear modulus " +
                       std::to_string(mu) + "; it must be > 0");
    E_     = 2. * mu * (1. + parameters.poissons_ratio);
    kappa_ = E_ / (3. * (1. - 2. * parameters.poissons_ratio));
  }

  void Ogden::respond(Principal &principal) const
  {
    const double(&strain)[dim] = principal.strain;
    const double log_J         = strain[0] + strain[1] + strain[2];
    const double J             = std::exp(log_J);
    for (unsigned int a = 0; a < dim; ++a)
    {
      principal.stress[a] = kappa_ * J * std::expm1(log_J);
      principal.secant[a] = 0.;
      std::fill_n(principal.modulus[a], dim, kappa_ * J * (2. * J - 1.));
    }
    for (unsigned int i = 0; i < modulus_.size(); ++i)
    {
      const double alpha = exponent_[i], mu_alpha = modulus_[i] * alpha;
      double       power[dim]; // isochoric stretch^alpha
      for (unsigned int a = 0; a < dim; ++a)
        power[a] = std::exp(alpha * (strain[a] - log_J / 3.));
      const double mean = (power[0] + power[1] + power[2]) / 3.;
      for (unsigned int a = 0; a < dim; ++a)
      {
        principal.stress[a] += modulus_[i] * (power[a] - mean);
        for (unsigned int b = 0; b < dim; ++b)
          principal.modulus[a][b] += mu_alpha * ((a == b ? power[a] : 0.) - (power[a] + power[b] - mean) / 3.);
        // (power[b] - power[c]) / (strain[b] - strain[c])
        const unsigned int b = (a + 1) % dim, c = (a + 2) % dim;
        const double       z = alpha * (strain[b] - strain[c]);
        principal.secant[a] += mu_alpha * power[c] * (z == 0. ? 1. : std::expm1(z) / z);
      }
    }
  }

  double Ogden::energy_of(const double (&strain)[dim]) const
  {
    const double log_J  = strain[0] + strain[1] + strain[2];
    double       energy = kappa_ / 2. * std::pow(std::expm1(log_J), 2);
    for (unsigned int i = 0; i < modulus_.size(); ++i)
      for (unsigned int a = 0; a < dim; ++a)
        energy += modulus_[i] / exponent_[i] * std::expm1(exponent_[i] * (strain[a] - log_J / 3.));
    return energy;
  }
} // namespace Nodus
