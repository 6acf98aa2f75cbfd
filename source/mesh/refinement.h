#ifndef nodus_mesh_refinement_h
#define nodus_mesh_refinement_h

#include "mesh/bodies.h"
#include <nodus/parameters/parameters.h>

#include <vector>

namespace Nodus
{
  /// Where the mesh is to change, by active cell index; owned cells count.
  struct RefinementIndicator
  {
    explicit RefinementIndicator(const Bodies::Triangulation &triangulation)
        : squared_error(triangulation.n_active_cells(), 0.)
        , refine(triangulation.n_active_cells(), 0)
    {
    }
    std::vector<double> squared_error;     ///< estimated, in the norm of the energy [energy]
    double              squared_norm = 0.; ///< of the stress likewise, on all ranks
    std::vector<char>   refine;            ///< cells that are to be refined whatever their error

    /// Square root of the sum over the owned cells of all ranks, relative to the norm. Collective.
    double relative_error(const Bodies::Triangulation &triangulation) const;
  };

  /// Sets the flags of @p triangulation that @p parameters ask for (eq. A3); @p n_unknowns: displacement degrees of
  /// freedom now. Cells stay between the refinement of their body and 'Maximum level' beyond it. Where too many
  /// unknowns would arise, the cells with the largest errors are refined alone. @returns whether the mesh will change.
  /// Collective.
  bool mark_cells(const AdaptivityParameters        &parameters,
                  const std::vector<BodyParameters> &bodies,
                  const RefinementIndicator         &indicator,
                  DoFIndex                           n_unknowns,
                  Bodies::RefinableTriangulation    &triangulation);
} // namespace Nodus

#endif
