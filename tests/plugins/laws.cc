// A plug-in with two laws: St Venant-Kirchhoff with keys of its own, and with those of nodus.

#include <nodus/plugins/material_law.h>

#include <deal.II/base/parameter_handler.h>

namespace
{
  using dealii::SymmetricTensor;
  using dealii::Tensor;
  using Nodus::dim;

  class StVenantKirchhoff : public Nodus::MaterialLaw
  {
  public:
    void respond(const Tensor<2, dim> &F,
                 const Step &,
                 SymmetricTensor<2, dim> &S,
                 SymmetricTensor<4, dim> *C) const override
    {
      const auto I = dealii::unit_symmetric_tensor<dim>();
      const auto E = strain(F);
      S            = lambda() * trace(E) * I + 2. * shear_modulus_ * E;
      if (C)
        *C = lambda() * outer_product(I, I) + 2. * shear_modulus_ * dealii::identity_tensor<dim>();
    }

    double stored_energy(const Tensor<2, dim> &F, const double *) const override
    {
      const auto E = strain(F);
      return 0.5 * lambda() * trace(E) * trace(E) + shear_modulus_ * (E * E);
    }

    double youngs_modulus() const override
    {
      return 9. * bulk_modulus_ * shear_modulus_ / (3. * bulk_modulus_ + shear_modulus_);
    }

  protected:
    double shear_modulus_ = 0., bulk_modulus_ = 0.;

  private:
    static SymmetricTensor<2, dim> strain(const Tensor<2, dim> &F)
    {
      return 0.5 * (symmetrize(transpose(F) * F) - dealii::unit_symmetric_tensor<dim>());
    }
    double lambda() const
    {
      return bulk_modulus_ - 2. / 3. * shear_modulus_;
    }
  };

  class OwnKeys : public StVenantKirchhoff
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Shear modulus", shear_modulus_, "Shear modulus [pressure], > 0.");
      prm.add_parameter("Bulk modulus", bulk_modulus_, "Bulk modulus [pressure], > 0.");
    }
    void initialize() override
    {
      if (!(shear_modulus_ > 0.) || !(bulk_modulus_ > 0.))
        throw Nodus::InputError("'Shear modulus' and 'Bulk modulus' must be given and > 0");
    }
  };

  class SharedKeys : public StVenantKirchhoff
  {
  public:
    bool uses_elastic_constants() const override
    {
      return true;
    }
    void set_elastic_constants(const double E, const double nu) override
    {
      shear_modulus_ = E / (2. * (1. + nu));
      bulk_modulus_  = E / (3. * (1. - 2. * nu));
    }
  };
} // namespace

NODUS_REGISTER_MATERIAL(OwnKeys, "Kirchhoff with moduli", "St Venant-Kirchhoff from shear and bulk modulus.");
NODUS_REGISTER_MATERIAL(SharedKeys, "Kirchhoff with constants", "St Venant-Kirchhoff from Young's modulus.");
