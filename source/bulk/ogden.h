#ifndef nodus_bulk_ogden_h
#define nodus_bulk_ogden_h

#include "bulk/principal_law.h"

#include <vector>

namespace Nodus
{
  /// Ogden's law in the isochoric stretches l_a = J^-1/3 lambda_a with the volumetric term of MooneyRivlin,
  /// W = sum_i mu_i/alpha_i (l_1^alpha_i + l_2^alpha_i + l_3^alpha_i - 3) + kappa/2 (J - 1)^2 (Ogden, Proc. R. Soc. A
  /// 326, 1972). At F = I the shear modulus is mu = sum_i mu_i alpha_i / 2, E = 2 mu (1 + nu), kappa = E / (3 (1 - 2
  /// nu)).
  class Ogden : public PrincipalLaw
  {
  public:
    /// @throws InputError unless there are as many exponents, not 0, as moduli and mu > 0.
    explicit Ogden(const MaterialParameters &parameters);

    double youngs_modulus() const override
    {
      return E_;
    }

  protected:
    void   respond(Principal &principal) const override;
    double energy_of(const double (&strain)[dim]) const override;

  private:
    std::vector<double> modulus_, exponent_;
    double              E_, kappa_;
  };
} // namespace Nodus

#endif
