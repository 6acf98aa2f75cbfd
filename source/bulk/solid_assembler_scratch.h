#ifndef nodus_bulk_solid_assembler_scratch_h
#define nodus_bulk_solid_assembler_scratch_h

#include "bulk/batch_stiffness.h"
#include "bulk/constrained_cells.h"
#include "bulk/element_kernel.h"
#include "bulk/loads.h"
#include "bulk/solid_assembler.h"

#include <algorithm>
#include <string>

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

    void sweep(const Vector                            &u,
               double                                   t,
               Vector                                  &internal,
               Vector                                  &external,
               const dealii::AffineConstraints<double> *constraints,
               BlockCsrMatrix                          *tangent,
               Vector                                  *rhs,
               InnerEnergy                             *energy);

    const dealii::DoFHandler<dim>                &dof_handler;
    const std::vector<std::unique_ptr<Material>> &materials;
    std::vector<std::shared_ptr<ElementKernel>>   kernels; ///< of the bodies; those with the same treatment share it
    Loads                                         loads;
    unsigned int                                  n_nodes, n_q; ///< per cell
    double stiffness_of_cells = 0.;                             ///< Young's modulus times volume of those owned

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
    std::vector<Batch>             batches;
    History                        start;   ///< states that the increment starts from
    std::vector<Lanes>             reached; ///< those of the last displacement: [batch][point][number]
    ConstrainedCells               constrained;
    std::shared_ptr<const NodeMap> nodes;      ///< of these cells, then of other ranks' constrained cells
    std::vector<unsigned int>      cell_nodes; ///< [cell][node], local numbers
    std::vector<DoFIndex>          dofs;       ///< of the nodes of these cells
    BatchStiffness                 stiffness;  ///< of the batch at hand

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
      gather(batch, at_nodes.X, at_lanes.X);
      return kernel(batch).points(at_lanes.X.data());
    }
    /// The next call begins a Newton iteration.
    void forget_iterates()
    {
      iterates = 0;
    }
    unsigned int iterates = 0; ///< tangents since then
    /// The next sweep is not the one before, whatever it is for.
    void forget_last()
    {
      last.tangent = nullptr;
    }

    /// At the local nodes, [node][component].
    struct AtNodes
    {
      std::vector<double> X, u, u_before; ///< position, displacement, that of the previous iterate
      std::vector<double> internal, external, rhs;
      std::vector<double> prescribed; ///< displacement where is_prescribed
      std::vector<char>   is_prescribed;
    } at_nodes;
    /// Of the batch at hand, as in ElementKernel::integrate().
    struct AtLanes
    {
      std::vector<Lanes> X, u, u_before, force;
    } at_lanes;

  private:
    void add_initial_states(const Material &material);
    void find_positions(const dealii::Mapping<dim> &mapping);

    bool
    is_last(const Vector &u, double t, const dealii::AffineConstraints<double> *constraints, BlockCsrMatrix *tangent);
    void note_prescribed(const dealii::AffineConstraints<double> *constraints);
    /// Force at the displacement in #at_lanes, into the same; with @p with_stiffness also #stiffness, otherwise adds to
    /// @p energy, if that is asked for.
    void compute(const Batch &batch, bool with_stiffness, Lanes &det_F, InnerEnergy *energy);
    void add_energy(const Batch                          &batch,
                    const ElementKernel::QuadraturePoint *points,
                    const Lanes                          &stored,
                    InnerEnergy                          &energy) const;
    void compute_rigid(const Batch &batch, Lanes &det_F);
    /// Message for a cell with det F <= 0, or nothing.
    std::string turned_inside_out(const Batch &batch, const Lanes &det_F) const;
    /// What is in #at_lanes and #stiffness, with the loads on the cells, to the sums at the nodes and to the tangent.
    void scatter(const Batch &batch, BlockCsrMatrix *tangent);
    void copy_sums(Vector &internal, Vector &external, Vector *rhs) const;

    /// The cell in @p lane of the batch at hand.
    void add_loads(unsigned int cell, unsigned int lane, bool with_tangent);
    void add_constrained(unsigned int cell, unsigned int lane, BlockCsrMatrix *tangent);

    /// What the last sweep was for, besides the displacement.
    struct LastSweep
    {
      std::vector<double> conditions; ///< time and prescribed displacements
      BlockCsrMatrix     *tangent = nullptr;
    } last;
    /// Of a cell with loads, or with hanging nodes.
    struct CellAtHand
    {
      std::vector<double>        u, forces[2], stiffness;
      dealii::Vector<double>     internal, external; ///< of the loads, as is the tangent
      dealii::FullMatrix<double> tangent;
    } at_cell;
  };
} // namespace Nodus

#endif
