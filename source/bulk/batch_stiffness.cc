#include "bulk/batch_stiffness.h"

#include <algorithm>

namespace Nodus
{
  void BatchStiffness::make_pattern(const std::shared_ptr<const NodeMap> &nodes,
                                    const std::vector<unsigned int>      &cell_nodes,
                                    ConstrainedCells                     &constrained,
                                    BlockCsrMatrix                       &tangent)
  {
    const unsigned int n_cells        = cell_nodes.size() / n_nodes_;
    const auto         is_constrained = [&](const unsigned int c)
    { return constrained.index(c) != dealii::numbers::invalid_unsigned_int; };
    std::vector<unsigned int> group_nodes;
    std::vector<std::size_t>  group_end;
    group_nodes.reserve(cell_nodes.size());
    group_end.reserve(n_cells);
    for (unsigned int c = 0; c < n_cells; ++c)
      if (!is_constrained(c))
      {
        group_nodes.insert(
            group_nodes.end(), cell_nodes.begin() + c * n_nodes_, cell_nodes.begin() + (c + 1) * n_nodes_);
        group_end.push_back(group_nodes.size());
      }
    constrained.add_groups(group_nodes, group_end);
    tangent.reinit(nodes, group_nodes, group_end);
    constrained.find_positions(tangent);
    positions_.clear();
    positions_.reserve(n_cells * n_pairs_);
    for (unsigned int c = 0; c < n_cells; ++c)
      for (unsigned int a = 0; a < n_nodes_; ++a)
        for (unsigned int b = a; b < n_nodes_; ++b)
          positions_.push_back(is_constrained(c)
                                   ? BlockCsrMatrix::Position()
                                   : tangent.position(cell_nodes[c * n_nodes_ + a], cell_nodes[c * n_nodes_ + b]));
  }

  void BatchStiffness::set_zero()
  {
    std::fill(values_.begin(), values_.end(), Lanes{});
  }

  void BatchStiffness::add(const unsigned int lane, const dealii::FullMatrix<double> &loads)
  {
    for (unsigned int a = 0; a < n_nodes_; ++a)
      for (unsigned int b = a; b < n_nodes_; ++b)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int k = 0; k < dim; ++k)
            entry(a, i, b, k, lane) += loads(dim * a + i, dim * b + k);
  }

  void BatchStiffness::copy_cell(const unsigned int lane, std::vector<double> &blocks) const
  {
    blocks.resize(values_.size());
    for (std::size_t k = 0; k < values_.size(); ++k)
      blocks[k] = values_[k][lane];
  }
} // namespace Nodus
