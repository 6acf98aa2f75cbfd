#ifndef nodus_mesh_mesh_share_h
#define nodus_mesh_mesh_share_h

#include "mesh/gmsh_reader.h"

#include <deal.II/grid/tria_description.h>

#include <functional>
#include <vector>

namespace Nodus
{
  /// What @p read gives on the first rank, on all of them: it alone reads files. @throws InputError on every rank where
  /// @p read throws it. Collective.
  CoarseMesh from_first_rank(const std::function<CoarseMesh()> &read, MPI_Comm communicator);

  /// Divides the cells of @p mesh into @p n_parts of equal weights by planes across the axes, and the slave faces along
  /// with them as evenly as goes: ranks without wait for those with contact. @param slave_faces number by cell
  /// @returns the part of each cell
  std::vector<unsigned int> divide(const CoarseMesh                &mesh,
                                   const std::vector<unsigned int> &slave_faces,
                                   unsigned int                     cell_weight,
                                   unsigned int                     face_weight,
                                   unsigned int                     n_parts);

  /// What a rank holds of a mesh that is not refined: the cells that it owns and those that touch them. Coarse cells
  /// keep their numbers in @p mesh. @param owner rank of each cell @param cut boundary id of faces that are at the
  /// boundary of the share, but not of the mesh
  dealii::TriangulationDescription::Description<dim, dim> share_of(const CoarseMesh                &mesh,
                                                                   const std::vector<unsigned int> &owner,
                                                                   dealii::types::boundary_id       cut,
                                                                   MPI_Comm                         communicator);
} // namespace Nodus

#endif
