#ifndef nodus_mesh_hanging_nodes_h
#define nodus_mesh_hanging_nodes_h

#include <nodus/base/types.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/affine_constraints.h>

#include <unordered_map>
#include <utility>
#include <vector>

namespace Nodus
{
  /// The hanging displacement nodes among those of this rank's cells and their neighbours, and the nodes that each one
  /// follows. Node i has the degrees of freedom 3i, 3i+1, 3i+2, which follow alike.
  ///
  /// deal.II finds the constraints of a refined edge on the ranks that see a refined face there; here all ranks that
  /// know the node have them, as its owner does.
  class HangingNodes
  {
  public:
    using Masters = std::vector<std::pair<DoFIndex, double>>; ///< nodes, none of them hanging, and weights of sum 1

    /// Collective.
    explicit HangingNodes(const dealii::DoFHandler<dim> &dof_handler);

    /// Whether there are any, on all ranks.
    bool exist() const
    {
      return exist_;
    }
    /// What @p node follows, or null where it is free.
    const Masters *masters(const DoFIndex node) const
    {
      const auto found = masters_.find(node);
      return found == masters_.end() ? nullptr : &found->second;
    }
    /// Reference positions of the nodes that hanging ones follow, by global node number.
    std::unordered_map<DoFIndex, Point> followed(const dealii::DoFHandler<dim> &dof_handler,
                                                 const dealii::Mapping<dim>    &mapping) const;
    /// Adds the lines of those degrees of freedom that @p constraints can hold.
    void add_to(dealii::AffineConstraints<double> &constraints) const;

  private:
    std::unordered_map<DoFIndex, Masters> masters_;
    bool                                  exist_;
  };

  /// The closed constraints of the hanging nodes, among the locally relevant degrees of freedom. Collective.
  dealii::AffineConstraints<double> hanging_constraints(const dealii::DoFHandler<dim> &dof_handler);

  /// Zero at all degrees of freedom that cells of this rank add to, by way of @p constraints too: compress() then takes
  /// to their owners what is added to those of others. Collective.
  Vector sums_over_cells(const dealii::DoFHandler<dim>           &dof_handler,
                         const dealii::AffineConstraints<double> &constraints);

  /// Whether a closed line of @p constraints sets @p dof to a value: it is prescribed, or all that it follows is.
  inline bool is_prescribed(const dealii::AffineConstraints<double> &constraints, const DoFIndex dof)
  {
    const auto *const entries = constraints.is_constrained(dof) ? constraints.get_constraint_entries(dof) : nullptr;
    return entries && entries->empty();
  }
} // namespace Nodus

#endif
