#ifndef nodus_output_body_points_h
#define nodus_output_body_points_h

#include "bulk/nodal_stress.h"
#include "mesh/bodies.h"
#include <nodus/base/types.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>

#include <string>
#include <utility>
#include <vector>

namespace Nodus
{
  /// Points that go with bodies, and what is there: values of the nodes around them, interpolated in their cells.
  class BodyPoints
  {
  public:
    struct Place
    {
      std::string  what; ///< for messages: "Output point 1 ('tip')"
      unsigned int body; ///< number, from 1
      Point        X;    ///< in the undeformed configuration
    };
    struct Values
    {
      Vector3                         displacement;
      dealii::SymmetricTensor<2, dim> cauchy_stress;
    };

    /// Collective. @throws InputError on every rank for a point outside of its body, with the distance of the nearest.
    BodyPoints(const Bodies                  &bodies,
               const dealii::DoFHandler<dim> &dof_handler,
               const dealii::Mapping<dim>    &mapping,
               const std::vector<Place>      &places);

    /// At all points, on every rank; @p u has ghost entries. Collective.
    std::vector<Values> values(const Vector &u, const NodalStress &stress) const;

  private:
    using Shares = std::vector<std::pair<DoFIndex, double>>; ///< of nodes, by the first degree of freedom

    MPI_Comm            communicator_;
    std::vector<Shares> shares_; ///< of each point; empty where the cell is that of another rank
  };
} // namespace Nodus

#endif
