#ifndef nodus_bulk_loads_h
#define nodus_bulk_loads_h

#include "bulk/boundary_conditions.h"
#include "bulk/material.h"
#include "solve/linear_system.h"

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <memory>
#include <vector>

namespace Nodus
{
  /// Body forces, tractions, pressures, springs, and loads and springs at points, cell by cell.
  class Loads
  {
  public:
    /// All arguments outlive the object.
    Loads(const dealii::DoFHandler<dim>                &dof_handler,
          const dealii::Mapping<dim>                   &mapping,
          const std::vector<std::unique_ptr<Material>> &materials,
          std::vector<BoundaryConditions::Load>        &loads);
    ~Loads();

    /// Finds the loads of the next cell: cells are numbered in the order of the calls.
    void add_cell(const dealii::DoFHandler<dim>::active_cell_iterator &cell);

    /// Sets the time; does nothing when it is the last one. Collective. @throws InputError where a load is not a
    /// number.
    void evaluate(double t);

    bool act_on(unsigned int cell) const;

    /// Displacement of a cell and what the loads add to; in the order of the element's degrees of freedom.
    struct Cell
    {
      const std::vector<double>  &u;
      dealii::Vector<double>     &internal; ///< springs
      dealii::Vector<double>     &external;
      dealii::FullMatrix<double> *tangent; ///< of internal - external; null: not wanted
    };
    /// Adds the loads of a cell that they act on, at the time of evaluate().
    void add(unsigned int number, const Cell &cell) const;

    /// Adds to the variation of @p system, and to its right-hand side where @p constraints prescribe displacements, the
    /// half of the tangent of follower pressures that is not symmetric (eq. B3), unless it cancels; the other half is
    /// part of add(). @p u: displacement with ghosts. Collective.
    void
    add_variation(const Vector &u, const dealii::AffineConstraints<double> &constraints, LinearSystem &system) const;

    /// Energy stored in the springs of a cell that loads act on, at the displacement @p u of its nodes.
    double spring_energy(unsigned int number, const std::vector<double> &u) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };
} // namespace Nodus

#endif
