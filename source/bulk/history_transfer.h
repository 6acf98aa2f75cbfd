#ifndef nodus_bulk_history_transfer_h
#define nodus_bulk_history_transfer_h

#include "bulk/material.h"
#include "bulk/solid_assembler.h"
#include "mesh/bodies.h"

#include <memory>
#include <vector>

namespace Nodus
{
  /// Carries the committed states of the materials to a refined and coarsened mesh (theory section 29): they are
  /// polynomials through the Gauss points of a cell, which are evaluated at those of its children, or of the cell that
  /// it becomes part of.
  class HistoryTransfer
  {
  public:
    /// Between the setting of the flags of @p triangulation and their execution. Collective.
    HistoryTransfer(const SolidAssembler                         &solid,
                    const std::vector<std::unique_ptr<Material>> &materials,
                    unsigned int                                  degree,
                    Bodies::RefinableTriangulation               &triangulation);
    ~HistoryTransfer();
    /// After it, with the new assembler. Collective.
    void finish(SolidAssembler &solid);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_; ///< null for materials without history
  };
} // namespace Nodus

#endif
