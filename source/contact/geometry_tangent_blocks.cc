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

  /// Writes couplings of free nodes, and what prescribed displacements add to the right-hand side.
  class GeometryTangent::Writer
  {
  public:
    Writer(const ContactSurfaces &surfaces, const ContactState &state, LinearSystem &system)
        : surfaces_(surfaces)
        , layout_(surfaces.layout())
        , state_(state)
        , system_(system)
        , forces_(surfaces.nodes().size())
        , gaps_(surfaces.slave_nodes().size(), 0.)
    {
    }

    void add_force(const unsigned int row, const unsigned int column, const Matrix3 &value)
    {
      for (unsigned int i = 0; i < dim; ++i)
        surfaces_.for_each_unknown(row,
                                   i,
                                   state_.x[row],
                                   state_.centre,
                                   [&](const DoFIndex row_index, const double row_part)
                                   {
                                     for (unsigned int j = 0; j < dim; ++j)
                                     {
                                       if (is_prescribed(column, j))
                                       {
                                         const double missing = row_part * value[i][j] * state_.prescribed[column][j];
                                         if (is_inner(row_index))
                                           forces_[row][i] -= missing;
                                         else
                                           system_.border_rhs[row_index - layout_.size()] -= missing;
                                       }
                                       surfaces_.for_each_unknown(
                                           column,
                                           j,
                                           state_.x[column],
                                           state_.centre,
                                           [&](const DoFIndex column_index, const double part)
                                           { add(row_index, column_index, row_part * part * value[i][j]); });
                                     }
                                   });
    }

    void add_gap(const unsigned int slave, const unsigned int column, const Vector3 &value)
    {
      const DoFIndex row = layout_.lambda(surfaces_.multiplier(slave));
      for (unsigned int j = 0; j < dim; ++j)
      {
        if (is_prescribed(column, j))
          gaps_[slave] -= value[j] * state_.prescribed[column][j];
        else if (value[j] != 0.)
          surfaces_.for_each_unknown(column,
                                     j,
                                     state_.x[column],
                                     state_.centre,
                                     [&](const DoFIndex index, const double part)
                                     { add(row, index, part * value[j]); });
      }
    }

    /// Collective.
    void finish()
    {
      wait_for_all(layout_.communicator);
      surfaces_.add(forces_, system_.rhs.block(0));
      surfaces_.slave_exchange().sum(gaps_);
      const OwnedValues rhs(system_.rhs.block(1));
      for (unsigned int k = 0; k < surfaces_.n_owned_slave_nodes(); ++k)
        rhs(surfaces_.multiplier(k)) += gaps_[k];
      system_.symmetric = false;
    }

  private:
    bool is_inner(const DoFIndex index) const
    {
      return index < layout_.size();
    }
    bool is_prescribed(const unsigned int node, const unsigned int component) const
    {
      return surfaces_.fixed(node, component) && surfaces_.rigid_body(node) == dealii::numbers::invalid_unsigned_int;
    }
    void add(const DoFIndex row, const DoFIndex column, const double value)
    {
      (is_inner(row) && is_inner(column) ? system_.variation : system_.border).add(row, column, value);
    }

    const ContactSurfaces &surfaces_;
    const BlockLayout     &layout_;
    const ContactState    &state_;
    LinearSystem          &system_;
    std::vector<Vector3>   forces_; ///< for the right-hand side, per surface node
    std::vector<double>    gaps_;   ///< likewise per slave node
  };

  void GeometryTangent::write(const Sum &sum, const ContactState &state, LinearSystem &system) const
  {
    const std::uint64_t size = surfaces_.nodes().size();
    system.variation.reserve(system.variation.row.size() + dim * dim * sum.force.size() + dim * sum.gap.size());
    Writer writer(surfaces_, state, system);
    for (const auto &[key, value] : sum.force)
      surfaces_.expand(key / size,
                       1.,
                       [&, column = key % size, &value = value](const unsigned int row, const double row_part)
                       {
                         surfaces_.expand(column,
                                          row_part,
                                          [&](const unsigned int free_column, const double part)
                                          { writer.add_force(row, free_column, part * value); });
                       });
    for (const auto &[key, value] : sum.gap)
      surfaces_.expand(key % size,
                       1.,
                       [&, slave = key / size, &value = value](const unsigned int column, const double part)
                       { writer.add_gap(slave, column, part * value); });
    writer.finish();
  }
} // namespace Nodus
