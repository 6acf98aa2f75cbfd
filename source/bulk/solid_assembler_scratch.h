#ifndef nodus_bulk_solid_assembler_scratch_h
#define nodus_bulk_solid_assembler_scratch_h

#include "bulk/constrained_cells.h"
#include "bulk/element_kernel.h"
#include "bulk/loads.h"
#include "bulk/solid_assembler.h"

#include <algorithm>

namespace Nodus
{
  struct SolidAssembler::PointStates
  {
    std::vector<Lanes> values; ///< [batch][point][number]
  };

  /// Every rank integrates all cells around its nodes, those of its neighbours too: nothing has to be sent, but for
  /// cells with hanging nodes.
  struct SolidAssembler::Scratch
  {
    Scratch(const dealii::DoFHandler<dim>                          &dof_handler,
            const dealii::Mapping<dim>                             &mapping,
            const std::vector<std::unique_ptr<Material>>           &materials,
            std::vector<BoundaryConditions::Load>                  &loads,
            const std::vector<BodyParameters::VolumetricTreatment> &treatments);

    void make_positions(BlockCsrMatrix &tangent);
    void sweep(const Vector                            &u,
               double                                   t,
               Vector                                  &internal,
               Vector                                  &external,
               const dealii::AffineConstraints<double> *constraints,
               BlockCsrMatrix                          *tangent,
               Vector                                  *rhs);

    const dealii::DoFHandler<dim>                &dof_handler;
    const std::vector<std::unique_ptr<Material>> &materials;
    std::vector<std::shared_ptr<ElementKernel>>   kernels; ///< of the bodies; those with the same treatment share it
    Loads                                         loads;
    unsigned int                                  n_nodes, n_q; ///< per cell

    struct Cell
    {
      Point         centre;
      unsigned char body;
      bool          owned;
    };
    std::vector<Cell>         cells;
    std::vector<unsigned int> number_of; ///< in cells, by active cell index
    /// Consecutive cells of one body: one in each lane, lanes that are left repeat the last.
    struct Batch
    {
      unsigned int first, size;
      std::size_t  state; ///< where its states begin
      unsigned int cell(const unsigned int lane) const
      {
        return first + std::min(lane, size - 1);
      }
    };
    std::vector<Batch>                    batches;
    History                               start;   ///< states that the increment starts from
    std::vector<Lanes>                    reached; ///< those of the last displacement: [batch][point][number]
    ConstrainedCells                      constrained;
    std::shared_ptr<const NodeMap>        nodes;      ///< of these cells, then of other ranks' constrained cells
    std::vector<unsigned int>             cell_nodes; ///< [cell][node], local numbers
    std::vector<DoFIndex>                 dofs;       ///< of the nodes of these cells
    std::vector<BlockCsrMatrix::Position> positions;  ///< [cell][node a][node b >= a]; constrained: not stored

    const Material &material(const Batch &batch) const
    {
      return *materials[cells[batch.first].body];
    }
    ElementKernel &kernel(const Batch &batch) const
    {
      return *kernels[cells[batch.first].body];
    }
    bool is_constrained(const unsigned int cell) const
    {
      return constrained.index(cell) != dealii::numbers::invalid_unsigned_int;
    }
    /// Gathers values at the local nodes.
    void gather(const Batch &batch, const std::vector<double> &nodal, std::vector<Lanes> &values) const;
    /// The quadrature points of the cells of a batch, until the next call.
    const ElementKernel::QuadraturePoint *points(const Batch &batch)
    {
      gather(batch, nodal_X, batch_X);
      return kernel(batch).points(batch_X.data());
    }
    /// The next call begins a Newton iteration.
    void forget_iterates()
    {
      iterates = 0;
    }
    unsigned int iterates = 0; ///< tangents since then
    void         forget_last()
    {
      last_tangent = nullptr;
    }

    // at the local nodes
    std::vector<double> nodal_X, nodal_u, nodal_u_before, nodal_internal, nodal_external, nodal_rhs, prescribed;
    std::vector<char>   is_prescribed;
    // of the batch at hand, as in ElementKernel::integrate()
    std::vector<Lanes> batch_X, batch_u, batch_u_before, batch_force, batch_stiffness;

  private:
    void add_initial_states(const Material &material);
    bool
    is_last(const Vector &u, double t, const dealii::AffineConstraints<double> *constraints, BlockCsrMatrix *tangent);
    void note_prescribed(const dealii::AffineConstraints<double> *constraints);
    void find_positions(const dealii::Mapping<dim> &mapping);
    void integrate_rigid(const Batch &batch, Lanes &det_F);
    void prefetch(const Batch &batch, BlockCsrMatrix &tangent) const;
    /// The cell in @p lane of the batch at hand.
    void add_loads(unsigned int cell, unsigned int lane, bool with_tangent);
    void add_constrained(unsigned int cell, unsigned int lane, BlockCsrMatrix *tangent);
    void eliminate_prescribed(unsigned int cell, unsigned int lane);
    void scatter(unsigned int cell, unsigned int lane, BlockCsrMatrix &tangent) const;
    /// Entry of the stiffness: node a, component i; node b, component k.
    double &entry(unsigned int a, unsigned int i, unsigned int b, unsigned int k, unsigned int lane);

    std::vector<double> last_conditions; ///< time and prescribed displacements of the last sweep
    BlockCsrMatrix     *last_tangent = nullptr;
    // of a cell with loads, or with hanging nodes
    std::vector<double>        cell_u, cell_forces[2], cell_stiffness;
    dealii::Vector<double>     cell_internal, cell_external;
    dealii::FullMatrix<double> cell_tangent;
  };
} // namespace Nodus

#endif
