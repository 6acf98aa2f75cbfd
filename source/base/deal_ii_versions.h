#ifndef nodus_base_deal_ii_versions_h
#define nodus_base_deal_ii_versions_h

#include <nodus/base/types.h>

#include <deal.II/base/config.h>
#include <deal.II/base/data_out_base.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/affine_constraints.h>
#if DEAL_II_VERSION_GTE(9, 7, 0)
#  include <deal.II/numerics/solution_transfer.h>
#else
#  include <deal.II/distributed/solution_transfer.h>
#endif

#include <map>

/// What has another name in some of the versions of deal.II that nodus is built with.
namespace Nodus
{
  /// Of a triangulation or a DoFHandler.
  template <typename Object>
  MPI_Comm communicator_of(const Object &object)
  {
#if DEAL_II_VERSION_GTE(9, 7, 0)
    return object.get_mpi_communicator();
#else
    return object.get_communicator();
#endif
  }

  /// Constraints without a line, for all unknowns that this rank knows of.
  inline dealii::AffineConstraints<double> no_constraints(const dealii::DoFHandler<dim> &dof_handler)
  {
    const dealii::IndexSet relevant = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler);
#if DEAL_II_VERSION_GTE(9, 6, 0)
    return dealii::AffineConstraints<double>(dof_handler.locally_owned_dofs(), relevant);
#else
    return dealii::AffineConstraints<double>(relevant);
#endif
  }

  /// Where the unknowns that this rank knows of are in the reference configuration.
  inline std::map<DoFIndex, Point> support_points(const dealii::Mapping<dim>    &mapping,
                                                  const dealii::DoFHandler<dim> &dof_handler)
  {
#if DEAL_II_VERSION_GTE(9, 5, 0)
    return dealii::DoFTools::map_dofs_to_support_points(mapping, dof_handler);
#else
    std::map<DoFIndex, Point> points;
    dealii::DoFTools::map_dofs_to_support_points(mapping, dof_handler, points);
    return points;
#endif
  }

#if DEAL_II_VERSION_GTE(9, 7, 0)
  using SolutionTransfer = dealii::SolutionTransfer<dim, Vector>;
#else
  using SolutionTransfer = dealii::parallel::distributed::SolutionTransfer<dim, Vector>;
#endif

#if DEAL_II_VERSION_GTE(9, 5, 0)
  constexpr auto fastest_compression = dealii::DataOutBase::CompressionLevel::best_speed;
#else
  constexpr auto fastest_compression = dealii::DataOutBase::VtkFlags::best_speed;
#endif
} // namespace Nodus

#endif
