#include "contact/geometry_tangent.h"
#include "parallel/owned_values.h"
#include "parallel/wait_for_all.h"

#include <algorithm>

// How couplings of nodes are brought together and written to the system.

namespace Nodus
{
  void GeometryTangent::Blocks::clear()
  {
    for (unsigned int row = 0; row < nodes.size(); ++row) // the others are zero
      std::fill_n(force.begin() + row * stride, nodes.size(), Matrix3());
    for (const unsigned int n : nodes)
      place[n] = none;
    nodes.clear();
    slaves.clear();
    offsets.clear();
    gap.clear();
  }

  unsigned int GeometryTangent::Blocks::node(const unsigned int n)
  {
    if (n >= place.size())
      place.resize(n + 1, none);
    if (place[n] != none)
      return place[n];
    const unsigned int i = place[n] = nodes.size();
    nodes.push_back(n);
    if (nodes.size() > stride)
    {
      const unsigned int   before = stride;
      std::vector<Matrix3> old_force(std::move(force));
      std::vector<Vector3> old_gap(std::move(gap));
      stride = std::max(32u, 2 * stride);
      force.assign(stride * stride, Matrix3());
      gap.assign(slaves.size() * stride, Vector3());
      for (unsigned int row = 0; row < before; ++row)
        std::copy_n(old_force.begin() + row * before, before, force.begin() + row * stride);
      for (unsigned int row = 0; row < slaves.size(); ++row)
        std::copy_n(old_gap.begin() + row * before, before, gap.begin() + row * stride);
    }
    return i;
  }

  unsigned int GeometryTangent::Blocks::slave(const unsigned int k)
  {
    const unsigned int i = std::find(slaves.begin(), slaves.end(), k) - slaves.begin();
    if (i == slaves.size())
    {
      slaves.push_back(k);
      gap.resize(slaves.size() * stride);
    }
    return i;
  }
  /// Neighbouring faces and slave nodes couple the same nodes: what they add is brought together first.
  void GeometryTangent::add_to(Sum &sum, const Blocks &blocks) const
  {
    const unsigned int  n    = blocks.nodes.size();
    const std::uint64_t size = surfaces_.nodes().size();
    for (unsigned int r = 0; r < n; ++r)
      for (unsigned int c = 0; c < n; ++c)
        if (const Matrix3 &value = blocks.force[r * blocks.stride + c]; value != Matrix3())
          sum.force[blocks.nodes[r] * size + blocks.nodes[c]] += value;
    for (unsigned int r = 0; r < blocks.slaves.size(); ++r)
      for (unsigned int c = 0; c < n; ++c)
        if (const Vector3 &value = blocks.gap[r * blocks.stride + c]; value != Vector3())
          sum.gap[blocks.slaves[r] * size + blocks.nodes[c]] += value;
  }

  void GeometryTangent::write(const Sum &sum, const ContactState &state, LinearSystem &system) const
  {
    const BlockLayout  &layout = surfaces_.layout();
    const auto         &nodes  = surfaces_.nodes();
    const std::uint64_t size   = nodes.size();
    system.variation.reserve(system.variation.row.size() + dim * dim * sum.force.size() + dim * sum.gap.size());
    // what prescribed displacements add to the right-hand side
    std::vector<Vector3> forces(nodes.size());
    std::vector<double>  gaps(surfaces_.slave_nodes().size(), 0.);
    const auto           is_inner = [&](const DoFIndex index) { return index < layout.size(); };
    const auto           is_rigid = [&](const unsigned int node)
    { return surfaces_.rigid_body(node) != dealii::numbers::invalid_unsigned_int; };
    const auto add_force = [&](const unsigned int row, const unsigned int column, const Matrix3 &value)
    {
      for (unsigned int i = 0; i < dim; ++i)
        surfaces_.for_each_unknown(row,
                                   i,
                                   state.x[row],
                                   state.centre,
                                   [&](const DoFIndex row_index, const double row_part)
                                   {
                                     for (unsigned int j = 0; j < dim; ++j)
                                     {
                                       if (surfaces_.fixed(column, j) && !is_rigid(column))
                                       {
                                         const double missing = row_part * value[i][j] * state.prescribed[column][j];
                                         if (is_inner(row_index))
                                           forces[row][i] -= missing;
                                         else
                                           system.border_rhs[row_index - layout.size()] -= missing;
                                       }
                                       surfaces_.for_each_unknown(
                                           column,
                                           j,
                                           state.x[column],
                                           state.centre,
                                           [&](const DoFIndex column_index, const double part)
                                           {
                                             (is_inner(row_index) && is_inner(column_index) ? system.variation
                                                                                            : system.border)
                                                 .add(row_index, column_index, row_part * part * value[i][j]);
                                           });
                                     }
                                   });
    };
    const auto add_gap = [&](const unsigned int slave, const unsigned int column, const Vector3 &value)
    {
      for (unsigned int j = 0; j < dim; ++j)
      {
        if (surfaces_.fixed(column, j) && !is_rigid(column))
          gaps[slave] -= value[j] * state.prescribed[column][j];
        else if (value[j] != 0.)
          surfaces_.for_each_unknown(column,
                                     j,
                                     state.x[column],
                                     state.centre,
                                     [&](const DoFIndex index, const double part)
                                     {
                                       (is_inner(index) ? system.variation : system.border)
                                           .add(layout.lambda(surfaces_.multiplier(slave)), index, part * value[j]);
                                     });
      }
    };
    for (const auto &[key, value] : sum.force)
      surfaces_.expand(key / size,
                       1.,
                       [&, column = key % size, &value = value](const unsigned int row, const double row_part)
                       {
                         surfaces_.expand(column,
                                          row_part,
                                          [&](const unsigned int free_column, const double part)
                                          { add_force(row, free_column, part * value); });
                       });
    for (const auto &[key, value] : sum.gap)
      surfaces_.expand(key % size,
                       1.,
                       [&, slave = key / size, &value = value](const unsigned int column, const double part)
                       { add_gap(slave, column, part * value); });
    wait_for_all(surfaces_.layout().communicator);
    surfaces_.add(forces, system.rhs.block(0));
    surfaces_.slave_exchange().sum(gaps);
    const OwnedValues rhs(system.rhs.block(1));
    for (unsigned int k = 0; k < surfaces_.n_owned_slave_nodes(); ++k)
      rhs(surfaces_.multiplier(k)) += gaps[k];
    system.symmetric = false;
  }
} // namespace Nodus
