#ifndef nodus_plugins_hyperelastic_law_h
#define nodus_plugins_hyperelastic_law_h

#include <nodus/plugins/material_law.h>

#include <type_traits>

#ifdef DEAL_II_TRILINOS_WITH_SACADO

#  include <deal.II/differentiation/ad/sacado_product_types.h>

#  include <Sacado.hpp>

// deal.II knows tensors of Sacado's numbers whose length is found at run time; these are faster.
namespace dealii
{
  template <typename T, int n>
  struct EnableIfScalar<Sacado::Fad::SFad<T, n>>
  {
    using type = Sacado::Fad::SFad<T, n>;
  };

  namespace internal
  {
    template <typename T, int n>
    struct ProductTypeImpl<Sacado::Fad::SFad<T, n>, Sacado::Fad::SFad<T, n>>
    {
      using type = Sacado::Fad::SFad<T, n>;
    };
    template <typename T, int n>
    struct ProductTypeImpl<Sacado::Fad::SFad<T, n>, double>
    {
      using type = Sacado::Fad::SFad<T, n>;
    };
    template <typename T, int n>
    struct ProductTypeImpl<double, Sacado::Fad::SFad<T, n>>
    {
      using type = Sacado::Fad::SFad<T, n>;
    };
    template <typename T, int n>
    struct ProductTypeImpl<Sacado::Fad::SFad<T, n>, int>
    {
      using type = Sacado::Fad::SFad<T, n>;
    };
    template <typename T, int n>
    struct ProductTypeImpl<int, Sacado::Fad::SFad<T, n>>
    {
      using type = Sacado::Fad::SFad<T, n>;
    };
  } // namespace internal
} // namespace dealii

namespace Nodus
{
  /// A material of one's own that is its energy: @p Law is derived from HyperelasticLaw<Law> and has
  ///
  ///   template <typename Number>
  ///   Number energy(const dealii::SymmetricTensor<2, 3, Number> &C) const;
  ///
  /// the energy per reference volume [pressure] of the right Cauchy-Green tensor C = F^T F, 0 at C = I. Number is
  /// Sacado's or double; functions of it are called without std::, as in log(J). S = 2 dW/dC and dS/dE = 4 d2W/dC2
  /// follow by automatic differentiation, exact to round-off, where W can be differentiated: eigenvalues of C cannot
  /// where two of them coincide, invariants can.
  template <typename Law>
  class HyperelasticLaw : public MaterialLaw
  {
  public:
    void respond(const dealii::Tensor<2, dim> &F,
                 const Step & /*step*/,
                 dealii::SymmetricTensor<2, dim> &S,
                 dealii::SymmetricTensor<4, dim> *C) const final
    {
      if (!C)
      {
        const First W = law().energy(strain<First>(F));
        for (unsigned int r = 0; r < n; ++r)
          S.access_raw_entry(r) = factor(r) * W.dx(r);
        return;
      }
      const Second W = law().energy(strain<Second>(F));
      for (unsigned int r = 0; r < n; ++r)
      {
        S.access_raw_entry(r) = factor(r) * W.dx(r).val();
        for (unsigned int c = 0; c < n; ++c)
          C->access_raw_entry(n * r + c) = factor(r) * factor(c) * W.dx(r).dx(c);
      }
    }

    double stored_energy(const dealii::Tensor<2, dim> &F, const double * /*state*/) const final
    {
      return law().energy(dealii::symmetrize(dealii::transpose(F) * F));
    }

  private:
    static constexpr int n = dealii::SymmetricTensor<2, dim>::n_independent_components;
    using First            = Sacado::Fad::SFad<double, n>;
    using Second           = Sacado::Fad::SFad<First, n>;

    const Law &law() const
    {
      return static_cast<const Law &>(*this);
    }

    /// S_ij is twice the derivative with C_ij; an independent component off the diagonal stands for C_ij and C_ji.
    static double factor(const unsigned int component)
    {
      return component < dim ? 2. : 1.;
    }

    static void seed(First &number, const double value, const unsigned int component)
    {
      number = First(n, component, value);
    }
    static void seed(Second &number, const double value, const unsigned int component)
    {
      number = Second(n, component, First(n, component, value));
    }

    /// C, its independent components the variables.
    template <typename Number>
    static dealii::SymmetricTensor<2, dim, Number> strain(const dealii::Tensor<2, dim> &F)
    {
      const dealii::SymmetricTensor<2, dim>   values = dealii::symmetrize(dealii::transpose(F) * F);
      dealii::SymmetricTensor<2, dim, Number> C;
      for (unsigned int c = 0; c < n; ++c)
        seed(C.access_raw_entry(c), values.access_raw_entry(c), c);
      return C;
    }
  };
} // namespace Nodus

#else

namespace Nodus
{
  /// Without Sacado: the header can be included, the class not be used.
  template <typename Law>
  class HyperelasticLaw : public MaterialLaw
  {
    static_assert(
        !std::is_same_v<Law, Law>,
        "HyperelasticLaw differentiates with Sacado, a package of Trilinos, which this deal.II is without: derive "
        "from MaterialLaw");
  };
} // namespace Nodus

#endif
#endif
