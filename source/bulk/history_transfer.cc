#include "bulk/history_transfer.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/cell_data_transfer.templates.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/lac/full_matrix.h>

namespace Nodus
{
  namespace
  {
    using Cell   = Bodies::Triangulation::cell_iterator;
    using States = std::vector<double>; ///< of a cell: [point][number]
  }                                     // namespace

  struct HistoryTransfer::Implementation
  {
    Implementation(const std::vector<std::unique_ptr<Material>> &materials,
                   const unsigned int                            degree,
                   Bodies::RefinableTriangulation               &triangulation)
        : materials(materials)
        , triangulation(triangulation)
        , transfer(
              triangulation,
              true,
              [this](const Cell &cell, const States &states) { return to_children(cell, states); },
              [this](const Cell &cell, const std::vector<States> &states) { return to_parent(cell, states); })
    {
      // polynomials through the Gauss points
      const dealii::QGauss<dim>               points(degree + 1);
      const dealii::FE_DGQArbitraryNodes<dim> basis(dealii::QGauss<1>(degree + 1));
      const unsigned int                      n = points.size();
      for (unsigned int child = 0; child < dealii::GeometryInfo<dim>::max_children_per_cell; ++child)
      {
        at_child.emplace_back(n, n);
        for (unsigned int q = 0; q < n; ++q)
          for (unsigned int j = 0; j < n; ++j)
            at_child[child](q, j) =
                basis.shape_value(j, dealii::GeometryInfo<dim>::child_to_cell_coordinates(points.point(q), child));
      }
      for (unsigned int q = 0; q < n; ++q)
      {
        const unsigned int child = dealii::GeometryInfo<dim>::child_cell_from_point(points.point(q));
        const Point        x     = dealii::GeometryInfo<dim>::cell_to_child_coordinates(points.point(q), child);
        child_of.push_back(child);
        at_parent.emplace_back();
        for (unsigned int j = 0; j < n; ++j)
          at_parent.back().push_back(basis.shape_value(j, x));
      }
    }

    template <typename Weights>
    void interpolate(const Material &material, const States &states, const Weights &weights, double *result) const
    {
      const unsigned int n_numbers = material.n_state();
      for (unsigned int i = 0; i < n_numbers; ++i)
      {
        result[i] = 0.;
        for (unsigned int j = 0; j < child_of.size(); ++j)
          result[i] += weights(j) * states[j * n_numbers + i];
      }
      material.correct_state(result);
    }

    std::vector<States> to_children(const Cell &cell, const States &states) const
    {
      const Material     &material = *materials[cell->material_id()];
      std::vector<States> children(at_child.size(), States(states.size()));
      for (unsigned int child = 0; child < children.size() && !states.empty(); ++child)
        for (unsigned int q = 0; q < child_of.size(); ++q)
          interpolate(
              material,
              states,
              [&](const unsigned int j) { return at_child[child](q, j); },
              children[child].data() + q * material.n_state());
      return children;
    }

    States to_parent(const Cell &cell, const std::vector<States> &children) const
    {
      const Material &material = *materials[cell->material_id()];
      States          states(children[0].size());
      for (unsigned int q = 0; q < child_of.size() && !states.empty(); ++q)
        interpolate(
            material,
            children[child_of[q]],
            [&](const unsigned int j) { return at_parent[q][j]; },
            states.data() + q * material.n_state());
      return states;
    }

    const std::vector<std::unique_ptr<Material>>                                  &materials;
    Bodies::RefinableTriangulation                                                &triangulation;
    std::vector<dealii::FullMatrix<double>>                                        at_child; ///< [child](q, j)
    std::vector<unsigned int>                                                      child_of; ///< of parents' points
    std::vector<std::vector<double>>                                               at_parent;
    std::vector<States>                                                            states; ///< by active cell
    dealii::parallel::distributed::CellDataTransfer<dim, dim, std::vector<States>> transfer;
  };

  HistoryTransfer::HistoryTransfer(const SolidAssembler                         &solid,
                                   const std::vector<std::unique_ptr<Material>> &materials,
                                   const unsigned int                            degree,
                                   Bodies::RefinableTriangulation               &triangulation)
  {
    if (!solid.has_history())
      return;
    implementation_ = std::make_unique<Implementation>(materials, degree, triangulation);
    auto &states    = implementation_->states;
    auto  own       = solid.history();
    states.resize(triangulation.n_active_cells());
    unsigned int n = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        states[cell->active_cell_index()] = std::move(own[n++]);
    implementation_->transfer.prepare_for_coarsening_and_refinement(states);
  }

  HistoryTransfer::~HistoryTransfer() = default;

  void HistoryTransfer::finish(SolidAssembler &solid)
  {
    if (!implementation_)
      return;
    const auto         &triangulation = implementation_->triangulation;
    std::vector<States> states(triangulation.n_active_cells()), own;
    implementation_->transfer.unpack(states);
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        own.push_back(states[cell->active_cell_index()]);
    solid.set_history(own);
  }
} // namespace Nodus
