#include "bulk/check_material.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    /// Of Young's modulus: smaller stresses are compared with that.
    constexpr double small_stress = 0.01;
    /// Of the strain, in differences of fourth order: truncation and round-off both leave about 1e-12.
    constexpr double step = 1e-3;

    struct Deformation
    {
      const char    *name;
      Tensor<2, dim> F;
    };

    Tensor<2, dim> tensor(const double (&rows)[dim][dim])
    {
      Tensor<2, dim> result;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          result[i][j] = rows[i][j];
      return result;
    }

    /// By 70 degrees about (1, 2, 2)/3.
    Tensor<2, dim> rotation()
    {
      const double         angle = 70. * std::acos(-1.) / 180.;
      const Tensor<1, dim> axis({1. / 3., 2. / 3., 2. / 3.});
      const auto           cross = tensor({{0., -axis[2], axis[1]}, {axis[2], 0., -axis[0]}, {-axis[1], axis[0], 0.}});
      return Tensor<2, dim>(unit_symmetric_tensor<dim>()) + std::sin(angle) * cross +
             (1. - std::cos(angle)) * cross * cross;
    }

    std::vector<Deformation> deformations()
    {
      std::vector<Deformation> all = {
          {"a small strain", tensor({{1.001, 0.002, -0.001}, {0., 0.998, 0.0015}, {0.001, 0., 1.0005}})},
          {"a moderate strain", tensor({{1.05, 0.03, -0.02}, {0.01, 0.96, 0.04}, {-0.03, 0.02, 1.02}})},
          {"a stretch to 1.6", tensor({{1.6, 0., 0.}, {0.1, 0.8, 0.}, {0., 0.05, 0.85}})},
          {"a compression to 0.6", tensor({{1.25, 0., 0.1}, {0., 1.3, 0.}, {0., 0.1, 0.6}})},
          {"a shear of 1", tensor({{1., 1., 0.}, {0., 1., 0.}, {0., 0., 1.}})},
          {"a change of volume to 1.3", tensor({{1.1, 0., 0.02}, {0., 1.09, 0.}, {0.01, 0., 1.085}})}};
      const Tensor<2, dim> F = all[3].F;
      all.push_back({"a compression to 0.6, rotated by 70 degrees", rotation() * F});
      return all;
    }

    /// Symmetric tensor whose independent component @p c is 1.
    SymmetricTensor<2, dim> unit(const unsigned int c)
    {
      SymmetricTensor<2, dim> M;
      M.access_raw_entry(c) = 1.;
      return M;
    }

    /// df/dE : M at F, by differences; f(F) has sums and multiples. A small strain changes with F itself.
    template <typename Function>
    auto
    derivative(const Function &f, const Tensor<2, dim> &F, const SymmetricTensor<2, dim> &M, const bool small_strain)
    {
      const Tensor<2, dim> G = small_strain ? Tensor<2, dim>(M) : transpose(invert(F)) * Tensor<2, dim>(M);
      return (8. * (f(F + step * G) - f(F - step * G)) - (f(F + 2. * step * G) - f(F - 2. * step * G))) / (12. * step);
    }

    bool is_finite(const SymmetricTensor<2, dim> &S)
    {
      return std::isfinite(S.norm());
    }

    /// A law with the state that a step begins with.
    struct LawAt
    {
      const Material     &material;
      std::vector<double> before;

      SymmetricTensor<2, dim>
      stress(const Tensor<2, dim> &F, std::vector<double> &after, SymmetricTensor<4, dim> *C = nullptr) const
      {
        SymmetricTensor<2, dim> S;
        after.resize(before.size());
        material.update(F, before.data(), after.data(), S, C);
        return S;
      }
      SymmetricTensor<2, dim> stress(const Tensor<2, dim> &F) const
      {
        std::vector<double> after;
        return stress(F, after);
      }
    };

    /// @p checks: of stress, tangent and rotation.
    void compare(const LawAt &point, const Deformation &at, std::vector<LawCheck> &checks)
    {
      const Material         &material = point.material;
      const bool              small    = material.small_strain();
      std::vector<double>     after;
      SymmetricTensor<4, dim> C;
      const auto              S = point.stress(at.F, after, &C);
      if (!is_finite(S) && !std::isfinite(material.stored_energy(at.F, after.data())))
        return;
      const double scale = std::max(S.norm(), small_stress * material.youngs_modulus());

      SymmetricTensor<2, dim> from_energy;
      double                  error = 0.;
      for (unsigned int c = 0; c < n_pairs; ++c)
      {
        const auto   M      = unit(c);
        const double weight = c < dim ? 1. : 0.5; // M has the component twice
        from_energy.access_raw_entry(c) =
            weight *
            derivative(
                [&](const Tensor<2, dim> &F) { return material.stored_energy(F, after.data()); }, at.F, M, small);
        const auto dS = derivative([&](const Tensor<2, dim> &F) { return point.stress(F); }, at.F, M, small);
        error         = std::max(error, (C * M - dS).norm() / C.norm());
        if (!is_finite(dS))
          error = std::nan("");
      }
      checks[0].add((S - from_energy).norm() / scale, at.name);
      checks[1].add(error, at.name);
      if (!small)
        checks[2].add((point.stress(rotation() * at.F) - S).norm() / scale, at.name);
    }
  } // namespace

  std::vector<LawCheck> check_material(Material &material)
  {
    std::vector<LawCheck> checks(4);
    checks[0].what = "stress against the derivative of the energy";
    checks[1].what = "tangent against differences of the stress";
    checks[2].what = "stress when the deformation is rotated";
    checks[3].what = "stress and energy at rest";

    LawAt                rest{material, std::vector<double>(material.n_state())};
    std::vector<double>  after;
    const Tensor<2, dim> I = unit_symmetric_tensor<dim>();
    material.set_initial(rest.before.data());
    material.set_step(1.);
    checks[3].add((rest.stress(I, after).norm() + std::abs(material.stored_energy(I, after.data()))) /
                      material.youngs_modulus(),
                  "rest");
    const auto all = deformations();
    for (unsigned int n = 0; n < all.size(); ++n)
    {
      compare(rest, all[n], checks);
      if (material.n_state() == 0)
        continue;
      LawAt second = rest;
      rest.stress(all[n].F, second.before);
      Deformation       next = all[(n + 1) % all.size()];
      const std::string name = std::string(next.name) + " after " + all[n].name;
      next.name              = name.c_str();
      compare(second, next, checks);
    }
    material.set_step(0.);
    if (material.small_strain())
      checks.erase(checks.begin() + 2);
    return checks;
  }
} // namespace Nodus
