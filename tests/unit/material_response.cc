// Uniaxial stress (free lateral faces) and simple shear of each law against closed forms, relative to 1e-8,
// compressible and nearly incompressible. J2 plasticity: monotonic, unloaded and loaded again, tabulated and
// exponential hardening, independent of the number of steps and of rotations in between; the work of the stress is
// stored or dissipated.

#include "bulk/material.h"

#include "../numbers.h"

#include <cmath>
#include <iostream>
#include <vector>

using namespace dealii;
using Nodus::dim;
using Law = Nodus::MaterialParameters::Law;

namespace
{
  constexpr double tolerance = 1e-8;

  void check(const std::string &what, const double error, const double allowed = tolerance)
  {
    std::cout << "  " << what << ": " << Numbers::error_below(error, allowed) << std::endl;
  }

  /// A stress that was computed, axial or shear, and its error relative to the closed form.
  struct Stress
  {
    double value, error;
  };

  void check(const std::string &what, const Stress &stress)
  {
    std::cout << "  " << what << ": " << Numbers::number(stress.value) << " (closed form within " << tolerance << ')';
    if (!(stress.error < tolerance))
      std::cout << ", error " << stress.error << ": NO";
    std::cout << std::endl;
  }

  void check(const std::string &what, const double value, const double reference, const double allowed)
  {
    std::cout << "  " << what << ": " << Numbers::comparison(value, reference, allowed) << std::endl;
  }

  /// A law and its moduli.
  struct Sample
  {
    Nodus::MaterialParameters        parameters;
    std::unique_ptr<Nodus::Material> law;
    double                           E, nu, mu, lambda, kappa;

    explicit Sample(const Nodus::MaterialParameters &p)
        : parameters(p)
        , law(Nodus::make_material(p))
        , E(law->youngs_modulus())
        , nu(p.poissons_ratio)
        , mu(E / (2. * (1. + nu)))
        , lambda(E * nu / ((1. + nu) * (1. - 2. * nu)))
        , kappa(E / (3. * (1. - 2. * nu)))
    {
    }
  };

  Nodus::MaterialParameters parameters(const Law law, const double nu)
  {
    Nodus::MaterialParameters p;
    p.law            = law;
    p.poissons_ratio = nu;
    if (law == Law::ogden) // rubber, MPa (Ogden 1972 after Treloar's data)
    {
      p.ogden_moduli    = {0.63, 0.0012, -0.01};
      p.ogden_exponents = {1.3, 5., -2.};
    }
    else
      p.youngs_modulus = 3.;
    if (law == Law::mooney_rivlin)
      p.mooney_rivlin_ratio = 0.4;
    return p;
  }

  /// @param stretch along x @param lateral the others
  Tensor<2, dim> uniaxial(const double stretch, const double lateral)
  {
    return Tensor<2, dim>({{stretch, 0., 0.}, {0., lateral, 0.}, {0., 0., lateral}});
  }

  /// Of free lateral faces: Cauchy stress (stress, 0, 0), relative.
  Stress uniaxial_error(const SymmetricTensor<2, dim> &computed, const double stress)
  {
    SymmetricTensor<2, dim> expected;
    expected[0][0] = stress;
    return {computed[0][0], (computed - expected).norm() / std::abs(stress)};
  }

  /// Uniaxial stretch of a law with the isochoric axial stretch @p r, whose principal Kirchhoff stresses then differ by
  /// @p q, and U = kappa/2 (J-1)^2: the lateral stress kappa J (J-1) - q/3 vanishes.
  Stress isochoric_uniaxial_error(const Sample &s, const double r, const double q)
  {
    const double J = (1. + std::sqrt(1. + 4. * q / (3. * s.kappa))) / 2., third = std::cbrt(J);
    return uniaxial_error(s.law->cauchy_stress(uniaxial(r * third, third / std::sqrt(r))), q / J);
  }

  Tensor<2, dim> shear(const double gamma)
  {
    return Tensor<2, dim>({{1., gamma, 0.}, {0., 1., 0.}, {0., 0., 1.}});
  }

  Stress
  shear_error(const Sample &s, const double gamma, const double xx, const double yy, const double zz, const double xy)
  {
    const SymmetricTensor<2, dim> expected({xx, yy, zz, xy, 0., 0.});
    const SymmetricTensor<2, dim> computed = s.law->cauchy_stress(shear(gamma));
    return {computed[0][1], (computed - expected).norm() / expected.norm()};
  }

  /// Principal stresses t of simple shear: the axes of the largest and the smallest stretch are turned by phi from x
  /// and y, tan 2 phi = 2/gamma; the third is z.
  Stress principal_shear_error(const Sample &s, const double gamma, const double (&t)[dim])
  {
    const double root = std::sqrt(4. + gamma * gamma), half = (t[0] - t[1]) / 2., mean = (t[0] + t[1]) / 2.;
    return shear_error(s, gamma, mean + half * gamma / root, mean - half * gamma / root, t[2], half * 2. / root);
  }

  void elastic(const double nu)
  {
    std::cout << "nu = " << nu << std::endl;
    for (const double axial : {0.6, 0.9, 1.7})
    {
      std::cout << " axial stretch about " << axial << std::endl;
      {
        const Sample s(parameters(Law::linear_elastic, nu));
        const double e = axial - 1.;
        check("linear elastic", uniaxial_error(s.law->cauchy_stress(uniaxial(axial, 1. - nu * e)), s.E * e));
      }
      {
        // Green strain e axially and -nu e laterally, S = E e; sigma = S stretch^2 / J
        const Sample s(parameters(Law::st_venant_kirchhoff, nu));
        const double e = (axial * axial - 1.) / 2., lateral_2 = 1. - 2. * nu * e;
        check("St Venant-Kirchhoff",
              uniaxial_error(s.law->cauchy_stress(uniaxial(axial, std::sqrt(lateral_2))), s.E * e * axial / lateral_2));
      }
      {
        // lateral stress mu (l^2 - 1) + lambda ln J = 0 gives J for a lateral stretch l
        const Sample s(parameters(Law::neo_hookean, nu));
        const double l = std::pow(axial, -nu), J = std::exp(-s.mu * (l * l - 1.) / s.lambda), stretch = J / (l * l);
        check("neo-Hookean",
              uniaxial_error(s.law->cauchy_stress(uniaxial(stretch, l)), s.mu * (stretch * stretch - l * l) / J));
      }
      {
        const Sample s(parameters(Law::mooney_rivlin, nu));
        const double r = axial, c10 = s.mu / 2. / 1.4, c01 = 0.4 * c10;
        check("Mooney-Rivlin", isochoric_uniaxial_error(s, r, 2. * (r * r - 1. / r) * (c10 + c01 / r)));
      }
      {
        const Sample s(parameters(Law::ogden, nu));
        double       q = 0.;
        for (unsigned int i = 0; i < 3; ++i)
          q += s.parameters.ogden_moduli[i] * (std::pow(axial, s.parameters.ogden_exponents[i]) -
                                               std::pow(axial, -s.parameters.ogden_exponents[i] / 2.));
        check("Ogden", isochoric_uniaxial_error(s, axial, q));
      }
    }
    for (const double g : {0.01, 1.5})
    {
      std::cout << " simple shear " << g << std::endl;
      {
        const Sample s(parameters(Law::linear_elastic, nu));
        check("linear elastic", shear_error(s, g, 0., 0., 0., s.mu * g));
      }
      {
        // Green strains xy g/2, yy g^2/2; sigma = F S F^T
        const Sample s(parameters(Law::st_venant_kirchhoff, nu));
        const double Szz = s.lambda * g * g / 2., Syy = Szz + s.mu * g * g, Sxy = s.mu * g;
        check("St Venant-Kirchhoff", shear_error(s, g, Szz + 2. * g * Sxy + g * g * Syy, Syy, Szz, Sxy + g * Syy));
      }
      {
        const Sample s(parameters(Law::neo_hookean, nu));
        check("neo-Hookean", shear_error(s, g, s.mu * g * g, 0., 0., s.mu * g));
      }
      {
        // deviatoric part of 2 c10 b - 2 c01 b^-1
        const Sample s(parameters(Law::mooney_rivlin, nu));
        const double c10 = s.mu / 2. / 1.4, c01 = 0.4 * c10, mean = 2. * (c10 - c01) * g * g / 3.;
        check("Mooney-Rivlin",
              shear_error(s, g, 2. * c10 * g * g - mean, -2. * c01 * g * g - mean, -mean, 2. * (c10 + c01) * g));
      }
      {
        const Sample s(parameters(Law::ogden, nu));
        const double stretch[dim] = {
            g / 2. + std::sqrt(1. + g * g / 4.), 1. / (g / 2. + std::sqrt(1. + g * g / 4.)), 1.};
        double t[dim] = {0., 0., 0.};
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int a = 0; a < dim; ++a)
            for (unsigned int b = 0; b < dim; ++b)
              t[a] += s.parameters.ogden_moduli[i] * ((a == b ? 1. : 0.) - 1. / 3.) *
                      std::pow(stretch[b], s.parameters.ogden_exponents[i]);
        check("Ogden", principal_shear_error(s, g, t));
      }
    }
  }

  constexpr double yield = 0.02, modulus = 0.5;

  Sample plastic()
  {
    auto p              = parameters(Law::j2_plasticity, 0.3);
    p.yield_stress      = yield;
    p.hardening_modulus = modulus;
    return Sample(p);
  }

  /// A material point on its way.
  struct Path
  {
    const Nodus::Material  &law;
    std::vector<double>     state;
    SymmetricTensor<2, dim> S;

    explicit Path(const Nodus::Material &law)
        : law(law)
        , state(law.n_state())
    {
      law.set_initial(state.data());
    }
    void go(const Tensor<2, dim> &F)
    {
      std::vector<double> after(state.size());
      law.update(F, state.data(), after.data(), S, nullptr);
      state = after;
    }
  };

  /// Axial logarithmic strain @p strain with the plastic one @p plastic in it, free lateral faces: the Kirchhoff stress
  /// is E (strain - plastic), the lateral strain -nu elastic - plastic/2.
  Tensor<2, dim> uniaxial_strain(const Sample &s, const double strain, const double plastic)
  {
    return uniaxial(std::exp(strain), std::exp(-s.nu * (strain - plastic) - plastic / 2.));
  }
  Stress uniaxial_error(const Sample &s, const Path &path, const double strain, const double plastic)
  {
    const double elastic = strain - plastic, J = std::exp((1. - 2. * s.nu) * elastic);
    return uniaxial_error(path.law.cauchy_stress(uniaxial_strain(s, strain, plastic), path.state.data()),
                          s.E * elastic / J);
  }

  void plasticity()
  {
    const Sample s = plastic();
    std::cout << "J2 plasticity" << std::endl;
    // linear hardening: E (e - p) = yield + H p
    const auto flow = [&](const double e) { return (s.E * e - yield) / (s.E + modulus); };
    check("elastic below the yield stress",
          uniaxial_error(s.law->cauchy_stress(uniaxial_strain(s, 0.9 * yield / s.E, 0.)),
                         0.9 * yield / std::exp((1. - 2. * s.nu) * 0.9 * yield / s.E)));
    for (const unsigned int n : {1, 7})
    {
      Path path(*s.law);
      for (unsigned int i = 1; i <= n; ++i)
      {
        const double e = 0.5 * i / n;
        path.go(uniaxial_strain(s, e, flow(e)));
      }
      const double p = flow(0.5);
      check("uniaxial to the logarithmic strain 0.5 in " + std::to_string(n) + " steps",
            uniaxial_error(s, path, 0.5, p));
      check("equivalent plastic strain", s.law->equivalent_plastic_strain(path.state.data()), p, tolerance);
      check("dissipation", s.law->dissipation(path.state.data()), yield * p + modulus * p * p / 2., tolerance);
      check("stored energy",
            s.law->stored_energy(uniaxial_strain(s, 0.5, p), path.state.data()),
            s.E * std::pow(0.5 - p, 2) / 2.,
            tolerance);

      // until nothing is left of the stress, then beyond where it came from
      path.go(uniaxial_strain(s, p, p));
      check("unloaded, no stress", path.S.norm() / s.E, 1e-12);
      path.go(uniaxial_strain(s, 0.45, p));
      check("loaded again, elastic", uniaxial_error(s, path, 0.45, p));
      path.go(uniaxial_strain(s, 0.6, flow(0.6)));
      check("loaded again, plastic", uniaxial_error(s, path, 0.6, flow(0.6)));
      // reversed: the plastic strain falls while the equivalent one a goes on: E (p - e) = yield + H a, a = 2 flow(0.6)
      // - p
      const double e = 0.3, p_back = (s.E * e + yield + 2. * modulus * flow(0.6)) / (s.E + modulus);
      path.go(uniaxial_strain(s, e, p_back));
      check("reversed, plastic", uniaxial_error(s, path, e, p_back));
    }
    {
      // one step of simple shear: logarithmic strains asinh(g/2), its negative and 0; radial return of the Mises stress
      const double g = 0.8, e = std::asinh(g / 2.), trial = std::sqrt(3.) * 2. * s.mu * e;
      const double left = 1. - 3. * s.mu * (trial - yield) / (3. * s.mu + modulus) / trial;
      check("one step of simple shear", principal_shear_error(s, g, {2. * s.mu * left * e, -2. * s.mu * left * e, 0.}));
    }
    {
      // the exponential law and a table of it that is as fine as it needs to be; E (e - p) is the yield stress at p
      auto voce              = parameters(Law::j2_plasticity, 0.3);
      voce.yield_stress      = yield;
      voce.hardening_modulus = modulus;
      voce.saturation_stress = 3. * yield;
      voce.saturation_rate   = 8.;
      const Sample exponential(voce);
      auto         table       = parameters(Law::j2_plasticity, 0.3);
      table.hardening_strains  = {0., 0.1, 0.2, 0.3};
      table.hardening_stresses = {yield, 2. * yield, 2.5 * yield, 3. * yield};
      const Sample tabulated(table);
      const double p          = 0.25;
      const double by_formula = yield + modulus * p + 2. * yield * (1. - std::exp(-8. * p)), by_table = 2.75 * yield;
      Path         first(*exponential.law), second(*tabulated.law), beyond(*tabulated.law);
      first.go(uniaxial_strain(s, p + by_formula / s.E, p));
      check("exponential hardening", uniaxial_error(s, first, p + by_formula / s.E, p));
      second.go(uniaxial_strain(s, p + by_table / s.E, p));
      check("tabulated hardening", uniaxial_error(s, second, p + by_table / s.E, p));
      check("its dissipation",
            tabulated.law->dissipation(second.state.data()),
            yield * (0.15 + 0.225 + 0.05 * 2.625),
            tolerance);
      beyond.go(uniaxial_strain(s, 0.5 + 3. * yield / s.E, 0.5));
      check("behind the table", uniaxial_error(s, beyond, 0.5 + 3. * yield / s.E, 0.5));
    }
    {
      // a rotation between two steps, and on both
      const Tensor<2, dim> R = Tensor<2, dim>({{0.36, 0.48, -0.8}, {-0.8, 0.6, 0.}, {0.48, 0.64, 0.6}});
      const Tensor<2, dim> F1({{1.1, 0.2, 0.}, {0., 0.95, 0.1}, {0., 0.05, 1.}});
      const Tensor<2, dim> F2({{1.2, 0.1, 0.1}, {0.1, 1.05, 0.3}, {0., 0.1, 0.8}});
      Path                 fixed(*s.law), turned(*s.law);
      fixed.go(F1);
      fixed.go(F2);
      turned.go(F1);
      turned.go(R * F1);
      turned.go(R * F2);
      double difference = (fixed.S - turned.S).norm() / fixed.S.norm();
      for (unsigned int i = 0; i < fixed.state.size(); ++i)
        difference = std::max(difference, std::abs(fixed.state[i] - turned.state[i]));
      check("rotations change nothing", difference, 1e-12);
      check("plastic volume is kept",
            std::abs(
                determinant(SymmetricTensor<2, dim>(
                    {fixed.state[0], fixed.state[1], fixed.state[2], fixed.state[3], fixed.state[4], fixed.state[5]})) -
                1.),
            1e-12);
      // the tangent of the second step
      SymmetricTensor<2, dim> S, plus, minus;
      SymmetricTensor<4, dim> C;
      Path                    start(*s.law);
      start.go(F1);
      std::vector<double> after(s.law->n_state());
      s.law->update(F2, start.state.data(), after.data(), S, &C);
      double       error = 0.;
      const double h     = 1e-6;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
        {
          Tensor<2, dim> dF;
          dF[i][j] = 1.;
          s.law->update(F2 + h * dF, start.state.data(), after.data(), plus, nullptr);
          s.law->update(F2 - h * dF, start.state.data(), after.data(), minus, nullptr);
          error = std::max(error, ((plus - minus) / (2. * h) - C * symmetrize(transpose(F2) * dF)).norm() / C.norm());
        }
      check("tangent of a second step", error);
    }
    {
      // work of P along a path of plastic flow in many steps: trapezoidal rule, an error of the second order
      double error[2];
      for (const unsigned int n : {200, 400})
      {
        Path           path(*s.law);
        Tensor<2, dim> P_before, F_before = unit_symmetric_tensor<dim>();
        double         work = 0.;
        for (unsigned int i = 1; i <= n; ++i)
        {
          const double         t = double(i) / n;
          const Tensor<2, dim> F(
              {{1. + 0.3 * t, 0.2 * t, 0.}, {0., 1. - 0.2 * t * t, 0.}, {0.1 * t, 0., 1. - 0.1 * t}});
          path.go(F);
          const Tensor<2, dim> P = F * Tensor<2, dim>(path.S);
          work += scalar_product(P + P_before, F - F_before) / 2.;
          P_before = P;
          F_before = F;
        }
        error[n / 400] = std::abs(
            (s.law->stored_energy(F_before, path.state.data()) + s.law->dissipation(path.state.data())) / work - 1.);
      }
      check("1e4 times work that is neither stored nor dissipated", 1e4 * error[1], 1.);
      check("its error falls with the step", error[1] / error[0], 0.6);
    }
  }
} // namespace

int main()
{
  elastic(0.3);
  elastic(0.4999);
  plasticity();
}
