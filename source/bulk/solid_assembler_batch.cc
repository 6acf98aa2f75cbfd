#include "bulk/solid_assembler_scratch.h"

#include <algorithm>
#include <cmath>
#include <sstream>

// What a sweep does with the cells that are worked on at once.

namespace Nodus
{
  using namespace dealii;

  void SolidAssembler::Scratch::gather(const Batch               &batch,
                                       const std::vector<double> &nodal,
                                       std::vector<Lanes>        &values) const
  {
    for (unsigned int v = 0; v < n_lanes; ++v)
    {
      const unsigned int *const node = cell_nodes.data() + batch.cell(v) * n_nodes;
      for (unsigned int i = 0; i < dim * n_nodes; ++i)
        values[i][v] = nodal[dim * node[i / dim] + i % dim];
    }
  }

  void SolidAssembler::Scratch::add_loads(const unsigned int cell, const unsigned int lane, const bool with_tangent)
  {
    const unsigned int *const node = cell_nodes.data() + cell * n_nodes;
    for (unsigned int i = 0; i < dim * n_nodes; ++i)
      at_cell.u[i] = at_lanes.u[i][lane];
    at_cell.internal = 0.;
    at_cell.external = 0.;
    at_cell.tangent  = 0.;
    loads.add(cell, {at_cell.u, at_cell.internal, at_cell.external, with_tangent ? &at_cell.tangent : nullptr});
    for (unsigned int i = 0; i < dim * n_nodes; ++i)
    {
      at_lanes.force[i][lane] += at_cell.internal(i);
      if (!is_constrained(cell))
        at_nodes.external[dim * node[i / dim] + i % dim] += at_cell.external(i);
    }
    if (with_tangent)
      stiffness.add(lane, at_cell.tangent);
  }

  void
  SolidAssembler::Scratch::add_constrained(const unsigned int cell, const unsigned int lane, BlockCsrMatrix *tangent)
  {
    for (unsigned int part = 0; part < 2; ++part)
      at_cell.forces[part].assign(dim * n_nodes, 0.);
    for (unsigned int i = 0; i < dim * n_nodes; ++i)
      at_cell.forces[0][i] = at_lanes.force[i][lane];
    if (loads.act_on(cell))
      std::copy(at_cell.external.begin(), at_cell.external.end(), at_cell.forces[1].begin());
    if (tangent)
      stiffness.copy_cell(lane, at_cell.stiffness);
    constrained.add(constrained.index(cell),
                    at_cell.forces[0],
                    at_cell.forces[1],
                    at_nodes.is_prescribed,
                    at_nodes.prescribed,
                    at_cell.stiffness,
                    tangent,
                    {at_nodes.internal, at_nodes.external, at_nodes.rhs});
  }

  /// No force; on the rows of the nodes, which are prescribed, a diagonal of the size of the others.
  void SolidAssembler::Scratch::compute_rigid(const Batch &batch, Lanes &det_F)
  {
    det_F = Lanes{} + 1.;
    std::fill(at_lanes.force.begin(), at_lanes.force.end(), Lanes{});
    stiffness.set_zero();
    const ElementKernel::QuadraturePoint *const points = this->points(batch);
    for (unsigned int v = 0; v < batch.size; ++v)
    {
      double volume = 0.;
      for (unsigned int q = 0; q < n_q; ++q)
        volume += points[q].JxW[v];
      const double diagonal = material(batch).youngs_modulus() * std::cbrt(volume) / n_nodes;
      for (unsigned int a = 0; a < n_nodes; ++a)
        for (unsigned int i = 0; i < dim; ++i)
          stiffness.entry(a, i, a, i, v) = diagonal;
    }
  }

  void SolidAssembler::Scratch::compute(const Batch       &batch,
                                        const bool         with_stiffness,
                                        Lanes             &det_F,
                                        InnerEnergy *const energy)
  {
    const ElementKernel::QuadraturePoint *const points = this->points(batch);
    Lanes                                       stored{};
    const bool goes_on = with_stiffness && iterates > 0 && kernel(batch).has_own_unknowns();
    if (goes_on)
      gather(batch, at_nodes.u_before, at_lanes.u_before);
    kernel(batch).integrate(points,
                            material(batch),
                            at_lanes.u.data(),
                            goes_on ? at_lanes.u_before.data() : nullptr,
                            {start->values.data() + batch.state, reached.data() + batch.state},
                            at_lanes.force.data(),
                            with_stiffness ? stiffness.data() : nullptr,
                            det_F,
                            energy ? &stored : nullptr);
    if (energy)
      add_energy(batch, points, stored, *energy);
  }

  void SolidAssembler::Scratch::add_energy(const Batch                                &batch,
                                           const ElementKernel::QuadraturePoint *const points,
                                           const Lanes                                &stored,
                                           InnerEnergy                                &energy) const
  {
    const unsigned int  n = material(batch).n_state();
    std::vector<double> state(n);
    for (unsigned int v = 0; v < batch.size; ++v)
      if (cells[batch.first + v].owned)
      {
        energy.stored += stored[v];
        for (unsigned int q = 0; n > 0 && q < n_q; ++q)
        {
          for (unsigned int i = 0; i < n; ++i)
            state[i] = reached[batch.state + q * n + i][v];
          energy.dissipated += material(batch).dissipation(state.data()) * points[q].JxW[v];
        }
      }
  }

  std::string SolidAssembler::Scratch::turned_inside_out(const Batch &batch, const Lanes &det_F) const
  {
    for (unsigned int v = 0; v < batch.size; ++v)
      if (!(det_F[v] > 0.))
      {
        const Cell        &cell = cells[batch.first + v];
        std::ostringstream message;
        message << "Body " << int(cell.body) + 1 << ": the element centred at (" << cell.centre
                << ") in the reference configuration is turned inside out, det F = " << det_F[v];
        return message.str();
      }
    return "";
  }

  void SolidAssembler::Scratch::scatter(const Batch &batch, BlockCsrMatrix *const tangent)
  {
    for (unsigned int v = 0; v < batch.size; ++v)
    {
      const unsigned int        c    = batch.first + v;
      const unsigned int *const node = cell_nodes.data() + c * n_nodes;
      if (loads.act_on(c))
        add_loads(c, v, tangent);
      if (is_constrained(c))
      {
        add_constrained(c, v, tangent);
        continue;
      }
      for (unsigned int i = 0; i < dim * n_nodes; ++i)
        at_nodes.internal[dim * node[i / dim] + i % dim] += at_lanes.force[i][v];
      if (!tangent)
        continue;
      stiffness.eliminate_prescribed(v, node, at_nodes.is_prescribed, at_nodes.prescribed, at_nodes.rhs);
      stiffness.add_to(*tangent, c, v);
    }
  }
} // namespace Nodus
