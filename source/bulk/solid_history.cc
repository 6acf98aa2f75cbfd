#include "base/deal_ii_versions.h"
#include "bulk/solid_assembler_scratch.h"
#include "parallel/throw_everywhere.h"

#include <deal.II/grid/grid_tools.h>

// The states of laws with history, and what is known at the quadrature points.

namespace Nodus
{
  using namespace dealii;

  namespace
  {
    /// Of n_lanes cells at a point.
    struct Response
    {
      Lanes cauchy_stress[n_pairs], energy;
    };

    /// At F and a state that it led to.
    void respond(const Material &material, const Lanes (&F)[dim][dim], const Lanes *const state, Response &response)
    {
      if (material.small_strain())
      {
        material.stress_and_energy_lanes(F, state, response.cauchy_stress, response.energy);
        return;
      }
      Lanes S[n_pairs], J;
      material.stress_and_energy_lanes(F, state, S, response.energy);
      determinant(F, J);
      push_forward(F, S, response.cauchy_stress);
      for (Lanes &stress : response.cauchy_stress)
        stress /= J;
    }
  } // namespace

  bool SolidAssembler::has_history() const
  {
    return std::any_of(scratch_->materials.begin(),
                       scratch_->materials.end(),
                       [](const auto &material) { return material->n_state() > 0; });
  }

  SolidAssembler::History SolidAssembler::start() const
  {
    return scratch_->start;
  }

  SolidAssembler::History SolidAssembler::reached() const
  {
    return std::make_shared<PointStates>(PointStates{scratch_->reached});
  }

  void SolidAssembler::start_from(const History &history)
  {
    scratch_->forget_iterates();
    if (!has_history())
      return;
    scratch_->start   = history;
    scratch_->reached = history->values;
    scratch_->forget_last();
  }

  std::vector<std::vector<double>> SolidAssembler::history() const
  {
    const Scratch                   &s = *scratch_;
    std::vector<std::vector<double>> history;
    for (const auto &batch : s.batches)
      for (unsigned int v = 0; v < batch.size; ++v)
        if (s.cells[batch.first + v].owned)
        {
          history.emplace_back(s.n_q * s.material(batch).n_state());
          for (std::size_t i = 0; i < history.back().size(); ++i)
            history.back()[i] = s.start->values[batch.state + i][v];
        }
    return history;
  }

  void SolidAssembler::set_history(const std::vector<std::vector<double>> &history)
  {
    Scratch                                 &s = *scratch_;
    std::string                              problem;
    std::vector<const std::vector<double> *> of_cell(s.cells.size(), nullptr);
    std::size_t                              n = 0;
    for (unsigned int c = 0; c < s.cells.size(); ++c)
      if (s.cells[c].owned)
      {
        if (n >= history.size() || history[n].size() != s.n_q * s.materials[s.cells[c].body]->n_state())
          problem = "The history of the material is not that of these cells and laws";
        else
          of_cell[c] = &history[n];
        ++n;
      }
    if (n != history.size())
      problem = "The history of the material is not that of these cells and laws";
    throw_everywhere<InputError>(problem, communicator_of(s.dof_handler));

    std::vector<std::vector<double>> of_ghosts(s.cells.size());
    GridTools::exchange_cell_data_to_ghosts<std::vector<double>>(
        s.dof_handler,
        [&](const auto &cell) { return *of_cell[s.number_of[cell->active_cell_index()]]; },
        [&](const auto &cell, const std::vector<double> &values)
        {
          const unsigned int c = s.number_of[cell->active_cell_index()];
          if (c == numbers::invalid_unsigned_int)
            return;
          of_ghosts[c] = values;
          of_cell[c]   = &of_ghosts[c];
        });
    PointStates states{s.start->values};
    for (const auto &batch : s.batches)
      for (unsigned int v = 0; v < n_lanes; ++v)
      {
        const auto &values = *of_cell[batch.cell(v)];
        for (std::size_t i = 0; i < values.size(); ++i)
          states.values[batch.state + i][v] = values[i];
      }
    start_from(std::make_shared<PointStates>(std::move(states)));
  }

  double SolidAssembler::spring_energy(const Vector &u) const
  {
    Scratch            &s = *scratch_;
    std::vector<double> nodal_u(s.dofs.size());
    u.extract_subvector_to(s.dofs.begin(), s.dofs.end(), nodal_u.begin());
    std::vector<double> cell_u(dim * s.n_nodes);
    double              energy = 0.;
    for (unsigned int c = 0; c < s.cells.size(); ++c)
      if (s.cells[c].owned && s.loads.act_on(c))
      {
        for (unsigned int i = 0; i < dim * s.n_nodes; ++i)
          cell_u[i] = nodal_u[dim * s.cell_nodes[c * s.n_nodes + i / dim] + i % dim];
        energy += s.loads.spring_energy(c, cell_u);
      }
    return energy;
  }

  void SolidAssembler::visit(const Vector                                                      &u,
                             const std::function<void(const DoFHandler<dim>::active_cell_iterator &cell,
                                                      const std::vector<PointResult> &points)> &visitor) const
  {
    Scratch            &s = *scratch_;
    std::vector<double> nodal_u(s.dofs.size());
    u.extract_subvector_to(s.dofs.begin(), s.dofs.end(), nodal_u.begin());
    std::vector<ElementKernel::DeformationGradient> F(s.n_q);
    std::vector<Response>                           responses(s.n_q);
    std::vector<PointResult>                        points(s.n_q);

    auto cell = s.dof_handler.begin_active();
    for (unsigned int n = 0; n < s.batches.size(); ++n)
    {
      const auto         &batch    = s.batches[n];
      const Material     &material = s.material(batch);
      std::vector<double> state(material.n_state());
      const Lanes *const  states = s.start->values.data() + batch.state;
      s.gather(batch, nodal_u, s.at_lanes.u);
      const ElementKernel::QuadraturePoint *const geometry = s.points(batch);
      s.kernel(batch).deformation(geometry, material.small_strain(), s.at_lanes.u.data(), F.data());
      for (unsigned int q = 0; q < s.n_q; ++q)
        respond(material, F[q].F, states + q * state.size(), responses[q]);
      for (unsigned int v = 0; v < batch.size; ++v)
      {
        if (!s.cells[batch.first + v].owned)
          continue;
        for (unsigned int q = 0; q < s.n_q; ++q)
        {
          PointResult &point = points[q];
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int J = 0; J < dim; ++J)
              point.deformation_gradient[i][J] = F[q].F[i][J][v];
          for (unsigned int r = 0; r < n_pairs; ++r)
            point.cauchy_stress.access_raw_entry(r) = responses[q].cauchy_stress[r][v];
          for (unsigned int i = 0; i < state.size(); ++i)
            state[i] = states[q * state.size() + i][v];
          point.equivalent_plastic_strain = material.equivalent_plastic_strain(state.data());
          point.stored_energy             = responses[q].energy[v];
          point.dissipation               = material.dissipation(state.data());
          point.JxW                       = geometry[q].JxW[v];
        }
        while (s.number_of[cell->active_cell_index()] != batch.first + v)
          ++cell;
        visitor(cell, points);
      }
    }
  }
} // namespace Nodus
