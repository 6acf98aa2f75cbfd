#ifndef nodus_bulk_rigid_material_h
#define nodus_bulk_rigid_material_h

#include "bulk/material.h"

namespace Nodus
{
  /// Of a rigid body, whose nodes are all prescribed: its cells have neither stress nor stiffness.
  class RigidMaterial : public Material
  {
  public:
    /// @p stiffness: of the bodies around it, the scale of what stands on the rows of its nodes [pressure].
    explicit RigidMaterial(const double stiffness)
        : stiffness_(stiffness)
    {
    }

    bool is_rigid() const override
    {
      return true;
    }
    void evaluate(const dealii::Tensor<2, dim> & /*F*/,
                  dealii::SymmetricTensor<2, dim> &S,
                  dealii::SymmetricTensor<4, dim> *C) const override
    {
      S = 0.;
      if (C)
        *C = 0.;
    }
    double energy(const dealii::Tensor<2, dim> & /*F*/) const override
    {
      return 0.;
    }
    double youngs_modulus() const override
    {
      return stiffness_;
    }

  private:
    double stiffness_;
  };
} // namespace Nodus

#endif
